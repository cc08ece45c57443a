// SPDX-License-Identifier: MIT
#include "runtime/mix/speech.h"

#include "runtime/mix/mixer_layers.h"

namespace mien {
namespace {

void add_player(const Mixer& mixer, uint16_t index, float share, SpeechLayer& layer) {
  if (index == kNoPlayer || !mixer.players[index].source.binding->closures.any()) return;
  const Player& player = mixer.players[index];
  const ClipSampler& sampler = player.sampler;
  const Closures& closures = player.source.binding->closures;
  float closed[kClosures];
  closures_at(*sampler.clip, closures, sampler.tick, sampler.wraps, closed);
  for (uint32_t c = 0; c < kClosures; ++c) {
    if (!closures.has(c)) continue;
    layer.labeled[c] += share;
    layer.closed[c] += share * closed[c];
  }
}

/// The closure label of a clip that a guard responds to; kClosures: none.
uint32_t closure_of(const Guard& guard) {
  switch (guard.kind < kStandardGuardCount ? static_cast<StandardGuard>(guard.kind)
                                           : StandardGuard::kLidsLeft) {
    case StandardGuard::kLipsLeft:
    case StandardGuard::kLipsCenter:
    case StandardGuard::kLipsRight: return kLipsClosed;
    case StandardGuard::kLipToTeeth: return kLipAtTeeth;
    case StandardGuard::kTeeth: return kTeethClosed;
    default: return kClosures;
  }
}

}  // namespace

Speech find_speech(const Mixer& mixer) {
  Speech speech;
  for (size_t i = 0; i < mixer.layers.count; ++i) {
    const LayerDesc& layer = mixer.mix->layers[i];
    if (layer.group != LayerGroup::kSpeech) continue;
    const LayerState& state = mixer.layers[i];
    const float weight = layer_weight(state, layer.mode, mixer.header->now);
    if (!(weight > 0.0f)) continue;
    SpeechLayer& found = speech.layers[speech.count++] = {weight, {}, {}};
    const float s = state.previous == kNoPlayer ? 1.0f : cross_share(state, mixer.header->now);
    add_player(mixer, state.current, s, found);
    add_player(mixer, state.previous, 1.0f - s, found);
  }
  return speech;
}

float activation_of(const Mixer& mixer, size_t guard, float distance, const Speech& speech) {
  const float wanted = mixer.guard_overrides[guard];
  if (wanted >= 0.0f) return wanted;
  const Guard& of = mixer.mix->guards[guard];
  const float measured = guard_activation(of, distance);
  if (!of.needs_speech) return measured;
  const uint32_t closure = closure_of(of);
  float most = 0.0f;
  for (uint32_t i = 0; i < speech.count; ++i) {
    const SpeechLayer& layer = speech.layers[i];
    float closed = measured;
    if (closure != kClosures) {
      closed = (1.0f - layer.labeled[closure]) * measured + layer.closed[closure];
    }
    if (layer.weight * closed > most) most = layer.weight * closed;
  }
  return most;
}

}  // namespace mien
