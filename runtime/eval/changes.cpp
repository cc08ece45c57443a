// SPDX-License-Identifier: MIT
#include "runtime/eval/changes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/base/bits.h"
#include "runtime/eval/stages.h"
#include "simd/kernels.h"

namespace mien {
namespace {

void mark_one(const Span<uint64_t>& set, size_t i) { set[i / 64] |= uint64_t{1} << i % 64; }

void mark_range(const Span<uint64_t>& set, uint32_t first, uint32_t count) {
  for (uint32_t i = first, end = first + count; i < end;) {
    const uint32_t in_word = std::min(64 - i % 64, end - i);
    set[i / 64] |= ~uint64_t{0} >> (64 - in_word) << i % 64;
    i += in_word;
  }
}

void clear_set(const Span<uint64_t>& set) { std::fill(set.begin(), set.end(), uint64_t{0}); }

size_t marked_count(const Span<uint64_t>& set) {
  size_t count = 0;
  for (const uint64_t word : set) {
    if (word != 0) count += bit_count(word);
  }
  return count;
}

/// Calls f(i) for the members of a set, ascending.
template <class F>
void for_each_marked(const Span<uint64_t>& set, F&& f) {
  for (size_t w = 0; w < set.count; ++w) {
    for (uint64_t bits = set[w]; bits != 0; bits &= bits - 1) f(w * 64 + lowest_bit(bits));
  }
}

/// Calls f(first, bits) for `count` values, 64 at a time, with the bits of those that differ from others,
/// if any do.
template <class F>
void for_each_different(const Rig& rig, const float* values, const float* others, uint32_t count,
                        F&& f) {
  constexpr uint32_t kWords = 16;
  for (uint32_t first = 0; first < count; first += 64 * kWords) {
    uint64_t words[kWords];
    const uint32_t now = std::min(count - first, 64 * kWords);
    rig.kernels->different({values + first, others + first, words, now});
    for (uint32_t w = 0; w * 64 < now; ++w) {
      if (words[w] != 0) f(first + w * 64, words[w]);
    }
  }
}

size_t nonzero_count(const Rig& rig, const Instance& instance) {
  constexpr uint32_t kWords = 16;
  size_t count = 0;
  for (uint32_t first = 0; first < rig.control_count; first += 64 * kWords) {
    uint64_t words[kWords];
    const uint32_t controls = std::min(rig.control_count - first, 64 * kWords);
    rig.kernels->nonzero({instance.controls.data + first, words, controls});
    for (uint32_t w = 0; w * 64 < controls; ++w) count += bit_count(words[w]);
  }
  return count;
}

}  // namespace

Uses mark_changes(const Rig& rig, Instance& instance, const ControlRange& range, float* previous) {
  const float* const now = instance.controls.data + range.first;
  const Uses* const control_uses = rig.control_uses.data + range.first;
  const Changes& changes = *instance.changes;
  Uses uses = 0;
  for_each_different(
      rig, now, previous, range.end - range.first, [&](uint32_t first, uint64_t bits) {
        const uint32_t word = (range.first + first) / 64, shift = (range.first + first) % 64;
        const uint64_t high = shift == 0 ? 0 : bits >> (64 - shift);
        for (const Span<uint64_t>* set :
             {&changes.psds, &changes.joints, &changes.channels, &changes.maps}) {
          (*set)[word] |= bits << shift;
          if (high != 0) (*set)[word + 1] |= high;
        }
        for (; bits != 0; bits &= bits - 1) {
          const uint32_t i = first + lowest_bit(bits);
          uses |= control_uses[i];
          previous[i] = now[i];
        }
      });
  return uses;
}

bool has_few_changes(const Rig& rig, const Instance& instance) {
  const Changes& changes = *instance.changes;
  if (changes.all & kStageJoints) return false;
  size_t different = 0;
  for_each_different(rig, instance.controls.data, changes.summed.data, rig.control_count,
                     [&](uint32_t, uint64_t bits) { different += bit_count(bits); });
  return 8 * different <= nonzero_count(rig, instance);
}

// Correctives -------------------------------------------------------------------------------------

void mark_all_psds(const Rig& rig, Instance& instance) {
  Changes& changes = *instance.changes;
  clear_set(changes.psds);
  changes.all &= ~uint32_t{kStagePsd};
  // They may have changed.
  for (const Span<uint64_t>* set : {&changes.joints, &changes.channels, &changes.maps}) {
    mark_range(*set, rig.raw_count, rig.psd_count);
  }
}

bool evaluate_changed_psds(const Rig& rig, Instance& instance, uint32_t lod) {
  Changes& changes = *instance.changes;
  if (changes.all & kStagePsd) return false;
  const PsdTable& psds = rig.psds;
  const uint32_t count = psds.count_at_lod[lod];
  // Those that may change: the others are 0 and stay so, because another control that they read is not
  // positive. Without branches, which would be mispredicted.
  const auto mark_readers = [&](size_t control, uint32_t after) {
    const float* const controls = instance.controls.data;
    for (const PsdReader& reader : rig.changes->psds.of(control)) {
      const bool may_change =
          (int{controls[reader.other] > 0.0f} | int{controls[psds.outputs[reader.entry]] != 0.0f}) &
          int{reader.entry >= after};
      changes.entries[reader.entry / 64] |= uint64_t{may_change} << reader.entry % 64;
    }
  };
  for_each_marked(changes.psds, [&](size_t control) {
    mark_readers(control, 0);
    // Another stage may have overwritten a corrective.
    const size_t psd = control - rig.raw_count;
    if (control >= rig.raw_count && psd < psds.entry_of_psd.count)
      mark_one(changes.entries, psds.entry_of_psd[psd]);
  });
  if (4 * marked_count(changes.entries) > count) {
    clear_set(changes.entries);
    return false;
  }
  clear_set(changes.psds);
  PsdListArgs args = {
      psds.outputs.data,      psds.weights.data,   psds.first_input.data, psds.inputs.data,
      instance.controls.data, changes.listed.data, changes.listed.data,   0};
  Uses uses = 0;
  const bool nested = rig.changes->nested_psds;
  for (size_t w = 0; w < changes.entries.count;) {
    // All of them at once, or, where correctives read each other, one after the other.
    for (args.count = 0; w < changes.entries.count; ++w) {
      uint64_t& bits = changes.entries[w];
      while (bits != 0 && !(nested && args.count != 0)) {
        const size_t entry = w * 64 + lowest_bit(bits);
        bits &= bits - 1;
        if (entry < count) changes.listed[args.count++] = static_cast<uint16_t>(entry);
      }
      if (nested && args.count != 0) break;
    }
    const uint32_t changed = rig.kernels->psd_list(args);
    for (const uint16_t entry : changes.listed.first(changed)) {
      const size_t output = psds.outputs[entry];
      uses |= rig.control_uses[output];
      mark_one(changes.joints, output);
      mark_one(changes.channels, output);
      mark_one(changes.maps, output);
      if (nested) mark_readers(output, entry + 1u);
    }
  }
  note_written_psds(instance, uses);
  return true;
}

// Blend shapes and animated maps ------------------------------------------------------------------

bool evaluate_changed_blend_shapes(const Rig& rig, Instance& instance, uint32_t lod) {
  Changes& changes = *instance.changes;
  const ChangeTables& tables = *rig.changes;
  const uint32_t count = rig.channels.count_at_lod[lod];
  const bool all = (changes.all & kStageBlendShapes) != 0 || !tables.single_channels ||
                   4 * marked_count(changes.channels) > count;
  if (!all) {
    for_each_marked(changes.channels, [&](size_t control) {
      for (const uint32_t entry : tables.channels.of(control)) {
        if (entry < count)
          instance.channels[rig.channels.outputs[entry]] = instance.controls[control];
      }
    });
  }
  // The caller evaluates the others.
  clear_set(changes.channels);
  changes.all &= ~uint32_t{kStageBlendShapes};
  return !all;
}

namespace {

/// What add_table_rows() gives for one animated map, clamped.
float animated_map(const Rig& rig, const Span<uint32_t>& rows, uint32_t row_count,
                   const float* controls) {
  const ControlTable& table = rig.maps;
  float sum = 0.0f;
  uint32_t next = 0;
  for (const uint32_t r : rows) {
    if (r >= row_count) break;
    const float input = controls[table.inputs[r]];
    // Without branches, which would be mispredicted.
    const int counts = int{r >= next} & int{table.from[r] <= input} & int{input <= table.to[r]};
    const float added = sum + (table.slope[r] * input + table.cut[r]);
    sum = counts ? added : sum;
    next = counts ? table.run_ends[r] : next;
  }
  return sum > 0.0f ? (sum < 1.0f ? sum : 1.0f) : 0.0f;
}

}  // namespace

bool evaluate_changed_maps(const Rig& rig, Instance& instance, uint32_t lod) {
  Changes& changes = *instance.changes;
  const ChangeTables& tables = *rig.changes;
  const bool all = (changes.all & kStageAnimatedMaps) != 0 ||
                   4 * marked_count(changes.maps) > rig.map_rows_at_lod[lod];
  if (!all) {
    clear_set(changes.map_outputs);
    for_each_marked(changes.maps, [&](size_t control) {
      for (const uint32_t map : tables.maps.of(control)) mark_one(changes.map_outputs, map);
    });
    for_each_marked(changes.map_outputs, [&](size_t map) {
      instance.maps[map] = animated_map(rig, tables.map_rows.of(map), rig.map_rows_at_lod[lod],
                                        instance.controls.data);
    });
  }
  // The caller evaluates the others.
  clear_set(changes.maps);
  changes.all &= ~uint32_t{kStageAnimatedMaps};
  return !all;
}

// Joints ------------------------------------------------------------------------------------------

namespace {

constexpr uint32_t kMaxChangedColumns = 512;  // at a time

/// Columns that changed, with the differences of their controls.
struct ChangedColumns {
  uint32_t count = 0, block_count = 0;
  double largest = 0;  // bound on the magnitudes of what they add to a sum
  JointRun runs[kMaxChangedColumns];
  uint32_t numbers[kMaxChangedColumns];
};

/// Returns false if there are more than `limit`.
bool list_changed_columns(const Rig& rig, const Instance& instance, uint32_t lod, uint32_t limit,
                          ChangedColumns& columns) {
  const JointMatrix& joints = rig.joints;
  const float* const controls = instance.controls.data;
  float* const summed = instance.changes->summed.data;
  const uint32_t panel_end = joints.panels_at_lod[lod];
  const Span<uint64_t>& set = instance.changes->joints;
  for (size_t w = 0; w < set.count; ++w) {
    for (uint64_t bits = set[w]; bits != 0; bits &= bits - 1) {
      const size_t control = w * 64 + lowest_bit(bits);
      const float difference = controls[control] - summed[control];
      // If there are too many, the caller sets all of these.
      summed[control] = controls[control];
      const uint32_t column = joints.column_of_control[control];
      if (column == kNoColumn || difference == 0.0f) continue;
      const ColumnPart part = joints.part(column, panel_end);
      if (part.pairs == 0 && part.singles == 0) continue;
      if (columns.count == limit) return false;
      columns.runs[columns.count] = {joints.starts[column], part.pairs, part.singles, difference};
      columns.numbers[columns.count++] = column;
      columns.block_count += 2u * part.pairs + part.singles;
      columns.largest += double{std::fabs(difference)} * rig.changes->largest[column];
    }
    set[w] = 0;
  }
  return true;
}

/// Marks the runs of rows that the columns reach and the LOD writes.
void mark_runs(const Rig& rig, const Changes& changes, uint32_t lod,
               const ChangedColumns& columns) {
  const RowRuns& runs = rig.changes->runs;
  const uint32_t words = runs.word_count;
  uint64_t* const marked = changes.runs.data;
  const uint64_t* const at_lod = runs.at_lod.data + size_t{lod} * words;
  // Writing all takes less time than finding out which of them to write if there are many. ML joints are added
  // to what their rows write.
  const uint32_t block_rows = rig.joints.panels[rig.joints.panels_at_lod[lod]].first_block_row;
  if (!rig.ml.joints.empty() || columns.block_count > 2 * block_rows) {
    std::copy(at_lod, at_lod + words, marked);
    return;
  }
  clear_set(changes.runs);
  for (uint32_t i = 0; i < columns.count; ++i) {
    const uint64_t* const of_column = runs.of_column.data + size_t{columns.numbers[i]} * words;
    for (uint32_t w = 0; w < words; ++w) marked[w] |= of_column[w];
  }
  // Columns may reach past the LOD. Whole words take less time than most of their bits.
  for (uint32_t w = 0; w < words; ++w) {
    marked[w] &= at_lod[w];
    if (bit_count(marked[w]) > 44) marked[w] = at_lod[w];
  }
}

/// Marks the joints of the angles in Changes::runs.
void mark_turned(const Rig& rig, const Changes& changes, const uint16_t* outputs) {
  const RowRuns& runs = rig.changes->runs;
  const uint32_t first = rig.joint_value_count();
  clear_set(changes.turned);
  for_each_marked(changes.runs, [&](size_t run) {
    uint32_t length = 1;
    while (run >= size_t{runs.first_words[length]} * 64) ++length;
    for (uint32_t r = 0; r < length; ++r) {
      if (outputs[run] + r >= first) mark_one(changes.turned, (outputs[run] + r - first) / 3u);
    }
  });
}

}  // namespace

bool add_changed_columns(const Rig& rig, Instance& instance, uint32_t lod) {
  Changes& changes = *instance.changes;
  // A frame rounds each sum once for each column that it adds, and as much as twice more: the differences,
  // and on some instruction sets the products.
  constexpr uint32_t kOfFrame = 2;
  if ((changes.all & kStageJoints) != 0 || changes.roundings + kOfFrame >= kMaxRoundings)
    return false;
  const JointMatrix& joints = rig.joints;
  // Adding a column takes longer than summing one, because its rows are written, too.
  constexpr uint32_t kFew = 16;
  const uint32_t limit = std::min({kFew + changes.summed_count / 2, kMaxChangedColumns,
                                   kMaxRoundings - kOfFrame - changes.roundings});
  ChangedColumns columns;
  if (!list_changed_columns(rig, instance, lod, limit, columns)) return false;
  // Sums that overflow would stay infinite. (This fails if a control is not finite, too.)
  changes.largest += columns.largest;
  if (!(changes.largest < kLargestFloat / 2)) {
    drop_sums(instance);
    return false;
  }
  if (columns.count != 0) {
    JointColumnsArgs add;
    const bool fixed = joints.values.empty();
    add.values = fixed ? static_cast<const void*>(joints.fixed_values.data) : joints.values.data;
    add.block_rows = joints.block_rows.data;
    add.runs = columns.runs;
    add.sums = changes.sums.data;
    add.run_count = columns.count;
    add.portable = rig.portable;
    (fixed ? rig.kernels->joint_columns_fixed : rig.kernels->joint_columns)(add);
    changes.roundings += columns.count + kOfFrame;
  }

  mark_runs(rig, changes, lod, columns);
  const RowRuns& runs = rig.changes->runs;
  FinishRunsArgs finish;
  finish.sums = changes.sums.data;
  finish.scales = joints.scales.empty() ? nullptr : joints.scales.data;
  finish.runs = changes.runs.data;
  finish.rows = runs.rows.data;
  finish.outputs = runs.outputs.data + size_t{lod} * runs.word_count * 64;
  finish.to = instance.joints_and_angles.data;
  finish.first_words = runs.first_words;
  rig.kernels->finish_runs(finish);
  if (rig.quaternion_outputs) mark_turned(rig, changes, finish.outputs);
  return true;
}

Uses panels_to_sum(const Rig& rig, const Instance& instance) {
  const Changes& changes = *instance.changes;
  const uint32_t count = rig.joints.panels_at_lod[instance.lod];
  Uses of_lod = 0;
  for (uint32_t c = 0; c < count; ++c) of_lod |= Uses{1} << panel_bit(rig.joints, c);
  const bool all = (changes.all & kStageJoints) != 0 || changes.roundings > kMaxRoundings / 2 ||
                   (of_lod & ~instance.stale) == 0;
  return all ? kAllPanels : instance.stale & kAllPanels;
}

void note_sums(const Rig& rig, Instance& instance, Uses panels) {
  Changes& changes = *instance.changes;
  std::copy(instance.controls.begin(), instance.controls.end(), changes.summed.begin());
  clear_set(changes.joints);
  const Span<uint16_t>& columns = rig.joints.columns;
  double largest = 0;
  for (size_t k = 0; k < columns.count; ++k) {
    largest += double{std::fabs(instance.controls[columns[k]])} * rig.changes->largest[k];
  }
  // Panels that are not stale keep the sums of before. (The bound may be NaN.)
  if (panels == kAllPanels || !(largest <= changes.largest)) changes.largest = largest;
  if (panels != kAllPanels) return;
  changes.all &= ~uint32_t{kStageJoints};
  changes.roundings = 0;
  changes.summed_count = static_cast<uint32_t>(nonzero_count(rig, instance));
}

}  // namespace mien
