// SPDX-License-Identifier: MIT
// Rig + instance -> pose. Nothing here allocates, locks or fails: the rig was checked when it was
// compiled, and callers check LOD and group numbers.
#pragma once

#include <cstring>

#include "runtime/eval/instance.h"

namespace mien {

/// Numbers of MIEN_STAGE_... in mien.h, in the order of evaluation.
enum Stages : uint32_t {
  kStageMl = 1,
  kStageRbf = 2,
  kStagePsd = 4,
  kStageJoints = 8,  // groups, then twists and swings, then joints of learned behavior
  kStageBlendShapes = 16,
  kStageAnimatedMaps = 32,
  kStagesAll = 63,
};

void map_gui_to_raw(const Rig& rig, Instance& instance);
void map_raw_to_gui(const Rig& rig, Instance& instance);

/// The stages named, in the order above.
void evaluate(const Rig& rig, Instance& instance, uint32_t lod, uint32_t stages);

// Its two halves, for what happens in between: looking for changes, then the stages that they
// concern.
void begin_evaluation(const Rig& rig, Instance& instance, uint32_t lod);
void evaluate_stages(const Rig& rig, Instance& instance, uint32_t lod, uint32_t stages);

/// The joint values of one group; the others are left alone, and so are values that a later group
/// writes instead.
void evaluate_joint_group(const Rig& rig, Instance& instance, uint32_t lod, uint32_t group);

/// The pose controls of one solver, whether the LOD lists it or not.
void evaluate_rbf_solver(const Rig& rig, Instance& instance, uint32_t lod, uint32_t solver);

/// The joints of one twist or swing.
void evaluate_twist_swing(const Rig& rig, Instance& instance, uint32_t lod, uint32_t setup);

/// To the range of finite floats; what is not a number becomes the lowest.
inline float saturated(double value) {
  if (!(value > -kLargestFloat)) return -kLargestFloat;
  return value < kLargestFloat ? static_cast<float>(value) : kLargestFloat;
}

// Stages in files of their own; `lod` has been entered.

constexpr uint64_t kAllPanels = ~uint64_t{0};
constexpr uint32_t kAllGroups = ~uint32_t{0};

/// Neighboring panels of a tile of the joint matrix, and the sums of the tile, of which those of
/// the panels start from 0. There is room for the whole tile: what an image is checked for is that
/// blocks of a tile add to block rows of the tile, whichever of its panels they are said to be of.
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
/// Rows of the panels that are marked (bit c >> panel_shift for panel c).
void evaluate_joint_rows(const Rig& rig, Instance& instance, uint32_t lod, uint64_t marks,
                         uint32_t only_group);
/// NaN equals itself, and 0 is not -0.
inline bool same_bits(float a, float b) {
  uint32_t x, y;
  memcpy(&x, &a, sizeof(x));
  memcpy(&y, &b, sizeof(y));
  return x == y;
}

/// Correctives were evaluated: whether any changed, and which panels of the joint matrix they
/// drive.
void note_changed_psds(Instance& instance, uint64_t panels, bool changed);

/// The joint stage without its rows, before and after them.
void begin_joints(const Rig& rig, Instance& instance, uint32_t lod);
void finish_joints(const Rig& rig, Instance& instance, uint32_t lod);

void evaluate_ml(const Rig& rig, Instance& instance, uint32_t lod);
/// Starts the joints of learned behavior from no delta; they add to what the groups write.
void clear_ml_joints(const Rig& rig, Instance& instance, uint32_t lod);
void add_ml_joints(const Rig& rig, Instance& instance, uint32_t lod);

void evaluate_rbf(const Rig& rig, Instance& instance, uint32_t lod);
void solve_rbf(const Rig& rig, Instance& instance, uint32_t solver);

/// In the form of the rig's outputs.
void write_rotation(const Rig& rig, Instance& instance, uint32_t joint, const Quaternion& q);

/// What a joint group turns, once its rows are written.
void evaluate_rotations(const Rig& rig, Instance& instance, uint32_t lod, uint32_t group);
void apply_twist_swing(const Rig& rig, Instance& instance, uint32_t lod, const TwistSwing& setup);

}  // namespace mien
