// SPDX-License-Identifier: MIT
// What is mixed for one rig, and how: the immutable part, shared by any number of characters.
//
// A row holds a value for each lane:
//
//     | raw controls | pose variables | zeros up to a multiple of 16 |
//
// Pose variables are numbers beside the controls that are mixed by the same rules: gaze target, head
// offset, breath. A step (mixer.h) goes through its stages in this order:
//
//     layers, in their order    the row after the last one of base or speech is the protected row
//     reactions                 behind the last layer that is not of the group life
//     guards                    hold back what breaks the protected row
//     layers and reactions that come after the guards
//     antagonists               of two opposite lanes one is 0
//     limits
#pragma once

#include <atomic>

#include "runtime/base/allocator.h"
#include "runtime/base/span.h"
#include "runtime/base/status.h"
#include "runtime/mix/gaze.h"
#include "runtime/mix/guard.h"
#include "runtime/rig/rig.h"
#include "simd/kernels.h"

namespace mien {

constexpr uint32_t kLaneStep = 16;
constexpr uint32_t kMaxLanes = 4096;
constexpr uint32_t kMaxLayers = 16;
constexpr uint32_t kMaxPoses = 1024;

// Layers
// ------------------------------------------------------------------------------------------------

/// What a layer is for. Guards protect those of base and speech; layers act in the order in which
/// they are given.
enum class LayerGroup : uint8_t { kBase, kSpeech, kEmotion, kReaction, kLife };
constexpr uint32_t kLayerGroups = 5;

/// BlendMode: simd/kernels.h. Lanes that a source has no channel or pose value for stay as they are.
constexpr uint32_t kBlendModes = 5;

/// Where the values of a layer come from.
enum class LayerSource : uint8_t {
  kClip,       // a clip that is played
  kPoses,      // a weighted sum of poses
  kStream,     // rows that arrive from outside
  kGenerator,  // blinks, gaze, breath, noise
};
constexpr uint32_t kLayerSources = 4;

enum class Generator : uint8_t { kBlink, kBreath, kNoise, kGaze };
constexpr uint32_t kGenerators = 4;

enum LayerFlags : uint32_t {
  kLayerAfterGuards = 1,  // mixed after the guards, which leave it alone; not for base and speech
};

struct LayerDesc {
  LayerGroup group = LayerGroup::kBase;
  BlendMode mode = BlendMode::kOverride;
  LayerSource source = LayerSource::kClip;
  uint32_t flags = 0;
  float weight = 1;         // 0 ... 1, at the beginning
  Span<const float> mask;   // [lane] 0 ... 1; those beyond its end are 0; empty: 1 everywhere
  uint32_t first_pose = 0;  // of kPoses
  uint32_t pose_count = 0;
  Span<const uint16_t> lanes;  // of the channels of kStream; that kGenerator moves
  Span<const float> amounts;   // beside the lanes of kGenerator
  Generator generator = Generator::kBlink;
  int64_t period = 0;           // ticks; of kGenerator (generator.h)
  int64_t delay = 0;            // ticks; with which kStream is played
  uint32_t stream_frames = 64;  // that wait in kStream at most
};

struct MixLayer {
  LayerGroup group;
  BlendMode mode;
  LayerSource source;
  uint32_t flags;
  float weight;
  uint32_t first_pose, pose_count;
  uint32_t first_fade;  // of the weights of its poses, among all such
  Generator generator;
  uint32_t stream_frames;
  int64_t period, delay;
  Span<uint16_t> lanes;
  Span<float> amounts;
  Span<float> mask;  // [lane], 0 in the padding
  bool has_mask;     // one was given
};

/// The lanes of a pose that are not 0.
struct PoseDesc {
  Span<const uint16_t> lanes;
  Span<const float> values;
};

// Reactions (reaction.h)
// ------------------------------------------------------------------------------------------------

constexpr uint32_t kMaxReactions = 16;
constexpr uint32_t kMaxStrokes = 8;  // of a reaction
constexpr int64_t kUntilReleased = INT64_MAX;

/// Leads the lanes of a pose towards its values and back. Times are in ticks.
struct Stroke {
  uint32_t pose;
  BlendMode mode;
  bool held;    // as long as the stimulus lasts; weaker as the reaction adapts, unless it lags
  bool lags;    // exponentially; attack and release are time constants. Else by quintics
  bool scaled;  // by the level of the reaction
  int64_t delay, attack;
  int64_t hold;  // after the attack, if not held
  int64_t release;
};

/// What a trigger does while the reaction runs.
enum class Retrigger : uint8_t {
  kExtend,   // the stimulus goes on; strokes that fall or rest begin again
  kRestart,  // all strokes begin again
  kIgnore,
};

struct ReactionDesc {
  Span<const Stroke> strokes;
  Retrigger retrigger = Retrigger::kExtend;
  bool after_guards = false;
  int64_t cooldown = 0;       // strokes that are not held begin at most so often
  float adapted = 1;          // what remains of the strength if the stimulus lasts, 0 ... 1
  int64_t adapt_ticks = 0;    // time constants of adaptation and
  int64_t recover_ticks = 0;  // of recovery after it
  /// A level of level_on or more is a stimulus, until it is below level_off. level_on 0: it has no level.
  float level_on = 0, level_off = 0;  // 0 ... 1
};

struct Reaction {
  uint32_t first_stroke, end_stroke;
  Retrigger retrigger;
  bool after_guards;
  uint8_t zeros[2];
  float adapted, level_on, level_off;
  int64_t cooldown, adapt_ticks, recover_ticks;
};

// Antagonists
// ------------------------------------------------------------------------------------------------

/// Two lanes that move the face in opposite directions. If both are above 0, the smaller one is
/// taken off both; with a stiffness below 1 that much of it.
struct AntagonistPair {
  uint16_t a, b;
  float stiffness;  // 0 ... 1
};

// The mix
// ------------------------------------------------------------------------------------------------

constexpr uint32_t kMaxBoundGuiControls = 4096;  // with the one that is always 0

/// For MixDesc::max_bound_gui.
inline uint32_t bound_gui_limit(uint32_t gui_count) {
  return gui_count < kMaxBoundGuiControls ? gui_count + 1 : kMaxBoundGuiControls;
}

/// Everything is copied.
struct MixDesc {
  uint32_t raw_count = 0;       // raw controls of the rig
  uint32_t variable_count = 0;  // pose variables
  /// Of the raw controls, for messages and mix_file.h. Null: they have none.
  const NameList* names = nullptr;
  Span<const LayerDesc> layers;
  Span<const PoseDesc> poses;
  Span<const ReactionDesc> reactions;
  Span<const Guard> guards;  // in the order in which they act
  const GazeTable* gaze =
      nullptr;  // of the layer with Generator::kGaze, of which there is one at most
  Span<const AntagonistPair> antagonists;
  /// [lane] of the same size in the other half of the face, itself in the middle: for what is played
  /// mirrored. Empty: nothing can be.
  Span<const uint16_t> mirror;
  /// [lane] Empty: none.
  Span<const float> lower, upper;
  /// How many clips play at a time, those that are faded out included, and how large they may be.
  uint32_t player_count = 0;
  uint32_t max_channels = 0, max_changing_channels = 0;
  uint32_t max_bound_gui = 0;   // largest Binding::gui_count
  bool plays_backward = false;  // SamplerLimits::reverse
  uint32_t max_events = 64;     // that a step can report
  /// Of the rig, so that its instruction set is used for all; the results are the same with any. Null:
  /// the best.
  const KernelTable* kernels = nullptr;
};

/// Immutable, in one block of memory.
struct Mix {
  uint32_t tag = 0;  // first, for the C API to recognize its handles
  uint32_t raw_count = 0, variable_count = 0;
  uint32_t lane_count = 0;  // with padding
  uint32_t fade_count = 0;  // weights of poses in all layers
  uint32_t player_count = 0, max_channels = 0, max_changing_channels = 0, max_bound_gui = 0;
  uint32_t max_events = 0;
  bool plays_backward = false;
  uint32_t first_unprotected = 0;      // layer after the last one of base or speech
  uint32_t first_after_reactions = 0;  // layer after the last one that precedes reactions
  uint64_t fingerprint = 0;            // of everything that a snapshot depends on
  const KernelTable* kernels = nullptr;
  Allocator allocator;
  size_t block_size = 0;
  mutable std::atomic<uint32_t> owners{1};  // the creator and every mixer

