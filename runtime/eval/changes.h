// SPDX-License-Identifier: MIT
// Small changes at small cost, for rigs with ChangeTables (MIEN_REUSE_SUMS).
//
//     controls that changed -> correctives that read them -> columns of the joint matrix
//                                                         -> channels, animated maps
//
// An instance keeps the sums of the joint matrix. For each control that changed, the difference times its
// column is added to them, and the joint values that these columns reach are written. Controls, channels
// and maps have the bits of a full evaluation; sums do not, because they are rounded once more for each
// column that is added. So all sums are computed anew after kMaxRoundings; and before, where that takes less
// time, for the panels that are stale.
#pragma once

#include "runtime/eval/instance.h"

namespace mien {

struct InstancePacket;

/// numbers.md, 10 states the error that follows from this.
constexpr uint32_t kMaxRoundings = 1536;

/// Marks what differs from `previous` in a range of controls, and returns the union of its
/// Rig::control_uses. Sets `previous` to the new values.
Uses mark_changes(const Rig& rig, Instance& instance, const ControlRange& range, float* previous);

/// To be called after all correctives have been computed.
void mark_all_psds(const Rig& rig, Instance& instance);

/// The sums are no longer those of the joint values.
inline void drop_sums(Instance& instance) {
  if (instance.changes) instance.changes->all |= kStageJoints;
}

/// Whether so little changed that the instance is evaluated faster by itself than in a packet.
bool has_few_changes(const Rig& rig, const Instance& instance);

// Each of these evaluates what changed, unless that takes longer than everything, or cannot be done: then it
// changes nothing and returns false.
bool evaluate_changed_psds(const Rig& rig, Instance& instance, uint32_t lod);
bool evaluate_changed_blend_shapes(const Rig& rig, Instance& instance, uint32_t lod);
bool evaluate_changed_maps(const Rig& rig, Instance& instance, uint32_t lod);
/// Leaves the joints whose angles it wrote in Changes::turned. Where it returns false, it may have changed
/// sums: those of the panels that are stale have to be computed anew.
bool add_changed_columns(const Rig& rig, Instance& instance, uint32_t lod);

/// The panels whose sums are to be computed anew if add_changed_columns() returned false; kAllPanels if these
/// are all that the LOD has.
Uses panels_to_sum(const Rig& rig, const Instance& instance);
/// To be called after their sums have been stored.
void note_sums(const Rig& rig, Instance& instance, Uses panels);

}  // namespace mien
