// SPDX-License-Identifier: MIT
// One character in a mix: its running clips, fades and reactions, in one block of memory.
//
//     | Mixer | rows of a step | players | events of the last step | state |
//
// The state holds everything that later steps depend on, except queued rows of streams, without pointers,
// so a copy of its bytes is a snapshot. Players refer to clips by pointers, the state by ids that the
// caller chooses (ClipSource).
//
// A step allocates nothing, locks nothing and cannot fail. Time is in ticks. Most of what runs is a
// function of time alone; docs/mixing.md, 8 "Time, numbers, memory" lists what depends on the steps.
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

/// A clip bound to the rig of the mix. Clip and binding must outlive their playback. The caller chooses the
/// id, which stands for the clip in snapshots.
struct ClipSource {
  uint64_t id = 0;
  const Clip* clip = nullptr;
  const Binding* binding = nullptr;
};

/// How a layer changes to another clip. If the layer plays nothing, kCrossfade and kInertial fade in.
enum class Transition : uint8_t {
  kCut,
  kCrossfade,  // both clips play. Needs a free player, else kInertial
  kInertial,   // the old clip stops; curves blend from their last value and velocity
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

/// What a layer showed in its last two steps, and the offsets of a transition: the values of all curves,
/// then their cover, which is 1 for curves that the source drives (BlendArgs in simd/mix_kernels.h).
enum LayerRow : uint32_t { kShown0, kShown1, kQuintic0, kQuintic1, kQuintic2, kQuinticRate };
constexpr uint32_t kLayerRows = 6;

struct LayerState {
  Fade weight;                         // set by the caller
  Fade presence;                       // 0: the layer plays nothing
  Fade cross;                          // share of the current player; 1: it plays alone
  int64_t shown_ticks;                 // between the last two steps
  int64_t offset_start, offset_ticks;  // of the transition; ticks 0: none
  uint16_t current, previous;          // indices of players, or kNoPlayer
  uint8_t shown_count;                 // how many of the last two rows exist
  uint8_t newest;                      // which of them is newer
  uint8_t in_player[2];                // 1: the row is that of the current player, see keep_shown()
};

/// A player in a snapshot.
struct PlayerState {
  uint64_t source;
  int64_t tick, loops, fraction;
  int32_t speed_numerator, speed_denominator;
  uint8_t used, wraps, interpolation, mirrored;
  uint8_t fresh, backward, zeros[2];
};

/// The largest time of a mixer, 51 years, so that no sum or difference of times overflows.
constexpr int64_t kMaxMixerTime = INT64_MAX / 8;

struct StateHeader {
  int64_t now;    // ticks since creation, at most kMaxMixerTime
  uint64_t seed;  // of the generators
};

// The mixer
// ------------------------------------------------------------------------------------------------

struct Player {
  ClipSource source;
  bool used = false, mirrored = false;
  ClipSampler sampler;
  Span<float> rows;  // values of all curves, their cover, then the values of another step
};

/// Rows of the curves of guards: protected, as the layers left them, what guards take off, what is left.
enum GuardedRow : uint32_t { kProtected, kFree, kBack, kGuarded };
constexpr uint32_t kGuardedRows = 4;

/// An event of a clip that the last step passed.
struct MixEvent {
  uint32_t layer;
  ClipEvent event;
};

struct Mixer : Object {
  static constexpr uint32_t kTag = 0x6D4D'5852;

  const Mix* mix = nullptr;
  ~Mixer() { release(mix); }

  Span<float> row;           // [curve] the result of the last step
  Span<float> guarded_rows;  // [GuardedRow][place in GuardTable::curves], zeros up to kGuardStep
  Span<float> layer_row;     // values of all curves, then their cover
  Span<float> scratch;       // [curve]
  Span<float> gui;
  Span<Player> players;
  Span<RowStream*> streams;   // [layer] null if it is not a stream
  Span<uint8_t> cover_rests;  // [layer] 1: its transition has no offsets of cover
  Span<MixEvent> events;
  uint32_t event_count = 0;
  bool lost_events = false;  // the last step passed more events than there is room for
  bool in_batch = false;     // while the arguments of a batch are checked
  float* stages = nullptr;   // [stage][curve]: the row after each stage of the last step, or null

