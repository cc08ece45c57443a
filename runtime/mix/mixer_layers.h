// SPDX-License-Identifier: MIT
// The players of layers and the rows that layers have shown; for mixer.cpp and mixer_step.cpp.
#pragma once

#include "runtime/mix/mix_rows.h"
#include "runtime/mix/mixer.h"

namespace mien {

/// Whether a layer keeps the rows that it has shown, to blend from them: clip and stream layers.
bool has_rows(const LayerDesc& layer);
/// How many of the first `end` layers do.
size_t layers_with_rows(const Mix& mix, size_t end);
inline size_t layer_row_floats(const Mix& mix) { return size_t{2} * mix.curve_count; }
/// Floats of a row that a layer shows: values and cover of all curves; of a stream only the values of its
/// channels, because it always covers the same curves.
size_t shown_floats(const Mix& mix, uint32_t layer);

/// The weight of a layer, with its fades in and out.
inline float layer_weight(const LayerState& layer, BlendMode mode, int64_t now) {
  const float lowest = mode == BlendMode::kAdd ? -1.0f : 0.0f;
  const float wanted = fade_value(layer.weight, now), there = fade_value(layer.presence, now);
  const float weight = wanted * (there < 1.0f ? (there > 0.0f ? there : 0.0f) : 1.0f);
  return weight < 1.0f ? (weight > lowest ? weight : lowest) : 1.0f;
}

/// The share of the current player in a crossfade.
inline float cross_share(const LayerState& layer, int64_t now) {
  const float s = fade_value(layer.cross, now);
  return s < 1.0f ? (s > 0.0f ? s : 0.0f) : 1.0f;
}

/// One of the two rows of values of a player, and its cover: which curves it drives.
inline float* player_values(const Mix& mix, const Player& player, uint32_t row) {
  return player.rows.data + (row == 0 ? 0 : 2 * size_t{mix.curve_count});
}
inline const float* player_cover(const Mix& mix, const Player& player) {
  return player.rows.data + mix.curve_count;
}

float* layer_row(Mixer& mixer, uint32_t layer, uint32_t row);
QuinticRows quintic_rows(Mixer& mixer, uint32_t layer);

/// Starts a transition at `start`: from the rows that the layer has shown last to `next`.
void start_offsets(Mixer& mixer, uint32_t index, const float* next, int64_t start, int64_t ticks);

void release_player(Mixer& mixer, uint16_t& player);

}  // namespace mien
