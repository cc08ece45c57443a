// SPDX-License-Identifier: MIT
// A mix in which everything is on, and a character that is told to do all that can be done: clips
// that play both ways and mirrored, a stream, poses, a reaction, generators, guards, antagonists,
// limits. All from seeds, by integers and basic operations: the same numbers everywhere. Used by
// tests, a benchmark and a fuzzer, so without GoogleTest.
#pragma once

#include <cstdlib>
#include <cstring>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "author/base/random.h"
#include "runtime/anim/clip_builder.h"
#include "runtime/mix/mixer.h"

namespace mien {

constexpr int64_t kSceneStep = kTicksPerSecond / 60;
constexpr int64_t kSceneMillisecond = kTicksPerSecond / 1000;

inline void scene_requires(Status status) {
  if (status != Status::kOk) abort();
}

/// Smooth curves between 0 and 1, one for each of `moved`; the other raw controls rest at 0.
inline std::vector<float> scene_curves(uint64_t seed, uint32_t raw_count,
                                       const std::vector<uint16_t>& moved, uint32_t frames) {
  Random random = Random::from_seed(seed, 0);
  std::vector<float> values(size_t{raw_count} * frames);
  for (uint16_t curve : moved) {
    const double period = random.between(40, 100), phase = random.real();
    for (uint32_t f = 0; f < frames; ++f) {
      const double t = f / period + phase, x = t - static_cast<double>(static_cast<int64_t>(t));
      values[size_t{f} * raw_count + curve] = static_cast<float>(16 * x * x * (1 - x) * (1 - x));
    }
  }
  return values;
}

/// A clip of all raw controls, and its binding. `values`: [frame][raw control].
struct SceneClip {
  ClipBytes file;
  Clip clip;
  Binding binding = {};

  SceneClip(const std::vector<float>& values, uint32_t raw_count, bool wraps) {
    std::vector<std::string> names;
    std::vector<Span<const char>> views;
    for (uint16_t c = 0; c < raw_count; ++c) {
      names.push_back("control" + std::to_string(c));
      controls_.push_back(c);
    }
    for (const std::string& name : names) views.push_back({name.data(), name.size()});
    const Span<const char> event_name = views[0];
    const ClipEventDesc event = {kSceneStep, 0, 1};
    ClipDesc desc;
    desc.frame_count = static_cast<uint32_t>(values.size() / raw_count);
    desc.values = values.data();
    desc.names = {views.data(), views.size()};
    desc.events = {&event, 1};
    desc.event_names = {&event_name, 1};
    desc.wraps = wraps;
    Error error;
    scene_requires(build_clip(desc, default_allocator(), {}, file, error));
    scene_requires(open_clip(file.bytes, file.size, clip, error));
    binding.raw_count = binding.channel_count = raw_count;
    for (uint16_t i = 0, c = 0; c < raw_count; ++c) {
      const bool changes = i < clip.changing_count && clip.changing(i) == c;
      (changes ? copies_ : constants_).push_back({c, c, i});
      i = static_cast<uint16_t>(i + changes);
    }
    binding.copies = {copies_.data(), copies_.size()};
    binding.constants = {constants_.data(), constants_.size()};
    binding.controls = {controls_.data(), controls_.size()};
  }
  ~SceneClip() { release_clip(file); }
  SceneClip(const SceneClip&) = delete;

 private:
  std::vector<BoundCopy> copies_, constants_;
  std::vector<uint16_t> controls_;
};

/// A guard over curves of a list, with gains and pairs as those of lips are: a few
/// millimeters. (On the generated head they have 6 to 21 curves and at most 7 pairs.)
inline Guard scene_guard(uint64_t seed, const std::vector<uint16_t>& moved) {
  Random random = Random::from_seed(seed, 1);
  Guard guard = {};
  guard.count =
      static_cast<uint32_t>(moved.size() < kMaxGuardCurves ? moved.size() : kMaxGuardCurves);
  const auto first = random.below(static_cast<uint32_t>(moved.size()));
  for (uint32_t i = 0; i < guard.count; ++i) {
    guard.curves[i] = moved[(first + i) % moved.size()];
    // Falling in size, of either sign.
    const float size = 8 * (1 - static_cast<float>(i) / kMaxGuardCurves);
    guard.gains[i] = random.chance(0.3) ? -size : size;
  }
  guard.pair_count = 8;
  for (uint32_t i = 0; i < guard.pair_count; ++i) {
    const uint32_t a = random.below(guard.count), b = random.below(guard.count - 1);
    guard.pairs[i] = {static_cast<uint16_t>(a), static_cast<uint16_t>(b < a ? b : b + 1),
                      static_cast<float>(random.between(-1, 1))};
  }
  guard.f_on = 200;  // of sums of so many curves
  guard.tolerance = 0.3f;
  return guard;
}

/// What differs between scenes.
struct SceneParts {
  static constexpr uint32_t kClips = 3, kMoods = 4, kPoses = kMoods + 1 + kGlareStrokes;

