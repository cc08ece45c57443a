// SPDX-License-Identifier: MIT
// How much work an evaluation is. docs/rig-evaluation.md, 9.6 "Statistics".
#pragma once

#include "runtime/eval/instance.h"

namespace mien {

/// With all controls active.
struct RigStatistics {
  uint32_t psd_count = 0;               // correctives computed
  uint32_t joint_count = 0;             // joints of the LOD
  uint32_t joint_row_count = 0;         // rows of the joint groups
  uint32_t blend_shape_count = 0;       // channels written
  uint32_t animated_map_row_count = 0;  // rows of the animated map table
  uint32_t rbf_solver_count = 0;
  uint32_t quaternion_joint_count = 0;
  uint64_t joint_entry_count = 0;  // stored in the joint matrix
  uint64_t joint_byte_count = 0;   // of these entries
};
RigStatistics rig_statistics(const Rig& rig, uint32_t lod);

/// What the joint stage reads for the current controls, at the LOD of the last evaluation.
struct InstanceStatistics {
  uint32_t active_control_count = 0;  // controls that are not 0
  uint32_t joint_column_count = 0;    // of the joint matrix
  uint64_t joint_entry_count = 0;     // of these columns
  uint64_t joint_byte_count = 0;      // of these entries
};
InstanceStatistics instance_statistics(const Instance& instance);

}  // namespace mien
