// SPDX-License-Identifier: MIT
// One character in a mix: what plays, fades and reacts, in one block of memory.
//
//     | Mixer | rows of a step | players | events of the last step | state |
//
// All that the future depends on is in the state, without pointers: copying its bytes is a snapshot.
// Players know clips by pointers and the state by numbers that the caller gives them (ClipSource).
//
// A step allocates nothing, locks nothing and cannot fail. Time is in ticks; everything but the
// velocity that an inertial transition takes over is a function of the time alone, however that is
// divided into steps.
#pragma once

#include "runtime/anim/binding.h"
#include "runtime/anim/clip_sampler.h"
#include "runtime/mix/fade.h"
#include "runtime/mix/generator.h"
#include "runtime/mix/mix.h"
#include "runtime/mix/reaction.h"
#include "runtime/mix/stream.h"

namespace mien {

// Clips
// ------------------------------------------------------------------------------------------------

/// A clip bound to the rig of the mix. Both have to outlive the playing. The id is the caller's: it
/// stands for the clip in snapshots.
struct ClipSource {
  uint64_t id = 0;
  const Clip* clip = nullptr;
  const Binding* binding = nullptr;
};

/// How a layer goes on from what it played. On a layer that plays nothing, the latter two fade in.
enum class Transition : uint8_t {
  kCut,
  kCrossfade,  // both play; the new one gains weight. Needs a free player, else kInertial
  kInertial,   // the old one is dropped; its last value and velocity lead over to the new one
};

struct LayerPlayDesc {
  PlayDesc play;
  Transition transition = Transition::kInertial;
  int64_t transition_ticks = kTicksPerSecond / 4;
  bool mirrored = false;  // needs a mirror map
};

constexpr uint16_t kNoPlayer = 0xFFFF;

// The state
// ------------------------------------------------------------------------------------------------

/// Values of a layer's last two steps, and offsets of a transition: [value of a lane], then [cover
/// of a lane] (mix_rows.h).
enum LayerRow : uint32_t { kShown0, kShown1, kQuintic0, kQuintic1, kQuintic2, kQuinticRate };
constexpr uint32_t kLayerRows = 6;

struct LayerState {
  Fade weight;                         // as the caller wants it
  Fade presence;                       // 0: plays nothing
  Fade cross;                          // 1: the current player alone
  int64_t shown_ticks;                 // between the last two steps
  int64_t offset_start, offset_ticks;  // of the transition; ticks 0: none
  uint16_t current, previous;          // players or kNoPlayer
  uint8_t shown_count;                 // how many of the last rows are there: 0, 1, 2
  uint8_t newest;                      // which one is
  uint8_t in_player[2];                // 1: it is the row of the current player, see keep_shown()
};

/// A player as a snapshot has it.
struct PlayerState {
  uint64_t source;
  int64_t tick, loops, fraction;
  int32_t speed_numerator, speed_denominator;
  uint8_t used, wraps, interpolation, mirrored;
  uint8_t fresh, backward, zeros[2];
};

/// Where the time of a mixer ends, so that no sum or difference of times overflows: 51 years.
constexpr int64_t kMaxMixerTime = INT64_MAX / 8;

struct StateHeader {
  int64_t now;    // ticks since the beginning, kMaxMixerTime at most
  uint64_t seed;  // of the generators
};

// The mixer
// ------------------------------------------------------------------------------------------------

struct Player {
  ClipSource source;
  bool used = false, mirrored = false;
  ClipSampler sampler;
  Span<float> rows;  // [value of a lane], then [cover of a lane], then [value] of another step
};

/// Lanes of guards: as they protect them, as layers left them, what they take off, what is left.
enum GuardedRow : uint32_t { kProtected, kFree, kBack, kGuarded };
constexpr uint32_t kGuardedRows = 4;

/// An event of a clip that the last step passed.
struct MixEvent {
  uint32_t layer;
  ClipEvent event;
};

struct Mixer {
  uint32_t tag = 0;  // first, for the C API to recognize its handles
  const Mix* mix = nullptr;
  Allocator allocator;
  size_t block_size = 0;

