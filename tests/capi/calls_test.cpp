// SPDX-License-Identifier: MIT
// Random sequences of calls through mien.h on a head with guards, a gaze, clips and their bindings. Right arguments
// succeed, wrong ones return their status and change nothing, numbers stay finite, and a mixer that was restored
// goes on with the same bits.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "tests/support/deform_rig.h"

namespace mien {
namespace {

constexpr int64_t kFrame = MIEN_TICKS_PER_SECOND / 60;
constexpr uint32_t kVariables = 3;

struct Close {
  void operator()(MienMix* mix) const { mien_mix_destroy(mix); }
  void operator()(MienMixer* mixer) const { mien_mixer_destroy(mixer); }
  void operator()(MienGaze* gaze) const { mien_gaze_destroy(gaze); }
  void operator()(MienClip* clip) const { mien_clip_close(clip); }
  void operator()(MienClipBinding* binding) const { mien_clip_binding_destroy(binding); }
  void operator()(MienClipPlayer* player) const { mien_clip_player_destroy(player); }
};
template <class T>
using Owned = std::unique_ptr<T, Close>;

enum Layer : uint32_t { kSpeech, kMood, kEyes, kLayers };

struct Stage {
  DnaHandle dna = generate_dna(MIEN_PRESET_HEAD, 0);
  RigHandle rig = create_rig(dna.get());
  DeformerHandle deformer = create_deformer(dna.get(), rig.get());
  uint32_t raw_count = count_of(rig, MIEN_KIND_RAW_CONTROL);
  Owned<MienGaze> gaze;
  Owned<MienMix> mix;
  Owned<MienClip> clip;
  Owned<MienClipBinding> binding;
  uint32_t guard_count = 0;

  Stage() {
    make_clip();
    MienGaze* eyes = nullptr;
    EXPECT_EQ(mien_gaze_create(deformer.get(), nullptr, &eyes, nullptr), MIEN_OK);
    gaze.reset(eyes);
    make_mix();
  }

  uint16_t control(const char* name) const {
    uint32_t index = 0;
    EXPECT_EQ(mien_rig_find(rig.get(), MIEN_KIND_RAW_CONTROL, name, &index), MIEN_OK) << name;
    return static_cast<uint16_t>(index);
  }

  /// A mouth that opens and closes.
  void make_clip() {
    const MienStringView names[] = {{"jawOpen", 7}, {"mouthClose", 10}, {"mouthFunnel", 11}};
    std::vector<float> values;
    for (int f = 0; f < 60; ++f) {
      const float open = f % 20 < 10 ? 0 : 0.4f;
      values.insert(values.end(), {open, 0, static_cast<float>(f) / 60});
    }
    MienClipDesc desc = sized<MienClipDesc>();
    desc.names = names;
    desc.values = values.data();
    desc.frame_count = 60;
    desc.channel_count = 3;
    MienClip* made = nullptr;
    EXPECT_EQ(mien_clip_build(&desc, &made, nullptr), MIEN_OK);
    clip.reset(made);
    MienClipBinding* bound = nullptr;
    EXPECT_EQ(mien_clip_binding_create(made, rig.get(), nullptr, &bound, nullptr), MIEN_OK);
    binding.reset(bound);
  }

  void make_mix() {
    const uint16_t smile[] = {control("mouthSmileLeft"), control("mouthSmileRight"),
                              control("jawOpen")};
    const float joy[] = {1, 1, 0.5f};
    const MienMixPose pose = {smile, joy, 3};
    const auto first = static_cast<uint16_t>(raw_count);
    const uint16_t target[] = {first, static_cast<uint16_t>(first + 1),
                               static_cast<uint16_t>(first + 2)};
    const float jitter[3] = {};
    MienMixLayer layers[kLayers] = {};
    for (MienMixLayer& layer : layers) layer.weight = 1;
    layers[kSpeech].group = MIEN_LAYER_GROUP_SPEECH;
    layers[kMood].group = MIEN_LAYER_GROUP_EMOTION;
    layers[kMood].mode = MIEN_BLEND_MODE_SCREEN;
    layers[kMood].source = MIEN_LAYER_SOURCE_POSES;
    layers[kMood].pose_count = 1;
    layers[kEyes].group = MIEN_LAYER_GROUP_LIFE;
    layers[kEyes].source = MIEN_LAYER_SOURCE_GENERATOR;
    layers[kEyes].generator = MIEN_GENERATOR_GAZE;
    layers[kEyes].period = MIEN_TICKS_PER_SECOND;
    layers[kEyes].curves = target;
    layers[kEyes].amounts = jitter;
    layers[kEyes].curve_count = 3;
    MienMixDesc desc = sized<MienMixDesc>();
    desc.layers = layers;
    desc.layer_count = kLayers;
    desc.poses = &pose;
    desc.pose_count = 1;
    desc.variable_count = kVariables;
    desc.gaze = gaze.get();
    desc.deformer = deformer.get();
    desc.guards = MIEN_GUARD_LIPS;
    MienMix* made = nullptr;
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_mix_create(rig.get(), &desc, &made, &error), MIEN_OK) << error.message;
    mix.reset(made);
    MienMixInfo info = sized<MienMixInfo>();
    EXPECT_EQ(mien_mix_info(made, &info), MIEN_OK);
    guard_count = info.guard_count;
  }
};

bool all_finite(const float* values, size_t count) {
  return std::all_of(values, values + count, [](float v) { return std::isfinite(v); });
}

/// One character, and what is done to it. Each call says whether its arguments were right.
struct Actor {
  const Stage& stage;
  std::mt19937 random;
  Owned<MienMixer> mixer;
  Owned<MienClipPlayer> player;
  InstanceHandle face;
  float most_activation = 0;

