// SPDX-License-Identifier: MIT
// The stages of an evaluation, one function each, for the pipeline in evaluate.cpp. The instance has
// entered `lod`. Stages look at Instance::stale only where a comment says so.
#pragma once

#include <cstring>

#include "runtime/eval/instance.h"

namespace mien {

struct InstancePacket;

// Controls (evaluate_controls.cpp) ----------------------------------------------------------------

/// Marks what becomes stale, by note_written_psds().
void evaluate_psds(const Rig& rig, Instance& instance, uint32_t lod);
void evaluate_blend_shapes(const Rig& rig, Instance& instance, uint32_t lod);
void evaluate_animated_maps(const Rig& rig, Instance& instance, uint32_t lod);

/// The PSD stage has run. `uses` is the union of Rig::control_uses of the correctives that changed.
inline void note_written_psds(Instance& instance, Uses uses) {
  instance.stale = (instance.stale | uses) & ~Uses{kStagePsd};
}

// Networks (evaluate_neural.cpp) and RBF solvers (evaluate_rbf.cpp) -------------------------------

// Both of all instances of the packet.
void evaluate_ml(const InstancePacket& packet);
void evaluate_rbf(const InstancePacket& packet);
/// One solver, whether the LOD lists it or not.
void solve_rbf(const Rig& rig, Instance& instance, uint32_t solver);

// Joints (evaluate_joints.cpp) --------------------------------------------------------------------

constexpr uint32_t kAllGroups = ~uint32_t{0};

/// Rows of the joint matrix, rotations, twists and swings, ML joints. Only stale panels are summed,
/// where that is enough.
void evaluate_joints(const Rig& rig, Instance& instance, uint32_t lod);

/// The joint stage by its parts: what comes before the rows of the joint matrix, the rows of stale
/// panels, and, of all instances of a packet, what comes after them. Then neither the stage nor any panel
/// is stale.
void begin_joints(const Rig& rig, Instance& instance, uint32_t lod);
void evaluate_stale_rows(const Rig& rig, Instance& instance, uint32_t lod);
void finish_joints(const InstancePacket& packet);

/// Rows of the panels in `panels` (bits of Uses): of one group, or of all.
void evaluate_joint_rows(const Rig& rig, Instance& instance, uint32_t lod, Uses panels,
                         uint32_t only_group);

/// Neighboring panels of an accumulator tile, and the sums of the tile; those of the panels start
/// from 0. There is room for the whole tile: a baked file is checked for blocks that add to block
/// rows outside of their tile, not for the panel that they are in.
struct JointTile {
  uint32_t first_block_row;  // of the tile
  uint32_t first_panel, end_panel;
  float* sums;  // [block row of the tile][8], 64-byte aligned

  float* of_panel(const JointMatrix& joints, uint32_t panel) const {
    return sums + size_t{joints.panels[panel].first_block_row - first_block_row} * kJointBlockRows;
  }
};

/// Adds columns `first_column` and on, scales and saturates, and writes what the LOD has of a group
/// or of all.
void finish_tile(const Rig& rig, Instance& instance, uint32_t lod, const JointTile& tile,
                 uint32_t first_column, uint32_t only_group);

/// Writes all groups of a packet, from finished sums in lanes: [packed row of the tile][32].
void write_tile_together(const InstancePacket& packet, const JointTile& tile);

// Rotations of joints (evaluate_rotations.cpp) ----------------------------------------------------

/// The rotations of all groups, once their rows are written, and all twists and swings. In a batch
/// the scratch memory has the controls.
void turn_joints(const InstancePacket& packet);
void twist_joints(const InstancePacket& packet);

/// The rotations of neighboring groups.
void evaluate_rotations(const Rig& rig, Instance& instance, uint32_t lod, uint32_t first_group,
                        uint32_t group_count);
/// Neighboring set-ups, in order.
void apply_twists_and_swings(const Rig& rig, Instance& instance, uint32_t lod, uint32_t first_setup,
                             uint32_t setup_count);
/// A convention as kernels take it.
EulerForm euler_form(const RotationConvention& convention);

// ML joints (evaluate_ml_joints.cpp) --------------------------------------------------------------

/// ML joints are added to what the groups write, and start from no delta.
void clear_ml_joints(const Rig& rig, Instance& instance, uint32_t lod);
void add_ml_joints(const Rig& rig, Instance& instance, uint32_t lod);

}  // namespace mien
