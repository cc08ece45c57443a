// SPDX-License-Identifier: MIT
// Joint groups -> columns of blocks (docs/rig-evaluation.md, 4.3 "Rows, columns and LODs" and 4.4
// "Sums").
//
//     block rows of rows (plan_block_rows.cpp)  ->  panels  ->  blocks by column
#include <algorithm>

#include "runtime/base/bits.h"
#include "runtime/load/compile/joint_blocks.h"
#include "simd/kernels.h"

namespace mien {
namespace {

// Panels ---------------------------------------------------------------------------------------

/// The largest number of block rows of a panel. Small panels track changes better, but their table has an
/// entry for each column, and must stay small compared with the blocks.
uint32_t panel_size(size_t block_row_count, size_t block_count, size_t column_count) {
  constexpr size_t kMarks = 48;  // of kPanelBits: LODs divide some panels again
  const size_t affordable = column_count ? std::max<size_t>(block_count / column_count / 4, 1) : 1;
  const size_t count = std::min(kMarks, affordable);
  const size_t size = (block_row_count + count - 1) / count;
  return static_cast<uint32_t>(std::clamp<size_t>(size + size % 2, 2, kMaxPanelBlockRows));
}

/// Calls f(first block row) for each panel, and for the end.
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

/// Which blocks are not all zeros.
Status find_blocks(Arena& scratch, JointPlan& plan, Error& error) {
  size_t words = 0;
  for (const PlannedRows& rows : plan.rows) words += plan.groups[rows.group].words_per_row;
  plan.blocks = scratch.unwritten_array<uint64_t>(words);
  if (words && !plan.blocks.data) return no_scratch(error);
  uint64_t* word = plan.blocks.data;
  for (const PlannedRows& rows : plan.rows) {
    const GroupColumns& group = plan.groups[rows.group];
    for (uint32_t w = 0; w < group.words_per_row; ++w) {
      uint64_t used = 0;
      for (uint32_t k = 0; k < rows.row_count; ++k) used |= group.row(rows.rows[k])[w];
      *word++ = used;
    }
  }
  return Status::kOk;
}

/// Calls f(control) for the blocks of rows; `word` is the first of theirs. Returns the first word of
/// the next rows.
template <class F>
const uint64_t* for_each_block(const Span<uint16_t> inputs, const uint64_t* word, F&& f) {
  const uint16_t* const end = inputs.end();
  for (const uint16_t* from = inputs.data; from < end; from += kWordBits) {
    for (uint64_t bits = *word++; bits != 0; bits &= bits - 1) f(from[lowest_bit(bits)]);
  }
  return word;
}

/// Finds the blocks that make pairs, and counts both kinds.
Status pair_blocks(const Rig& rig, Arena& scratch, JointPlan& plan, Error& error) {
  size_t most = 0;
  for (uint64_t word : plan.blocks) most += bit_count(word);
  const uint32_t block_row_count = plan.block_row_count();
  const Span<uint8_t> halves_of_control = scratch.array<uint8_t>(rig.control_count);
  plan.halves = scratch.unwritten_array<BlockHalves>(most + 1);  // the last may be unused

  plan.first_halves = scratch.array<uint32_t>(block_row_count / 2 + 1);
  plan.places = scratch.array<uint32_t>(rig.control_count);
  if ((rig.control_count && (!halves_of_control.data || !plan.places.data)) || !plan.halves.data ||
      !plan.first_halves.data) {
    return no_scratch(error);
  }
  uint8_t* const halves_of = halves_of_control.data;
  PlannedColumn* const columns = plan.columns.data;
  BlockHalves* next = plan.halves.data;
  const uint64_t* word = plan.blocks.data;
  for (uint32_t b = 0; b < block_row_count; b += 2) {
    BlockHalves* const first = next;
    for (uint32_t i = plan.first_rows[b]; i < plan.first_rows[b + 2]; ++i) {
      PlannedRows& rows = plan.rows[i];
      const uint8_t half = 1 << rows.block_row % 2;
      uint32_t before = 0;
      // Without branches, which would be mispredicted: pairs come at random.
      word = for_each_block(plan.groups[rows.group].inputs, word, [&](size_t control) {
        const uint8_t halves = halves_of[control];
        halves_of[control] = halves | half;
        next->control = static_cast<uint16_t>(control);
        next += halves == 0;
        before |= halves;
      });
      rows.whole = rows.row_count == kJointBlockRows && (before & half) == 0;
    }
    for (BlockHalves* found = first; found != next; ++found) {
      const size_t control = found->control;
      const uint8_t halves = halves_of[control];
      found->is_pair = halves == 3;
      found->is_second = halves == 2;
      ++columns[control].next[found->is_pair].entry;
      halves_of[control] = 0;
    }
    plan.first_halves[b / 2 + 1] = static_cast<uint32_t>(next - plan.halves.data);
  }
  for (const PlannedColumn& column : plan.columns) {
    const uint32_t pairs = column.next[1].entry, singles = column.next[0].entry;
    plan.column_count += pairs + singles != 0;
    plan.entry_count += pairs + singles;
    plan.block_count += size_t{2} * (pairs + (singles + 1) / 2);
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
  // The current run: neighboring rows whose sums go to neighboring values.
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

/// Lists the targets of each panel, and behind them those of all panels at once.
Status plan_targets(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                    Error& error) {
  const bool all = plan.block_row_count() <= kMaxTileBlockRows;
  size_t most = 0;
  for (const PlannedRows& rows : plan.rows) most += rows.row_count;
  plan.targets = scratch.unwritten_array<PlannedTarget>(all ? 2 * most : most);
  plan.first_targets = scratch.array<uint32_t>(plan.panel_ends + 1);
  if ((most && !plan.targets.data) || !plan.first_targets.data) return no_scratch(error);
  uint32_t panel = 0, first = 0, count = 0;
  const auto list = [&](uint32_t from, uint32_t to) {
    for_each_target(view, plan, rig, from, to,
                    [&](const JointTarget& target, uint32_t kind, uint8_t reach) {
                      plan.targets[count++] = {target, static_cast<uint8_t>(kind), reach};
                    });
  };
  for_each_panel(plan, [&](uint32_t block_row) {
    list(first, block_row);  // of the panel that ends here
    plan.first_targets[panel++] = count;
    first = block_row;
  });
  if (all) list(0, plan.block_row_count());
  plan.first_targets[panel] = count;
  plan.targets.count = count;
  return Status::kOk;
}

/// The targets of a panel; the number after the last panel means those of all panels. Returns their end.
uint32_t fill_targets(const JointPlan& plan, uint32_t panel, Rig& rig) {
  JointMatrix& joints = rig.joints;
  // Where targets of each kind and reach begin, the farthest first.
  uint32_t begin[kTargetKinds][kMaxLods + 2] = {};
  const uint32_t first = plan.first_targets[panel];
  const Span<PlannedTarget> targets =
      plan.targets.slice(first, plan.first_targets[panel + 1] - first);
  for (const PlannedTarget& t : targets) ++begin[t.kind][rig.lod_count - t.reach + 1];
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
  for (const PlannedTarget& t : targets) {
    joints.targets[begin[t.kind][rig.lod_count - t.reach]++] = t.target;
  }
  if (panel != joints.panel_count()) return next;
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
void fill_scales(const dna::DnaView& view, const JointPlan& plan, Rig& rig) {
  for (const PlannedRows& rows : plan.rows) {
    const dna::JointGroup& group = view.bhvr.joints.groups[rows.group];
    float* scales =
        rig.joints.scales.data + size_t{rows.block_row} * kJointBlockRows + rows.first_in_block;
    for (uint32_t k = 0; k < rows.row_count; ++k) {
      const uint8_t* row = row_values(group, rows.rows[k]);
      scales[k] = rig.kernels->largest_magnitude(row, group.input_indices.count) / 32767.0f;
    }
  }
}

/// How many LODs, counted from 0, read each control through a joint group. Rows that are not in the
/// matrix (they turn joints, or are overridden) count, too.
void mark_reach(const JointPlan& plan, Span<uint8_t> reach) {
  const uint8_t* rows = plan.reaches.data;
  for (const GroupColumns& group : plan.groups) {
    const uint32_t row_count = group.row_count;
    for (uint32_t w = 0; w < group.words_per_row; ++w) {
      uint64_t seen = 0;  // the first nonzero row has the largest reach
      for (uint32_t r = 0; r < row_count && rows[r] != 0; ++r) {
        const uint64_t used = group.row(r)[w];
        for (uint64_t bits = used & ~seen; bits != 0; bits &= bits - 1) {
          uint8_t& of_control = reach[group.inputs[w * kWordBits + lowest_bit(bits)]];
          of_control = std::max(of_control, rows[r]);
        }
        seen |= used;
      }
    }
    rows += row_count;
  }
}

/// Where the columns begin; turns the counts of the plan into places.
void place_columns(JointPlan& plan, JointMatrix& joints) {
  uint32_t k = 0, block = 0, entry = 0;
  std::fill(joints.column_of_control.begin(), joints.column_of_control.end(), kNoColumn);
  for (uint32_t control = 0; control < plan.columns.count; ++control) {
    PlannedColumn& column = plan.columns[control];
    const uint32_t pairs = column.next[1].entry, singles = column.next[0].entry;
    if (pairs + singles == 0) continue;
    joints.columns[k] = static_cast<uint16_t>(control);
    joints.column_of_control[control] = k;
    joints.starts[k++] = {block, entry, block + 2 * pairs, entry + pairs};
    column.next[1] = {entry, block};
    column.next[0] = {entry + pairs, block + 2 * pairs};
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
  Status status = find_nonzeros(view, rig, scratch, plan, error);
  if (status == Status::kOk) status = plan_block_rows(view, rig, scratch, plan, error);
  if (status == Status::kOk) status = find_blocks(scratch, plan, error);
  if (status == Status::kOk) status = pair_blocks(rig, scratch, plan, error);
  if (status == Status::kOk) status = plan_strips(view, rig, scratch, plan, error);
  if (status != Status::kOk) return status;

  plan.panel_size = panel_size(plan.block_row_count(), plan.block_count, plan.column_count);
  for_each_panel(plan, [&](uint32_t) { ++plan.panel_ends; });
  return plan_targets(view, rig, scratch, plan, error);
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
  place_strips(rig, plan, placer, joints);
  joints.parts = placer.array<ColumnPart>(plan.column_count * plan.panel_ends);
  joints.panels = placer.array<JointPanel>(plan.panel_ends);
  joints.panels_at_lod = placer.array<uint32_t>(rig.lod_count);
  joints.targets = placer.array<JointTarget>(plan.targets.count);
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
  mark_reach(plan, reach);

  for (uint8_t use : plan.uses) joints.contested |= use == kContested;
  uint32_t panel = 0;
  for_each_panel(plan,
                 [&](uint32_t block_row) { joints.panels[panel++].first_block_row = block_row; });
  const uint32_t panel_count = joints.panel_count();
  while (panel_count > uint64_t{kPanelBits} << joints.panel_shift) ++joints.panel_shift;
  for (uint32_t c = 0; c < panel_count; ++c) {
    joints.panels[c + 1].first_target = fill_targets(plan, c, rig);
    const uint8_t panel_reach = plan.block_row_reaches[joints.panels[c].first_block_row];
    for (uint32_t l = 0; l < panel_reach; ++l) joints.panels_at_lod[l] = c + 1;
  }
  if (joints.fits_tile()) fill_targets(plan, panel_count, rig);
  if (rig.half_storage) fill_scales(view, plan, rig);

  place_columns(plan, joints);
  fill_joint_blocks(view, plan, rig);
  fill_strips(plan, joints);
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