  Actor(const Stage& on, uint32_t seed) : stage(on), random(seed) {
    MienMixer* made = nullptr;
    EXPECT_EQ(mien_mixer_create(stage.mix.get(), nullptr, &made, nullptr), MIEN_OK);
    mixer.reset(made);
    MienClipPlayer* plays = nullptr;
    EXPECT_EQ(mien_clip_player_create(stage.clip.get(), nullptr, &plays, nullptr), MIEN_OK);
    player.reset(plays);
    MienInstance* instance = nullptr;
    EXPECT_EQ(mien_instance_create(stage.rig.get(), nullptr, &instance, nullptr), MIEN_OK);
    face.reset(instance);
  }

  uint32_t below(uint32_t end) { return random() % end; }
  float share() { return static_cast<float>(below(257)) / 256; }
  int64_t some_ticks() { return below(4) == 0 ? 0 : below(60) * kFrame; }
  /// Mostly an index that exists.
  uint32_t index(uint32_t count) { return below(8) == 0 ? count + below(3) : below(count); }
  MienStatus expected(bool exists) const { return exists ? MIEN_OK : MIEN_ERROR_INDEX; }
  std::vector<float> row() const {
    MienFloatView view = {};
    EXPECT_EQ(mien_mixer_row(mixer.get(), &view), MIEN_OK);
    return {view.data, view.data + view.count};
  }