  Span<MixLayer> layers;
  Span<uint32_t> pose_ends;     // [pose] into pose_lanes and pose_values
  Span<Span<float>> pose_rows;  // [pose][lane], or empty if it has few lanes
  Span<uint16_t> pose_lanes;
  Span<float> pose_values;
  Span<Reaction> reactions;
  Span<Stroke> strokes;
  Span<Guard> guards;               // as they were given
  Span<uint16_t> guarded;           // the lanes of all guards, ascending
  Span<PlacedGuard> placed_guards;  // for rows of them
  Span<AntagonistPair> antagonists;
  bool has_gaze = false;  // a layer generates it
  GazeTable gaze;
  Span<uint16_t> gaze_lanes;  // of the left and of the right eye, then those of the head
  Span<uint16_t> mirror;      // [lane], or empty
  bool has_limits = false;    // some were given
  Span<float> lower, upper;   // [lane]
  NameList names;             // of the raw controls, in no order, or none

  uint32_t used_lanes() const { return raw_count + variable_count; }
};

/// On success `out` is to be given back by release_mix(). kInvalidArgument, kIndex or kMemory; the
/// message says which element is wrong.
Status create_mix(const MixDesc& desc, const Allocator& allocator, Mix*& out, Error& error);
void release_mix(const Mix* mix);

}  // namespace mien
