// SPDX-License-Identifier: MIT
// Rows of joint groups, as files have them.
#pragma once

#include <cstring>

#include "runtime/compile/compile_rig.h"
#include "runtime/dna/format/quaternion_columns.h"

namespace mien {

/// Where a row's result goes. Rows of joints represented by quaternions go nowhere: their columns
/// are turns. With quaternion outputs the attributes behind the rotation move up by one, and angles
/// stand behind all joints until they are made into quaternions.
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

/// Bits of a big-endian float, or of several merged by `or`, but for the sign; zero if all are zero.
inline uint32_t magnitude(uint32_t bits) { return bits & to_big_endian(uint32_t{0x7FFFFFFF}); }
inline uint32_t file_bits(const uint8_t* value) {
  uint32_t bits;
  memcpy(&bits, value, sizeof(bits));
  return bits;
}
inline uint32_t magnitude_bits(const uint8_t* value) { return magnitude(file_bits(value)); }

inline const uint8_t* row_values(const dna::JointGroup& group, uint32_t row) {
  return group.values.data + size_t{row} * group.input_indices.count * sizeof(float);
}

// Scans go by strips of columns: a count that the compiler knows, so that it makes vector code.
constexpr uint32_t kStrip = 32;

inline bool is_zero(const dna::JointGroup& group, uint32_t row) {
  const uint8_t* values = row_values(group, row);
  const uint32_t columns = group.input_indices.count;
  uint32_t c = 0, any = 0;
  for (; c + kStrip <= columns && magnitude(any) == 0; c += kStrip) {
    for (uint32_t i = 0; i < kStrip; ++i) any |= file_bits(values + size_t{c + i} * 4);
  }
  for (; c < columns && magnitude(any) == 0; ++c) any |= file_bits(values + size_t{c} * 4);
  return magnitude(any) == 0;
}

constexpr uint32_t kWordBits = 64;

inline Status no_scratch(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory to compile the joint groups");
}

/// What becomes of a row: JointPlan::uses.
enum RowUse : uint8_t {
  kUnused,  // zeros, out of reach, or overridden wherever it is reached
  kUsed,
  kContested,  // another row writes the same value at some LODs
};

/// Which rows count, and which block rows they are computed in: fills `uses`, `rows`, `first_rows`
/// and `block_row_reaches` of the plan. kMemory (scratch), or kDnaLimit for more block rows than
/// can be numbered.
Status plan_block_rows(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                       Error& error);

}  // namespace mien
