// SPDX-License-Identifier: MIT
// Whether the tables of a rig that came from outside keep evaluation within its arrays. Arrays that
// compilation lays out one after another must lie so here, too: then nothing is counted twice, and work and
// memory are bounded by the size of the file.
#include <algorithm>
#include <cstring>

#include "runtime/baked/baked_objects.h"
#include "runtime/baked/part_check.h"
#include "runtime/rig/work.h"
#include "simd/joint_kernels.h"
#include "simd/rbf_kernels.h"
#include "simd/rotation_kernels.h"

namespace mien {
namespace {

struct RigChecker : Checker {
  const Rig& rig;
};

bool is_order(const uint8_t axes[3]) {
  return axes[0] < 3 && axes[1] < 3 && axes[2] < 3 && axes[0] != axes[1] && axes[1] != axes[2] &&
         axes[0] != axes[2];
}

bool is_range(const ControlRange& range, uint32_t control_count) {
  return range.first <= range.end && range.end <= control_count;
}

/// Enumerations of the C interface.
bool are_known(const Units& units) {
  bool known = units.translation <= 1 && units.rotation <= 1;
  for (const uint32_t axis : units.axes) known &= axis <= 5;
  for (const int32_t sign : units.rotation_signs) known &= sign == 1 || sign == -1;
  return known;
}

bool check_counts(const RigChecker& c) {
  const Rig& rig = c.rig;
  const uint64_t parts =
      uint64_t{rig.raw_count} + rig.psd_count + rig.ml_count + uint64_t{rig.rbf_count};
  return c.ok(rig.lod_count <= kMaxLods, "LODs") &&
         c.ok(parts <= rig.control_count && rig.control_count <= 0x10000 &&
                  rig.initial_controls.count == rig.control_count &&
                  rig.control_uses.count == rig.control_count,
              "controls") &&
         c.ok(is_range(rig.ml_writes, rig.control_count) &&
                  is_range(rig.rbf_writes, rig.control_count),
              "controls that stages write") &&
         c.ok(rig.joint_attributes == kFileAttributes + rig.quaternion_outputs &&
                  rig.joint_count <= 0x10000 &&
                  rig.neutral_joints.count == rig.joint_value_count() &&
                  rig.joint_parents.count == rig.joint_count &&
                  below(rig.joint_parents, rig.joint_count),
              "joints") &&
         c.ok(rig.units.rotation_sequence <= 5 && is_order(rig.rotation.axes) &&
                  is_order(rig.ml.rotation.axes),
              "rotation order") &&
         c.ok(are_known(rig.units), "units and axes");
}

// Names -------------------------------------------------------------------------------------------

bool is_sorted(const NameList& names) {
  for (size_t i = 1; i < names.sorted.count; ++i) {
    const uint32_t x = names.sorted[i - 1], y = names.sorted[i];
    const Span<char> a = names[x], b = names[y];
    const size_t common = std::min(a.count, b.count);
    const int order = common ? memcmp(a.data, b.data, common) : 0;
    if (order > 0) return false;
    if (order == 0 && (a.count != b.count ? a.count > b.count : x >= y)) return false;
  }
  return true;
}

bool check_names(const RigChecker& c, bool full) {
  const Rig& rig = c.rig;
  const uint32_t counts[kKindsWithNames] = {
      rig.gui_count,   rig.raw_count,     rig.psd_count, rig.ml_count,   rig.rbf_count,
      rig.joint_count, rig.channel_count, rig.map_count, rig.mesh_count, rig.mask_count};
  for (size_t k = 0; k < kKindsWithNames; ++k) {
    const NameList& names = rig.names[k];
    // Controls of networks may be there though their layer, with the names, is not.
    const bool may_lack = k == size_t(Kind::kMlControl) && names.count() == 0;
    if (!c.ok((names.count() == counts[k] || may_lack) &&
                  is_runs(names.first, names.count(), names.chars.count) &&
                  names.first.count == names.count() + size_t{1} &&
                  names.sorted.count == names.count() && below(names.sorted, names.count()) &&
                  (!full || is_sorted(names)),
              "names")) {
      return false;
    }
  }
  return true;
}

bool check_lists(const RigChecker& c, const LodLists& lists, uint32_t limit, const char* what) {
  if (lists.first.empty()) return c.ok(false, what);
  const size_t rows = lists.first.count - 1;
  return c.ok(lists.row_of_lod.count <= c.rig.lod_count && below(lists.row_of_lod, rows) &&
                  is_runs(lists.first, rows, lists.indices.count) && below(lists.indices, limit),
              what);
}

// Controls ----------------------------------------------------------------------------------------

bool check_table(const RigChecker& c, const ControlTable& table, uint32_t inputs, uint32_t outputs,
                 const char* what) {
  const size_t rows = table.inputs.count;
  bool advances = table.run_ends.count == rows;
  for (size_t r = 0; advances && r < rows; ++r) {
    advances = table.run_ends[r] > r && table.run_ends[r] <= rows;
  }
  return c.ok(advances && table.outputs.count == rows && table.from.count == rows &&
                  table.to.count == rows && table.slope.count == rows && table.cut.count == rows &&
                  below(table.inputs, inputs) && below(table.outputs, outputs),
              what);
}

bool check_leading(const RigChecker& c, const Span<uint32_t>& at_lod, size_t most,
                   const char* what) {
  return c.ok(at_lod.count == c.rig.lod_count && below(at_lod, uint64_t{most} + 1), what);
}

bool check_controls(const RigChecker& c) {
  const Rig& rig = c.rig;
  const ReverseTable& reverse = rig.raw_to_gui;
  const ChannelTable& channels = rig.channels;
  if (!check_table(c, rig.gui_to_raw, rig.gui_count, rig.raw_count, "GUI to raw controls") ||
      !c.ok(below(rig.driven_raw, rig.raw_count), "driven raw controls") ||
      !check_table(c, rig.maps, rig.control_count, rig.map_count, "animated maps") ||
      !check_leading(c, rig.map_rows_at_lod, rig.maps.inputs.count, "animated maps")) {
    return false;
  }
  const size_t groups = reverse.first_row.empty() ? 0 : reverse.first_row.count - 1;
  return c.ok(!reverse.first_row.empty() &&
                  reverse.first_group.count == size_t{rig.gui_count} + 1 &&
                  is_runs(reverse.first_group, rig.gui_count, groups) &&
                  is_runs(reverse.first_row, reverse.first_group[rig.gui_count],
                          reverse.rows.count) &&
                  below(reverse.rows, rig.gui_to_raw.inputs.count),
              "raw to GUI controls") &&
         c.ok(channels.inputs.count == channels.outputs.count &&
                  below(channels.inputs, rig.control_count) &&
                  below(channels.outputs, rig.channel_count),
              "blend shape channels") &&
         check_leading(c, channels.count_at_lod, channels.inputs.count, "blend shape channels");
}

/// Runs have the stated lengths, and each corrective is where it is looked up, after everything that it
/// reads.
bool is_ordered(const Rig& rig) {
  const PsdTable& psds = rig.psds;
  const uint32_t count = rig.psd_count, first_psd = rig.raw_count;
  bool ordered = true;
  uint32_t run = 0, run_end = 0, run_inputs = 0;
  for (uint32_t e = 0; e < count; ++e) {
    const uint32_t inputs = psds.first_input[e + 1] - psds.first_input[e];
    if (e == run_end) {
      run = e;
      run_inputs = inputs;
      run_end = e + psds.run_lengths[e];
    }
    ordered &= e + psds.run_lengths[e] == run_end && inputs == run_inputs;
    ordered &= psds.entry_of_psd[psds.outputs[e] - first_psd] == e;
    for (uint32_t k = psds.first_input[e]; k < psds.first_input[e + 1]; ++k) {
      const uint32_t psd = psds.inputs[k] - first_psd;
      ordered &= psd >= count || psds.entry_of_psd[psd] < run;
    }
  }
  return ordered;
}

bool check_psds(const RigChecker& c, bool full) {
  const Rig& rig = c.rig;
  const PsdTable& psds = rig.psds;
  const uint32_t count = rig.psd_count;
  if (!c.ok(psds.outputs.count == count && psds.weights.count == count &&
                psds.entry_of_psd.count == count && psds.run_lengths.count == count &&
                psds.first_input.count == size_t{count} + 1 &&
                is_runs(psds.first_input, count, psds.inputs.count) &&
                below(psds.inputs, rig.control_count) && below(psds.entry_of_psd, count) &&
                (count == 0 ||
                 extent_of(psds.outputs, static_cast<uint16_t>(rig.raw_count)).max < count),
            "correctives") ||
      !check_leading(c, psds.count_at_lod, count, "correctives")) {
    return false;
  }
  // All entries of a run have as many inputs as the first.
  bool good = true;
  for (uint32_t e = 0; e < count; ++e) {
    const uint32_t first = psds.first_input[e], inputs = psds.first_input[e + 1] - first;
    const uint32_t length = psds.run_lengths[e];
    good &= length - 1 < count - e && first + uint64_t{inputs} * length <= psds.inputs.count;
  }
  return c.ok(good, "runs of correctives") &&
         c.ok(!full || is_ordered(rig), "order of correctives");
}

// Joint matrix ------------------------------------------------------------------------------------

bool check_panels(const RigChecker& c) {
  const Rig& rig = c.rig;
  const JointMatrix& joints = rig.joints;
  const Span<JointPanel>& panels = joints.panels;
  bool good = panels[0].first_block_row == 0 && panels[0].first_target == 0;
  for (size_t i = 0; i + 1 < panels.count; ++i) {
    const uint32_t block_rows = panels[i + 1].first_block_row - panels[i].first_block_row;
    good &= panels[i].first_block_row < panels[i + 1].first_block_row &&
            block_rows <= kMaxPanelBlockRows;
    good &= block_rows % 2 == 0;
    good &= panels[i].first_target <= panels[i + 1].first_target;
  }
  const uint32_t count = joints.panel_count();
  return c.ok(good && panels[count].first_block_row <= kMaxBlockRows &&
                  panels[count].first_target <= joints.targets.count,
              "panels of the joint matrix") &&
         c.ok(joints.panel_shift < 32 && count <= uint64_t{kPanelBits} << joints.panel_shift,
              "marks of the joint matrix") &&
         check_leading(c, joints.panels_at_lod, count, "LODs of the joint matrix");
}

/// The targets of all panels at once that a LOD writes belong to panels that it sums: the sums of other
/// panels are stale.
bool are_summed(const JointMatrix& joints, const JointTarget* targets, uint32_t rows,
                const Span<uint16_t>& at_lod) {
  bool good = true;
  uint32_t t = 0, end = 0;
  for (size_t l = at_lod.count; l-- > 0;) {  // each LOD has those of the next one, and more
    for (; t < at_lod[l]; ++t) end = std::max(end, targets[t].packed_row + rows);
    good &= end <= joints.panels[joints.panels_at_lod[l]].first_block_row * kJointBlockRows;
  }
  return good;
}

bool check_targets(const RigChecker& c) {
  const Rig& rig = c.rig;
  const JointMatrix& joints = rig.joints;
  const uint32_t lods = rig.lod_count;
  if (!c.ok(joints.targets_at_lod.count == joints.panels.count * kTargetKinds * lods,
            "targets of the joint matrix")) {
    return false;
  }
  const uint32_t outputs =
      rig.joint_value_count() + (rig.quaternion_outputs ? rig.joint_count * 3 : 0);
  bool good = true;
  const JointPanel all_from = {0, joints.panels[joints.panel_count()].first_target};
  const JointPanel all_to = {joints.panels[joints.panel_count()].first_block_row,
                             static_cast<uint32_t>(joints.targets.count)};
  for (uint32_t panel = 0; good && lods != 0 && panel <= joints.panel_count(); ++panel) {
    const bool all = panel == joints.panel_count();
    const JointPanel& at = all ? all_from : joints.panels[panel];
    const JointPanel& next = all ? all_to : joints.panels[panel + 1];
    const uint32_t packed_rows = (next.first_block_row - at.first_block_row) * kJointBlockRows;
    uint32_t target = at.first_target;
    for (uint32_t kind = 0; good && kind < kTargetKinds; ++kind) {
      const Span<uint16_t> at_lod =
          joints.targets_at_lod.slice((size_t{panel} * kTargetKinds + kind) * lods, lods);
      const uint32_t rows = kTargetRows[kind], count = at_lod[0];
      good = below(at_lod, count + uint64_t{1}) && count <= next.first_target - target;
      Extent<uint32_t> packed_row, output, group;
      for (uint32_t end = good ? target + count : target; target < end; ++target) {
        const JointTarget& t = joints.targets[target];
        packed_row.add(t.packed_row);
        output.add(t.output);
        group.add(t.group);
      }
      good =
          good && (count == 0 || (packed_row.max + rows <= packed_rows &&
                                  output.max + rows <= outputs && group.max < joints.group_count));
      good =
          good && (!all || are_summed(joints, joints.targets.data + target - count, rows, at_lod));
    }
  }
  return c.ok(good, "targets of the joint matrix");
}

/// How many parts have more pairs or singles than the part after them.
size_t count_falls(const Span<ColumnPart>& parts) {
  constexpr size_t kStrip = 0x4000;  // the most that 16-bit sums can count
  size_t falls = 0;
  for (size_t first = 0; first + 1 < parts.count; first += kStrip) {
    const size_t count = std::min(parts.count - first - 1, kStrip);
    const ColumnPart* at = parts.data + first;
    uint16_t pairs = 0, singles = 0;
    for (size_t i = 0; i < count; ++i) {
      pairs += static_cast<uint16_t>(at[i].pairs > at[i + 1].pairs);
      singles += static_cast<uint16_t>(at[i].singles > at[i + 1].singles);
    }
    falls += size_t{pairs} + singles;
  }
  return falls;
}

/// The blocks of columns in a tile add to block rows of the tile. (A pair adds to the even block row it is
/// in and the next one: tiles end with an odd one.)
bool check_tiles(const JointMatrix& joints) {
  const auto fit = [](const Span<uint16_t>& block_rows, uint32_t first, uint32_t end) {
    const Extent<uint16_t> extent =
        extent_of(block_rows, static_cast<uint16_t>(first * kBlockRowUnit));
    return block_rows.empty() ||
           (extent.max < (end - first) * kBlockRowUnit && extent.bits % kBlockRowUnit == 0);
  };
  bool good = true;
  for (uint32_t panel = 0, end; good && panel < joints.panel_count(); panel = end) {
    end = joints.tile_end(panel);
    const uint32_t first_block_row = joints.panels[panel].first_block_row;
    const uint32_t end_block_row = joints.panels[end].first_block_row;
    if (panel == 0 && end == joints.panel_count()) return fit(joints.block_rows, 0, end_block_row);
    for (size_t k = 0; k < joints.columns.count; ++k) {
      const ColumnPart from = joints.part(k, panel), to = joints.part(k, end);
      const size_t pairs = joints.starts[k].pair_entry, singles = joints.starts[k].single_entry;
      for (const auto& [first, last] : {std::pair(pairs + from.pairs, pairs + to.pairs),
                                        std::pair(singles + from.singles, singles + to.singles)}) {
        good &= fit(joints.block_rows.slice(first, last - first), first_block_row, end_block_row);
      }
    }
  }
  return good;
}

bool check_strips(const RigChecker& c) {
  const JointMatrix& joints = c.rig.joints;
  const Span<RowStrip>& strips = joints.strips;
  const size_t values = joints.strip_values.count + joints.strip_fixed_values.count;
  if (strips.empty()) {
    return c.ok(joints.strip_inputs.empty() && values == 0, "strips of the joint matrix");
  }
  const size_t count = strips.count - 1;
  const uint32_t block_rows = joints.panels[joints.panel_count()].first_block_row;
  bool good = strips[0].first_block_row == 0 && strips[0].first_block == 0 &&
              strips[0].first_input == 0 && strips[count].first_block_row == block_rows &&
              strips[count].first_input == joints.strip_inputs.count &&
              uint64_t{strips[count].first_block} * kJointBlockRows == values;
  for (size_t s = 0; s < count; ++s) {
    const uint64_t rows = uint64_t{strips[s + 1].first_block_row} - strips[s].first_block_row;
    const uint64_t inputs = uint64_t{strips[s + 1].first_input} - strips[s].first_input;
    good &= rows - 1 < kMaxStripBlockRows && strips[s].first_block % 2 == 0 &&
            inputs <= joints.strip_inputs.count &&
            uint64_t{strips[s + 1].first_block} - strips[s].first_block - rows * inputs <= 1;
  }
  const bool stored = c.rig.half_storage ? joints.strip_values.empty() && joints.values.empty()
                                         : joints.strip_fixed_values.empty();
  return c.ok(good && stored && joints.fits_tile() &&
                  joints.first_strip_column < joints.columns.count &&
                  below(joints.strip_inputs, c.rig.control_count),
              "strips of the joint matrix");
}

bool check_blocks(const RigChecker& c, size_t blocks) {
  const JointMatrix& joints = c.rig.joints;
  const size_t entries = joints.block_rows.count, columns = joints.columns.count;
  const size_t ends = joints.panels.count;
  if (!c.ok(joints.starts.count == columns + 1 && joints.starts[0].first_pair == 0 &&
                joints.starts[0].pair_entry == 0 && joints.starts[columns].first_pair == blocks &&
                joints.starts[columns].pair_entry == entries &&
                joints.parts.count == columns * ends && below(joints.columns, c.rig.control_count),
            "columns of the joint matrix")) {
    return false;
  }
  // Each column belongs to its control, and each other control to none. Parts rise from none to all
  // of the column: so they fall between columns, and nowhere else.
  bool good = joints.column_of_control.count == c.rig.control_count;
  for (size_t k = 1; k < columns; ++k) good &= joints.columns[k - 1] < joints.columns[k];
  for (size_t i = 0, k = 0; good && i < joints.column_of_control.count; ++i) {
    const bool has_column = k < columns && joints.columns[k] == i;
    good = joints.column_of_control[i] == (has_column ? k++ : kNoColumn);
  }
  size_t falls = 0;
  for (size_t k = 0; k < columns; ++k) {
    const ColumnPart* parts = joints.parts.data + k * ends;
    const uint32_t pairs = parts[ends - 1].pairs, singles = parts[ends - 1].singles;
    const JointColumn &start = joints.starts[k], &next = joints.starts[k + 1];
    good &= pairs + singles != 0 && (parts[0].pairs | parts[0].singles) == 0;
    good &= start.single_entry == uint64_t{start.pair_entry} + pairs &&
            next.pair_entry == uint64_t{start.single_entry} + singles;
    good &= start.first_pair % 2 == 0 &&
            start.first_single == uint64_t{start.first_pair} + 2 * pairs &&
            next.first_pair == uint64_t{start.first_single} + (singles + 1) / 2 * 2;
    if (k + 1 < columns) falls += size_t{pairs != 0} + (singles != 0);
  }
  return c.ok(good && count_falls(joints.parts) == falls && check_tiles(joints),
              "blocks of the joint matrix");
}

bool check_joints(const RigChecker& c) {
  const Rig& rig = c.rig;
  const JointMatrix& joints = rig.joints;
  if (!c.ok(joints.panels.count >= 1 && joints.panels.count <= kMaxBlockRows + size_t{1},
            "panels of the joint matrix") ||
      !check_panels(c)) {
    return false;
  }
  // An empty array of float values means 16-bit values with scales.
  const size_t values = joints.values.count + joints.fixed_values.count;
  const size_t sums = size_t{joints.panels[joints.panel_count()].first_block_row} * kJointBlockRows;
  const bool stored = rig.half_storage ? joints.values.empty() && joints.scales.count == sums
                                       : joints.fixed_values.empty() && joints.scales.empty() &&
                                             (values != 0 || sums == 0);
  return c.ok(stored && values % kJointBlockRows == 0, "values of the joint matrix") &&
         c.ok(joints.group_rows_at_lod.count == uint64_t{joints.group_count} * rig.lod_count,
              "joint groups") &&
         check_targets(c) && check_blocks(c, values / kJointBlockRows) && check_strips(c);
}

// Rotations ---------------------------------------------------------------------------------------

bool check_rotations(const RigChecker& c) {
  const Rig& rig = c.rig;
  const RotationTable& table = rig.rotations;
  const size_t values = rig.half_storage ? table.halves.count : table.values.count;
  bool good = table.groups.count == rig.joints.group_count &&
              table.blocks_at_lod.count == rig.lod_count && table.first_steps.count != 0 &&
              below(table.columns, rig.control_count) &&
              (rig.quaternion_outputs || table.angle_joints.empty());
  if (!c.ok(good, "rotations of joint groups")) return false;
  const uint64_t blocks = table.block_count(), steps = table.columns.count / kBlockLanes;
  const uint64_t lanes = blocks * kBlockLanes;
  good = blocks == padded(uint64_t{table.turns.count}) / kBlockLanes &&
         table.steps_at_lod.count == blocks * rig.lod_count &&
         table.lane_steps_at_lod.count == lanes * rig.lod_count &&
         values == steps * 4 * kBlockLanes && is_runs(table.first_steps, blocks, steps) &&
         below(table.blocks_at_lod, blocks + 1);
  if (!c.ok(good, "rotations of joint groups")) return false;
  for (uint64_t l = 0; l < rig.lod_count; ++l) {
    for (uint64_t b = 0; b < blocks; ++b) {
      good &= table.steps_at_lod[l * blocks + b] <= table.first_steps[b + 1] - table.first_steps[b];
    }
  }
  for (const AngleJoint& joint : table.angle_joints) good &= joint.joint < rig.joint_count;
  for (const RotationOutput& turn : table.turns) {
    good &= turn.joint < rig.joint_count && turn.lane < lanes;
  }
  uint64_t angles = 0, turns = 0;
  for (const GroupRotations& group : table.groups) {
    good &= group.first_angle_joint == angles && group.first_turn == turns;
    angles += group.angle_joint_count;
    turns += group.turn_count;
    good &= angles <= table.angle_joints.count && turns <= table.turns.count;
  }
  return c.ok(good, "rotations of joint groups");
}

bool check_twists(const RigChecker& c) {
  const Rig& rig = c.rig;
  const TwistSwingTable& table = rig.twist_swing;
  const uint64_t blocks = padded(uint64_t{table.outputs.count}) / kBlockLanes,
                 lanes = blocks * kBlockLanes;
  bool good = table.inputs.count == 4 * lanes && table.lanes.count == kTwistSwingRows * lanes &&
              table.blocks_at_lod.count == rig.lod_count &&
              below(table.inputs, rig.control_count) && below(table.blocks_at_lod, blocks + 1);
  for (const RotationOutput& output : table.outputs) {
    good &= output.joint < rig.joint_count && output.lane < lanes;
  }
  uint64_t at = 0;
  for (const TwistSwing& setup : table.setups) {
    good &= setup.first_output == at;
    at += setup.output_count;
    good &= at <= table.outputs.count;
  }
  return c.ok(good, "twists and swings");
}

// RBF solvers -------------------------------------------------------------------------------------

bool check_solvers(const RigChecker& c) {
  const Rig& rig = c.rig;
  const RbfTable& rbf = rig.rbf;
  uint64_t inputs = 0, rotations = 0, poses = 0, lanes = 0, targets = 0, inverses = 0;
  for (size_t i = 0; i < rbf.plans.count; ++i) {
    const RbfSolverPlan& plan = rbf.plans[i];
    const uint32_t width = plan.angle_inputs;
    const bool parts = width == 2 || width == 3;
    if (!c.ok((width == 0 || width == 4 || parts) && is_flag(plan.interpolative) &&
                  is_flag(plan.always_normalize) && plan.function <= 4 &&
                  (width == 0 || plan.input_count % width == 0) &&
                  plan.first_input == (parts ? rotations : inputs) &&
                  rbf.solvers[i].first_pose == poses && plan.first_lane == lanes &&
                  plan.first_target == targets && plan.first_inverse == inverses,
              "RBF solvers")) {
      return false;
    }
    (parts ? rotations : inputs) += parts ? plan.input_count / width : plan.input_count;
    poses += plan.pose_count;
    lanes += padded(uint64_t{plan.pose_count});
    if (!c.ok(inputs <= rbf.inputs.count && rotations <= rbf.swings.count &&
                  poses <= rbf.poses.count && lanes <= rbf.pose_scales.count &&
                  (plan.first_control == kNoFirstControl ||
                   fits(plan.first_control, plan.pose_count, rig.control_count)),
              "RBF solvers")) {
      return false;
    }
    targets += padded(uint64_t{plan.pose_count}) * std::max(plan.input_count, 1u);
    if (plan.interpolative) inverses += padded(uint64_t{plan.pose_count}) * plan.pose_count;
    if (!c.ok(targets <= rbf.targets.count && inverses <= rbf.inverses.count, "RBF solvers")) {
      return false;
    }
  }
  return true;
}

bool check_rbf(const RigChecker& c) {
  const Rig& rig = c.rig;
  const RbfTable& rbf = rig.rbf;
  if (!c.ok(rbf.solvers.count == rbf.plans.count && rbf.rotations.count % (4 * kBlockLanes) == 0 &&
                rbf.swings.count * 4 == rbf.rotations.count &&
                rbf.pose_factors.count == rbf.pose_scales.count &&
                below(rbf.inputs, rig.control_count) && below(rbf.rotations, rig.control_count),
            "RBF solvers") ||
      !c.ok(!rbf.first_input.empty() && rbf.first_input.count == rbf.first_output.count,
            "RBF poses")) {
    return false;
  }
  const size_t poses = rbf.first_input.count - 1;
  return c.ok(is_runs(rbf.first_input, poses, rbf.pose_inputs.count) &&
                  is_runs(rbf.first_output, poses, rbf.pose_outputs.count) &&
                  rbf.pose_weights.count == rbf.pose_outputs.count && below(rbf.poses, poses) &&
                  below(rbf.pose_inputs, rig.control_count) &&
                  below(rbf.pose_outputs, rig.control_count),
              "RBF poses") &&
         check_solvers(c) &&
         check_lists(c, rbf.lod_solvers, static_cast<uint32_t>(rbf.solvers.count),
                     "LODs of RBF solvers");
}

// Learned behavior --------------------------------------------------------------------------------

/// `widest` becomes the scratch size that the layers need in an instance.
bool check_layers(const RigChecker& c, uint64_t& widest) {
  const MlTable& ml = c.rig.ml;
  const size_t values = c.rig.half_storage ? ml.halves.count : ml.values.count;
  uint64_t value = 0, bias = 0;
  for (const NetworkLayer& layer : ml.layers) {
    const bool in_order = layer.first_value == value && layer.first_bias == bias;
    bias += padded(uint64_t{layer.output_count});
    if (!c.ok(in_order && bias <= ml.biases.count && layer.function <= 4 &&
                  padded(uint64_t{layer.output_count}) <= padded(uint64_t{ml.widest_layer}) &&
                  layer.input_count <= ml.widest_layer &&
                  (layer.output_count != 0 || layer.input_count == 0),
              "network layers")) {
      return false;
    }
    value += padded(uint64_t{layer.output_count}) * layer.input_count;
    if (!c.ok(value <= values, "network layers")) return false;
    widest = std::max({widest, padded(uint64_t{layer.output_count}), uint64_t{layer.input_count}});
  }
  return true;
}

/// The inputs of a step lie in the buffer or in the list of controls, and its outputs fit. `widest` grows
/// to the most values that a step takes.
bool check_step_inputs(const RigChecker& c, const MlStep& step, uint64_t& widest) {
  const MlTable& ml = c.rig.ml;
  bool good = fits(step.first_dependency, step.dependency_count, ml.dependencies.count) &&
              fits(step.first_gather, step.gather_count, ml.controls.count) &&
              // A sum reads controls where they are, a network from the buffer.
              (step.layer_count == 0 || step.gather_count <= ml.widest_layer);
  uint64_t taken = 0, most = step.gather_count;
  for (uint32_t d = 0; good && d < step.dependency_count; ++d) {
    const MlDependency& from = ml.dependencies[step.first_dependency + d];
    good = is_flag(from.gathers);
    if (!good) break;
    most += std::min(from.count, ml.buffer_size);
    if (step.layer_count == 0) {
      const size_t limit = from.gathers ? ml.controls.count : ml.buffer_size;
      good = fits(from.first, step.output_count, limit);
    } else if (step.gather_count == 0) {
      taken += from.count;
      good = fits(from.first, from.count, ml.buffer_size) && taken <= ml.widest_layer;
    }
  }
  widest = std::max(widest, most);
  return good;
}

bool check_steps(const RigChecker& c, uint64_t& widest) {
  const Rig& rig = c.rig;
  const MlTable& ml = rig.ml;
  uint64_t outputs = 0, gathered = 0, dependencies = 0;
  for (const MlStep& step : ml.steps) {
    const bool runs = step.layer_count != 0;
    bool good = fits(step.first_layer, step.layer_count, ml.layers.count) &&
                step.first_output == outputs && check_step_inputs(c, step, widest) &&
                (step.mask == kNoMask || step.mask < rig.mask_count);
    gathered += step.gather_count;
    dependencies += step.dependency_count;
    outputs += padded(uint64_t{step.output_count});
    good = good && outputs <= ml.buffer_size && dependencies <= ml.dependencies.count &&
           gathered <= ml.controls.count;
    if (good && runs) {
      good = ml.layers[step.first_layer + step.layer_count - 1].output_count == step.output_count &&
             fits(step.first_limit, rig.lod_count, ml.limits.count) &&
             fits(step.first_scatter, step.scatter_count, ml.controls.count);
    }
    if (!c.ok(good, "steps of learned behavior")) return false;
  }
  return c.ok(outputs == ml.buffer_size, "steps of learned behavior");
}

bool check_ml(const RigChecker& c) {
  const Rig& rig = c.rig;
  const MlTable& ml = rig.ml;
  const uint32_t parts = ml.quaternion_rotations ? 4 : 3;
  uint64_t widest = 0;
  bool joints = true;
  for (const MlJoint& joint : ml.joints) {
    joints &= joint.joint < rig.joint_count;
    for (int i = 0; i < 3; ++i) {
      for (const uint16_t control : {joint.translation[i], joint.scale[i]}) {
        joints &= control == kNoControl || control < rig.control_count;
      }
    }
    joints &=
        joint.rotation_control == kNoControl || joint.rotation_control + parts <= rig.control_count;
  }
  return c.ok(joints, "joints of learned behavior") &&
         c.ok(ml.buffer_size <= kMaxBufferFloats && below(ml.controls, rig.control_count) &&
                  (ml.steps.empty() || ml.default_is_one.count == rig.control_count),
              "controls of learned behavior") &&
         c.ok(!ml.converts || (is_order(ml.change.from) && is_order(ml.change.to)),
              "system of learned behavior") &&
         check_layers(c, widest) && check_steps(c, widest) &&
         // Every instance allocates this much, so it must not exceed what some step needs.
         c.ok(ml.widest_layer <= widest, "network layers");
}

/// Last, because counting the work of a frame follows indices.
bool check_work(const RigChecker& c, uint64_t bytes) {
  // Twice what compiling allows, because compiling measures a rig slightly larger than the bytes written.
  const uint64_t budget = 2 * work_budget(bytes);
  return c.ok(count_rbf_steps(c.rig, budget) <= budget, "work of RBF solvers") &&
         c.ok(count_ml_steps(c.rig, budget) <= budget, "work of learned behavior");
}

}  // namespace

Status check_rig(const Rig& rig, uint64_t bytes, bool full, Error& error) {
  const RigChecker c = {{error}, rig};
  const bool good =
      check_counts(c) && check_names(c, full) && check_controls(c) && check_psds(c, full) &&
      check_joints(c) && check_rotations(c) && check_twists(c) && check_rbf(c) && check_ml(c) &&
      check_lists(c, rig.lod_joints, rig.joint_count, "LODs of joints") &&
      check_lists(c, rig.lod_channels, rig.channel_count, "LODs of blend shape channels") &&
      check_lists(c, rig.lod_maps, rig.map_count, "LODs of animated maps") &&
      check_lists(c, rig.lod_meshes, rig.mesh_count, "LODs of meshes") &&
      check_lists(c, rig.variable_joint_values, rig.joint_value_count(), "variable joint values") &&
      check_work(c, bytes);
  return good ? Status::kOk : error.status;
}

}  // namespace mien
