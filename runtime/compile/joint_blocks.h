// SPDX-License-Identifier: MIT
// Blocks of the joint matrix, out of the numbers of a file.
#pragma once

#include <algorithm>

#include "runtime/compile/plan_block_rows.h"

namespace mien {

/// Where rows stand in the file.
struct FileRows {
  const uint8_t* at[kJointBlockRows];  // behind the last one it stands again
  uint32_t count;

  FileRows(const dna::JointGroup& group, const PlannedRows& rows) : count(rows.row_count) {
    for (uint32_t k = 0; k < kJointBlockRows; ++k) {
      at[k] = row_values(group, rows.rows[std::min(k, count - 1)]);
    }
  }
  const uint8_t* value(uint32_t row, uint32_t column) const {
    return at[row] + size_t{column} * sizeof(float);
  }
};

/// The one pass that reads the numbers to keep them: fills the blocks, their block rows and the parts of
/// columns. `plan` says where columns begin.
void fill_joint_blocks(const dna::DnaView& view, const JointPlan& plan, Rig& rig);

}  // namespace mien
