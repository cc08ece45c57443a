// SPDX-License-Identifier: MIT
// Joint groups -> columns of blocks (docs/rig-evaluation.md, 4.3 "Rows, columns and LODs" and 4.4
// "Sums").
//
//     block rows of rows (plan_block_rows.cpp)  ->  panels  ->  blocks by column
#include <algorithm>
#include <cmath>

#include "runtime/base/bits.h"
#include "runtime/compile/joint_blocks.h"

namespace mien {
namespace {

// Panels ---------------------------------------------------------------------------------------

/// How many block rows a panel has at most. Small panels tell changes apart; their table has an
/// entry for each column, though, and shall stay small beside the blocks.
uint32_t panel_size(size_t block_row_count, size_t block_count, size_t column_count) {
  constexpr size_t kMarks = 48;  // of kPanelBits: LODs divide some panels once more
  const size_t affordable = column_count ? std::max<size_t>(block_count / column_count / 4, 1) : 1;
  const size_t count = std::min(kMarks, affordable);
  const size_t size = (block_row_count + count - 1) / count;
  return static_cast<uint32_t>(std::clamp<size_t>(size + size % 2, 2, kMaxPanelBlockRows));
}

/// Calls f(first block row) for each panel, and once more for the end.
template <class F>
void for_each_panel(const JointPlan& plan, F&& f) {
  const uint32_t block_row_count = plan.block_row_count();
  for (uint32_t b = 0, first = 0; b < block_row_count; ++b) {
    const bool begins = b == 0 || plan.block_row_reaches[b] != plan.block_row_reaches[b - 1] ||
                        b - first == plan.panel_size;
    if (!begins) continue;
    first = b;
    f(b);
  }
  f(block_row_count);
}

// Blocks ----------------------------------------------------------------------------------------

uint32_t words_of(const dna::JointGroup& group) {
  return (group.input_indices.count + kWordBits - 1) / kWordBits;
}

/// used[c]: not zero if some of the rows is not zero in column `first` + c. A count that the compiler
/// knows, so that it makes vector code.
template <uint32_t kCount>
void merge_columns(const FileRows& rows, uint32_t first, uint32_t* used) {
  uint32_t merged[kCount];
  for (uint32_t c = 0; c < kCount; ++c) {
    uint32_t bits = 0;
    for (uint32_t k = 0; k < kJointBlockRows; ++k) bits |= file_bits(rows.value(k, first + c));
    merged[c] = magnitude(bits);
  }
  memcpy(used, merged, sizeof(merged));
}

/// Bit c: some of the rows is not zero in column `first` + c, of `count` columns.
uint64_t columns_used(const FileRows& rows, uint32_t first, uint32_t count) {
  uint32_t used[kWordBits] = {};
  uint32_t c = 0;
  for (; c + kStrip <= count; c += kStrip) merge_columns<kStrip>(rows, first + c, used + c);
  for (; c + 4 <= count; c += 4) merge_columns<4>(rows, first + c, used + c);
  for (; c < count; ++c) merge_columns<1>(rows, first + c, used + c);
  uint8_t flags[kWordBits];
  for (c = 0; c < kWordBits; ++c) flags[c] = used[c] != 0;
  uint64_t bits = 0;
  for (c = 0; c < kWordBits; c += 8) {
    // The product brings byte i, which is 0 or 1, to bit 56 + i.
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < 8; ++i) bytes |= uint64_t{flags[c + i]} << 8 * i;
    bits |= (bytes * 0x0102040810204080u >> 56) << c;
  }
  return bits;
}

/// Which blocks are not all zeros: the one pass over the numbers that planning takes.
Status find_blocks(const dna::DnaView& view, Arena& scratch, JointPlan& plan, Error& error) {
  size_t words = 0;
  for (const PlannedRows& rows : plan.rows) words += words_of(view.bhvr.joints.groups[rows.group]);
  plan.blocks = scratch.array<uint64_t>(words);
  if (words && !plan.blocks.data) return no_scratch(error);
  uint64_t* word = plan.blocks.data;
  for (const PlannedRows& rows : plan.rows) {
    const dna::JointGroup& group = view.bhvr.joints.groups[rows.group];
    const FileRows file(group, rows);
    const uint32_t columns = group.input_indices.count;
    for (uint32_t c = 0; c < columns; c += kWordBits) {
      *word++ = columns_used(file, c, std::min(columns - c, kWordBits));
    }
  }
  return Status::kOk;
}

/// Calls f(column of the group, control) for the blocks of rows; `word` is the first of theirs.
/// Returns the first word of the next rows.
template <class F>
const uint64_t* for_each_block(const dna::Array<uint16_t>& inputs, const uint64_t* word, F&& f) {
  for (uint32_t from = 0; from < inputs.count; from += kWordBits) {
    for (uint64_t bits = *word++; bits != 0; bits &= bits - 1) {
      const uint32_t c = from + lowest_bit(bits);
      f(c, inputs[c]);
    }
  }
  return word;
}

/// Finds the blocks that make pairs, and counts both kinds.
Status pair_blocks(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                   Error& error) {
  size_t most = 0;
  for (uint64_t word : plan.blocks) most += bit_count(word);
  const uint32_t block_row_count = plan.block_row_count();
  const Span<uint8_t> halves_of_control = scratch.array<uint8_t>(rig.control_count);
  plan.halves = scratch.array<BlockHalves>(most);
  plan.first_halves = scratch.array<uint32_t>(block_row_count / 2 + 1);
  plan.places = scratch.array<uint32_t>(rig.control_count);
  if ((rig.control_count && (!halves_of_control.data || !plan.places.data)) ||
      (most && !plan.halves.data) || !plan.first_halves.data) {
    return no_scratch(error);
  }
  uint8_t* const halves_of = halves_of_control.data;
  BlockHalves* const found = plan.halves.data;
  uint32_t end = 0;
  const uint64_t* word = plan.blocks.data;
  for (uint32_t b = 0; b < block_row_count; b += 2) {
    for (uint32_t i = plan.first_rows[b]; i < plan.first_rows[b + 2]; ++i) {
      PlannedRows& rows = plan.rows[i];
      const uint32_t half = 1 + rows.block_row % 2;
      uint32_t again = 0;
      // Without branches: nobody foresees what is a pair.
      word = for_each_block(view.bhvr.joints.groups[rows.group].input_indices, word,
                            [&](uint32_t, uint32_t control) {
                              const uint32_t halves = halves_of[control];
                              found[end].control = static_cast<uint16_t>(control);
                              end += halves == 0;
                              again |= halves & half;
                              halves_of[control] = static_cast<uint8_t>(halves | half);
                            });
      rows.whole = rows.row_count == kJointBlockRows && again == 0;
    }
    for (uint32_t k = plan.first_halves[b / 2]; k < end; ++k) {
      uint8_t& halves = halves_of[found[k].control];
      found[k].halves = halves;
      ++plan.columns[found[k].control].entries[halves == kBothHalves];
      halves = 0;
    }
    plan.first_halves[b / 2 + 1] = end;
  }
  for (const PlannedColumn& column : plan.columns) {
    const uint32_t pairs = column.entries[1], singles = column.entries[0];
    plan.column_count += pairs + singles != 0;
    plan.entry_count += pairs + singles;
    plan.block_count += size_t{2} * (pairs + (singles + 1) / 2);
    plan.used_blocks += size_t{2} * pairs + singles;
  }
  return Status::kOk;
}

/// Calls f(packed row counted from first_block_row, output, group, reach) for the rows of block rows, in
/// order.
template <class F>
void for_each_packed_row(const dna::DnaView& view, const JointPlan& plan, const Rig& rig,
                         uint32_t first_block_row, uint32_t end_block_row, F&& f) {
  for (uint32_t i = plan.first_rows[first_block_row]; i < plan.first_rows[end_block_row]; ++i) {
    const PlannedRows& rows = plan.rows[i];
    const dna::JointGroup& group = view.bhvr.joints.groups[rows.group];
    const uint32_t first_packed_row =
        (rows.block_row - first_block_row) * kJointBlockRows + rows.first_in_block;
    for (uint32_t k = 0; k < rows.row_count; ++k) {
      const uint32_t output = output_of(view, rig, group.output_indices[rows.rows[k]]);
      f(first_packed_row + k, output, rows.group, rows.reaches[k]);
    }
  }
}

/// Calls f(target, kind, reach) for all targets of these block rows, in order of their packed rows.
template <class F>
void for_each_target(const dna::DnaView& view, const JointPlan& plan, const Rig& rig,
                     uint32_t first_block_row, uint32_t end_block_row, F&& f) {
  // The run that is growing: rows side by side whose sums go side by side.
  uint32_t packed_row = 0, output = 0, group = 0, count = 0;
  uint8_t reach = 0;
  const auto pass = [&] {
    for (uint32_t kind = 0; kind < kTargetKinds; ++kind) {
      for (; count >= kTargetRows[kind]; count -= kTargetRows[kind]) {
        const JointTarget target = {static_cast<uint16_t>(packed_row),
                                    static_cast<uint16_t>(output), static_cast<uint16_t>(group)};
        f(target, kind, reach);
        packed_row += kTargetRows[kind];
        output += kTargetRows[kind];
      }
    }
  };
  for_each_packed_row(
      view, plan, rig, first_block_row, end_block_row,
      [&](uint32_t next_row, uint32_t next_output, uint32_t next_group, uint8_t next) {
        const bool grows = next_row == packed_row + count && next_output == output + count &&
                           next_group == group && next == reach;
        if (!grows) {
          pass();
          packed_row = next_row;
          output = next_output;
          group = next_group;
          reach = next;
        }
        ++count;
      });
  pass();
}

/// Of a panel, or with the number behind the last one of all panels. Returns where they end.
uint32_t fill_targets(const dna::DnaView& view, const JointPlan& plan, uint32_t panel, Rig& rig) {
  JointMatrix& joints = rig.joints;
  // Where targets of each kind and reach begin, the farthest first.
  uint32_t begin[kTargetKinds][kMaxLods + 2] = {};
  const bool all = panel == joints.panel_count();
  const uint32_t first_block_row = all ? 0 : joints.panels[panel].first_block_row;
  const uint32_t end_block_row = joints.panels[all ? panel : panel + 1].first_block_row;
  for_each_target(view, plan, rig, first_block_row, end_block_row,
                  [&](const JointTarget&, uint32_t kind, uint8_t reach) {
                    ++begin[kind][rig.lod_count - reach + 1];
                  });
  uint32_t next = joints.panels[panel].first_target;
  uint16_t* at_lod = joints.targets_at_lod.data + size_t{panel} * kTargetKinds * rig.lod_count;
  for (auto& kind : begin) {
    for (uint32_t l = 0; l <= rig.lod_count; ++l) kind[l + 1] += kind[l];
    for (uint32_t l = 0; l < rig.lod_count; ++l) {
      *at_lod++ = static_cast<uint16_t>(kind[rig.lod_count - l]);
    }
    const uint32_t of_kind = kind[rig.lod_count];
    for (uint32_t l = 0; l <= rig.lod_count; ++l) kind[l] += next;
    next += of_kind;
  }
  for_each_target(view, plan, rig, first_block_row, end_block_row,
                  [&](const JointTarget& target, uint32_t kind, uint8_t reach) {
                    joints.targets[begin[kind][rig.lod_count - reach]++] = target;
                  });
  if (!all) return next;
  // By now each begin[] is where the targets of that reach end.
  JointTarget* from = joints.targets.data + joints.panels[panel].first_target;
  for (const auto& kind : begin) {
    for (uint32_t l = 0; l <= rig.lod_count; ++l) {
      JointTarget* to = joints.targets.data + kind[l];
      std::sort(from, to, [](const JointTarget& a, const JointTarget& b) {
        return a.output != b.output ? a.output < b.output : a.packed_row < b.packed_row;
      });
      from = to;
    }
  }
  return next;
}

/// The largest entry of a row becomes the largest 16-bit number.
void fill_scales(const dna::DnaView& view, const JointPlan& plan, JointMatrix& joints) {
  for (const PlannedRows& rows : plan.rows) {
    const dna::JointGroup& group = view.bhvr.joints.groups[rows.group];
    float* scales =
        joints.scales.data + size_t{rows.block_row} * kJointBlockRows + rows.first_in_block;
    for (uint32_t k = 0; k < rows.row_count; ++k) {
      const uint8_t* row = row_values(group, rows.rows[k]);
      float largest = 0.0f;
      for (uint32_t c = 0; c < group.input_indices.count; ++c) {
        const float size = std::fabs(load_big_endian<float>(row + size_t{c} * sizeof(float)));
        if (size <= 3.4e38f) largest = std::max(largest, size);
      }
      scales[k] = largest / 32767.0f;
    }
  }
}

/// Rows that are not in the matrix (they turn joints, or are overridden) mark what they read, too.
void mark_other_rows(const dna::DnaView& view, const JointPlan& plan, Span<uint8_t> reach) {
  size_t at = 0;
  for (const dna::JointGroup& group : view.bhvr.joints.groups) {
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      const uint8_t row_reach = plan.reaches[at];
      if (plan.uses[at++] != kUnused || is_zero(group, r)) continue;
      const uint8_t* values = row_values(group, r);
      for (uint32_t c = 0; c < group.input_indices.count; ++c) {
        if (magnitude_bits(values + size_t{c} * sizeof(float)) == 0) continue;
        uint8_t& control_reach = reach[group.input_indices[c]];
        control_reach = std::max(control_reach, row_reach);
      }
    }
  }
}

