// SPDX-License-Identifier: MIT
// The stages of an evaluation, one function each, for the pipeline (evaluate_packet()). The instance is
// already at `lod`. Stages read Instance::stale only where a comment says so.
#pragma once

#include <algorithm>
#include <cstring>

#include "runtime/eval/instance.h"
#include "simd/joint_kernels.h"
#include "simd/rotation_kernels.h"

namespace mien {

struct InstancePacket;

// Controls (evaluate_controls.cpp) ----------------------------------------------------------------

/// Calls note_written_psds() to mark what becomes stale.
void evaluate_psds(const Rig& rig, Instance& instance, uint32_t lod);
void evaluate_blend_shapes(const Rig& rig, Instance& instance, uint32_t lod);
void evaluate_animated_maps(const Rig& rig, Instance& instance, uint32_t lod);

/// Call this after the PSD stage. `uses` is the union of Rig::control_uses of the changed correctives.
inline void note_written_psds(Instance& instance, Uses uses) {
  instance.stale = (instance.stale | uses) & ~Uses{kStagePsd};
}

// Networks (evaluate_neural.cpp) and RBF solvers (evaluate_rbf.cpp) -------------------------------

/// The share of a network that its mask leaves.
inline float mask_of(const Rig& rig, const Instance& instance, const MlStep& step) {
  if (step.mask == kNoMask) return 1.0f;
  const float mask = instance.masks[step.mask];
  if (!rig.ml.blend_masks) return mask == 0.0f ? 0.0f : 1.0f;
  return mask > 0.0f ? (mask < 1.0f ? mask : 1.0f) : 0.0f;
}

/// The outputs of a step that the LOD has.
inline uint32_t scatter_count(const Rig& rig, const MlStep& step, uint32_t lod) {
  return std::min({step.scatter_count, step.output_count, rig.ml.limits[step.first_limit + lod]});
}

// Both evaluate all instances of the packet.
void evaluate_ml(const InstancePacket& packet);
/// Returns whether the lanes of the scratch memory have the controls that it read and wrote.
bool evaluate_rbf(const InstancePacket& packet);
/// One solver, whether the LOD lists it or not.
void solve_rbf(const Rig& rig, Instance& instance, uint32_t solver);

// Joints (evaluate_joints.cpp) --------------------------------------------------------------------

constexpr uint32_t kAllGroups = ~uint32_t{0};

/// Evaluates rows of the joint matrix, rotations, twists and swings, and ML joints. Sums only stale panels
/// where that is enough.
void evaluate_joints(const Rig& rig, Instance& instance, uint32_t lod);

/// The joint stage in three parts: the work before the rows of the joint matrix; the rows of stale panels;
/// the work after them, for all instances of a packet. Then neither the stage nor any panel is stale.
void begin_joints(const Rig& rig, Instance& instance, uint32_t lod);
void evaluate_stale_rows(const Rig& rig, Instance& instance, uint32_t lod);
void finish_joints(const InstancePacket& packet);
/// The same for one instance, after add_changed_columns().
void finish_changed_joints(const Rig& rig, Instance& instance, uint32_t lod);

/// Evaluates the rows of `panels` (bits of Uses), of one group or of all groups.
void evaluate_joint_rows(const Rig& rig, Instance& instance, uint32_t lod, Uses panels,
                         uint32_t only_group);

/// Neighboring panels of an accumulator tile, and the sums of the tile; the sums of these panels start at
/// 0. There is room for the whole tile, because the checks of baked files only make sure that blocks add
/// to block rows of their tile, not of their panel.
struct JointTile {
  uint32_t first_block_row;  // of the tile
  uint32_t first_panel, end_panel;
  float* sums;  // [block row of the tile][8], 64-byte aligned

  float* of_panel(const JointMatrix& joints, uint32_t panel) const {
    return sums + size_t{joints.panels[panel].first_block_row - first_block_row} * kJointBlockRows;
  }
};

/// Adds the columns from `first_column` on, scales and saturates the sums, and writes the joint values that
/// the LOD has, of one group or of all groups. `keep`: stores the sums in Changes::sums, too.
void finish_tile(const Rig& rig, Instance& instance, uint32_t lod, const JointTile& tile,
                 uint32_t first_column, uint32_t only_group, bool keep);

/// Writes all groups for a packet, from finished sums: [packed row of the tile][instance], 32 instances.
void write_tile_together(const InstancePacket& packet, const JointTile& tile);

// Rotations of joints (evaluate_rotations.cpp) ----------------------------------------------------

/// Applies the rotations of all groups, after their rows are written, and all twists and swings. In a
/// batch, the scratch memory already has the controls.
void turn_joints(const InstancePacket& packet);
/// The same for one instance; only the angles of Changes::turned changed.
void turn_changed_joints(const Rig& rig, Instance& instance, uint32_t lod);
void twist_joints(const InstancePacket& packet);

/// Applies the rotations of consecutive groups.
void evaluate_rotations(const Rig& rig, Instance& instance, uint32_t lod, uint32_t first_group,
                        uint32_t group_count);
/// Applies consecutive setups, in order.
void apply_twists_and_swings(const Rig& rig, Instance& instance, uint32_t lod, uint32_t first_setup,
                             uint32_t setup_count);
/// A rotation convention in the form that kernels take.
EulerForm euler_form(const RotationConvention& convention);

// ML joints (evaluate_ml_joints.cpp) --------------------------------------------------------------

/// ML joints are added to what the groups write; clear_ml_joints() sets them to no delta first.
void clear_ml_joints(const Rig& rig, Instance& instance, uint32_t lod);
void add_ml_joints(const Rig& rig, Instance& instance, uint32_t lod);

}  // namespace mien