  struct Pose {
    std::vector<uint16_t> curves;
    std::vector<float> values;
  };
  uint32_t raw_count = 0;
  std::vector<uint16_t> moved;       // raw controls, all of which something moves
  std::vector<float> clips[kClips];  // [frame][raw control]; the third is played as speech
  std::vector<float> speech_mask;    // [curve]
  std::vector<uint16_t> channels;    // of the stream
  std::vector<uint16_t> blinks;      // curves of the generator
  std::vector<uint16_t> small;       // curves of breath and noise
  Pose poses[kPoses];                // moods, what scales over the guards, the strokes of the glare
  std::vector<Guard> guards;
};

/// All at random. `moved`: the raw controls that something moves; empty: all.
inline SceneParts random_scene(uint32_t raws, std::vector<uint16_t> moved = {}) {
  SceneParts parts;
  parts.raw_count = raws;
  for (uint16_t l = 0; moved.size() < raws && moved.size() == l; ++l) moved.push_back(l);
  const auto curve = [&moved](size_t i) { return moved[i % moved.size()]; };
  const std::vector<uint16_t> half(moved.begin(),
                                   moved.begin() + static_cast<long>(moved.size() / 2));
  for (uint32_t i = 0; i < SceneParts::kClips; ++i) {
    parts.clips[i] = scene_curves(80 + i, raws, i == 2 ? half : moved, 100 + 50 * i);
  }
  for (uint32_t l = 0; l <= raws; ++l) {
    parts.speech_mask.push_back(l % 4 == 0 ? 0.0f : l % 4 == 1 ? 0.5f : 1.0f);
  }
  for (uint32_t i = 0; i < 20 && i < moved.size(); ++i) parts.channels.push_back(curve(3 * i));
  parts.blinks = {curve(0), curve(1)};
  parts.small = {curve(2), curve(3), curve(4), curve(5)};
  for (uint32_t p = 0; p < SceneParts::kPoses; ++p) {
    for (uint32_t i = 0; i < 12 && i < moved.size(); ++i) {
      const bool variable = i == 0 && p == SceneParts::kPoses - 1;
      parts.poses[p].curves.push_back(variable ? static_cast<uint16_t>(raws) : curve(7 * p + i));
      parts.poses[p].values.push_back(0.1f * static_cast<float>(1 + (p + i) % 9));
    }
  }
  for (uint32_t g = 0; g < 6; ++g) parts.guards.push_back(scene_guard(g, moved));
  parts.moved = std::move(moved);
  return parts;
}

struct MixScene {
  enum Layer : uint32_t { kBase, kLive, kSpeech, kMood, kBlinks, kBreathing, kFidget, kOverGuards };
  static constexpr uint32_t kLayers = 8, kMoods = SceneParts::kMoods, kClips = SceneParts::kClips;
  static constexpr uint32_t kChannels = 20;

  uint32_t raw_count;
  std::deque<SceneClip> clips;
  std::vector<ClipSource> sources;
  Mix* mix = nullptr;

  explicit MixScene(uint32_t raws, const KernelTable* kernels = nullptr)
      : MixScene(random_scene(raws), kernels) {}