/// Where the columns begin; turns the counts of the plan into places.
void place_columns(JointPlan& plan, JointMatrix& joints) {
  uint32_t k = 0, block = 0, entry = 0;
  std::fill(joints.column_of_control.begin(), joints.column_of_control.end(), kNoColumn);
  for (uint32_t control = 0; control < plan.columns.count; ++control) {
    PlannedColumn& column = plan.columns[control];
    const uint32_t pairs = column.entries[1], singles = column.entries[0];
    if (pairs + singles == 0) continue;
    joints.columns[k] = static_cast<uint16_t>(control);
    joints.column_of_control[control] = k;
    joints.starts[k++] = {block, entry, block + 2 * pairs, entry + pairs};
    column.blocks[1] = block;
    column.blocks[0] = block + 2 * pairs;
    column.entries[1] = entry;
    column.entries[0] = entry + pairs;
    block += 2 * pairs + singles;
    entry += pairs + singles;
    if (singles % 2 != 0) {
      if (!joints.values.empty()) {
        float* end = joints.values.data + size_t{block} * kJointBlockRows;
        std::fill(end, end + kJointBlockRows, 0.0f);
      }
      ++block;
    }
  }
  joints.starts[k] = {block, entry, block, entry};
}

/// Beside values, a list by block rows takes 8 bytes for each block.
bool lists_by_row(const JointPlan& plan) {
  constexpr size_t kFewBlocks = 4;  // of a column
  return plan.block_row_count() <= kMaxTileBlockRows &&
         plan.block_count <= kFewBlocks * plan.column_count;
}

