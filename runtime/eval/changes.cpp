// SPDX-License-Identifier: MIT
#include "runtime/eval/changes.h"

#include <algorithm>
#include <cstring>

#include "runtime/base/bits.h"
#include "runtime/eval/stages.h"
#include "simd/kernels.h"

namespace mien {
namespace {

void mark_one(const Span<uint64_t>& set, size_t i) { set[i / 64] |= uint64_t{1} << i % 64; }

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

void mark_range(const Span<uint64_t>& set, uint32_t first, uint32_t count) {
  for (uint32_t i = first, end = first + count; i < end;) {
    const uint32_t in_word = std::min(64 - i % 64, end - i);
    set[i / 64] |= ~uint64_t{0} >> (64 - in_word) << i % 64;
    i += in_word;
  }
}

Uses mark_changes(const Rig& rig, Instance& instance, const ControlRange& range, float* previous) {
  constexpr uint32_t kStep = 16;
  const float* const now = instance.controls.data + range.first;
  const Uses* const control_uses = rig.control_uses.data + range.first;
  const uint32_t count = range.end - range.first;
  Changes& changes = instance.changes;
  Uses uses = 0;
  for (uint32_t first = 0; first < count; first += kStep) {
    const uint32_t end = std::min(count, first + kStep);
    const size_t bytes = (end - first) * sizeof(float);
    if (memcmp(previous + first, now + first, bytes) == 0) continue;
    uint64_t bits = 0;
    for (uint32_t i = first; i < end; ++i) {
      const uint64_t differs = bits_of(previous[i]) != bits_of(now[i]);
      uses |= control_uses[i] & (Uses{0} - differs);
      bits |= differs << (i - first);
    }
    memcpy(previous + first, now + first, bytes);
    const uint32_t at = range.first + first;
    for (const Span<uint64_t>* set : {&changes.psds, &changes.joints, &changes.channels}) {
      (*set)[at / 64] |= bits << at % 64;
      if (at % 64 > 64 - kStep) (*set)[at / 64 + 1] |= bits >> (64 - at % 64);
    }
  }
  return uses;
}

bool has_few_changes(const Rig& rig, const Instance& instance) {
  const size_t marked = marked_count(instance.changes.joints);
  return 8 * marked <= nonzero_count(rig, instance);
}

// Correctives -------------------------------------------------------------------------------------

void mark_all_psds(const Rig& rig, Instance& instance) {
  Changes& changes = instance.changes;
  clear_set(changes.psds);
  changes.all &= ~uint32_t{kStagePsd};
  // They may have changed.
  mark_range(changes.joints, rig.raw_count, rig.psd_count);
  mark_range(changes.channels, rig.raw_count, rig.psd_count);
}

bool evaluate_changed_psds(const Rig& rig, Instance& instance, uint32_t lod) {
  Changes& changes = instance.changes;
  if (changes.all & kStagePsd) return false;
  const PsdTable& psds = rig.psds;
  const ControlReaders& readers = rig.changes->psds;
  const uint32_t count = psds.count_at_lod[lod];
  size_t marked = 0;
  for_each_marked(changes.psds, [&](size_t control) {
    marked += readers.first[control + 1] - readers.first[control] + 1;
  });
  if (8 * marked > count) return false;

  for_each_marked(changes.psds, [&](size_t control) {
    for (const uint32_t entry : readers.of(control)) mark_one(changes.entries, entry);
    // Another stage may have overwritten a corrective.
    const size_t psd = control - rig.raw_count;
    if (control >= rig.raw_count && psd < psds.entry_of_psd.count)
      mark_one(changes.entries, psds.entry_of_psd[psd]);
  });
  clear_set(changes.psds);
  Uses uses = 0;
  for (size_t w = 0; w < changes.entries.count; ++w) {
    while (const uint64_t bits = changes.entries[w]) {
      changes.entries[w] = bits & (bits - 1);
      const size_t entry = w * 64 + lowest_bit(bits);
      if (entry >= count) continue;
      const Uses changed = rig.kernels->psds({psds.outputs.data + entry, psds.weights.data + entry,
                                              psds.first_input.data + entry, psds.inputs.data,
                                              psds.run_lengths.data + entry, rig.control_uses.data,
                                              instance.controls.data, 1});
      if (changed == 0) continue;
      uses |= changed;
      const size_t output = psds.outputs[entry];
      mark_one(changes.joints, output);
      mark_one(changes.channels, output);
      for (const uint32_t reader : readers.of(output)) {
        if (reader > entry) mark_one(changes.entries, reader);
      }
    }
  }
  note_written_psds(instance, uses);
  return true;
}

// Blend shapes ------------------------------------------------------------------------------------

bool evaluate_changed_blend_shapes(const Rig& rig, Instance& instance, uint32_t lod) {
  Changes& changes = instance.changes;
  const uint32_t count = rig.channels.count_at_lod[lod];
  const bool all = (changes.all & kStageBlendShapes) != 0 || !rig.changes->single_channels ||
                   4 * marked_count(changes.channels) > count;
  if (!all) {
    for_each_marked(changes.channels, [&](size_t control) {
      for (const uint32_t entry : rig.changes->channels.of(control)) {
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

// Joints ------------------------------------------------------------------------------------------

namespace {

/// Lists the columns that changed, with the differences of their controls, and marks their block rows.
/// Returns their number; more than `limit` if there are more, or if a difference is not finite.
uint32_t list_changed_columns(const Rig& rig, const Instance& instance, uint32_t lod,
                              uint32_t limit, JointRun* runs) {
  const JointMatrix& joints = rig.joints;
  const Changes& changes = instance.changes;
  const size_t words = rig.changes->word_count;
  uint32_t count = 0;
  for (size_t w = 0; w < changes.joints.count; ++w) {
    for (uint64_t bits = changes.joints[w]; bits != 0; bits &= bits - 1) {
      const size_t control = w * 64 + lowest_bit(bits);
      const uint32_t column = joints.column_of_control[control];
      if (column == kNoColumn) continue;
      const float difference = instance.controls[control] - changes.summed[control];
      if (difference == 0.0f) continue;
      const ColumnPart& part = joints.part(column, joints.panels_at_lod[lod]);
      if (part.pairs == 0 && part.singles == 0) continue;
      if (count == limit || !(difference - difference == 0.0f)) return limit + 1;
      runs[count++] = {joints.starts[column], part.pairs, part.singles, difference};
      const uint64_t* const rows = rig.changes->block_rows.data + column * words;
      for (size_t i = 0; i < words; ++i) changes.block_rows[i] |= rows[i];
    }
  }
  return count;
}

/// Marks the joints of the angles in `block_rows`.
void mark_turned(const Rig& rig, const Changes& changes, const uint16_t* outputs) {
  const uint32_t first = rig.joint_value_count();
  const auto end = static_cast<uint32_t>(joints_and_angles_count(rig));
  for_each_marked(changes.block_rows, [&](size_t block_row) {
    const uint16_t* const eight = outputs + block_row * kJointBlockRows;
    for (uint32_t r = 0; r < kJointBlockRows; ++r) {
      if (eight[r] >= first && eight[r] < end) mark_one(changes.turned, (eight[r] - first) / 3u);
    }
  });
}

}  // namespace

bool add_changed_columns(const Rig& rig, Instance& instance, uint32_t lod) {
  Changes& changes = instance.changes;
  if (changes.all & kStageJoints) return false;
  const JointMatrix& joints = rig.joints;
  // Adding a column takes longer than summing one, because its rows are written, too.
  constexpr uint32_t kFew = 16;
  const uint32_t limit =
      std::min(kFew + changes.summed_count / 2, kMaxAddedColumns - changes.added_columns);
  JointRun runs[kMaxAddedColumns];
  clear_set(changes.block_rows);
  const uint32_t count = list_changed_columns(rig, instance, lod, limit, runs);
  if (count > limit) return false;

  JointColumnsArgs add;
  const bool fixed = joints.values.empty();
  add.values = fixed ? static_cast<const void*>(joints.fixed_values.data) : joints.values.data;
  add.block_rows = joints.block_rows.data;
  add.runs = runs;
  add.sums = changes.sums.data;
  add.run_count = count;
  add.portable = rig.portable;
  (fixed ? rig.kernels->joint_columns_fixed : rig.kernels->joint_columns)(add);
  changes.added_columns += count;

  // ML joints are added to what their rows write.
  const uint32_t row_count = joints.panels[joints.panels_at_lod[lod]].first_block_row;
  if (!rig.ml.joints.empty()) mark_range(changes.block_rows, 0, row_count);
  // Columns may reach past the LOD.
  const size_t words = bit_words(row_count);
  if (row_count % 64 != 0) changes.block_rows[words - 1] &= ~uint64_t{0} >> (64 - row_count % 64);
  std::fill(changes.block_rows.begin() + words, changes.block_rows.end(), uint64_t{0});

  FinishBlockRowsArgs finish;
  finish.sums = changes.sums.data;
  finish.scales = joints.scales.empty() ? nullptr : joints.scales.data;
  finish.block_rows = changes.block_rows.data;
  finish.outputs = rig.changes->row_outputs.data + rig.changes->first_row_output[lod];
  finish.to = instance.joints_and_angles.data;
  finish.word_count = static_cast<uint32_t>(words);
  if (!rig.kernels->finish_block_rows(finish)) {
    drop_sums(instance);
    return false;
  }
  clear_set(changes.turned);
  if (rig.quaternion_outputs) mark_turned(rig, changes, finish.outputs);
  for_each_marked(changes.joints,
                  [&](size_t control) { changes.summed[control] = instance.controls[control]; });
  clear_set(changes.joints);
  return true;
}

Uses panels_to_sum(const Rig& rig, const Instance& instance) {
  const Changes& changes = instance.changes;
  const uint32_t count = rig.joints.panels_at_lod[instance.lod];
  Uses of_lod = 0;
  for (uint32_t c = 0; c < count; ++c) of_lod |= Uses{1} << panel_bit(rig.joints, c);
  const bool all = (changes.all & kStageJoints) != 0 ||
                   changes.added_columns > kMaxAddedColumns / 2 || (of_lod & ~instance.stale) == 0;
  return all ? kAllPanels : instance.stale & kAllPanels;
}

void note_sums(const Rig& rig, Instance& instance, Uses panels) {
  Changes& changes = instance.changes;
  std::copy(instance.controls.begin(), instance.controls.end(), changes.summed.begin());
  clear_set(changes.joints);
  if (panels != kAllPanels) return;
  changes.all &= ~uint32_t{kStageJoints};
  changes.added_columns = 0;
  changes.summed_count = static_cast<uint32_t>(nonzero_count(rig, instance));
}

}  // namespace mien
