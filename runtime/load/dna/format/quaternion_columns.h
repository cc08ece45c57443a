// SPDX-License-Identifier: MIT
// The columns of a joint group rotate its quaternion joints one after another, so the order of the
// columns matters. It depends on the LODs of the file (docs/rig-evaluation.md, 4.3 "Rows, columns
// and LODs"). The rig compiler and LOD selection both need it.
#pragma once

#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

/// `output` as files number it: 9 * joint + attribute.
inline bool is_rotation(uint32_t output) {
  const uint32_t attribute = output % 9;
  return attribute >= 3 && attribute < 6;
}

inline bool is_quaternion_joint(const DnaView& view, uint32_t joint) {
  return joint < view.jbmd.joints.count && view.jbmd.joints[joint].rotation == 1;
}

/// True for a row that rotates a quaternion joint.
inline bool is_quaternion_row(const DnaView& view, uint32_t output) {
  return is_rotation(output) && is_quaternion_joint(view, output / 9);
}

/// Writes the columns of `group` that have an entry in a quaternion row to `order`, in order of
/// application, and returns their number. `order` and the scratch array `first_rows` have room for
/// all columns of the group. If `columns_at_lod` is not null, columns_at_lod[l] becomes the number of
/// leading ones that LOD l uses.
uint32_t order_quaternion_columns(const DnaView& view, const JointGroup& group,
                                  const Span<uint32_t>& first_rows, const Span<uint32_t>& order,
                                  uint32_t* columns_at_lod);

}  // namespace mien::dna
