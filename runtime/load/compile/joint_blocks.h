// SPDX-License-Identifier: MIT
// Blocks of the joint matrix, from the numbers of a file.
#pragma once

#include <algorithm>

#include "runtime/load/compile/plan_block_rows.h"

namespace mien {

/// Where rows stand in the file.
struct FileRows {
  const uint8_t* at[kJointBlockRows];  // the last one is repeated after the end
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

/// Cuts block rows into strips where strips are worth their memory: a block row joins the one before it if that
/// reduces what is read. kMemory (scratch).
Status plan_strips(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                   Error& error);
void place_strips(const Rig& rig, const JointPlan& plan, Placer& placer, JointMatrix& joints);
/// Copies the blocks, which are in place.
void fill_strips(const JointPlan& plan, JointMatrix& joints);

}  // namespace mien
