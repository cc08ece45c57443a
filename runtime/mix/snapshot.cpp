// SPDX-License-Identifier: MIT
// A snapshot:
//
//     | "MIENSNP\n" | version u32 | size u32 | fingerprint of the mix u64 | state |
//
// Its bytes may come from anywhere. Everything that is used as an index or in arithmetic of times is
// checked before anything changes. Other numbers may have any value that steps can keep: rows need not be
// finite, because sums of large numbers of a clip are not either, and limits make them finite.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/mix/mixer.h"
#include "runtime/rig/rig.h"

namespace mien {
namespace {

constexpr char kMagic[8] = {'M', 'I', 'E', 'N', 'S', 'N', 'P', '\n'};
constexpr uint32_t kVersion = 3;
constexpr int64_t kMaxTime = kMaxMixerTime + 2 * kMaxFadeTicks;  // including times still to come

struct SnapshotHeader {
  char magic[8];
  uint32_t version, size;
  uint64_t fingerprint;
};

constexpr char kOutOfRange[] = "has a number out of range: it is damaged";

Status wrong_snapshot(Error& error, const char* what) {
  return fail(error, Status::kInvalidArgument, kNoOffset, "the snapshot %s", what);
}

/// The state in the bytes, addressed as in the mixer.
struct SavedState {
  const Mixer& mixer;
  const uint8_t* bytes;