void place_variable_values(const dna::DnaView& view, Placer& placer, Rig& rig) {
  size_t total = 0;
  for (uint32_t l = 0; l < rig.lod_count; ++l) {
    size_t values = 0;
    // A row may stand for a whole quaternion.
    for (const dna::JointGroup& group : view.bhvr.joints.groups) {
      values += 4 * size_t{rows_at_lod(group.lods, l)};
    }
    for (const dna::Twist& t : view.twsw.twists) values += 4 * size_t{t.output_joint_indices.count};
    for (const dna::Swing& s : view.twsw.swings) values += 4 * size_t{s.output_joint_indices.count};
    values += 4 * size_t{view.mlbe.joints.output_indices.count};
    total += std::min<size_t>(values, rig.joint_value_count());
  }
  LodLists& lists = rig.variable_joint_values;
  lists.row_of_lod = placer.array<uint16_t>(rig.lod_count);
  lists.first = placer.array<uint32_t>(size_t{rig.lod_count} + 1);
  lists.indices = placer.array<uint16_t>(total);
}

}  // namespace

Status plan_joints(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                   Error& error) {
  plan.columns = scratch.array<PlannedColumn>(rig.control_count);
  if (rig.control_count && !plan.columns.data) return no_scratch(error);
  Status status = plan_block_rows(view, rig, scratch, plan, error);
  if (status == Status::kOk) status = find_blocks(view, scratch, plan, error);
  if (status == Status::kOk) status = pair_blocks(view, rig, scratch, plan, error);
  if (status != Status::kOk) return status;

  plan.panel_size = panel_size(plan.block_row_count(), plan.block_count, plan.column_count);
  uint32_t last = 0;
  for_each_panel(plan, [&](uint32_t block_row) {
    ++plan.panel_ends;
    for_each_target(view, plan, rig, last, block_row,
                    [&](const JointTarget&, uint32_t, uint8_t) { ++plan.target_count; });
    last = block_row;
  });
  if (plan.block_row_count() <= kMaxTileBlockRows) {
    for_each_target(view, plan, rig, 0, plan.block_row_count(),
                    [&](const JointTarget&, uint32_t, uint8_t) { ++plan.target_count; });
  }
  return Status::kOk;
}

