// SPDX-License-Identifier: MIT
// Joints represented by quaternions are turned by one column of their group after another, and the
// order of the columns decides the result. It depends on the LODs of the file (rig-evaluation 4.3):
// the rig compiler and LOD selection both need it.
#pragma once

#include "runtime/dna/format/dna_view.h"

namespace mien::dna {

/// Of an output as files number it: 9 * joint + attribute.
inline bool is_rotation(uint32_t output) {
  const uint32_t attribute = output % 9;
  return attribute >= 3 && attribute < 6;
}

inline bool is_quaternion_joint(const DnaView& view, uint32_t joint) {
  return joint < view.jbmd.joints.count && view.jbmd.joints[joint].rotation == 1;
}

/// True for a row that turns a joint represented by a quaternion.
inline bool is_quaternion_row(const DnaView& view, uint32_t output) {
  return is_rotation(output) && is_quaternion_joint(view, output / 9);
}

/// Columns of `group` with an entry in a turning row, in their order: `order` has room for all
/// columns of the group, `first_rows` too (scratch). Returns their number; columns_at_lod[l], if
/// not null, becomes how many leading ones LOD l uses.
uint32_t order_quaternion_columns(const DnaView& view, const JointGroup& group,
                                  const Span<uint32_t>& first_rows, const Span<uint32_t>& order,
                                  uint32_t* columns_at_lod);

}  // namespace mien::dna