  MixScene(const SceneParts& parts, const KernelTable* kernels) : raw_count(parts.raw_count) {
    for (uint32_t i = 0; i < kClips; ++i) {
      clips.emplace_back(parts.clips[i], raw_count, i > 0);
      sources.push_back({i + 1, &clips[i].clip, &clips[i].binding});
    }
    const uint32_t curves = raw_count + 1;
    std::vector<float> amounts(4, 0.5f), lower(curves, 0.0f), upper(curves, 1.0f);
    lower[raw_count] = -10, upper[raw_count] = 10;
    std::vector<uint16_t> mirror;
    for (uint16_t l = 0; l < curves; ++l) {
      mirror.push_back(l < raw_count && (l ^ 1u) < raw_count ? l ^ 1 : l);
    }
    std::vector<PoseDesc> poses;
    for (const SceneParts::Pose& pose : parts.poses) {
      poses.push_back(
          {{pose.curves.data(), pose.curves.size()}, {pose.values.data(), pose.values.size()}});
    }

    LayerDesc layers[kLayers];
    const auto set = [&layers](Layer at, LayerGroup group, BlendMode mode, LayerSource source) {
      layers[at].group = group;
      layers[at].mode = mode;
      layers[at].source = source;
    };
    set(kBase, LayerGroup::kBase, BlendMode::kOverride, LayerSource::kClip);
    set(kLive, LayerGroup::kBase, BlendMode::kOverride, LayerSource::kStream);
    set(kSpeech, LayerGroup::kSpeech, BlendMode::kOverride, LayerSource::kClip);
    set(kMood, LayerGroup::kEmotion, BlendMode::kScreen, LayerSource::kPoses);
    set(kBlinks, LayerGroup::kLife, BlendMode::kMax, LayerSource::kGenerator);
    set(kBreathing, LayerGroup::kLife, BlendMode::kAdd, LayerSource::kGenerator);
    set(kFidget, LayerGroup::kLife, BlendMode::kAdd, LayerSource::kGenerator);
    set(kOverGuards, LayerGroup::kEmotion, BlendMode::kScale, LayerSource::kPoses);
    layers[kLive].curves = {parts.channels.data(), parts.channels.size()};
    layers[kLive].delay = 50 * kSceneMillisecond;
    layers[kLive].weight = 0.5f;
    layers[kSpeech].mask = {parts.speech_mask.data(), parts.speech_mask.size()};
    layers[kMood].pose_count = kMoods;
    layers[kOverGuards].first_pose = kMoods;
    layers[kOverGuards].weight = 0;  // without pose weights it scales to 0
    layers[kOverGuards].pose_count = 1;
    layers[kOverGuards].after_guards = 1;
    const std::vector<uint16_t>* generated[] = {&parts.blinks, &parts.small, &parts.small};
    for (uint32_t g = 0; g < 3; ++g) {
      LayerDesc& layer = layers[kBlinks + g];
      layer.generator = static_cast<Generator>(g);
      layer.period = kTicksPerSecond * (2 + g);
      layer.curves = {generated[g]->data(), generated[g]->size()};
      layer.amounts = {amounts.data(), generated[g]->size()};
    }
    Stroke strokes[kGlareStrokes];
    glare_strokes(kMoods + 1, strokes);
    const ReactionDesc glare = glare_reaction(strokes);
    std::vector<AntagonistPair> antagonists;
    for (size_t i = 0; i < 96 && 2 * i + 1 < parts.moved.size(); i += 2) {
      antagonists.push_back({parts.moved[i], parts.moved[i + 1], 0.25f});
    }

    std::string chars;
    std::vector<uint32_t> ends = {0};
    for (uint32_t l = 0; l < raw_count; ++l) {
      chars += "control" + std::to_string(l);
      ends.push_back(static_cast<uint32_t>(chars.size()));
    }
    const NameList names = {{ends.data(), ends.size()}, {&chars[0], chars.size()}, {}};

    MixDesc desc;
    desc.raw_count = raw_count;
    desc.variable_count = 1;
    desc.names = names;
    desc.layers = {layers, kLayers};
    desc.poses = {poses.data(), poses.size()};
    desc.reactions = {&glare, 1};
    desc.guards = {parts.guards.data(), parts.guards.size()};
    desc.antagonists = {antagonists.data(), antagonists.size()};
    desc.mirror = {mirror.data(), mirror.size()};
    desc.lower = {lower.data(), lower.size()};
    desc.upper = {upper.data(), upper.size()};
    desc.player_count = 4;
    desc.max_channels = desc.max_changing_channels = raw_count;
    desc.kernels = kernels;
    Error error;
    scene_requires(create_mix(desc, default_allocator(), mix, error));
  }
  ~MixScene() { release(mix); }
  MixScene(const MixScene&) = delete;

  ClipFinder finder() const {
    return {this, [](const void* user, uint64_t id, ClipSource& source) {
              const MixScene& scene = *static_cast<const MixScene*>(user);
              if (id < 1 || id > kClips) return false;
              source = scene.sources[id - 1];
              return true;
            }};
  }
};

/// Plays the scene at random; what it does depends on the random numbers alone.
struct SceneActor {
  struct Destroy {
    void operator()(Mixer* made) const { release(made); }
  };
  const MixScene& scene;
  std::unique_ptr<Mixer, Destroy> mixer;
  int64_t pushed = 0;  // tick of the last row

