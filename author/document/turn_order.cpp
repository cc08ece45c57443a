// SPDX-License-Identifier: MIT
#include "author/document/turn_order.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "runtime/load/dna/format/quaternion_columns.h"

namespace mien::author {

using dna::JointGroup;
using dna::NewArray;

namespace {

/// The rows that `takes` chooses, with these columns. A row counts at a LOD if it is there, or, if `whole`, if any is.
template <class Takes>
bool rows_of(const JointGroup& group, const Takes& takes, Span<const uint32_t> columns, bool whole,
             Arena& arena, JointGroup& out) {
  uint32_t rows = 0;
  for (uint32_t r = 0; r < group.output_indices.count; ++r) rows += takes(group.output_indices[r]);
  NewArray<uint16_t> inputs, outputs, lods;
  NewArray<float> values;
  if (!make(arena, columns.count, inputs) || !make(arena, rows, outputs) ||
      !make(arena, group.lods.count, lods) || !make(arena, size_t{rows} * columns.count, values)) {
    return false;
  }
  for (uint32_t c = 0; c < columns.count; ++c) inputs.set(c, group.input_indices[columns[c]]);
  for (uint32_t l = 0; l < lods.count; ++l) lods.set(l, 0);
  uint32_t kept = 0;
  for (uint32_t r = 0; r < group.output_indices.count; ++r) {
    if (!takes(group.output_indices[r])) continue;
    outputs.set(kept, group.output_indices[r]);
    for (uint32_t c = 0; c < columns.count; ++c) {
      values.set(kept * columns.count + c,
                 group.values[size_t{r} * group.input_indices.count + columns[c]]);
    }
    ++kept;
    for (uint32_t l = 0; l < lods.count; ++l) {
      if (group.lods[l] > r) lods.set(l, static_cast<uint16_t>(whole ? rows : kept));
    }
  }
  out = {lods, inputs, outputs, values, {}};
  return true;
}

struct Scratch {
  Span<uint32_t> first_rows, old_order, new_order, columns;
  Span<uint8_t> used;  // by column
};

/// Whether the columns of a group that still rotate joints do so in the order that they had. `old_count` columns are
/// in old_order then.
bool keeps_order(const dna::DnaView& before, const JointGroup& old_group, const dna::DnaView& after,
                 const JointGroup& new_group, Scratch& s, uint32_t& old_count) {
  old_count = dna::order_quaternion_columns(before, old_group, s.first_rows, s.old_order, nullptr);
  const uint32_t count =
      dna::order_quaternion_columns(after, new_group, s.first_rows, s.new_order, nullptr);
  std::fill(s.used.begin(), s.used.end(), uint8_t{0});
  for (uint32_t k = 0; k < count; ++k) s.used[s.new_order[k]] = 1;
  uint32_t next = 0;
  for (uint32_t k = 0; k < old_count; ++k) {
    if (!s.used[s.old_order[k]]) continue;
    if (s.new_order[next++] != s.old_order[k]) return false;
  }
  return true;
}

}  // namespace

bool keep_turn_order(const dna::DnaView& before, dna::DnaView& after, Arena& arena) {
  if (after.jbmd.joints.count == 0) return true;
  const dna::List<JointGroup> old_groups = before.bhvr.joints.groups;
  dna::List<JointGroup>& groups = after.bhvr.joints.groups;
  uint32_t widest = 0;
  size_t most = groups.count;
  for (const JointGroup& group : groups) {
    widest = std::max(widest, group.input_indices.count);
    most += group.output_indices.count;
  }
  Scratch s;
  Span<JointGroup> all;
  if (!make(arena, widest, s.first_rows) || !make(arena, widest, s.old_order) ||
      !make(arena, widest, s.new_order) || !make(arena, widest, s.columns) ||
      !make(arena, widest, s.used) || !make(arena, most, all)) {
    return false;
  }
  uint32_t count = groups.count;
  for (uint32_t g = 0; g < groups.count; ++g) {
    JointGroup& group = all[g] = groups[g];
    uint32_t old_count = 0;
    if (keeps_order(before, old_groups[g], after, groups[g], s, old_count)) continue;
    const JointGroup& whole = groups[g];
    // Each joint at its first row.
    for (uint32_t r = 0; r < whole.output_indices.count; ++r) {
      const uint32_t output = whole.output_indices[r], joint = output / 9;
      if (!dna::is_quaternion_row(after, output)) continue;
      bool first = true;
      for (uint32_t q = 0; q < r; ++q) {
        first &= whole.output_indices[q] / 9 != joint ||
                 !dna::is_quaternion_row(after, whole.output_indices[q]);
      }
      if (!first) continue;
      const auto of_joint = [&](uint32_t other) {
        return other / 9 == joint && dna::is_rotation(other);
      };
      uint32_t columns = 0;
      for (uint32_t k = 0; k < old_count; ++k) {
        bool turns = false;
        for (uint32_t q = r; q < whole.output_indices.count; ++q) {
          turns |= of_joint(whole.output_indices[q]) &&
                   whole.values[size_t{q} * whole.input_indices.count + s.old_order[k]] != 0;
        }
        if (turns) s.columns[columns++] = s.old_order[k];
      }
      JointGroup& own = all[count++];
      NewArray<uint16_t> members;
      if (!rows_of(whole, of_joint, s.columns.first(columns), true, arena, own) ||
          !make(arena, 1, members))
        return false;
      members.set(0, static_cast<uint16_t>(joint));
      own.joint_indices = members;
    }
    for (uint32_t c = 0; c < whole.input_indices.count; ++c) s.columns[c] = c;
    const auto others = [&](uint32_t output) { return !dna::is_quaternion_row(after, output); };
    JointGroup rest;
    if (!rows_of(whole, others, s.columns.first(whole.input_indices.count), false, arena, rest))
      return false;
    rest.joint_indices = whole.joint_indices;
    group = rest;
  }
  groups = {all.data, count};
  return true;
}

}  // namespace mien::author
