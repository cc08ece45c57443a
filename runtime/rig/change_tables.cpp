// SPDX-License-Identifier: MIT
#include "runtime/rig/change_tables.h"

#include <algorithm>

#include "runtime/rig/rig.h"

namespace mien {
namespace {

uint32_t block_rows_before(const JointMatrix& joints, uint32_t panel_end) {
  return joints.panels[panel_end].first_block_row;
}

void place_readers(const Rig& rig, size_t entries, Placer& placer, ControlReaders& readers) {
  readers.first = placer.array<uint32_t>(size_t{rig.control_count} + 1);
  readers.entries = placer.array<uint32_t>(entries);
}

/// Calls for_each(f) twice: it calls f(control, entry) for all entries, in order.
template <class ForEach>
void fill_readers(ControlReaders& readers, ForEach&& for_each) {
  for_each([&](uint32_t control, uint32_t) { ++readers.first[control + 1]; });
  for (size_t c = 1; c < readers.first.count; ++c) readers.first[c] += readers.first[c - 1];
  // Filling moves each start to the next one; they are moved back afterwards.
  for_each(
      [&](uint32_t control, uint32_t entry) { readers.entries[readers.first[control]++] = entry; });
  for (size_t c = readers.first.count - 1; c > 0; --c) readers.first[c] = readers.first[c - 1];
  readers.first[0] = 0;
}

void place_tables(const Rig& rig, Placer& placer, ChangeTables& tables) {
  const JointMatrix& joints = rig.joints;
  place_readers(rig, rig.psds.inputs.count, placer, tables.psds);
  place_readers(rig, rig.channels.inputs.count, placer, tables.channels);
  tables.word_count = static_cast<uint32_t>(
      bit_words(joints.panels.empty() ? 0 : block_rows_before(joints, joints.panel_count())));
  tables.block_rows = placer.array<uint64_t>(joints.columns.count * tables.word_count);
  size_t rows = 0;
  for (uint32_t lod = 0; lod < rig.lod_count; ++lod) {
    rows += size_t{block_rows_before(joints, joints.panels_at_lod[lod])} * kJointBlockRows;
  }
  tables.first_row_output = placer.array<uint32_t>(size_t{rig.lod_count} + 1);
  tables.row_outputs = placer.array<uint16_t>(rows);
}

void fill_column_rows(const JointMatrix& joints, ChangeTables& tables) {
  for (size_t k = 0; k < joints.columns.count; ++k) {
    uint64_t* const words = tables.block_rows.data + k * tables.word_count;
    joints.for_each_block(k, joints.panel_count(), [&](uint32_t, uint32_t block_row) {
      words[block_row / 64] |= uint64_t{1} << block_row % 64;
    });
  }
}

/// Calls f(packed row, output) for the rows that a LOD writes, in the order of evaluation.
template <class F>
void for_each_written_row(const Rig& rig, uint32_t lod, F&& f) {
  const JointMatrix& joints = rig.joints;
  for (uint32_t c = 0; c < joints.panels_at_lod[lod]; ++c) {
    const size_t first_row = size_t{joints.panels[c].first_block_row} * kJointBlockRows;
    const JointTarget* target = joints.targets.data + joints.panels[c].first_target;
    for (uint32_t kind = 0; kind < kTargetKinds; ++kind) {
      const uint16_t* const at_lod =
          joints.targets_at_lod.data + (size_t{c} * kTargetKinds + kind) * rig.lod_count;
      for (uint32_t t = 0; t < at_lod[lod]; ++t) {
        for (uint32_t r = 0; r < kTargetRows[kind]; ++r) {
          f(first_row + target[t].packed_row + r, target[t].output + r);
        }
      }
      target += at_lod[0];
    }
  }
}

/// `last_row` is scratch memory: an element for each joint value and angle.
void fill_row_outputs(const Rig& rig, Span<uint32_t> last_row, ChangeTables& tables) {
  const auto none = static_cast<uint16_t>(last_row.count);
  uint32_t first = 0;
  for (uint32_t lod = 0; lod < rig.lod_count; ++lod) {
    tables.first_row_output[lod] = first;
    uint16_t* const outputs = tables.row_outputs.data + first;
    const uint32_t rows =
        block_rows_before(rig.joints, rig.joints.panels_at_lod[lod]) * kJointBlockRows;
    std::fill(outputs, outputs + rows, none);
    for_each_written_row(rig, lod, [&](size_t row, size_t output) {
      last_row[output] = static_cast<uint32_t>(row);
    });
    for_each_written_row(rig, lod, [&](size_t row, size_t output) {
      if (last_row[output] == row) outputs[row] = static_cast<uint16_t>(output);
    });
    first += rows;
  }
  tables.first_row_output[rig.lod_count] = first;
}

}  // namespace

const ChangeTables* create_change_tables(const Rig& rig, const Allocator& allocator) {
  Arena scratch(allocator);
  const size_t outputs = joints_and_angles_count(rig);
  const Span<uint32_t> last_row = scratch.array<uint32_t>(std::max(outputs, size_t{1}));
  const Span<uint8_t> channels = scratch.array<uint8_t>(size_t{rig.channel_count} + 1);
  if (last_row.empty() || channels.empty()) return nullptr;
  auto* const tables = create_object<ChangeTables>(
      allocator, [&](Placer& placer, ChangeTables& placed) { place_tables(rig, placer, placed); });
  if (!tables) return nullptr;

  fill_readers(tables->psds, [&](auto&& f) {
    for (uint32_t e = 0; e < rig.psds.outputs.count; ++e) {
      const uint32_t first = rig.psds.first_input[e], end = rig.psds.first_input[e + 1];
      for (uint32_t i = first; i < end; ++i) f(rig.psds.inputs[i], e);
    }
  });
  fill_readers(tables->channels, [&](auto&& f) {
    for (uint32_t i = 0; i < rig.channels.inputs.count; ++i) f(rig.channels.inputs[i], i);
  });
  tables->single_channels = true;
  for (const uint16_t channel : rig.channels.outputs) {
    tables->single_channels &= channels[channel] == 0;
    channels[channel] = 1;
  }
  fill_column_rows(rig.joints, *tables);
  fill_row_outputs(rig, last_row.first(outputs), *tables);
  return tables;
}

}  // namespace mien
