// SPDX-License-Identifier: MIT
#include "runtime/mix/mixer_layers.h"

#include <cstring>

#include "runtime/base/vectors.h"

namespace mien {

bool has_rows(const LayerDesc& layer) {
  return layer.source == LayerSource::kClip || layer.source == LayerSource::kStream;
}

size_t layers_with_rows(const Mix& mix, size_t end) {
  size_t count = 0;
  for (const LayerDesc& layer : mix.layers.first(end)) count += has_rows(layer);
  return count;
}

size_t shown_floats(const Mix& mix, uint32_t layer) {
  if (mix.layers[layer].source == LayerSource::kClip) return layer_row_floats(mix);
  return (mix.layers[layer].curves.count + kRowStep - 1) / kRowStep * kRowStep;
}

float* layer_row(Mixer& mixer, uint32_t layer, uint32_t row) {
  const size_t slot = layers_with_rows(*mixer.mix, layer);
  const size_t floats = layer_row_floats(*mixer.mix);
  return mixer.layer_rows.slice((slot * kLayerRows + row) * floats, floats).data;
}

QuinticRows quintic_rows(Mixer& mixer, uint32_t layer) {
  return {layer_row(mixer, layer, kQuintic0), layer_row(mixer, layer, kQuintic1),
          layer_row(mixer, layer, kQuintic2), layer_row(mixer, layer, kQuinticRate)};
}

void start_offsets(Mixer& mixer, uint32_t index, const float* next, int64_t start, int64_t ticks) {
  LayerState& layer = mixer.layers[index];
  layer.offset_ticks = 0;
  if (layer.shown_count == 0 || ticks == 0) return;
  const bool moves = layer.shown_count == 2 && layer.shown_ticks > 0;
  const float* last = layer_row(mixer, index, kShown0 + layer.newest);
  const float* before = moves ? layer_row(mixer, index, kShown0 + (layer.newest ^ 1)) : last;
  const size_t floats = shown_floats(*mixer.mix, index), curves = mixer.mix->curve_count;
  const size_t cover_bytes = (floats > curves ? floats - curves : 0) * sizeof(float);
  mixer.cover_rests[index] = memcmp(last + curves, next + curves, cover_bytes) == 0 &&
                             memcmp(before + curves, next + curves, cover_bytes) == 0;
  start_quintics(last, before, next, moves ? fraction_of(ticks, layer.shown_ticks) : 0.0f, floats,
                 quintic_rows(mixer, index));
  layer.offset_start = start;
  layer.offset_ticks = ticks;
}

void release_player(Mixer& mixer, uint16_t& player) {
  if (player != kNoPlayer) mixer.players[player].used = false;
  player = kNoPlayer;
}

void sample_player(Mixer& mixer, Player& player, uint32_t row, bool constants) {
  const Mix& mix = *mixer.mix;
  const Binding& binding = *player.source.binding;
  float* const values = player_values(mix, player, row);
  if (!player.mirrored && !constants && binding.sums.empty()) {
    const Span<const float> changing = sample_changing(player.sampler);
    MIEN_UNROLL_FOUR
    for (const BoundCopy& copy : binding.copies) values[copy.control] = changing[copy.changing];
    return;
  }
  const Span<const float> channels = sample_clip(player.sampler);
  if (!player.mirrored) {
    apply_binding(binding, channels, mixer.gui, {values, mix.raw_count}, constants);
    return;
  }
  apply_binding(binding, channels, mixer.gui, mixer.scratch.first(mix.raw_count));
  for (uint16_t curve : binding.controls) values[mix.mirror[curve]] = mixer.scratch[curve];
}

void keep_shown(Mixer& mixer, uint32_t index) {
  const Mix& mix = *mixer.mix;
  LayerState& layer = mixer.layers[index];
  const size_t bytes = mix.curve_count * sizeof(float);
  for (uint32_t k = 0; k < 2; ++k) {
    if (!layer.in_player[k]) continue;
    layer.in_player[k] = 0;
    const Player& player = mixer.players[layer.current];
    float* const shown = layer_row(mixer, index, kShown0 + k);
    memcpy(shown, player_values(mix, player, k), bytes);
    memcpy(shown + mix.curve_count, player_cover(mix, player), bytes);
  }
}

}  // namespace mien
