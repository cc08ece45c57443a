// SPDX-License-Identifier: MIT
// Mixes and mixers through mien.h: rows reach instances, snapshots continue, wrong arguments, every
// allocation failing once. What mixing does is tested in tests/mix.
#include <cmath>
#include <cstdio>
#include <functional>

#include "tests/support/counting_allocator.h"
#include "tests/support/misuse.h"
#include "tests/support/plain_rig.h"
#include "tests/support/temporary_path.h"

namespace mien {
namespace {

constexpr int64_t kStep = MIEN_TICKS_PER_SECOND / 60;

/// A rig of six raw controls, a clip for the first two, and a mix of everything.
struct Scene {
  RigHandle rig;
  ClipHandle clip;
  BindingHandle binding;
  std::vector<MienMixLayer> layers = std::vector<MienMixLayer>(4);
  std::vector<MienMixPose> poses;
  MienMixStroke stroke = {};
  MienMixReaction reaction = {};
  MienMixAntagonists antagonists = {4, 5, 1.0f};
  std::vector<float> lower = std::vector<float>(7, 0.0f), upper = std::vector<float>(7, 1.0f);
  const uint16_t pose_curves[2] = {2, 6};
  const float pose_values[2] = {0.5f, 1.0f};
  const uint16_t lid[1] = {3};
  const float one[1] = {1};

  Scene() {
    PlainRig plain;
    plain.raw_count = 6;
    rig = make_rig(plain);
    const std::vector<std::string> names = names_of(rig, MIEN_KIND_RAW_CONTROL);
    MienStringView views[2];
    for (int i = 0; i < 2; ++i) views[i] = {names[i].data(), names[i].size()};
    std::vector<float> values(2 * 61);
    for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i) / 128;
    const MienClipEvent event = {10 * kStep, {"word", 4}, 0.5f, 0};
    MienClipDesc desc = sized<MienClipDesc>();
    desc.names = views;
    desc.values = values.data();
    desc.frame_count = 61;
    desc.channel_count = 2;
    desc.events = &event;
    desc.event_count = 1;
    MienClip* made = nullptr;
    EXPECT_EQ(mien_clip_build(&desc, &made, nullptr), MIEN_OK);
    clip.reset(made);
    MienClipBinding* bound = nullptr;
    EXPECT_EQ(mien_clip_binding_create(made, rig.get(), nullptr, &bound, nullptr), MIEN_OK);
    binding.reset(bound);

    poses.push_back({pose_curves, pose_values, 2});
    layers[0].group = MIEN_LAYER_GROUP_SPEECH;
    layers[1].group = MIEN_LAYER_GROUP_EMOTION;
    layers[1].mode = MIEN_BLEND_MODE_SCREEN;
    layers[1].source = MIEN_LAYER_SOURCE_POSES;
    layers[1].pose_count = 1;
    layers[2].source = MIEN_LAYER_SOURCE_STREAM;
    layers[2].curves = lid;
    layers[2].curve_count = 1;
    layers[3].group = MIEN_LAYER_GROUP_LIFE;
    layers[3].mode = MIEN_BLEND_MODE_ADD;
    layers[3].source = MIEN_LAYER_SOURCE_GENERATOR;
    layers[3].generator = MIEN_GENERATOR_NOISE;
    layers[3].period = MIEN_TICKS_PER_SECOND;
    layers[3].curves = lid;
    layers[3].amounts = one;
    layers[3].curve_count = 1;
    for (MienMixLayer& layer : layers) layer.weight = 1;
    stroke.attack = stroke.release = 6 * kStep;
    stroke.is_held = 1;
    reaction.strokes = &stroke;
    reaction.stroke_count = 1;
    reaction.adapted = 1;
  }