  bool play() {
    MienPlayDesc desc = sized<MienPlayDesc>();
    desc.transition = below(3);
    desc.transition_ticks = some_ticks();
    desc.clip_id = 7;
    const bool right = below(8) != 0;
    EXPECT_EQ(mien_mixer_play(mixer.get(), right ? kSpeech : kMood, stage.clip.get(),
                              stage.binding.get(), &desc, nullptr) == MIEN_OK,
              right);
    return right;
  }
  bool stop() { return mien_mixer_stop(mixer.get(), kSpeech, some_ticks()) == MIEN_OK; }
  bool set_mood() {
    const uint32_t pose = index(1);
    EXPECT_EQ(mien_mixer_set_pose_weight(mixer.get(), kMood, pose, share(), some_ticks()),
              expected(pose < 1));
    return pose < 1;
  }
  bool set_guard() {
    const uint32_t guard = index(stage.guard_count);
    const float activation = below(3) == 0 ? -1 : share();
    EXPECT_EQ(mien_mixer_set_guard(mixer.get(), guard, activation),
              expected(guard < stage.guard_count));
    EXPECT_EQ(mien_mixer_set_guard(mixer.get(), 0, below(2) ? 1.5f : NAN),
              MIEN_ERROR_INVALID_ARGUMENT);
    return guard < stage.guard_count;
  }
  bool read_guard() {
    const uint32_t guard = index(stage.guard_count);
    MienGuardState state = sized<MienGuardState>();
    EXPECT_EQ(mien_mixer_guard(mixer.get(), guard, &state), expected(guard < stage.guard_count));
    if (guard >= stage.guard_count) return false;
    const float numbers[] = {state.activation, state.protected_distance, state.wanted, state.limit,
                             state.distance};
    EXPECT_TRUE(all_finite(numbers, std::size(numbers)));
    EXPECT_TRUE(state.activation >= 0 && state.activation <= 1) << state.activation;
    most_activation = std::max(most_activation, state.activation);
    return true;
  }
  bool set_target() {
    const uint32_t variable = index(kVariables);
    const float value = (share() - 0.5f) * 4000;
    EXPECT_EQ(mien_mixer_set_variable(mixer.get(), variable, value),
              expected(variable < kVariables));
    return variable < kVariables;
  }
  bool look_at() {
    std::vector<float> row(stage.raw_count, 9);
    const bool right = below(8) != 0;
    const MienGazeTarget target = {(share() - 0.5f) * 4000,
                                   right ? (share() - 0.5f) * 4000 : INFINITY, 1000};
    MienGazeRest rest = {};
    EXPECT_EQ(mien_gaze_look_at(stage.gaze.get(), &target, row.data(), row.size(), &rest),
              right ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT);
    EXPECT_TRUE(all_finite(row.data(), row.size()));
    EXPECT_TRUE(right || row == std::vector<float>(stage.raw_count, 9));
    return right;
  }
  bool apply_binding() {
    MienFloatView values = {};
    EXPECT_EQ(mien_clip_player_advance(player.get(), below(40) * kFrame), MIEN_OK);
    EXPECT_EQ(mien_clip_player_sample(player.get(), &values), MIEN_OK);
    std::vector<float> row(stage.raw_count, 9);
    const bool right = below(8) != 0;
    EXPECT_EQ(mien_clip_binding_apply(stage.binding.get(), values.data, values.count + !right,
                                      row.data(), row.size()),
              right ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT);
    const auto driven = std::count_if(row.begin(), row.end(), [](float v) { return v != 9; });
    EXPECT_EQ(driven, right ? 3 : 0);
    return right;
  }
  bool step() {
    const int64_t ticks = below(8) == 0 ? -1 : below(6) * kFrame / 2;
    const std::vector<float> before = row();
    EXPECT_EQ(mien_mixer_step(mixer.get(), ticks, face.get()) == MIEN_OK, ticks >= 0);
    const std::vector<float> after = row();
    EXPECT_TRUE(all_finite(after.data(), after.size()));
    EXPECT_TRUE(ticks >= 0 || before == after);
    return ticks >= 0;
  }
  bool evaluate() {
    EXPECT_EQ(mien_rig_evaluate(stage.rig.get(), face.get(), below(2)), MIEN_OK);
    MienFloatView joints = {};
    EXPECT_EQ(mien_instance_joints(face.get(), &joints), MIEN_OK);
    EXPECT_TRUE(all_finite(joints.data, joints.count));
    return true;
  }
  /// A copy goes on with the same bits.
  bool restore() {
    size_t size = 0;
    EXPECT_EQ(mien_mixer_snapshot(mixer.get(), nullptr, 0, &size, nullptr), MIEN_OK);
    std::vector<uint8_t> bytes(size);
    EXPECT_EQ(mien_mixer_snapshot(mixer.get(), bytes.data(), size, &size, nullptr), MIEN_OK);
    MienMixerClip clips[1] = {};
    clips[0].clip_id = 7;
    clips[0].clip = stage.clip.get();
    clips[0].clip_binding = stage.binding.get();
    Actor copy(stage, 1);
    if (below(8) == 0) {
      EXPECT_NE(mien_mixer_restore(copy.mixer.get(), bytes.data(), size - 1, clips, 1, nullptr),
                MIEN_OK);
      return false;
    }
    EXPECT_EQ(mien_mixer_restore(copy.mixer.get(), bytes.data(), size, clips, 1, nullptr), MIEN_OK);
    for (Actor* each : {this, &copy}) {
      EXPECT_EQ(mien_mixer_step(each->mixer.get(), kFrame, nullptr), MIEN_OK);
    }
    EXPECT_EQ(row(), copy.row());
    return true;
  }
};

TEST(Calls, SucceedInAnyOrder) {
  const Stage stage;
  ASSERT_GT(stage.guard_count, 0u);
  using Call = bool (Actor::*)();
  const Call calls[] = {&Actor::play,      &Actor::stop,          &Actor::set_mood,
                        &Actor::set_guard, &Actor::read_guard,    &Actor::set_target,
                        &Actor::look_at,   &Actor::apply_binding, &Actor::step,
                        &Actor::evaluate,  &Actor::restore};
  uint32_t right[std::size(calls)] = {}, all[std::size(calls)] = {};
  float most_activation = 0;
  for (uint32_t seed = 0; seed < 20 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Actor actor(stage, seed);
    for (int i = 0; i < 250; ++i) {
      // Half of the calls are steps, so that something happens between the others.
      const size_t c = actor.below(2) ? 8 : actor.below(static_cast<uint32_t>(std::size(calls)));
      ++all[c];
      right[c] += (actor.*calls[c])();
    }
    most_activation = std::max(most_activation, actor.most_activation);
  }
  for (size_t c = 0; c < std::size(calls); ++c) {
    EXPECT_GT(right[c], all[c] / 2) << c;
    EXPECT_GT(right[c], 20u) << c;
  }
  EXPECT_GT(most_activation, 0.5f) << "guards acted";
}

}  // namespace
}  // namespace mien
