// SPDX-License-Identifier: MIT
#include "author/document/prune_joints.h"

#include <algorithm>
#include <cmath>

#include "author/base/dna_making.h"
#include "author/document/check_view.h"
#include "author/document/control_poses.h"
#include "author/document/renumber.h"

namespace mien::author {

using dna::JointGroup;
using dna::NewArray;

namespace {

/// A group without the rows and columns that have only zeros. Nothing else is different if there are none.
bool drop_zeros(JointGroup& group, Arena& arena) {
  const uint32_t columns = group.input_indices.count, rows = group.output_indices.count;
  Span<uint8_t> row_used, column_used;
  if (!make(arena, rows, row_used) || !make(arena, columns, column_used)) return false;
  for (uint32_t r = 0; r < rows; ++r) {
    for (uint32_t c = 0; c < columns; ++c) {
      if (group.values[size_t{r} * columns + c] == 0) continue;
      row_used[r] = column_used[c] = 1;
    }
  }
  const auto used_rows =
      static_cast<uint32_t>(std::count(row_used.begin(), row_used.end(), uint8_t{1}));
  const auto used_columns =
      static_cast<uint32_t>(std::count(column_used.begin(), column_used.end(), uint8_t{1}));
  if (used_rows == rows && used_columns == columns) return true;
  JointGroup left = group;
  NewArray<uint16_t> inputs, outputs, lods;
  NewArray<float> values;
  if (!make(arena, used_columns, inputs) || !make(arena, used_rows, outputs) ||
      !make(arena, size_t{used_rows} * used_columns, values) ||
      !make(arena, group.lods.count, lods)) {
    return false;
  }
  for (uint32_t c = 0, next = 0; c < columns; ++c) {
    if (column_used[c]) inputs.set(next++, group.input_indices[c]);
  }
  uint32_t next = 0, kept = 0;
  for (uint32_t l = 0; l < lods.count; ++l) lods.set(l, 0);
  for (uint32_t r = 0; r < rows; ++r) {
    if (!row_used[r]) continue;
    outputs.set(kept++, group.output_indices[r]);
    for (uint32_t c = 0; c < columns; ++c) {
      if (column_used[c]) values.set(next++, group.values[size_t{r} * columns + c]);
    }
    for (uint32_t l = 0; l < lods.count; ++l) {
      if (group.lods[l] > r) lods.set(l, static_cast<uint16_t>(kept));
    }
  }
  left.input_indices = inputs;
  left.output_indices = outputs;
  left.values = values;
  left.lods = lods;
  group = left;
  return true;
}

}  // namespace

Status prune_joint_matrix(Document& document, const JointPruning& pruning, PrunedJoints& out,
                          Error& error) {
  out = {};
  const float limits[3] = {pruning.translation, pruning.rotation, pruning.scale};
  for (float limit : limits) {
    if (limit >= 0 && std::isfinite(limit)) continue;
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "an epsilon is %g; epsilons are from 0 on", static_cast<double>(limit));
  }
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  Arena& arena = edit.arena();
  dna::List<JointGroup>& groups = edit.view.bhvr.joints.groups;
  Span<uint8_t> changed;
  if (!copy_list(arena, groups) || !make(arena, kMaxControls, changed))
    return no_memory(error, "an edit");
  for (JointGroup& group : groups) {
    const uint32_t columns = group.input_indices.count, rows = group.output_indices.count;
    NewArray<float> values;
    for (uint32_t r = 0; r < rows; ++r) {
      const float limit = limits[group.output_indices[r] % 9 / 3];
      for (uint32_t c = 0; c < columns; ++c) {
        const size_t at = size_t{r} * columns + c;
        const float value = group.values[at];
        out.entries += value != 0;
        if (value == 0 || !(std::abs(value) <= limit)) continue;
        if (!values.data && !copy_array(arena, group.values, values))
          return no_memory(error, "an edit");
        values.set(at, 0);
        changed[group.input_indices[c]] = 1;
        ++out.removed;
      }
    }
    if (!values.data) continue;
    group.values = values;
    if (!drop_zeros(group, arena)) return no_memory(error, "an edit");
  }
  size_t controls = changed.count;
  while (controls != 0 && !changed[controls - 1]) --controls;
  const Status measured = measure_difference(document.view(), edit.view, changed.first(controls),
                                             document.allocator(), out.worst, error);
  if (measured != Status::kOk) return measured;
  if (out.removed != 0) edit.commit();
  return Status::kOk;
}

}  // namespace mien::author