void place_joints(const dna::DnaView& view, const JointPlan& plan, Placer& placer, Rig& rig) {
  JointMatrix& joints = rig.joints;
  const size_t values = plan.block_count * kJointBlockRows;
  if (rig.half_storage) {
    joints.fixed_values = placer.array<int16_t>(values, kBlockAlignment);
    joints.scales = placer.array<float>(plan.block_row_count() * kJointBlockRows, kBlockAlignment);
  } else {
    joints.values = placer.unwritten_array<float>(values, kBlockAlignment);
  }
  joints.block_rows = placer.array<uint16_t>(plan.entry_count);
  joints.columns = placer.array<uint16_t>(plan.column_count);
  joints.column_of_control = placer.array<uint32_t>(rig.control_count);
  joints.starts = placer.array<JointColumn>(plan.column_count + 1);
  if (lists_by_row(plan)) {
    joints.first_row_blocks = placer.array<uint32_t>(size_t{plan.block_row_count()} + 1);
    joints.row_blocks = placer.array<InputBlock>(plan.used_blocks);
  }
  joints.parts = placer.array<ColumnPart>(plan.column_count * plan.panel_ends);
  joints.panels = placer.array<JointPanel>(plan.panel_ends);
  joints.panels_at_lod = placer.array<uint32_t>(rig.lod_count);
  joints.targets = placer.array<JointTarget>(plan.target_count);
  joints.targets_at_lod = placer.array<uint16_t>(plan.panel_ends * kTargetKinds * rig.lod_count);

  const auto& groups = view.bhvr.joints.groups;
  joints.group_rows_at_lod = placer.array<uint16_t>(size_t{groups.count} * rig.lod_count);
  joints.group_count = groups.count;
  place_variable_values(view, placer, rig);
}

