// SPDX-License-Identifier: MIT
// Rows of joint groups, as files have them.
#pragma once

#include "runtime/load/compile/compile_rig.h"
#include "runtime/load/dna/format/quaternion_columns.h"

namespace mien {

/// Where a row's result goes. Rows of joints represented by quaternions go nowhere: their columns are
/// turns. With quaternion outputs the attributes behind the rotation move up by one, and angles follow all
/// joints until they are converted to quaternions.
inline uint32_t output_of(const dna::DnaView& view, const Rig& rig, uint32_t file_output) {
  const uint32_t joint = file_output / kFileAttributes, attribute = file_output % kFileAttributes;
  if (dna::is_rotation(file_output) && dna::is_quaternion_joint(view, joint)) return kNoOutput;
  if (!rig.quaternion_outputs) return file_output;
  if (dna::is_rotation(file_output)) return rig.joint_value_count() + joint * 3 + attribute - 3;
  return joint * rig.joint_attributes + attribute + (attribute >= 6);
}

inline uint32_t output_limit(const Rig& rig) {
  return rig.joint_value_count() + (rig.quaternion_outputs ? rig.joint_count * 3 : 0);
}

inline const uint8_t* row_values(const dna::JointGroup& group, uint32_t row) {
  return group.values.data + size_t{row} * group.input_indices.count * sizeof(float);
}

constexpr uint32_t kWordBits = 64;

inline Status no_scratch(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory to compile the joint groups");
}

/// The use of a row: JointPlan::uses.
enum RowUse : uint8_t {
  kUnused,  // zeros, out of reach, or overridden wherever it is reached
  kUsed,
  kContested,  // another row writes the same value at some LODs
};

/// Copies the inputs of the groups, and looks at all their numbers once. kMemory (scratch).
Status find_nonzeros(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                     Error& error);

/// Which rows count, and which block rows they are computed in: fills `uses`, `rows`, `first_rows`
/// and `block_row_reaches` of the plan. kMemory (scratch), or kDnaLimit for more block rows than
/// can be numbered.
Status plan_block_rows(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                       Error& error);

}  // namespace mien
