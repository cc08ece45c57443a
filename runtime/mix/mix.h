// SPDX-License-Identifier: MIT
// The description of what is mixed for one rig, and how. Immutable, shared by any number of characters.
//
// A row holds a value for each curve:
//
//     | raw controls | pose variables | zeros up to a multiple of 16 |
//
// Pose variables are numbers of the caller that are mixed like controls: gaze target, head offset,
// breath. A step (mixer.h) runs these stages in order:
//
//     layers, in their order    the row after the last one of base or speech is the protected row
//     reactions                 after the last layer that is not of the group life
//     guards                    hold back what opens a distance that the protected row closes
//     layers and reactions that act after the guards
//     antagonists               two opposite curves cancel out
//     limits
#pragma once

#include "runtime/anim/binding.h"
#include "runtime/base/object.h"
#include "runtime/base/status.h"
#include "runtime/mix/gaze.h"
#include "runtime/mix/guard.h"
#include "runtime/rig/rig.h"

namespace mien {

constexpr uint32_t kRowStep = 16;
constexpr uint32_t kMaxCurves = 4096;
constexpr uint32_t kMaxLayers = 16;
constexpr uint32_t kMaxPoses = 1024;

// Layers
// ------------------------------------------------------------------------------------------------

/// The purpose of a layer. Guards protect the result of base and speech. Layers act in the order in which
/// they are given.
enum class LayerGroup : uint8_t { kBase, kSpeech, kEmotion, kReaction, kLife };
constexpr uint32_t kLayerGroups = 5;

/// BlendMode: simd/mix_kernels.h. A layer does not change curves for which its source has no value.
constexpr uint32_t kBlendModes = 5;

/// Where the values of a layer come from.
enum class LayerSource : uint8_t {
  kClip,       // a clip that is played
  kPoses,      // a weighted sum of poses
  kStream,     // rows that another thread pushes
  kGenerator,  // blinks, gaze, breath, noise
};
constexpr uint32_t kLayerSources = 4;

enum class Generator : uint8_t { kBlink, kBreath, kNoise, kGaze };
constexpr uint32_t kGenerators = 4;

struct LayerDesc {
  LayerGroup group = LayerGroup::kBase;
  BlendMode mode = BlendMode::kOverride;
  LayerSource source = LayerSource::kClip;
  uint32_t after_guards = 0;  // 1: acts after the guards; not for base and speech
  float weight = 1;           // the initial one; 0 ... 1, with kAdd -1 ... 1
  Span<const float> mask;     // [curve] 0 ... 1; 0 for curves beyond its end; empty: all 1
  uint32_t first_pose = 0;    // of kPoses
  uint32_t pose_count = 0;
  Span<const uint16_t> curves;  // of the channels of kStream; or that kGenerator moves
  Span<const float> amounts;    // of kGenerator: a factor for each of its curves
  Generator generator = Generator::kBlink;
  int64_t period = 0;           // ticks; of kGenerator (generator.h)
  int64_t delay = 0;            // ticks; kStream is played this much later than its times
  uint32_t stream_frames = 64;  // capacity of the queue of kStream
};

/// The curves of a pose that are not 0.
struct PoseDesc {
  Span<const uint16_t> curves;
  Span<const float> values;
};

// Reactions (reaction.h)
// ------------------------------------------------------------------------------------------------

constexpr uint32_t kMaxReactions = 16;
constexpr uint32_t kMaxStrokes = 8;  // of a reaction
constexpr int64_t kUntilReleased = INT64_MAX;

/// Moves the curves of a pose to its values and back to 0. Times are in ticks.
struct Stroke {
  uint32_t pose;
  BlendMode mode;
  bool is_held;    // stays as long as the stimulus lasts, and adapts unless it lags
  bool is_lag;     // moves exponentially: attack and release are time constants. Else quintics
  bool is_scaled;  // scaled by the level of the reaction
  int64_t delay, attack;
  int64_t hold;  // after the attack, if not held
  int64_t release;
};

/// What a trigger does while the reaction runs.
enum class Retrigger : uint8_t {
  kExtend,   // extends the stimulus; strokes that fall or rest start again
  kRestart,  // all strokes start again
  kIgnore,
};

struct ReactionDesc {
  Span<const Stroke> strokes;
  Retrigger retrigger = Retrigger::kExtend;
  bool after_guards = false;
  int64_t cooldown = 0;       // minimum time between two starts of strokes that are not held
  float adapted = 1;          // share of the strength that remains if the stimulus lasts, 0 ... 1
  int64_t adapt_ticks = 0;    // time constants of adaptation and
  int64_t recover_ticks = 0;  // of recovery after it
  /// A level of level_on or more is a stimulus, which ends below level_off. level_on 0: no levels.
  float level_on = 0, level_off = 0;  // 0 ... 1
};

// Antagonists
// ------------------------------------------------------------------------------------------------

/// Two curves that move the face in opposite directions. If both are above 0, the smaller one times
/// stiffness is subtracted from both.
struct AntagonistPair {
  uint16_t first, second;
  float stiffness;  // 0 ... 1
};

// The mix
// ------------------------------------------------------------------------------------------------

/// For MixDesc::max_bound_gui.
inline uint32_t bound_gui_limit(uint32_t gui_count) {
  return gui_count < kMaxBoundGuiControls ? gui_count + 1 : kMaxBoundGuiControls;
}

/// Everything is copied. mix_fields.h describes the fields.
struct MixDesc {
  uint32_t raw_count = 0;       // raw controls of the rig
  uint32_t variable_count = 0;  // pose variables
  NameList names;               // of the raw controls, for messages and mix_file.h; or none
  Span<const LayerDesc> layers;
  Span<const PoseDesc> poses;
  Span<const ReactionDesc> reactions;
  Span<const Guard> guards;  // numbered in this order, which does not change results
  const GazeTable* gaze =
      nullptr;  // of the layer with Generator::kGaze, of which there is one at most
  Span<const AntagonistPair> antagonists;
  /// [curve] The counterpart in the other half of the face, or the curve itself. Empty: clips cannot be
  /// played mirrored.
  Span<const uint16_t> mirror;
  /// [curve] Limits. Empty: none.
  Span<const float> lower, upper;
  /// How many clips can play at the same time, including those that fade out, and how large they may be.
  uint32_t player_count = 0;
  uint32_t max_channels = 0, max_changing_channels = 0;
  uint32_t max_bound_gui = 0;  // largest Binding::gui_count
  bool reverse = false;        // clips may play backward: SamplerLimits::reverse
  uint32_t max_events = 64;    // capacity for the events of a step
  /// The kernels of the rig, so that mixing uses the same instruction set. Null: the best one. Results are
  /// the same with all.
  const KernelTable* kernels = nullptr;
};

inline bool is_gaze(const LayerDesc& layer) {
  return layer.source == LayerSource::kGenerator && layer.generator == Generator::kGaze;
}

/// Whether guards protect the layers of a group.
inline bool is_protected(LayerGroup group) {
  return group == LayerGroup::kBase || group == LayerGroup::kSpeech;
}

/// Layers that play clips.
uint32_t clip_layer_count(const MixDesc& desc);

/// Gives sizes that are 0 their defaults: two players for each layer of clips, a channel for each raw
/// control, all of which change if a clip can have as many.
void set_default_sizes(MixDesc& desc);

/// Immutable, in one block of memory: a copy of the desc, and further data that steps need. Masks of the
/// copy are 0 for curves that the layer cannot change; there is no gaze if no layer generates it.
struct Mix : Object, MixDesc {
  static constexpr uint32_t kTag = 0x6D4D'4958;

