// SPDX-License-Identifier: MIT
// Mixes, clips and mixers as tests make them: channel c of a clip drives raw control c.
#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "author/base/random.h"
#include "runtime/mix/mixer.h"
#include "tests/support/made_clip.h"

namespace mien {

using Row = std::vector<float>;

constexpr int64_t kMillisecond = kTicksPerSecond / 1000;

/// A clip that drives the first raw controls, or those of a list.
struct BoundClip {
  MadeClip made;
  Binding binding = {};
  ClipSource source;

  explicit BoundClip(ClipInput input, uint32_t raw_count, std::vector<uint16_t> curves = {})
      : made(std::move(input)), controls_(std::move(curves)) {
    for (uint16_t c = 0, i = 0; c < made.clip.channel_count; ++c) {
      if (controls_.size() <= c) controls_.push_back(c);
      const bool changes = i < made.clip.changing_count && made.clip.changing(i) == c;
      (changes ? copies_ : constants_).push_back({c, controls_[c], i});
      i = static_cast<uint16_t>(i + changes);
    }
    binding.raw_count = raw_count;
    binding.channel_count = made.clip.channel_count;
    binding.copies = {copies_.data(), copies_.size()};
    binding.constants = {constants_.data(), constants_.size()};
    binding.controls = {controls_.data(), controls_.size()};
    binding.closures = find_closures(made.clip);
    source = {++last_id(), &made.clip, &binding};
  }

 private:
  static uint64_t& last_id() {
    static uint64_t id = 0;
    return id;
  }
  std::vector<uint16_t> controls_;
  std::vector<BoundCopy> copies_, constants_;
};

/// A description that owns what it refers to.
struct MixInput {
  MixDesc desc;
  std::vector<LayerDesc> layers;

  explicit MixInput(uint32_t raw_count, uint32_t variables = 0) {
    desc.raw_count = raw_count;
    desc.variable_count = variables;
    desc.player_count = 8;
    desc.max_channels = desc.max_changing_channels = raw_count;
  }

  LayerDesc& add(BlendMode mode, LayerSource source = LayerSource::kClip,
                 LayerGroup group = LayerGroup::kBase) {
    layers.emplace_back();
    layers.back().mode = mode;
    layers.back().source = source;
    layers.back().group = group;
    return layers.back();
  }
  Span<const float> keep(Row row) {
    rows_.push_back(std::move(row));
    return {rows_.back().data(), rows_.back().size()};
  }
  /// Number of the pose.
  uint32_t add_pose(std::vector<uint16_t> curves, Row values) {
    pose_curves_.push_back(std::move(curves));
    const Span<const float> kept = keep(std::move(values));
    poses_.push_back({{pose_curves_.back().data(), pose_curves_.back().size()}, kept});
    return static_cast<uint32_t>(poses_.size() - 1);
  }
  const MixDesc& finish() {
    desc.layers = {layers.data(), layers.size()};
    desc.poses = {poses_.data(), poses_.size()};
    return desc;
  }

 private:
  std::deque<Row> rows_;
  std::deque<std::vector<uint16_t>> pose_curves_;
  std::vector<PoseDesc> poses_;
};

struct CloseMix {
  void operator()(Mix* mix) const { release(mix); }
  void operator()(Mixer* mixer) const { release(mixer); }
};
using MixHandle = std::unique_ptr<Mix, CloseMix>;
using MixerHandle = std::unique_ptr<Mixer, CloseMix>;

inline MixHandle make_mix(MixInput& input) {
  Mix* mix = nullptr;
  Error error;
  EXPECT_EQ(create_mix(input.finish(), default_allocator(), mix, error), Status::kOk)
      << error.message;
  return MixHandle(mix);
}

/// A mixer and the calls of tests, all of which succeed.
struct OwnMixer {
  MixerHandle handle;
  Mixer& mixer;

  explicit OwnMixer(const MixHandle& mix, uint64_t seed = 1)
      : handle(create_mixer(*mix, seed, true, default_allocator())), mixer(*handle) {}

  void play(uint32_t layer, const BoundClip& clip, Transition transition = Transition::kCut,
            int64_t ticks = 0, PlayDesc play = {}) {
    LayerPlayDesc desc;
    desc.transition = transition;
    desc.transition_ticks = ticks;
    desc.play = play;
    Error error;
    EXPECT_EQ(play_clip(mixer, layer, clip.source, desc, error), Status::kOk) << error.message;
  }
  void weight(uint32_t layer, float value, int64_t ticks = 0) {
    Error error;
    EXPECT_EQ(set_layer_weight(mixer, layer, value, ticks, error), Status::kOk) << error.message;
  }
  void pose(uint32_t layer, uint32_t pose, float value, int64_t ticks = 0) {
    Error error;
    EXPECT_EQ(set_pose_weight(mixer, layer, pose, value, ticks, error), Status::kOk)
        << error.message;
  }
  /// All curves.
  Row step(int64_t ticks) {
    Row row(mixer.mix->curve_count);
    step_mixer(mixer, ticks, row.data(), row.size(), nullptr);
    row.resize(mixer.mix->used_curves());
    return row;
  }
};

inline bool same_bits(const Row& a, const Row& b) {
  return a.size() == b.size() && memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// Curves between 0 and 1 with a period of 40 to 100 frames and no kinks, all different.
inline Curves smooth_curves(uint64_t seed, uint32_t channels, uint32_t frames) {
  Random random = Random::from_seed(seed, 0);
  Curves curves(channels, frames);
  for (uint32_t c = 0; c < channels; ++c) {
    // No library functions, so that it is the same everywhere.
    const double period = random.between(40, 100), phase = random.real();
    for (uint32_t f = 0; f < frames; ++f) {
      const double t = f / period + phase, x = t - static_cast<double>(static_cast<int64_t>(t));
      curves.at(f, c) = static_cast<float>(16 * x * x * (1 - x) * (1 - x));
    }
  }
  return curves;
}

}  // namespace mien