  Span<float> row;           // [lane] the result of the last step
  Span<float> guarded_rows;  // [GuardedRow][place in Mix::guarded], zeros up to kGuardStep
  Span<float> layer_row;     // [value of a lane], then [cover of a lane]
  Span<float> scratch;       // [lane]
  Span<float> gui;
  Span<Player> players;
  Span<RowStream*> streams;   // [layer] null where it is none
  Span<uint8_t> cover_rests;  // [layer] 1: its transition has no offsets of the cover
  Span<MixEvent> events;
  uint32_t event_count = 0;
  bool lost_events = false;  // the last step passed more of them than there is room for
  bool in_batch = false;     // while a batch is checked
  float* stages = nullptr;   // [stage][lane]: the row after each stage of the last step, or null

  Span<uint8_t> state;
  // In it:
  StateHeader* header = nullptr;
  Span<LayerState> layers;
  Span<PlayerState> player_states;  // written for snapshots
  Span<Fade> pose_weights;          // MixLayer::first_fade
  Span<float> variables;            // [pose variable] with which a row begins
  Span<float> held;                 // [place in Mix::guarded] by how much guards moved it
  Span<GeneratorState> generators;  // [layer]
  Span<GazeState> gazes;            // one if a layer generates gazes
  Span<ReactionState> reactions;
  Span<StrokeState> strokes;
  Span<float> guard_overrides;  // [guard] activation that the caller wants; negative: none
  Span<float> layer_rows;       // [layer of clips or a stream][LayerRow][value, cover]
};

/// Stages of a step: a layer each, then these.
enum MixStage : uint32_t { kStageReactions, kStageGuards, kStageAntagonists, kStageLimits };
inline uint32_t stage_count(const Mix& mix) {
  return static_cast<uint32_t>(mix.layers.count) + kStageLimits + 1;
}

/// Bytes of a mixer that keeps its stages, or does not.
size_t mixer_size(const Mix& mix, bool stages);

/// At time 0: nothing plays, poses have weight 0, variables are 0, layers the weight of their desc.
/// With `stages`, the row after each stage is kept. The mixer owns the mix with others. Null if memory
/// ran out.
Mixer* create_mixer(const Mix& mix, uint64_t seed, bool stages, const Allocator& allocator);
void destroy_mixer(Mixer* mixer);

/// kIndex for a layer that does not exist or plays no clips, kMismatch for a binding of another clip
/// or of a rig with another number of raw controls, kInvalidArgument for a delta clip in kOverride, a
/// mirrored clip without a mirror map, negative times or speeds out of range, kClipLimit for a clip
/// larger than the mix allows. Then the layer goes on as before.
Status play_clip(Mixer& mixer, uint32_t layer, const ClipSource& source, const LayerPlayDesc& desc,
                 Error& error);

/// Fades out what a layer plays, which then ends.
Status stop_layer(Mixer& mixer, uint32_t layer, int64_t fade_ticks, Error& error);

/// 0 ... 1; in kAdd from -1 on. kIndex, kInvalidArgument.
Status set_layer_weight(Mixer& mixer, uint32_t layer, float weight, int64_t fade_ticks,
                        Error& error);

/// Of the `pose`-th pose of a layer, 0 ... 1. If the weights of a layer add up to more than 1, they
/// are divided by their sum. kIndex, kInvalidArgument.
Status set_pose_weight(Mixer& mixer, uint32_t layer, uint32_t pose, float weight,
                       int64_t fade_ticks, Error& error);

/// The value with which a pose variable enters each step. kIndex, kInvalidArgument if not finite.
Status set_variable(Mixer& mixer, uint32_t variable, float value, Error& error);

/// Gives a layer of a stream one value per channel, of a time of the mixer (`header->now`). May be
/// called by one thread at any time; all other functions are for the thread that steps. A frame that
/// is not newer than the last one, or for which there is no room, is dropped, which is no error;
/// `accepted` tells, unless it is null. kIndex, kMismatch for another number of values,
/// kInvalidArgument for one that is not finite.
Status push_row(Mixer& mixer, uint32_t layer, int64_t tick, Span<const float> values,
                bool* accepted, Error& error);

/// Something happens: for `hold_ticks` or, with kUntilReleased, until end_stimulus(). Strength
/// 0 ... 1. kIndex, kInvalidArgument.
Status trigger(Mixer& mixer, uint32_t reaction, float strength, int64_t hold_ticks, Error& error);
Status end_stimulus(Mixer& mixer, uint32_t reaction, Error& error);
/// Of what a reaction reacts to, 0 ... 1: see set_reaction_level(). kIndex; kInvalidArgument, also for a
/// reaction without a level.
Status set_level(Mixer& mixer, uint32_t reaction, float level, Error& error);

/// Activation of a guard, 0 ... 1, or negative: as it finds it itself. kIndex, kInvalidArgument.
Status set_guard(Mixer& mixer, uint32_t guard, float activation, Error& error);

/// What a guard did in the last step. Distances are f of its lanes, in millimeters.
struct GuardState {
  Span<const uint16_t> lanes;  // that it knows
  float activation;
  float protected_distance;  // of the protected row
  float wanted;              // of the row that the layers and reactions before the guards made
  float limit;               // that it lets pass when fully active
  float distance;            // of the row that the guards left
};

/// kIndex.
Status guard_state(const Mixer& mixer, uint32_t guard, GuardState& state, Error& error);

/// Advances by 0 ... kMaxStepTicks and mixes. The first `count` lanes of the result go to `out`: raw
/// controls of an instance, or all lanes. The whole row stays in `mixer.row`. `active` gets a bit for
/// each lane that is not 0, [(lane_count + 63) / 64] words, or is null.
void step_mixer(Mixer& mixer, int64_t ticks, float* out, size_t count, uint64_t* active);

/// Several characters, of the same mix or not: each as if alone. outs[i] is for mixers[i]; `active`
/// holds `active_stride` words per mixer or is null.
void step_mixers(Span<Mixer* const> mixers, int64_t ticks, float* const* outs, size_t count,
                 uint64_t* active, size_t active_stride);

// For play_clip() and snapshots: what a clip must be like for a layer; a player that begins, with its
// rows; one of them at the time that it has, with or without what never changes; and a copy of what the
// layer has shown last, for when its player is gone.
Status check_source(const Mix& mix, uint32_t layer, const ClipSource& source, Error& error);
Status start_player(Mixer& mixer, Player& player, const ClipSource& source, const PlayDesc& desc,
                    bool mirrored, Error& error);
void sample_player(Mixer& mixer, Player& player, uint32_t row, bool constants);
void keep_shown(Mixer& mixer, uint32_t layer);

// Snapshots (snapshot.cpp)
// ------------------------------------------------------------------------------------------------

/// Bytes of a snapshot of any mixer of the mix.
size_t snapshot_size(const Mix& mix);

/// Bytes of Mixer::state.
size_t state_size(const Mix& mix);

/// Finds the clip with an id; false if there is none.
struct ClipFinder {
  const void* user;
  bool (*find)(const void* user, uint64_t id, ClipSource& source);
};

/// Everything that the next steps depend on but rows of streams, in the byte order of the machine.
/// kInvalidArgument if there is no room.
Status take_snapshot(Mixer& mixer, Span<uint8_t> out, Error& error);

/// Goes on from a snapshot of a mixer of the same mix, bit for bit; rows that streams have received
/// stay. kInvalidArgument for bytes that are no snapshot of this mix or hold what no mixer can be in,
/// kMismatch for a clip that is missing or another one; the mixer then stays as it is.
Status restore_snapshot(Mixer& mixer, Span<const uint8_t> bytes, const ClipFinder& clips,
                        Error& error);

}  // namespace mien