  template <class T>
  T read(const T& in_mixer) const {
    T value;
    memcpy(&value, bytes + (reinterpret_cast<const uint8_t*>(&in_mixer) - mixer.state.data),
           sizeof(T));
    return value;
  }
};

bool is_duration(int64_t ticks) { return ticks >= 0 && ticks <= kMaxFadeTicks; }
bool is_time(int64_t tick) { return tick >= -kMaxTime && tick <= kMaxTime; }

// Whether a snapshot may have a value; numbers that are only computed with may have any finite value.
bool valid(float value) { return std::isfinite(value); }

bool valid(const Fade& fade) {
  return is_time(fade.start) && is_duration(fade.ticks) && valid(fade.target) &&
         valid(fade.offset.c0) && valid(fade.offset.c1) && valid(fade.offset.c2) &&
         fade.offset.rate >= 0.0f;
}

bool is_layer(const Mixer& mixer, const SavedState& saved, uint32_t index, uint64_t& players) {
  const LayerState layer = saved.read(mixer.layers[index]);
  const uint16_t used[2] = {layer.current, layer.previous};
  for (uint16_t player : used) {
    if (player == kNoPlayer) continue;
    if (mixer.mix->layers[index].source != LayerSource::kClip || player >= mixer.players.count ||
        (players >> player & 1) != 0) {
      return false;
    }
    players |= uint64_t{1} << player;
  }
  return (layer.current != kNoPlayer || layer.previous == kNoPlayer) && valid(layer.weight) &&
         valid(layer.presence) && valid(layer.cross) && layer.shown_count <= 2 &&
         layer.newest <= 1 && layer.in_player[0] == 0 && layer.in_player[1] == 0 &&
         is_duration(layer.shown_ticks) && is_time(layer.offset_start) &&
         is_duration(layer.offset_ticks);
}

Status check_player(const Mixer& mixer, const PlayerState& player, uint32_t layer,
                    const ClipFinder& clips, Error& error) {
  ClipSource source;
  if (!clips.find(clips.user, player.source, source)) {
    return fail(error, Status::kMismatch, kNoOffset,
                "layer %u: the clip with the number %llu is missing", layer,
                static_cast<unsigned long long>(player.source));
  }
  const Status status = check_source(*mixer.mix, layer, source, error);
  if (status != Status::kOk) return Status::kMismatch;
  const Clip& clip = *source.clip;
  const int64_t length = clip.length(player.wraps != 0);
  if (clip.channel_count > mixer.mix->max_channels ||
      clip.changing_count > mixer.mix->max_changing_channels ||
      (player.wraps ? player.tick >= length : player.tick > length)) {
    return fail(error, Status::kMismatch, kNoOffset, "layer %u: the clip is another one", layer);
  }
  const bool possible =
      player.tick >= 0 && player.loops >= -kMaxLoops && player.loops <= kMaxLoops &&
      player.speed_denominator >= 1 && player.speed_denominator <= kMaxSpeed &&
      player.fraction >= 0 && player.fraction < player.speed_denominator &&
      player.speed_numerator >= -kMaxSpeed && player.speed_numerator <= kMaxSpeed &&
      player.wraps <= 1 && player.mirrored <= 1 && player.fresh <= 1 && player.backward <= 1 &&
      player.interpolation <= static_cast<uint8_t>(Interpolation::kCatmullRom) &&
      (!player.mirrored || !mixer.mix->mirror.empty());
  return possible
             ? Status::kOk
             : wrong_snapshot(error, "has a player in a state that none can be in: it is damaged");
}

bool valid(const ReactionState& reaction) {
  return is_time(reaction.triggered) &&
         (is_time(reaction.stimulus_end) || reaction.stimulus_end == kUntilReleased) &&
         valid(reaction.gain) && valid(reaction.strength) && reaction.running <= 1 &&
         is_time(reaction.level.start) && std::fabs(reaction.level.target) <= 1 &&
         valid(reaction.level.offset) && valid(reaction.level.push) && reaction.level_is_on <= 1;
}

bool valid(const StrokeState& stroke) {
  return valid(stroke.envelope) && is_time(stroke.begin) && stroke.phase <= kStrokeFalls;
}

bool valid(const GazeState& gaze, int64_t now) {
  bool near = true;
  for (int k = 0; k < 3; ++k) {
    near = near && std::fabs(gaze.from[k]) <= 1e6f && std::fabs(gaze.to[k]) <= 1e6f;
  }
  // Blinks begin with a shift, and at no time before 0.
  const bool shifted = gaze.large_shift >= 0 && gaze.large_shift <= now;
  return near && is_time(gaze.start) && is_duration(gaze.duration) && gaze.begun <= 1 &&
         (shifted || gaze.large_shift == kNoShift);
}

template <class T>
bool all_valid(const SavedState& saved, Span<T> in_mixer) {
  return std::all_of(in_mixer.begin(), in_mixer.end(),
                     [&](const T& item) { return valid(saved.read(item)); });
}

Status check_state(const Mixer& mixer, const SavedState& saved, const ClipFinder& clips,
                   Error& error) {
  const int64_t now = saved.read(*mixer.header).now;
  if (now < 0 || now > kMaxMixerTime) return wrong_snapshot(error, "has a time out of range");
  uint64_t players = 0;
  for (uint32_t i = 0; i < mixer.layers.count; ++i) {
    if (!is_layer(mixer, saved, i, players)) {
      return wrong_snapshot(
          error, "has a layer in a state that none can be in: it is damaged, take another");
    }
    const LayerState layer = saved.read(mixer.layers[i]);
    const uint16_t used[2] = {layer.current, layer.previous};
    for (uint16_t player : used) {
      if (player == kNoPlayer) continue;
      const Status status =
          check_player(mixer, saved.read(mixer.player_states[player]), i, clips, error);
      if (status != Status::kOk) return status;
    }
  }
  for (uint32_t i = 0; i < mixer.generators.count; ++i) {
    const LayerDesc& layer = mixer.mix->layers[i];
    const bool blinks = layer.source == LayerSource::kGenerator &&
                        layer.generator == Generator::kBlink && !layer.curves.empty();
    const int64_t next = saved.read(mixer.generators[i]).next;
    // A step goes through all blinks since then.
    if (next < 0 || !is_time(next) || (blinks && now - next > kMaxFadeTicks)) {
      return wrong_snapshot(error, kOutOfRange);
    }
  }
  bool all = all_valid(saved, mixer.pose_weights) && all_valid(saved, mixer.reactions) &&
             all_valid(saved, mixer.strokes) && all_valid(saved, mixer.variables) &&
             all_valid(saved, mixer.guard_overrides);
  for (const GazeState& gaze : mixer.gazes) all = all && valid(saved.read(gaze), now);
  return all ? Status::kOk : wrong_snapshot(error, kOutOfRange);
}

PlayerState saved_player(const Player& player) {
  const ClipSampler& sampler = player.sampler;
  PlayerState state = {};
  state.source = player.source.id;
  state.tick = sampler.tick;
  state.loops = sampler.loops;
  state.fraction = sampler.fraction;
  state.speed_numerator = sampler.speed_numerator;
  state.speed_denominator = sampler.speed_denominator;
  state.used = 1;
  state.wraps = sampler.wraps;
  state.interpolation = static_cast<uint8_t>(sampler.interpolation);
  state.mirrored = player.mirrored;
  state.fresh = sampler.fresh;
  state.backward = sampler.backward;
  return state;
}

void restore_player(Mixer& mixer, Player& player, const PlayerState& state,
                    const ClipSource& source) {
  PlayDesc desc;
  desc.start_tick = state.tick;
  desc.speed_numerator = state.speed_numerator;
  desc.speed_denominator = state.speed_denominator;
  desc.looping = state.wraps ? Looping::kLoop : Looping::kOnce;
  desc.interpolation = static_cast<Interpolation>(state.interpolation);
  Error error;
  start_player(mixer, player, source, desc, state.mirrored != 0, error);  // was checked
  player.sampler.loops = state.loops;
  player.sampler.fraction = state.fraction;
  player.sampler.fresh = state.fresh != 0;
  player.sampler.backward = state.backward != 0;
}

}  // namespace

size_t snapshot_size(const Mix& mix) { return sizeof(SnapshotHeader) + state_size(mix); }

Status take_snapshot(Mixer& mixer, Span<uint8_t> out, Error& error) {
  if (out.count < snapshot_size(*mixer.mix)) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "%zu bytes for a snapshot of %zu",
                out.count, snapshot_size(*mixer.mix));
  }
  for (uint32_t i = 0; i < mixer.layers.count; ++i) keep_shown(mixer, i);
  for (uint32_t i = 0; i < mixer.players.count; ++i) {
    mixer.player_states[i] = mixer.players[i].used ? saved_player(mixer.players[i]) : PlayerState{};
  }
  SnapshotHeader header = {};
  memcpy(header.magic, kMagic, sizeof(kMagic));
  header.version = kVersion;
  header.size = static_cast<uint32_t>(mixer.state.count);
  header.fingerprint = mixer.mix->fingerprint;
  memcpy(out.data, &header, sizeof(header));
  memcpy(out.data + sizeof(header), mixer.state.data, mixer.state.count);
  return Status::kOk;
}