void fill_joints(const dna::DnaView& view, JointPlan& plan, Span<uint8_t> reach, Rig& rig) {
  JointMatrix& joints = rig.joints;
  const auto& groups = view.bhvr.joints.groups;
  for (uint32_t g = 0; g < groups.count; ++g) {
    for (uint32_t l = 0; l < rig.lod_count; ++l) {
      joints.group_rows_at_lod[size_t{g} * rig.lod_count + l] =
          static_cast<uint16_t>(rows_at_lod(groups[g].lods, l));
    }
  }
  mark_other_rows(view, plan, reach);

  for (uint8_t use : plan.uses) joints.contested |= use == kContested;
  uint32_t panel = 0;
  for_each_panel(plan,
                 [&](uint32_t block_row) { joints.panels[panel++].first_block_row = block_row; });
  const uint32_t panel_count = joints.panel_count();
  while (panel_count > uint64_t{kPanelBits} << joints.panel_shift) ++joints.panel_shift;
  for (uint32_t c = 0; c < panel_count; ++c) {
    joints.panels[c + 1].first_target = fill_targets(view, plan, c, rig);
    const uint8_t panel_reach = plan.block_row_reaches[joints.panels[c].first_block_row];
    for (uint32_t l = 0; l < panel_reach; ++l) joints.panels_at_lod[l] = c + 1;
  }
  if (joints.fits_tile()) fill_targets(view, plan, panel_count, rig);
  if (rig.half_storage) fill_scales(view, plan, joints);

  place_columns(plan, joints);
  fill_joint_blocks(view, plan, reach, rig);
  if (!joints.first_row_blocks.empty()) {
    list_blocks_by_row(joints, joints.first_row_blocks, joints.row_blocks);
  }
}