  MienMixDesc desc() const {
    MienMixDesc desc = sized<MienMixDesc>();
    desc.layers = layers.data();
    desc.layer_count = layers.size();
    desc.poses = poses.data();
    desc.pose_count = poses.size();
    desc.reactions = &reaction;
    desc.reaction_count = 1;
    desc.antagonists = &antagonists;
    desc.antagonist_count = 1;
    desc.lower = lower.data();
    desc.upper = upper.data();
    desc.variable_count = 1;
    return desc;
  }
  MixHandle mix(MienStatus expected = MIEN_OK) const { return mix(desc(), expected); }
  MixHandle mix(const MienMixDesc& from, MienStatus expected = MIEN_OK) const {
    MienMix* made = nullptr;
    MienError error = sized<MienError>();
    EXPECT_EQ(mien_mix_create(rig.get(), &from, &made, &error), expected) << error.message;
    EXPECT_EQ(made == nullptr, expected != MIEN_OK);
    return MixHandle(made);
  }
  static MixerHandle mixer(const MixHandle& mix, uint32_t stages = 0) {
    MienMixerDesc desc = sized<MienMixerDesc>();
    desc.stages = stages;
    MienMixer* made = nullptr;
    EXPECT_EQ(mien_mixer_create(mix.get(), &desc, &made, nullptr), MIEN_OK);
    return MixerHandle(made);
  }
  MienStatus play(const MixerHandle& mixer, uint32_t layer = 0) const {
    MienPlayDesc desc = sized<MienPlayDesc>();
    desc.transition = MIEN_TRANSITION_CUT;
    desc.clip_id = 77;
    return mien_mixer_play(mixer.get(), layer, clip.get(), binding.get(), &desc, nullptr);
  }
};

std::vector<float> row_of(const MixerHandle& mixer) {
  MienFloatView row = {};
  EXPECT_EQ(mien_mixer_row(mixer.get(), &row), MIEN_OK);
  return {row.data, row.data + row.count};
}

TEST(Mixer, WritesItsRowIntoTheControlsOfAnInstance) {
  const Scene scene;
  const MixHandle mix = scene.mix();
  const MixerHandle mixer = Scene::mixer(mix, 1);
  Character face(scene.rig);
  ASSERT_EQ(scene.play(mixer), MIEN_OK);
  ASSERT_EQ(mien_mixer_set_pose_weight(mixer.get(), 1, 0, 1.0f, 0), MIEN_OK);
  ASSERT_EQ(mien_mixer_set_variable(mixer.get(), 0, 0.25f), MIEN_OK);
  ASSERT_EQ(mien_mixer_set_weight(mixer.get(), 3, 0.0f, 0), MIEN_OK);
  ASSERT_EQ(mien_mixer_step(mixer.get(), 10 * kStep, face.instance.get()), MIEN_OK);
  const std::vector<float> row = row_of(mixer);
  EXPECT_EQ(row, (std::vector<float>{20 / 128.0f, 21 / 128.0f, 0.5f, 0, 0, 0, 1.0f}));
  EXPECT_TRUE(same_bits(span_of(row).first(6), face.raw));

  MienMixerInfo info = sized<MienMixerInfo>();
  ASSERT_EQ(mien_mixer_info(mixer.get(), &info), MIEN_OK);
  EXPECT_EQ(info.tick, 10 * kStep);
  ASSERT_EQ(info.event_count, 1u);
  MienClipEvent event;
  uint32_t layer = 9;
  ASSERT_EQ(mien_mixer_event(mixer.get(), 0, &event, &layer), MIEN_OK);
  EXPECT_EQ(std::string(event.name.data, event.name.count), "word");
  EXPECT_EQ(layer, 0u);
  EXPECT_EQ(mien_mixer_event(mixer.get(), 1, &event, &layer), MIEN_ERROR_INDEX);

  MienMixInfo mix_info = sized<MienMixInfo>();
  ASSERT_EQ(mien_mix_info(mix.get(), &mix_info), MIEN_OK);
  EXPECT_EQ(mix_info.raw_control_count, 6u);
  EXPECT_EQ(mix_info.curve_count, 7u);
  EXPECT_EQ(mix_info.layer_count, 4u);
  EXPECT_EQ(mix_info.guard_count, 0u);
  MienFloatView first, last;
  ASSERT_EQ(mien_mixer_stage(mixer.get(), 0, &first), MIEN_OK);
  EXPECT_EQ(first.data[2], 0.0f);
  ASSERT_EQ(mien_mixer_stage(mixer.get(), mix_info.stage_count - 1, &last), MIEN_OK);
  EXPECT_EQ(last.data[2], 0.5f);
  EXPECT_EQ(mien_mixer_stage(mixer.get(), mix_info.stage_count, &last), MIEN_ERROR_INDEX);
}

TEST(Mixer, ReactsStreamsAndStops) {
  const Scene scene;
  const MixHandle mix = scene.mix();
  const MixerHandle mixer = Scene::mixer(mix);
  ASSERT_EQ(mien_mixer_set_weight(mixer.get(), 3, 0.0f, 0), MIEN_OK);
  ASSERT_EQ(mien_mixer_trigger(mixer.get(), 0, 1.0f, -1), MIEN_OK);
  ASSERT_EQ(mien_mixer_step(mixer.get(), 600 * kStep, nullptr), MIEN_OK);
  EXPECT_EQ(row_of(mixer)[2], 0.5f);
  ASSERT_EQ(mien_mixer_release(mixer.get(), 0), MIEN_OK);
  ASSERT_EQ(mien_mixer_step(mixer.get(), 6 * kStep, nullptr), MIEN_OK);
  EXPECT_EQ(row_of(mixer)[2], 0.0f);

  const float value = 0.75f;
  uint32_t accepted = 9;
  for (int i = 0; i < 30; ++i) {
    ASSERT_EQ(mien_mixer_push(mixer.get(), 2, (606 + i) * kStep, &value, 1, &accepted), MIEN_OK);
    EXPECT_EQ(accepted, 1u);
    ASSERT_EQ(mien_mixer_step(mixer.get(), kStep, nullptr), MIEN_OK);
  }
  EXPECT_EQ(row_of(mixer)[3], 0.75f);
  ASSERT_EQ(mien_mixer_push(mixer.get(), 2, 0, &value, 1, &accepted), MIEN_OK);
  EXPECT_EQ(accepted, 0u);

  ASSERT_EQ(scene.play(mixer), MIEN_OK);
  ASSERT_EQ(mien_mixer_step(mixer.get(), kStep, nullptr), MIEN_OK);
  EXPECT_GT(row_of(mixer)[0], 0.0f);
  ASSERT_EQ(mien_mixer_stop(mixer.get(), 0, kStep), MIEN_OK);
  ASSERT_EQ(mien_mixer_step(mixer.get(), kStep, nullptr), MIEN_OK);
  EXPECT_EQ(row_of(mixer)[0], 0.0f);
}

TEST(Mixer, ABatchIsEachAlone) {
  const Scene scene;
  const MixHandle mix = scene.mix();
  std::vector<MixerHandle> together, alone;
  std::vector<MienMixer*> mixers;
  std::vector<Character> faces;
  std::vector<MienInstance*> instances;
  for (int i = 0; i < 5; ++i) faces.emplace_back(scene.rig);
  for (int i = 0; i < 5; ++i) {
    together.push_back(Scene::mixer(mix));
    alone.push_back(Scene::mixer(mix));
    ASSERT_EQ(scene.play(together[i]), MIEN_OK);
    ASSERT_EQ(scene.play(alone[i]), MIEN_OK);
    ASSERT_EQ(mien_mixer_step(together[i].get(), i * kStep, nullptr), MIEN_OK);
    ASSERT_EQ(mien_mixer_step(alone[i].get(), i * kStep, nullptr), MIEN_OK);
    mixers.push_back(together[i].get());
    instances.push_back(faces[i].instance.get());
  }
  ASSERT_EQ(mien_mixer_step_batch(mixers.data(), instances.data(), 5, kStep), MIEN_OK);
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(mien_mixer_step(alone[i].get(), kStep, nullptr), MIEN_OK);
    const std::vector<float> row = row_of(alone[i]);
    EXPECT_TRUE(same_bits(span_of(row).first(6), faces[i].raw));
  }
  mixers[4] = nullptr;
  const std::vector<float> before = row_of(together[0]);
  EXPECT_EQ(mien_mixer_step_batch(mixers.data(), nullptr, 5, kStep), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(row_of(together[0]), before);
  mixers[4] = mixers[1];
  EXPECT_EQ(mien_mixer_step_batch(mixers.data(), nullptr, 5, kStep), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(row_of(together[0]), before);
  EXPECT_EQ(mien_mixer_step_batch(mixers.data(), nullptr, 4, kStep), MIEN_OK);
}

TEST(Mixer, TimeEndsWhereSumsOfTimesWouldOverflow) {
  const Scene scene;
  const MixHandle mix = scene.mix();
  const MixerHandle mixer = Scene::mixer(mix);
  size_t size = 0;
  ASSERT_EQ(mien_mixer_snapshot(mixer.get(), nullptr, 0, &size, nullptr), MIEN_OK);
  std::vector<uint8_t> snapshot(size);
  ASSERT_EQ(mien_mixer_snapshot(mixer.get(), snapshot.data(), size, &size, nullptr), MIEN_OK);
  const auto restore_at = [&](int64_t tick) {
    memcpy(snapshot.data() + 24, &tick, sizeof(tick));  // behind the header
    return mien_mixer_restore(mixer.get(), snapshot.data(), size, nullptr, 0, nullptr);
  };
  constexpr int64_t kEnd = (int64_t{1} << 60) - 1, kLongest = int64_t{1} << 40;
  EXPECT_EQ(restore_at(kEnd + 1), MIEN_ERROR_INVALID_ARGUMENT);
  ASSERT_EQ(restore_at(kEnd - kLongest), MIEN_OK);
  EXPECT_EQ(mien_mixer_trigger(mixer.get(), 0, 1, kLongest), MIEN_OK);
  EXPECT_EQ(mien_mixer_step(mixer.get(), kLongest, nullptr), MIEN_OK);
  MienMixer* const one = mixer.get();
  EXPECT_EQ(mien_mixer_step(one, 1, nullptr), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_mixer_step_batch(&one, nullptr, 1, kLongest), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_mixer_step(one, 0, nullptr), MIEN_OK);
  MienMixerInfo info = sized<MienMixerInfo>();
  ASSERT_EQ(mien_mixer_info(one, &info), MIEN_OK);
  EXPECT_EQ(info.tick, kEnd);
  // Whatever it was told to do until then fits into a snapshot.
  EXPECT_EQ(mien_mixer_trigger(one, 0, 1, kLongest), MIEN_OK);
  ASSERT_EQ(mien_mixer_snapshot(one, snapshot.data(), size, &size, nullptr), MIEN_OK);
  EXPECT_EQ(mien_mixer_restore(one, snapshot.data(), size, nullptr, 0, nullptr), MIEN_OK);
}

TEST(Mixer, OutlivesItsMix) {
  const Scene scene;
  CountingAllocator counting;
  const MienAllocator allocator = counting.get();
  MienMixDesc desc = scene.desc();
  desc.allocator = &allocator;
  MixHandle mix = scene.mix(desc);
  MixerHandle one = Scene::mixer(mix), other = Scene::mixer(mix);
  mix.reset();
  ASSERT_EQ(scene.play(one), MIEN_OK);
  ASSERT_EQ(mien_mixer_step(one.get(), kStep, nullptr), MIEN_OK);
  EXPECT_GT(row_of(one)[0], 0.0f);
  one.reset();
  EXPECT_FALSE(counting.clean()) << "the other mixer needs the mix";
  other.reset();
  EXPECT_TRUE(counting.clean()) << counting.first_wrong;
}

TEST(Mixer, FollowsTheLevelOfWhatItReactsTo) {
  Scene scene;
  scene.stroke.is_scaled = 1;
  scene.reaction.level_on = 0.5f;
  scene.reaction.level_off = 0.25f;
  const MixHandle mix = scene.mix();
  const MixerHandle mixer = Scene::mixer(mix);
  ASSERT_EQ(mien_mixer_set_weight(mixer.get(), 3, 0.0f, 0), MIEN_OK);
  const auto after = [&](float level, int64_t ticks) {
    EXPECT_EQ(mien_mixer_set_level(mixer.get(), 0, level), MIEN_OK);
    EXPECT_EQ(mien_mixer_step(mixer.get(), ticks, nullptr), MIEN_OK);
    return row_of(mixer)[2];
  };
  const int64_t while_it_settles = 2 * MIEN_TICKS_PER_SECOND;
  EXPECT_EQ(after(0.49f, while_it_settles), 0.0f);
  EXPECT_EQ(after(0.5f, while_it_settles), 0.25f);
  EXPECT_EQ(after(1.0f, while_it_settles), 0.5f);
  EXPECT_EQ(after(0.25f, while_it_settles), 0.125f);
  EXPECT_EQ(after(0.24f, MIEN_TICKS_PER_SECOND / 20), 0.125f) << "it may flicker";
  EXPECT_EQ(after(0.24f, 6 * kStep), 0.0f);
}

TEST(Mixer, SnapshotsContinueToTheBit) {
  Scene scene;
  scene.stroke.is_scaled = 1;
  scene.reaction.level_on = 0.5f;
  const MixHandle mix = scene.mix();
  const MixerHandle one = Scene::mixer(mix), other = Scene::mixer(mix);
  ASSERT_EQ(scene.play(one), MIEN_OK);
  ASSERT_EQ(mien_mixer_trigger(one.get(), 0, 1.0f, 20 * kStep), MIEN_OK);
  ASSERT_EQ(mien_mixer_step(one.get(), 5 * kStep, nullptr), MIEN_OK);
  ASSERT_EQ(mien_mixer_set_level(one.get(), 0, 0.6f), MIEN_OK);
  ASSERT_EQ(mien_mixer_step(one.get(), kStep, nullptr), MIEN_OK);
  size_t size = 0;
  ASSERT_EQ(mien_mixer_snapshot(one.get(), nullptr, 0, &size, nullptr), MIEN_OK);
  MienMixInfo info = sized<MienMixInfo>();
  ASSERT_EQ(mien_mix_info(mix.get(), &info), MIEN_OK);
  EXPECT_EQ(info.snapshot_bytes, size);
  Bytes bytes(size);
  EXPECT_EQ(mien_mixer_snapshot(one.get(), bytes.data(), size - 1, &size, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  ASSERT_EQ(mien_mixer_snapshot(one.get(), bytes.data(), size, &size, nullptr), MIEN_OK);
  const MienMixerClip clips[] = {{76, nullptr, nullptr},
                                 {77, scene.clip.get(), scene.binding.get()}};
  EXPECT_EQ(mien_mixer_restore(other.get(), bytes.data(), size, clips, 1, nullptr),
            MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_mixer_restore(other.get(), bytes.data(), size - 1, clips, 2, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  ASSERT_EQ(mien_mixer_restore(other.get(), bytes.data(), size, clips, 2, nullptr), MIEN_OK);
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(mien_mixer_step(one.get(), kStep, nullptr), MIEN_OK);
    ASSERT_EQ(mien_mixer_step(other.get(), kStep, nullptr), MIEN_OK);
    ASSERT_EQ(row_of(one), row_of(other));
  }
}

TEST(Mix, RefusesWhatIsWrong) {
  const auto refused = [](MienStatus expected, auto&& change) {
    Scene scene;
    MienMixDesc desc = scene.desc();
    change(scene, desc);
    scene.mix(desc, expected);
  };
  const MienStatus null = MIEN_ERROR_NULL_ARGUMENT, invalid = MIEN_ERROR_INVALID_ARGUMENT;
  refused(null, [](Scene&, MienMixDesc& d) { d.layers = nullptr; });
  refused(null, [](Scene&, MienMixDesc& d) { d.poses = nullptr; });
  refused(null, [](Scene&, MienMixDesc& d) { d.reactions = nullptr; });
  refused(null, [](Scene&, MienMixDesc& d) { d.antagonists = nullptr; });
  refused(null, [](Scene&, MienMixDesc& d) { d.lower = nullptr; });
  refused(null, [](Scene&, MienMixDesc& d) { d.guards = MIEN_GUARD_LIPS; });
  refused(null, [](Scene& s, MienMixDesc&) { s.layers[2].curves = nullptr; });
  refused(null, [](Scene& s, MienMixDesc&) { s.poses[0].values = nullptr; });
  refused(null, [](Scene& s, MienMixDesc&) { s.reaction.strokes = nullptr; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.layers[3].amounts = nullptr; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.layers[0].mode = 256; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.layers[0].group = 5; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.layers[0].source = 4; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.layers[3].generator = 4; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.layers[3].generator = 3; });
  refused(null, [](Scene&, MienMixDesc& d) { d.custom_guard_count = 1; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.layers[0].reserved = 1; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.layers[0].weight = 2; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.reaction.stroke_count = 9; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.reaction.retrigger = 256; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.reaction.level_on = 1.01f; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.reaction.level_on = NAN; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.reaction.level_off = 0.01f; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.reaction.reserved = 1; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.stroke.reserved = 1; });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.stroke.mode = 256; });
  refused(invalid, [](Scene& s, MienMixDesc&) {
    static const uint16_t twice[] = {2, 2};
    s.poses[0].curves = twice;
  });
  refused(invalid, [](Scene& s, MienMixDesc&) { s.antagonists.second = 7; });
  refused(invalid, [](Scene&, MienMixDesc& d) { d.variable_count = 5000; });
  refused(invalid, [](Scene&, MienMixDesc& d) { d.layer_count = SIZE_MAX; });
  refused(invalid, [](Scene&, MienMixDesc& d) { d.guards = 8; });
  refused(invalid, [](Scene&, MienMixDesc& d) { d.reserved = 1; });
  refused(MIEN_ERROR_STRUCT_SIZE, [](Scene&, MienMixDesc& d) { d.struct_size = 8; });
}

TEST(Mixer, RefusesWhatIsWrong) {
  Scene scene;
  scene.reaction.level_on = 0.5f;
  const MixHandle mix = scene.mix();
  const MixerHandle handle = Scene::mixer(mix);
  MienMixer* mixer = handle.get();
  PlainRig plain;
  plain.raw_count = 3;
  const RigHandle small_rig = make_rig(plain);
  Character small(small_rig);
  EXPECT_EQ(scene.play(handle, 1), MIEN_ERROR_INDEX);
  MienPlayDesc desc = sized<MienPlayDesc>();
  desc.transition = 3;
  EXPECT_EQ(mien_mixer_play(mixer, 0, scene.clip.get(), scene.binding.get(), &desc, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_mixer_play(mixer, 0, nullptr, scene.binding.get(), nullptr, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mixer_stop(mixer, 1, 0), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_mixer_stop(mixer, 0, -1), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_mixer_set_weight(mixer, 4, 0, 0), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_mixer_set_weight(mixer, 0, NAN, 0), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_mixer_set_pose_weight(mixer, 1, 1, 0, 0), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_mixer_set_variable(mixer, 1, 0), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_mixer_set_variable(mixer, 0, INFINITY), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_mixer_set_guard(mixer, 0, 1), MIEN_ERROR_INDEX);
  MienGuardState guard = sized<MienGuardState>();
  EXPECT_EQ(mien_mixer_guard(mixer, 0, &guard), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_mixer_guard(mixer, 0, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mixer_guard(nullptr, 0, &guard), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mixer_trigger(mixer, 1, 1, 0), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_mixer_trigger(mixer, 0, 2, 0), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_mixer_release(mixer, 1), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_mixer_set_level(mixer, 1, 1), MIEN_ERROR_INDEX);
  for (float level : {-0.01f, 1.01f, NAN}) {
    EXPECT_EQ(mien_mixer_set_level(mixer, 0, level), MIEN_ERROR_INVALID_ARGUMENT);
  }
  EXPECT_EQ(mien_mixer_set_level(nullptr, 0, 1), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mixer_set_level(reinterpret_cast<MienMixer*>(mix.get()), 0, 1), MIEN_ERROR_HANDLE);
  const Scene no_level;
  const MixHandle plain_mix = no_level.mix();
  const MixerHandle unlit = Scene::mixer(plain_mix);
  EXPECT_EQ(mien_mixer_set_level(unlit.get(), 0, 1), MIEN_ERROR_INVALID_ARGUMENT);
  const float values[2] = {};
  EXPECT_EQ(mien_mixer_push(mixer, 2, 0, nullptr, 1, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mixer_push(mixer, 2, 0, values, 2, nullptr), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_mixer_push(mixer, 0, 0, values, 1, nullptr), MIEN_ERROR_INDEX);
  EXPECT_EQ(mien_mixer_step(mixer, -1, nullptr), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_mixer_step(mixer, int64_t{1} << 41, nullptr), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_mixer_step(mixer, 1, small.instance.get()), MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_mixer_step(reinterpret_cast<MienMixer*>(mix.get()), 1, nullptr),
            MIEN_ERROR_HANDLE);
  EXPECT_EQ(mien_mixer_step_batch(nullptr, nullptr, 1, 1), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mixer_step_batch(nullptr, nullptr, 0, 1), MIEN_OK);
  MienFloatView view;
  EXPECT_EQ(mien_mixer_stage(mixer, 0, &view), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_mixer_row(nullptr, &view), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(view.data, nullptr);
  MienMixer* made = mixer;
  MienMixerDesc wrong = sized<MienMixerDesc>();
  wrong.reserved = 1;
  EXPECT_EQ(mien_mixer_create(mix.get(), &wrong, &made, nullptr), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(made, nullptr);
  EXPECT_EQ(mien_mixer_restore(mixer, nullptr, 1, nullptr, 0, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  mien_mixer_destroy(nullptr);
  mien_mix_destroy(nullptr);
}

TEST(Mix, EveryFailedAllocationIsReportedAndNothingLeaks) {
  const Scene scene;
  CountingAllocator counting;
  const MienAllocator allocator = counting.get();
  MienMixDesc desc = scene.desc();
  desc.allocator = &allocator;
  for (size_t fail_at = 1;; ++fail_at) {
    counting.restart();
    counting.fail_at = fail_at;
    MienMix* mix = nullptr;
    const MienStatus status = mien_mix_create(scene.rig.get(), &desc, &mix, nullptr);
    MienMixer* mixer = nullptr;
    const MienMixerDesc mixer_desc = desc_with<MienMixerDesc>(&allocator);
    const MienStatus made =
        status == MIEN_OK ? mien_mixer_create(mix, &mixer_desc, &mixer, nullptr) : status;
    mien_mixer_destroy(mixer);
    mien_mix_destroy(mix);
    ASSERT_TRUE(counting.clean()) << counting.first_wrong;
    if (counting.failed == 0) {
      EXPECT_EQ(made, MIEN_OK);
      EXPECT_GT(fail_at, 2u);
      break;
    }
    EXPECT_EQ(made, MIEN_ERROR_MEMORY);
  }
}

// Files -------------------------------------------------------------------------------------------

Bytes bytes_of(const MixHandle& mix) {
  size_t size = 0;
  EXPECT_EQ(mien_mix_write_memory(mix.get(), nullptr, 0, &size, nullptr), MIEN_OK);
  Bytes bytes(size);
  EXPECT_EQ(mien_mix_write_memory(mix.get(), bytes.data(), size, &size, nullptr), MIEN_OK);
  return bytes;
}

MixHandle opened(const Bytes& bytes, const MienRig* rig, MienStatus expected = MIEN_OK) {
  MienMix* mix = nullptr;
  MienError error = sized<MienError>();
  EXPECT_EQ(mien_mix_open_memory(bytes.data(), bytes.size(), rig, nullptr, &mix, &error), expected)
      << error.message;
  EXPECT_EQ(mix == nullptr, expected != MIEN_OK);
  return MixHandle(mix);
}

TEST(MixFile, IsOpenedForARigAndMixesTheSame) {
  const Scene scene;
  const MixHandle mix = scene.mix();
  const Bytes bytes = bytes_of(mix);
  const MixHandle again = opened(bytes, scene.rig.get());
  EXPECT_EQ(bytes_of(again), bytes);
  EXPECT_EQ(bytes_of(opened(bytes, nullptr)), bytes);
  const MixerHandle one = Scene::mixer(mix), other = Scene::mixer(again);
  for (const MixerHandle* mixer : {&one, &other}) {
    ASSERT_EQ(scene.play(*mixer), MIEN_OK);
    ASSERT_EQ(mien_mixer_trigger(mixer->get(), 0, 1.0f, 20 * kStep), MIEN_OK);
  }
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(mien_mixer_step(one.get(), kStep, nullptr), MIEN_OK);
    ASSERT_EQ(mien_mixer_step(other.get(), kStep, nullptr), MIEN_OK);
    ASSERT_EQ(row_of(one), row_of(other));
  }
  PlainRig plain;
  plain.raw_count = 3;
  opened(bytes, make_rig(plain).get(), MIEN_ERROR_NAME);

  const std::string path = temporary_path("mix");
  ASSERT_EQ(mien_mix_write_file(mix.get(), path.c_str(), nullptr), MIEN_OK);
  MienMix* from_file = nullptr;
  ASSERT_EQ(mien_mix_open_file(path.c_str(), scene.rig.get(), nullptr, &from_file, nullptr),
            MIEN_OK);
  EXPECT_EQ(bytes_of(MixHandle(from_file)), bytes);
  std::remove(path.c_str());
  EXPECT_EQ(mien_mix_open_file(path.c_str(), nullptr, nullptr, &from_file, nullptr),
            MIEN_ERROR_FILE_OPEN);
  EXPECT_EQ(from_file, nullptr);
}

TEST(MixFile, TextIsThatOfTheMix) {
  const Scene scene;
  const MixHandle mix = scene.mix();
  size_t size = 0;
  ASSERT_EQ(mien_mix_write_text(mix.get(), nullptr, 0, &size, nullptr), MIEN_OK);
  std::string text(size, '?');
  ASSERT_EQ(mien_mix_write_text(mix.get(), &text[0], size, &size, nullptr), MIEN_OK);
  EXPECT_NE(text.find("\nlayers.1.mode screen\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nposes.0.value variable:0 1\n"), std::string::npos) << text;
}

TEST(MixFile, RefusesWhatIsWrong) {
  const Scene scene;
  const MixHandle mix = scene.mix();
  const Bytes bytes = bytes_of(mix);
  MienMix* out = mix.get();
  size_t size = 9;
  Bytes little(bytes.size() - 1, 7);
  EXPECT_EQ(mien_mix_write_memory(mix.get(), little.data(), little.size(), &size, nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(size, bytes.size());
  EXPECT_EQ(little, Bytes(bytes.size() - 1, 7));
  EXPECT_EQ(mien_mix_write_memory(mix.get(), nullptr, 1, &size, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(size, 0u);
  EXPECT_EQ(mien_mix_write_text(nullptr, nullptr, 0, &size, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mix_write_file(mix.get(), nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_mix_write_file(mix.get(), "/no/such/folder/x.mix", nullptr),
            MIEN_ERROR_FILE_WRITE);
  EXPECT_EQ(mien_mix_open_memory(nullptr, 1, nullptr, nullptr, &out, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(out, nullptr);
  EXPECT_EQ(mien_mix_open_memory(nullptr, 0, nullptr, nullptr, &out, nullptr),
            MIEN_ERROR_MIX_SIGNATURE);
  EXPECT_EQ(
      mien_mix_open_memory(bytes.data(), bytes.size(), reinterpret_cast<const MienRig*>(mix.get()),
                           nullptr, &out, nullptr),
      MIEN_ERROR_HANDLE);
  MienMixOpenDesc desc = sized<MienMixOpenDesc>();
  desc.struct_size = 1;
  EXPECT_EQ(mien_mix_open_memory(bytes.data(), bytes.size(), nullptr, &desc, &out, nullptr),
            MIEN_ERROR_STRUCT_SIZE);
  Bytes changed = bytes;
  changed.back() ^= 1;
  opened(changed, nullptr, MIEN_ERROR_MIX_CHECKSUM);
}

TEST(MixFile, EveryFailedAllocationIsReportedAndNothingLeaks) {
  const Scene scene;
  const Bytes bytes = bytes_of(scene.mix());
  CountingAllocator counting;
  const MienAllocator allocator = counting.get();
  const MienMixOpenDesc desc = desc_with<MienMixOpenDesc>(&allocator);
  const std::string path = temporary_path("mix");
  for (size_t fail_at = 1;; ++fail_at) {
    counting.restart();
    counting.fail_at = fail_at;
    MienMix* mix = nullptr;
    size_t size = 0;
    MienStatus status =
        mien_mix_open_memory(bytes.data(), bytes.size(), scene.rig.get(), &desc, &mix, nullptr);
    if (status == MIEN_OK) status = mien_mix_write_text(mix, nullptr, 0, &size, nullptr);
    if (status == MIEN_OK) status = mien_mix_write_file(mix, path.c_str(), nullptr);
    mien_mix_destroy(mix);
    if (status == MIEN_OK) {
      status = mien_mix_open_file(path.c_str(), scene.rig.get(), &desc, &mix, nullptr);
      mien_mix_destroy(mix);
    }
    ASSERT_TRUE(counting.clean()) << counting.first_wrong;
    if (counting.failed == 0) {
      EXPECT_EQ(status, MIEN_OK);
      EXPECT_GT(fail_at, 6u);
      break;
    }
    EXPECT_EQ(status, MIEN_ERROR_MEMORY) << fail_at;
  }
  std::remove(path.c_str());
}

}  // namespace
}  // namespace mien
