// SPDX-License-Identifier: MIT
#include "runtime/rig/change_tables.h"

#include <algorithm>
#include <cmath>

#include "runtime/rig/rig.h"

namespace mien {
namespace {

// Lists -------------------------------------------------------------------------------------------

template <class T>
void place_lists(size_t lists, size_t items, Placer& placer, Lists<T>& placed) {
  placed.first = placer.array<uint32_t>(lists + 1);
  placed.items = placer.array<T>(items);
}

/// Calls for_each(f) twice: it calls f(list, item) for all items, in order.
template <class T, class ForEach>
void fill_lists(Lists<T>& lists, ForEach&& for_each) {
  for_each([&](uint32_t list, T) { ++lists.first[list + 1]; });
  for (size_t i = 1; i < lists.first.count; ++i) lists.first[i] += lists.first[i - 1];
  // Filling moves each start to the next one; they are moved back afterwards.
  for_each([&](uint32_t list, T item) { lists.items[lists.first[list]++] = item; });
  for (size_t i = lists.first.count - 1; i > 0; --i) lists.first[i] = lists.first[i - 1];
  lists.first[0] = 0;
}

void place_control_lists(const Rig& rig, Placer& placer, ChangeTables& tables) {
  place_lists(rig.control_count, rig.psds.inputs.count, placer, tables.psds);
  place_lists(rig.control_count, rig.channels.inputs.count, placer, tables.channels);
  place_lists(rig.control_count, rig.maps.inputs.count, placer, tables.maps);
  place_lists(rig.map_count, rig.maps.inputs.count, placer, tables.map_rows);
}

void fill_control_lists(const Rig& rig, ChangeTables& tables) {
  fill_lists(tables.psds, [&](auto&& f) {
    for (uint32_t e = 0; e < rig.psds.outputs.count; ++e) {
      const uint32_t first = rig.psds.first_input[e], end = rig.psds.first_input[e + 1];
      for (uint32_t i = first; i < end; ++i) {
        const uint16_t* const inputs = rig.psds.inputs.data;
        const uint32_t other = i == first ? end - 1 : first;
        f(inputs[i], PsdReader{static_cast<uint16_t>(e), inputs[other]});
      }
    }
  });
  fill_lists(tables.channels, [&](auto&& f) {
    for (uint32_t i = 0; i < rig.channels.inputs.count; ++i) f(rig.channels.inputs[i], i);
  });
  fill_lists(tables.maps, [&](auto&& f) {
    for (size_t r = 0; r < rig.maps.inputs.count; ++r) f(rig.maps.inputs[r], rig.maps.outputs[r]);
  });
  fill_lists(tables.map_rows, [&](auto&& f) {
    for (uint32_t r = 0; r < rig.maps.outputs.count; ++r) f(rig.maps.outputs[r], r);
  });
}

// Runs of rows ------------------------------------------------------------------------------------

constexpr uint32_t kNoRun = ~uint32_t{0};

/// Scratch memory.
struct PackedRows {
  size_t count = 0;
  uint16_t none = 0;       // an output that there is not
  Span<uint16_t> outputs;  // [lod][packed row] the joint value or angle that it writes, or none
  Span<uint8_t> lengths;   // [packed row] of the run that begins there, or 0
  Span<uint32_t> runs;     // [packed row] the run that it belongs to, or kNoRun
  Span<uint32_t> writers;  // [output] the last packed row that writes it
};

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

void find_outputs(const Rig& rig, PackedRows& rows) {
  std::fill(rows.outputs.begin(), rows.outputs.end(), rows.none);
  for (uint32_t lod = 0; lod < rig.lod_count; ++lod) {
    uint16_t* const outputs = rows.outputs.data + lod * rows.count;
    for_each_written_row(rig, lod, [&](size_t row, size_t output) {
      rows.writers[output] = static_cast<uint32_t>(row);
    });
    for_each_written_row(rig, lod, [&](size_t row, size_t output) {
      if (rows.writers[output] == row) outputs[row] = static_cast<uint16_t>(output);
    });
  }
}

/// Whether a row is written at any LOD.
bool is_written(const Rig& rig, const PackedRows& rows, size_t row) {
  for (uint32_t lod = 0; lod < rig.lod_count; ++lod) {
    if (rows.outputs[lod * rows.count + row] != rows.none) return true;
  }
  return false;
}

/// Whether each LOD that writes a row also writes the next one, beside it, and the other way round.
bool joins_next(const Rig& rig, const PackedRows& rows, size_t row) {
  if (row + 1 == rows.count) return false;
  for (uint32_t lod = 0; lod < rig.lod_count; ++lod) {
    const uint16_t* const outputs = rows.outputs.data + lod * rows.count + row;
    const bool written = outputs[0] != rows.none;
    if (written != (outputs[1] != rows.none)) return false;
    if (written && outputs[1] != outputs[0] + 1) return false;
  }
  return true;
}

void find_runs(const Rig& rig, PackedRows& rows, RowRuns& runs) {
  size_t counts[kMaxRunRows + 1] = {};  // [rows]
  for (size_t row = 0, end; row < rows.count; row = end) {
    end = row + 1;
    if (!is_written(rig, rows, row)) continue;
    while (end < row + kMaxRunRows && joins_next(rig, rows, end - 1)) ++end;
    rows.lengths[row] = static_cast<uint8_t>(end - row);
    ++counts[end - row];
  }
  for (uint32_t n = 1; n <= kMaxRunRows; ++n) {
    runs.first_words[n] = runs.first_words[n - 1] + static_cast<uint32_t>(bit_words(counts[n]));
  }
  runs.word_count = runs.first_words[kMaxRunRows];
}

void place_runs(const Rig& rig, uint32_t word_count, Placer& placer, RowRuns& runs) {
  runs.rows = placer.array<uint32_t>(size_t{word_count} * 64);
  runs.outputs = placer.array<uint16_t>(size_t{rig.lod_count} * word_count * 64);
  runs.at_lod = placer.array<uint64_t>(size_t{rig.lod_count} * word_count);
  runs.of_column = placer.array<uint64_t>(rig.joints.columns.count * word_count);
}

/// The largest magnitude of each column.
void fill_largest(const JointMatrix& joints, const Span<float>& largest) {
  for (size_t k = 0; k < joints.columns.count; ++k) {
    joints.for_each_block(k, joints.panel_count(), [&](uint32_t block, uint32_t block_row) {
      for (uint32_t r = 0; r < kJointBlockRows; ++r) {
        const size_t at = size_t{block} * kJointBlockRows + r;
        const size_t row = size_t{block_row} * kJointBlockRows + r;
        const float value =
            joints.values.empty() ? static_cast<float>(joints.fixed_values[at]) : joints.values[at];
        const float scale = joints.scales.empty() ? 1.0f : std::max(1.0f, joints.scales[row]);
        largest[k] = std::max(largest[k], std::min(std::fabs(value) * scale, kLargestFloat));
      }
    });
  }
}

void mark_bit(uint64_t* words, size_t i) { words[i / 64] |= uint64_t{1} << i % 64; }

void fill_runs(const Rig& rig, const PackedRows& rows, RowRuns& runs) {
  uint32_t next[kMaxRunRows + 1] = {};  // [rows] run
  for (uint32_t n = 1; n <= kMaxRunRows; ++n) next[n] = runs.first_words[n - 1] * 64;
  std::fill(rows.runs.begin(), rows.runs.end(), kNoRun);
  for (size_t row = 0; row < rows.count; ++row) {
    const uint32_t length = rows.lengths[row];
    if (length == 0) continue;
    const uint32_t run = next[length]++;
    runs.rows[run] = static_cast<uint32_t>(row);
    std::fill_n(rows.runs.begin() + row, length, run);
    for (uint32_t lod = 0; lod < rig.lod_count; ++lod) {
      const uint16_t output = rows.outputs[lod * rows.count + row];
      if (output == rows.none) continue;
      runs.outputs[size_t{lod} * runs.word_count * 64 + run] = output;
      mark_bit(runs.at_lod.data + size_t{lod} * runs.word_count, run);
    }
  }
}

void fill_column_runs(const JointMatrix& joints, const PackedRows& rows, RowRuns& runs) {
  for (size_t k = 0; k < joints.columns.count; ++k) {
    uint64_t* const words = runs.of_column.data + k * runs.word_count;
    joints.for_each_block(k, joints.panel_count(), [&](uint32_t block, uint32_t block_row) {
      for (uint32_t r = 0; r < kJointBlockRows; ++r) {
        const size_t at = size_t{block} * kJointBlockRows + r;
        const uint32_t run = rows.runs[size_t{block_row} * kJointBlockRows + r];
        const bool moves =
            joints.values.empty() ? joints.fixed_values[at] != 0 : joints.values[at] != 0.0f;
        if (moves && run != kNoRun) mark_bit(words, run);
      }
    });
  }
}

}  // namespace

const ChangeTables* create_change_tables(const Rig& rig, const Allocator& allocator) {
  Arena scratch(allocator);
  PackedRows rows;
  const JointMatrix& joints = rig.joints;
  if (!joints.panels.empty())
    rows.count = size_t{joints.panels[joints.panel_count()].first_block_row} * kJointBlockRows;
  const size_t outputs = joints_and_angles_count(rig);
  rows.none = static_cast<uint16_t>(outputs);
  rows.outputs = scratch.unwritten_array<uint16_t>(rig.lod_count * rows.count);
  rows.lengths = scratch.array<uint8_t>(rows.count);
  rows.runs = scratch.array<uint32_t>(rows.count);
  rows.writers = scratch.array<uint32_t>(outputs);
  const Span<uint8_t> channels = scratch.array<uint8_t>(size_t{rig.channel_count} + 1);
  if (rows.outputs.count != rig.lod_count * rows.count || rows.lengths.count != rows.count ||
      rows.runs.count != rows.count || rows.writers.count != outputs || channels.empty()) {
    return nullptr;
  }
  RowRuns runs;
  find_outputs(rig, rows);
  find_runs(rig, rows, runs);
  auto* const tables =
      create_object<ChangeTables>(allocator, [&](Placer& placer, ChangeTables& placed) {
        place_control_lists(rig, placer, placed);
        place_runs(rig, runs.word_count, placer, placed.runs);
        placed.largest = placer.array<float>(joints.columns.count);
      });
  if (!tables) return nullptr;

  fill_control_lists(rig, *tables);
  for (const uint16_t output : rig.psds.outputs) {
    tables->nested_psds |= !tables->psds.of(output).empty();
  }
  tables->single_channels = true;
  for (const uint16_t channel : rig.channels.outputs) {
    tables->single_channels &= channels[channel] == 0;
    channels[channel] = 1;
  }
  std::copy_n(runs.first_words, kMaxRunRows + 1, tables->runs.first_words);
  tables->runs.word_count = runs.word_count;
  fill_runs(rig, rows, tables->runs);
  fill_column_runs(joints, rows, tables->runs);
  fill_largest(joints, tables->largest);
  return tables;
}

}  // namespace mien
