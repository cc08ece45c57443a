// SPDX-License-Identifier: MIT
// Strips of block rows (RowStrip in simd/joint_kernels.h): a second copy, by rows, of columns that are
// usually in use.
#include <algorithm>

#include "runtime/load/compile/joint_blocks.h"

namespace mien {
namespace {

/// The first control that strips have, or that behind the last one. They are worth their memory where
/// columns have few blocks, as for the correctives of a body, and where nearly all are in use, as for
/// networks.
uint32_t first_strip_control(const dna::DnaView& view, const Rig& rig, const JointPlan& plan) {
  constexpr size_t kFewBlocks = 4;  // of a column
  if (plan.block_row_count() == 0 || plan.block_row_count() > kMaxTileBlockRows)
    return rig.control_count;
  if (plan.block_count <= kFewBlocks * plan.column_count) return 0;
  return rig.ml_count != 0 ? view.first_ml() : rig.control_count;
}

}  // namespace

Status plan_strips(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                   Error& error) {
  constexpr size_t kMaxBlocks = 16384;  // 512 KiB of floats, which a second-level cache holds
  plan.first_strip_control = first_strip_control(view, rig, plan);
  if (plan.first_strip_control == rig.control_count) return Status::kOk;
  const uint32_t block_row_count = plan.block_row_count();
  plan.strips = scratch.array<RowStrip>(block_row_count + 1);
  plan.strip_of_row = scratch.array<uint32_t>(block_row_count);
  // [control] the last strip that has it as an input, counted from 1.
  const Span<uint32_t> last_strip = scratch.array<uint32_t>(rig.control_count);
  if (!plan.strips.data || !plan.strip_of_row.data || !last_strip.data) return no_scratch(error);

  const auto reads = [](size_t block_rows, size_t inputs) { return (block_rows + 1) * inputs; };
  uint32_t count = 0;
  size_t rows = 0, inputs = 0;  // of the last strip
  size_t end_block = 0, end_input = 0;
  const auto begin_strip = [&](uint32_t block_row) {
    end_block += rows * inputs;
    end_block += end_block % 2;  // padded, for strips that begin with an even block
    end_input += inputs;
    rows = inputs = 0;
    plan.strips[count++] = {block_row, static_cast<uint32_t>(end_block),
                            static_cast<uint32_t>(end_input)};
  };
  for (uint32_t b = 0; b < block_row_count; ++b) {
    const auto for_each_input = [&](auto&& f) {
      const BlockHalves* const end = plan.halves.data + plan.first_halves[b / 2 + 1];
      for (const BlockHalves* at = plan.halves.data + plan.first_halves[b / 2]; at != end; ++at) {
        if (at->control < plan.first_strip_control) continue;
        if (at->is_pair || at->is_second == b % 2) f(last_strip[at->control]);
      }
    };
    size_t alone = 0, together = inputs;
    for_each_input([&](uint32_t last) { ++alone, together += last != count; });
    const bool joins = count != 0 && rows < kMaxStripBlockRows &&
                       reads(rows + 1, together) <= reads(rows, inputs) + reads(1, alone);
    if (!joins) begin_strip(b);
    inputs = joins ? together : alone;
    ++rows;
    for_each_input([&](uint32_t& last) { last = count; });
    plan.strip_of_row[b] = count - 1;
  }
  begin_strip(block_row_count);
  const bool used = end_block != 0 && end_block <= kMaxBlocks;
  plan.strips.count = used ? count : 0;
  return Status::kOk;
}

void place_strips(const Rig& rig, const JointPlan& plan, Placer& placer, JointMatrix& joints) {
  if (plan.strips.empty()) return;
  const RowStrip& end = plan.strips[plan.strips.count - 1];
  const size_t values = size_t{end.first_block} * kJointBlockRows;
  joints.strips = placer.array<RowStrip>(plan.strips.count);
  joints.strip_inputs = placer.array<uint16_t>(end.first_input);
  if (rig.half_storage) {
    joints.strip_fixed_values = placer.array<int16_t>(values, kBlockAlignment);
  } else {
    joints.strip_values = placer.array<float>(values, kBlockAlignment);
  }
}

void fill_strips(const JointPlan& plan, JointMatrix& joints) {
  if (plan.strips.empty()) return;
  const auto copy = [&](auto& from, auto& to, uint32_t block, size_t place) {
    const auto* const values = from.data + size_t{block} * kJointBlockRows;
    std::copy_n(values, kJointBlockRows, to.data + place * kJointBlockRows);
  };
  // From here on, plan.strips holds where the next input of each strip goes.
  std::copy(plan.strips.begin(), plan.strips.end(), joints.strips.begin());
  uint32_t& first = joints.first_strip_column;
  while (joints.columns[first] < plan.first_strip_control) ++first;
  for (size_t k = first; k < joints.columns.count; ++k) {
    const uint16_t control = joints.columns[k];
    joints.for_each_block(k, joints.panel_count(), [&](uint32_t block, uint32_t block_row) {
      const uint32_t s = plan.strip_of_row[block_row];
      const RowStrip &strip = joints.strips[s], &next = joints.strips[s + 1];
      uint32_t& end = plan.strips[s].first_input;
      if (end == strip.first_input || joints.strip_inputs[end - 1] != control) {
        joints.strip_inputs[end++] = control;
      }
      const size_t rows = next.first_block_row - strip.first_block_row;
      const size_t place = strip.first_block + (end - 1 - strip.first_input) * rows + block_row -
                           strip.first_block_row;
      if (joints.values.empty()) {
        copy(joints.fixed_values, joints.strip_fixed_values, block, place);
      } else {
        copy(joints.values, joints.strip_values, block, place);
      }
    });
  }
}

}  // namespace mien
