// SPDX-License-Identifier: MIT
// Conditional tables and correctives (docs/rig-evaluation.md, 2 "Conditional tables" and 3
// "Correctives").
#include <algorithm>
#include <cstring>
#include <utility>

#include "runtime/load/compile/compile_rig.h"

namespace mien {
namespace {

Status no_memory_for_controls(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory to compile the controls");
}

void place_table(const dna::ConditionalTable& from, Placer& placer, ControlTable& table) {
  const uint32_t rows = from.input_indices.count;
  table.inputs = placer.array<uint16_t>(rows);
  table.outputs = placer.array<uint16_t>(rows);
  table.from = placer.array<float>(rows);
  table.to = placer.array<float>(rows);
  table.slope = placer.array<float>(rows);
  table.cut = placer.array<float>(rows);
  table.run_ends = placer.array<uint32_t>(rows);
}

void fill_table(const dna::ConditionalTable& from, ControlTable& table) {
  copy_array(from.input_indices, table.inputs);
  copy_array(from.output_indices, table.outputs);
  copy_array(from.from_values, table.from);
  copy_array(from.to_values, table.to);
  copy_array(from.slope_values, table.slope);
  copy_array(from.cut_values, table.cut);
  for (size_t r = table.inputs.count; r-- > 0;) {
    if (table.from[r] > table.to[r]) std::swap(table.from[r], table.to[r]);
    const bool goes_on = r + 1 < table.inputs.count && table.inputs[r] == table.inputs[r + 1] &&
                         table.outputs[r] == table.outputs[r + 1];
    table.run_ends[r] = goes_on ? table.run_ends[r + 1] : static_cast<uint32_t>(r + 1);
  }
}

Status fill_driven_raw(const ControlTable& table, uint32_t raw_count, Arena& scratch,
                       Span<uint16_t>& driven, Error& error) {
  Span<uint8_t> marks = scratch.array<uint8_t>(raw_count);
  if (raw_count && !marks.data) return no_memory_for_controls(error);
  for (uint16_t output : table.outputs) marks[output] = 1;
  uint32_t count = 0;
  for (uint32_t i = 0; i < raw_count; ++i) {
    if (marks[i]) driven[count++] = static_cast<uint16_t>(i);
  }
  driven.count = count;
  return Status::kOk;
}

// With one zero, so that intervals from 0 and from -0 are equal.
uint32_t bits(float value) {
  const float plain = value == 0.0f ? 0.0f : value;
  uint32_t pattern;
  memcpy(&pattern, &plain, sizeof(pattern));
  return pattern;
}

// Rows are sorted so that equal [from, to] of one input stand together, then those groups by their
// first row: O(n log n), whatever a file holds.
Status fill_reverse(const ControlTable& table, uint32_t gui_count, Arena& scratch,
                    ReverseTable& reverse, Error& error) {
  const uint32_t row_count = static_cast<uint32_t>(table.inputs.count);
  Span<uint32_t> leader = scratch.array<uint32_t>(row_count);  // [row]: first row of its group
  if (row_count && !leader.data) return no_memory_for_controls(error);
  Span<uint32_t> rows = reverse.rows;
  for (uint32_t r = 0; r < row_count; ++r) rows[r] = r;
  // Compared by bits, because NaN has no order.
  const auto same_interval = [&](uint32_t a, uint32_t b) {
    return table.inputs[a] == table.inputs[b] && bits(table.from[a]) == bits(table.from[b]) &&
           bits(table.to[a]) == bits(table.to[b]);
  };
  std::sort(rows.begin(), rows.end(), [&](uint32_t a, uint32_t b) {
    if (table.inputs[a] != table.inputs[b]) return table.inputs[a] < table.inputs[b];
    if (bits(table.from[a]) != bits(table.from[b]))
      return bits(table.from[a]) < bits(table.from[b]);
    if (bits(table.to[a]) != bits(table.to[b])) return bits(table.to[a]) < bits(table.to[b]);
    return a < b;
  });
  for (uint32_t i = 0; i < row_count; ++i) {
    const bool starts = i == 0 || !same_interval(rows[i - 1], rows[i]);
    leader[rows[i]] = starts ? rows[i] : leader[rows[i - 1]];
  }
  std::sort(rows.begin(), rows.end(), [&](uint32_t a, uint32_t b) {
    if (table.inputs[a] != table.inputs[b]) return table.inputs[a] < table.inputs[b];
    if (leader[a] != leader[b]) return leader[a] < leader[b];
    return a < b;
  });

  uint32_t group_count = 0, input = 0;
  for (uint32_t i = 0; i < row_count; ++i) {
    if (i != 0 && leader[rows[i]] == leader[rows[i - 1]]) continue;
    while (input <= table.inputs[rows[i]]) reverse.first_group[input++] = group_count;
    reverse.first_row[group_count++] = i;
  }
  while (input <= gui_count) reverse.first_group[input++] = group_count;
  reverse.first_row[group_count] = row_count;
  return Status::kOk;
}

}  // namespace

void place_controls(const dna::DnaView& view, Placer& placer, Rig& rig) {
  const dna::Controls& controls = view.bhvr.controls;
  const uint32_t rows = controls.conditionals.input_indices.count;
  place_table(controls.conditionals, placer, rig.gui_to_raw);
  rig.driven_raw = placer.array<uint16_t>(std::min(rows, rig.raw_count));
  rig.raw_to_gui.first_group = placer.array<uint32_t>(size_t{rig.gui_count} + 1);
  rig.raw_to_gui.first_row = placer.array<uint32_t>(size_t{rows} + 1);
  rig.raw_to_gui.rows = placer.array<uint32_t>(rows);

  rig.psds.outputs = placer.array<uint16_t>(rig.psd_count);
  rig.psds.weights = placer.array<float>(rig.psd_count);
  rig.psds.first_input = placer.array<uint32_t>(size_t{rig.psd_count} + 1);
  rig.psds.run_lengths = placer.array<uint16_t>(rig.psd_count);
  rig.psds.inputs = placer.array<uint16_t>(controls.psds.columns.count);
  rig.psds.count_at_lod = placer.array<uint32_t>(rig.lod_count);
  rig.psds.entry_of_psd = placer.array<uint16_t>(rig.psd_count);

  const dna::BlendShapeChannels& channels = view.bhvr.channels;
  rig.channels.inputs = placer.array<uint16_t>(channels.input_indices.count);
  rig.channels.outputs = placer.array<uint16_t>(channels.output_indices.count);
  rig.channels.count_at_lod = placer.array<uint32_t>(rig.lod_count);

  place_table(view.bhvr.maps.conditionals, placer, rig.maps);
  rig.map_rows_at_lod = placer.array<uint32_t>(rig.lod_count);
}

Status fill_controls(const dna::DnaView& view, Arena& scratch, Rig& rig, Error& error) {
  fill_table(view.bhvr.controls.conditionals, rig.gui_to_raw);
  Status status = fill_driven_raw(rig.gui_to_raw, rig.raw_count, scratch, rig.driven_raw, error);
  if (status == Status::kOk) {
    status = fill_reverse(rig.gui_to_raw, rig.gui_count, scratch, rig.raw_to_gui, error);
  }
  if (status != Status::kOk) return status;

  copy_array(view.bhvr.channels.input_indices, rig.channels.inputs);
  copy_array(view.bhvr.channels.output_indices, rig.channels.outputs);
  fill_table(view.bhvr.maps.conditionals, rig.maps);
  for (uint32_t l = 0; l < rig.lod_count; ++l) {
    rig.channels.count_at_lod[l] = rows_at_lod(view.bhvr.channels.lods, l);
    rig.map_rows_at_lod[l] = rows_at_lod(view.bhvr.maps.lods, l);
  }
  return Status::kOk;
}

Status fill_psds(const dna::DnaView& view, Span<uint8_t> reach, Arena& scratch, Rig& rig,
                 Error& error) {
  const dna::PsdTable& table = view.bhvr.controls.psds;
  const uint32_t count = rig.psd_count, entries = table.rows.count, first_psd = view.first_psd();
  PsdTable& psds = rig.psds;

  // Marks the controls that channels and maps read; joint groups have marked theirs.
  for (uint32_t i = 0; i < rig.channels.inputs.count; ++i) {
    uint8_t& r = reach[rig.channels.inputs[i]];
    r = std::max(r, lod_reach(view.bhvr.channels.lods, rig.lod_count, i));
  }
  for (uint32_t i = 0; i < rig.maps.inputs.count; ++i) {
    uint8_t& r = reach[rig.maps.inputs[i]];
    r = std::max(r, lod_reach(view.bhvr.maps.lods, rig.lod_count, i));
  }
  if (count == 0) return Status::kOk;

  // Table entries by corrective, in file order.
  Span<uint32_t> first = scratch.array<uint32_t>(size_t{count} + 1);
  Span<uint32_t> by_psd = scratch.array<uint32_t>(entries);
  // Users of each corrective that is an input of others: `user_of[entry]` chained by `next_use`.
  Span<uint32_t> last_use = scratch.array<uint32_t>(count);
  Span<uint32_t> next_use = scratch.array<uint32_t>(entries);
  Span<uint32_t> waits_for = scratch.array<uint32_t>(count);
  Span<uint32_t> order = scratch.array<uint32_t>(count);
  Span<uint32_t> depth = scratch.array<uint32_t>(count);  // of the longest chain after it
  if (!first.data || !last_use.data || !waits_for.data || !order.data || !depth.data ||
      (entries && (!by_psd.data || !next_use.data))) {
    return no_memory_for_controls(error);
  }
  constexpr uint32_t kNone = ~uint32_t{0};
  std::fill(last_use.begin(), last_use.end(), kNone);
  const auto psd_of = [&](uint32_t control) {
    return control >= first_psd && control - first_psd < count ? control - first_psd : kNone;
  };
  for (uint32_t e = 0; e < entries; ++e) ++first[table.rows[e] - first_psd + 1];
  for (uint32_t p = 0; p < count; ++p) first[p + 1] += first[p];
  for (uint32_t e = entries; e-- > 0;) {  // backwards, counting down from each end
    const uint32_t psd = table.rows[e] - first_psd;
    by_psd[--first[psd + 1]] = e;
    const uint32_t needed = psd_of(table.columns[e]);
    if (needed == kNone) continue;
    next_use[e] = last_use[needed];
    last_use[needed] = e;
    ++waits_for[psd];
  }
  // Counting down left first[p + 1] at the start of p: shift back into place.
  for (uint32_t p = 0; p < count; ++p) first[p] = first[p + 1];
  first[count] = entries;

  // Kahn's algorithm: a corrective is ready once all its inputs are placed.
  uint32_t ready = 0;
  for (uint32_t p = 0; p < count; ++p) {
    if (waits_for[p] == 0) order[ready++] = p;
  }
  for (uint32_t i = 0; i < ready; ++i) {
    for (uint32_t e = last_use[order[i]]; e != kNone; e = next_use[e]) {
      const uint32_t user = table.rows[e] - first_psd;
      depth[user] = std::max(depth[user], depth[order[i]] + 1);
      if (--waits_for[user] == 0) order[ready++] = user;
    }
  }
  if (ready != count) {
    uint32_t p = 0;
    while (waits_for[p] == 0) ++p;
    return fail(error, Status::kDnaValue, view.offset_of(table.rows.data),
                "bhvr.controls.psds: corrective %u depends on itself, directly or through others",
                p);
  }

  // A LOD that needs a corrective needs its inputs, too.
  for (uint32_t i = count; i-- > 0;) {
    const uint32_t p = order[i];
    for (uint32_t k = first[p]; k < first[p + 1]; ++k) {
      const uint32_t needed = psd_of(table.columns[by_psd[k]]);
      if (needed == kNone) continue;
      uint8_t& r = reach[first_psd + needed];
      r = std::max(r, reach[first_psd + p]);
    }
  }

  // Those of all LODs first, those of the finest last: an input reaches as far as its user. Among
  // them those that depend on fewer others; then by their number of inputs, so that evaluation
  // meets long runs of the same.
  const uint8_t* const psd_reach = reach.data + first_psd;
  const uint32_t *const first_of = first.data, *const depth_of = depth.data;
  const auto reach_of = [psd_reach](uint32_t p) { return psd_reach[p]; };
  const auto before = [psd_reach, first_of, depth_of](uint32_t a, uint32_t b) {
    if (psd_reach[a] != psd_reach[b]) return psd_reach[a] > psd_reach[b];
    if (depth_of[a] != depth_of[b]) return depth_of[a] < depth_of[b];
    const uint32_t inputs_a = first_of[a + 1] - first_of[a];
    const uint32_t inputs_b = first_of[b + 1] - first_of[b];
    return inputs_a != inputs_b ? inputs_a < inputs_b : a < b;
  };
  // Kahn's order often is this one.
  if (!std::is_sorted(order.begin(), order.end(), before)) {
    std::sort(order.begin(), order.end(), before);
  }
  for (uint32_t i = 0; i < count; ++i) {
    psds.entry_of_psd[order[i]] = static_cast<uint16_t>(i);
    for (uint32_t l = 0; l < reach_of(order[i]); ++l) psds.count_at_lod[l] = i + 1;
  }
  for (uint32_t i = count; i-- > 0;) {
    const uint32_t p = order[i];
    const auto follows = [&](uint32_t next) {
      return reach_of(next) == reach_of(p) && depth[next] == depth[p] &&
             first[next + 1] - first[next] == first[p + 1] - first[p];
    };
    const bool runs_on = i + 1 < count && follows(order[i + 1]);
    psds.run_lengths[i] = static_cast<uint16_t>(runs_on ? psds.run_lengths[i + 1] + 1 : 1);
  }
  for (uint32_t p = 0; p < count; ++p) {
    const uint32_t entry = psds.entry_of_psd[p];
    psds.outputs[entry] = static_cast<uint16_t>(first_psd + p);
    psds.first_input[entry + 1] = first[p + 1] - first[p];
  }
  for (uint32_t i = 0; i < count; ++i) psds.first_input[i + 1] += psds.first_input[i];
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t p = psds.outputs[i] - first_psd;
    float weight = first[p] < first[p + 1] ? 1.0f : 0.0f;
    for (uint32_t k = first[p]; k < first[p + 1]; ++k) {
      weight *= table.values[by_psd[k]];
      psds.inputs[psds.first_input[i] + k - first[p]] = table.columns[by_psd[k]];
    }
    // An infinite product would turn an input of 0 into NaN.
    psds.weights[i] = std::min(std::max(weight, -kLargestFloat), kLargestFloat);
  }
  return Status::kOk;
}

}  // namespace mien