// Ascending, without repetition: values are marked for each LOD, then listed. The neutral pose, not
// filled yet, serves as the place for the marks.
void fill_variable_joint_values(const dna::DnaView& view, Rig& rig) {
  LodLists& lists = rig.variable_joint_values;
  const Span<float>& marks = rig.neutral_joints;
  const auto mark_rotation = [&](uint32_t joint) {
    const uint32_t first = joint * rig.joint_attributes + 3;
    for (uint32_t k = 0; k < rig.joint_attributes - 6; ++k) marks[first + k] = 1.0f;
  };
  for (uint32_t l = 0; l < rig.lod_count; ++l) {
    std::fill(marks.begin(), marks.end(), 0.0f);
    for (const dna::JointGroup& group : view.bhvr.joints.groups) {
      const uint32_t rows = rows_at_lod(group.lods, l);
      for (uint32_t r = 0; r < rows; ++r) {
        const uint32_t output = group.output_indices[r], joint = output / kFileAttributes;
        const bool whole = rig.quaternion_outputs || dna::is_quaternion_joint(view, joint);
        if (dna::is_rotation(output) && whole) {
          mark_rotation(joint);
        } else {
          marks[output_of(view, rig, output)] = 1.0f;
        }
      }
    }
    for (const RotationOutput& output : rig.twist_swing.outputs) {
      if (output.lods >> l & 1) mark_rotation(output.joint);
    }
    for (const MlJoint& joint : rig.ml.joints) {
      if (!(joint.lods >> l & 1)) continue;
      const uint32_t first = joint.joint * rig.joint_attributes;
      for (uint32_t a = 0; a < 3; ++a) {
        if (joint.translation[a] != kNoControl) marks[first + a] = 1.0f;
        if (joint.scale[a] != kNoControl) marks[first + rig.joint_attributes - 3 + a] = 1.0f;
      }
      if (joint.rotation_control != kNoControl) mark_rotation(joint.joint);
    }
    uint32_t at = lists.first[l];
    for (uint32_t v = 0; v < marks.count; ++v) {
      if (marks[v] != 0.0f) lists.indices[at++] = static_cast<uint16_t>(v);
    }
    lists.row_of_lod[l] = static_cast<uint16_t>(l);
    lists.first[l + 1] = at;
  }
}

}  // namespace mien