  SceneActor(const MixScene& of, uint64_t seed, const Allocator& allocator = default_allocator())
      : scene(of), mixer(create_mixer(*of.mix, seed, false, allocator)) {
    if (!mixer) abort();
  }

  void play(uint32_t layer, uint32_t clip, const LayerPlayDesc& desc) {
    Error error;
    scene_requires(play_clip(*mixer, layer, scene.sources[clip], desc, error));
  }

  /// What is on all the time: two clips, a stream that is a step ahead, moods.
  void begin() {
    LayerPlayDesc desc;
    desc.transition = Transition::kCut;
    desc.play.looping = Looping::kLoop;
    play(MixScene::kBase, 1, desc);
    play(MixScene::kSpeech, 2, desc);
    Error error;
    for (uint32_t p = 0; p < MixScene::kMoods; ++p) {
      scene_requires(set_pose_weight(*mixer, MixScene::kMood, p, 0.3f, 0, error));
    }
  }

  void push(Random& random) {
    float row[MixScene::kChannels];
    const auto count = static_cast<uint32_t>(mixer->streams[MixScene::kLive]->channels);
    for (uint32_t c = 0; c < count; ++c) row[c] = static_cast<float>(random.below(1025)) / 1024;
    const int64_t now = mixer->header->now;
    pushed = pushed + kSceneStep > now ? pushed + kSceneStep : now;
    Error error;
    scene_requires(push_row(*mixer, MixScene::kLive, pushed, {row, count}, nullptr, error));
  }

  void disturb(Random& random) {
    const auto some = [&random](uint32_t below) { return random.below(below) * kSceneMillisecond; };
    Error error;
    if (random.chance(0.7) && pushed < mixer->header->now + kSceneStep) push(random);
    if (random.chance(0.04)) {
      LayerPlayDesc desc;
      desc.transition = static_cast<Transition>(random.below(3));
      desc.transition_ticks = some(500);
      desc.mirrored = random.chance(0.3);
      desc.play.speed_numerator = static_cast<int32_t>(random.below(7)) - 3;
      desc.play.speed_denominator = 2;
      desc.play.interpolation = static_cast<Interpolation>(random.below(3));
      const uint32_t layer = random.chance(0.5) ? MixScene::kBase : MixScene::kSpeech;
      play(layer, random.below(MixScene::kClips), desc);
    }
    if (random.chance(0.01)) {
      const uint32_t layer = random.chance(0.5) ? MixScene::kBase : MixScene::kSpeech;
      scene_requires(stop_layer(*mixer, layer, some(300), error));
    }
    // One after the other: the order of evaluation of arguments is the compiler's.
    const auto share = [&random] { return static_cast<float>(random.below(257)) / 256; };
    if (random.chance(0.05)) {
      const uint32_t layer = random.below(MixScene::kLayers);
      const float weight = share();
      scene_requires(set_layer_weight(*mixer, layer, weight, some(300), error));
    }
    if (random.chance(0.05)) {
      const uint32_t pose = random.below(MixScene::kMoods);
      const float weight = share();
      scene_requires(set_pose_weight(*mixer, MixScene::kMood, pose, weight, some(300), error));
    }
    if (random.chance(0.03)) {
      const int64_t hold = random.chance(0.2) ? kUntilReleased : some(1000);
      scene_requires(trigger(*mixer, 0, share(), hold, error));
    }
    if (random.chance(0.03)) scene_requires(end_stimulus(*mixer, 0, error));
    if (random.chance(0.02) && !mixer->guard_overrides.empty()) {
      const uint32_t guard = random.below(static_cast<uint32_t>(mixer->guard_overrides.count));
      scene_requires(set_guard(*mixer, guard, 2 * share() - 1, error));
    }
    if (random.chance(0.02)) scene_requires(set_variable(*mixer, 0, share(), error));
    if (random.chance(0.05)) scene_requires(set_level(*mixer, 0, share(), error));
  }

  /// All curves.
  const float* step(int64_t ticks) {
    step_mixer(*mixer, ticks, nullptr, 0, nullptr);
    return mixer->row.data;
  }
};

/// After FNV-1a, a float at a time.
inline uint64_t hash_floats(uint64_t hash, const float* values, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    uint32_t bits;
    memcpy(&bits, values + i, sizeof(bits));
    hash = (hash ^ bits) * 0x100000001B3u;
  }
  return hash;
}
constexpr uint64_t kHashStart = 0xCBF29CE484222325u;

}  // namespace mien