  Span<uint8_t> state;
  // In it:
  StateHeader* header = nullptr;
  Span<LayerState> layers;
  Span<PlayerState> player_states;  // written for snapshots
  Span<Fade> pose_weights;          // Mix::first_fades
  Span<float> variables;            // [pose variable] at the start of each step
  Span<float> held;                 // [place in GuardTable::curves] how far guards took it back
  Span<GeneratorState> generators;  // [layer]
  Span<GazeState> gazes;            // one if there is a gaze layer
  Span<ReactionState> reactions;
  Span<StrokeState> strokes;
  Span<float> guard_overrides;  // [guard] activation set by the caller; negative: none
  Span<float> layer_rows;       // [clip or stream layer][LayerRow][values, cover]
};

/// Stages of a step: one for each layer, then these.
enum MixStage : uint32_t { kStageReactions, kStageGuards, kStageAntagonists, kStageLimits };
inline uint32_t stage_count(const Mix& mix) {
  return static_cast<uint32_t>(mix.layers.count) + kStageLimits + 1;
}

/// Bytes of a mixer. `stages`: it keeps the row after each stage.
size_t mixer_size(const Mix& mix, bool stages);

/// Creates a mixer at time 0: nothing plays, pose weights and pose variables are 0, layers have the weight
/// of their desc. `stages`: it keeps the row after each stage. The mixer becomes an owner of the mix. Null
/// if memory ran out.
Mixer* create_mixer(const Mix& mix, uint64_t seed, bool stages, const Allocator& allocator);

/// Plays a clip in a layer, from the next step on. kIndex if the layer does not exist or is not a clip
/// layer, kMismatch if the binding is for another clip or for a rig with another number of raw controls,
/// kInvalidArgument for a delta clip in kOverride, a mirrored clip without a mirror map, or times and speeds
/// out of range, kClipLimit if the clip is larger than the mix allows. On failure the layer continues as
/// before.
Status play_clip(Mixer& mixer, uint32_t layer, const ClipSource& source, const LayerPlayDesc& desc,
                 Error& error);

/// Fades out the clip of a layer and stops it. kIndex, kInvalidArgument.
Status stop_layer(Mixer& mixer, uint32_t layer, int64_t fade_ticks, Error& error);

/// Fades the weight of a layer to 0 ... 1, or with kAdd to -1 ... 1. kIndex, kInvalidArgument.
Status set_layer_weight(Mixer& mixer, uint32_t layer, float weight, int64_t fade_ticks,
                        Error& error);

/// Fades the weight of a pose to 0 ... 1; `pose` counts from the first pose of the layer. Weights of a
/// layer that add up to more than 1 are divided by their sum. kIndex, kInvalidArgument.
Status set_pose_weight(Mixer& mixer, uint32_t layer, uint32_t pose, float weight,
                       int64_t fade_ticks, Error& error);

/// Sets the value of a pose variable at the start of each step. kIndex; kInvalidArgument if not finite.
Status set_variable(Mixer& mixer, uint32_t variable, float value, Error& error);

/// Queues a row for a stream layer: one value per channel, for a time of the mixer (`header->now`). One
/// other thread may call this at any time; all other functions are for the thread that steps. A row that
/// is not newer than the last one, or for which the queue has no room, is dropped. That is not an error:
/// `accepted` is set to false, unless it is null. kIndex, kMismatch for another number of values,
/// kInvalidArgument for a value that is not finite or a time beyond 2^61.
Status push_row(Mixer& mixer, uint32_t layer, int64_t tick, Span<const float> values,
                bool* accepted, Error& error);

/// Starts a reaction to a stimulus of `strength` 0 ... 1 that lasts for `hold_ticks`, or with
/// kUntilReleased until end_stimulus(). kIndex, kInvalidArgument.
Status trigger(Mixer& mixer, uint32_t reaction, float strength, int64_t hold_ticks, Error& error);
Status end_stimulus(Mixer& mixer, uint32_t reaction, Error& error);
/// Sets the level of what a reaction responds to, 0 ... 1: see set_reaction_level(). kIndex;
/// kInvalidArgument, also if the reaction takes no levels.
Status set_level(Mixer& mixer, uint32_t reaction, float level, Error& error);

/// Sets the activation of a guard, 0 ... 1; negative: automatic. kIndex, kInvalidArgument.
Status set_guard(Mixer& mixer, uint32_t guard, float activation, Error& error);

/// What a guard did in the last step. Distances are f of its curves, in millimeters.
struct GuardState {
  Span<const uint16_t> curves;  // of its function
  float activation;
  float protected_distance;  // of the protected row
  float wanted;              // of the row just before the guards
  float limit;               // largest distance that it allows when fully active
  float distance;            // of the row after the guards
};

/// kIndex.
Status guard_state(const Mixer& mixer, uint32_t guard, GuardState& state, Error& error);

/// Advances the time by 0 ... kMaxStepTicks and mixes. The first `count` curves of the result go to `out`:
/// the raw controls of an instance, or all curves. `mixer.row` has the whole row. `active` gets a bit for
/// each curve that is not 0, in (curve_count + 63) / 64 words; it may be null.
void step_mixer(Mixer& mixer, int64_t ticks, float* out, size_t count, uint64_t* active);

/// Steps several mixers, of the same mix or not, with the results of single calls. outs[i] belongs to
/// mixers[i]; `active` has `active_stride` words per mixer, or is null.
void step_mixers(Span<Mixer* const> mixers, int64_t ticks, float* const* outs, size_t count,
                 uint64_t* active, size_t active_stride);

// For play_clip() and snapshots. check_source() checks whether a clip may play in a layer. start_player()
// starts a player and fills its rows. sample_player() samples a row at the time of the player, with or
// without the channels that never change. keep_shown() copies the row that a layer has shown last, because
// its player is about to change.
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

/// Copies everything that later steps depend on, except queued rows of streams, in the byte order of the
/// machine. kInvalidArgument if there is no room.
Status take_snapshot(Mixer& mixer, Span<uint8_t> out, Error& error);

/// Restores a snapshot of a mixer of the same mix; later steps give the same bits. Queued rows of streams
/// stay. kInvalidArgument if the bytes are not a snapshot of this mix or not a possible state of a mixer,
/// kMismatch if a clip is missing or is not the one that was playing. On failure the mixer does not change.
Status restore_snapshot(Mixer& mixer, Span<const uint8_t> bytes, const ClipFinder& clips,
                        Error& error);

}  // namespace mien