  uint32_t curve_count = 0;            // with padding
  uint32_t fade_count = 0;             // weights of poses in all layers
  uint32_t stroke_count = 0;           // of all reactions
  uint32_t first_unprotected = 0;      // layer after the last one of base or speech
  uint32_t first_after_reactions = 0;  // layer after the last one that precedes reactions
  uint64_t fingerprint = 0;            // of everything that a snapshot depends on

  Span<Span<float>> mask_rows;   // [layer][curve] the mask, 0 in the padding
  Span<uint32_t> first_fades;    // [layer] of the weights of its poses, in Mixer::pose_weights
  Span<Span<float>> pose_rows;   // [pose][curve], or empty if the pose has few curves
  Span<uint32_t> first_strokes;  // [reaction] in Mixer::strokes
  Span<uint8_t> closes_lids;     // [stroke of all reactions] 1: its pose raises a curve of a blink
  GuardTable guard_table;
  Span<uint16_t> gaze_curves;        // of the left and of the right eye, then those of the head
  Span<float> lower_row, upper_row;  // [curve] limits, or none: the largest numbers

  uint32_t used_curves() const { return raw_count + variable_count; }
};

/// On success, give back `out` with release(). kInvalidArgument, kIndex or kMemory; the message names
/// the element that is wrong.
Status create_mix(const MixDesc& desc, const Allocator& allocator, Mix*& out, Error& error);

}  // namespace mien