Status restore_snapshot(Mixer& mixer, Span<const uint8_t> bytes, const ClipFinder& clips,
                        Error& error) {
  SnapshotHeader header;
  if (bytes.count < snapshot_size(*mixer.mix))
    return wrong_snapshot(error, "is truncated or of another mix");
  memcpy(&header, bytes.data, sizeof(header));
  if (memcmp(header.magic, kMagic, sizeof(kMagic)) != 0 || header.version != kVersion ||
      header.size != mixer.state.count || header.fingerprint != mixer.mix->fingerprint) {
    return wrong_snapshot(error, "is none, or of another version or mix");
  }
  const SavedState saved = {mixer, bytes.data + sizeof(header)};
  const Status status = check_state(mixer, saved, clips, error);
  if (status != Status::kOk) return status;

  memcpy(mixer.state.data, saved.bytes, mixer.state.count);
  for (Player& player : mixer.players) player.used = false;
  for (const LayerState& layer : mixer.layers) {
    const uint16_t used[2] = {layer.current, layer.previous};
    for (uint16_t player : used) {
      if (player == kNoPlayer) continue;
      const PlayerState& state = mixer.player_states[player];
      ClipSource source;
      clips.find(clips.user, state.source, source);
      restore_player(mixer, mixer.players[player], state, source);
    }
  }
  for (uint8_t& rests : mixer.cover_rests) rests = 0;  // their offsets are zeros then
  mixer.event_count = 0;
  mixer.lost_events = false;
  return Status::kOk;
}

}  // namespace mien
