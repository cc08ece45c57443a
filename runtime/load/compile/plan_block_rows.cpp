// SPDX-License-Identifier: MIT
// Rows of joint groups -> rows that count -> block rows of 8.
//
// Block rows 2i and 2i + 1 stay neighbors: blocks that a column has in both are read together. So block rows
// of one group come in twos, and those left over are matched by what their groups read.
#include "runtime/load/compile/plan_block_rows.h"

#include <algorithm>

#include "runtime/base/bits.h"
#include "simd/kernels.h"

namespace mien {
namespace {

// Which rows count ------------------------------------------------------------------------------

/// How many LODs, counted from 0, reach each row: lod_reach() of all at once.
Status find_reaches(const dna::DnaView& view, const Rig& rig, Arena& scratch,
                    Span<uint8_t>& reaches, Error& error) {
  const auto& groups = view.bhvr.joints.groups;
  size_t row_count = 0;
  for (const dna::JointGroup& group : groups) row_count += group.output_indices.count;
  reaches = scratch.array<uint8_t>(row_count);
  if (row_count && !reaches.data) return no_scratch(error);
  uint8_t* rows = reaches.data;
  for (const dna::JointGroup& group : groups) {
    const uint32_t count = group.output_indices.count;
    for (uint32_t l = 0; l < rig.lod_count; ++l) {
      std::fill_n(rows, std::min(count, rows_at_lod(group.lods, l)), static_cast<uint8_t>(l + 1));
    }
    rows += count;
  }
  return Status::kOk;
}

/// Of rows with the same output the last one counts, at each LOD anew: a row is overridden where a
/// later one is reached. Rows of zeros write nothing, so that they override nothing.
Status choose_rows(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                   Error& error) {
  const auto& groups = view.bhvr.joints.groups;
  const size_t row_count = plan.reaches.count;
  Span<uint8_t>& uses = plan.uses;
  uses = scratch.array<uint8_t>(row_count);
  const uint32_t outputs = output_limit(rig);
  Span<uint8_t> overridden = scratch.array<uint8_t>(outputs);  // leading LODs taken by later rows
  Span<uint32_t> writer = scratch.array<uint32_t>(outputs);    // 1 + the row that took them
  if ((row_count && !uses.data) || (outputs && (!overridden.data || !writer.data))) {
    return no_scratch(error);
  }
  size_t at = row_count;
  for (uint32_t g = groups.count; g-- > 0;) {
    const dna::JointGroup& group = groups[g];
    for (uint32_t r = group.output_indices.count; r-- > 0;) {
      --at;
      const uint32_t output = output_of(view, rig, group.output_indices[r]);
      const uint8_t reach = plan.reaches[at];
      if (output == kNoOutput || reach == 0 || plan.groups[g].is_zero(r)) continue;
      if (reach <= overridden[output]) continue;
      uses[at] = kUsed;
      if (writer[output] != 0) {
        uses[at] = kContested;
        uses[writer[output] - 1] = kContested;
      }
      overridden[output] = reach;
      writer[output] = static_cast<uint32_t>(at + 1);
    }
  }
  return Status::kOk;
}

// Block rows and panels ---------------------------------------------------------------------------

/// The rows of each group in sequence: rows that the same LODs reach are sorted by output, so that the rows
/// of a joint are neighbors and share their zeros.
Status order_rows(const dna::DnaView& view, const Span<uint8_t>& reaches, Arena& scratch,
                  Span<uint16_t>& order, Error& error) {
  const auto& groups = view.bhvr.joints.groups;
  order = scratch.array<uint16_t>(reaches.count);
  if (reaches.count && !order.data) return no_scratch(error);
  uint16_t* rows = order.data;
  const uint8_t* reach = reaches.data;
  for (const dna::JointGroup& group : groups) {
    const uint32_t count = group.output_indices.count;
    for (uint32_t r = 0; r < count; ++r) rows[r] = static_cast<uint16_t>(r);
    for (uint32_t begin = 0, end; begin < count; begin = end) {
      for (end = begin + 1; end < count && reach[end] == reach[begin]; ++end) {
      }
      std::sort(rows + begin, rows + end, [&](uint16_t a, uint16_t b) {
        const uint32_t of_a = group.output_indices[a], of_b = group.output_indices[b];
        return of_a != of_b ? of_a < of_b : a < b;
      });
    }
    rows += count;
    reach += count;
  }
  return Status::kOk;
}

/// Calls f(group number, reaches of its rows, rows, row count, contested) for what shares a block
/// row, group by group: neighbors of one group that count. A contested row is alone in its block row,
/// so that block rows in order of their reach write in the right order.
template <class F>
void for_each_rows(const dna::DnaView& view, const JointPlan& plan, const Span<uint16_t>& order,
                   F&& f) {
  size_t first_row = 0;
  const auto& groups = view.bhvr.joints.groups;
  for (uint32_t g = 0; g < groups.count; ++g) {
    uint16_t rows[kJointBlockRows];
    uint32_t count = 0;
    const uint32_t row_count = groups[g].output_indices.count;
    const uint8_t* const reaches = plan.reaches.data + first_row;
    for (uint32_t r = 0; r < row_count; ++r) {
      const uint16_t row = order[first_row + r];
      const uint8_t use = plan.uses[first_row + row];
      if (use == kContested) f(g, reaches, &row, 1u, true);
      if (use != kUsed) continue;
      rows[count++] = row;
      if (count == kJointBlockRows) f(g, reaches, rows, count, false);
      count %= kJointBlockRows;
    }
    if (count != 0) f(g, reaches, rows, count, false);
    first_row += row_count;
  }
}

/// The controls that a group reads: bit c % 1024 for control c.
struct GroupSignature {
  uint64_t words[16];

  uint32_t overlap(const GroupSignature& other) const {
    uint32_t bits = 0;
    for (size_t w = 0; w < 16; ++w) bits += bit_count(words[w] & other.words[w]);
    return bits;
  }
};

/// A block row before it has its number.
struct BlockRowDraft {
  uint32_t group;    // of its first rows
  uint32_t partner;  // or kAlone
  uint32_t number;
};
constexpr uint32_t kAlone = ~uint32_t{0};

/// Gives the rows of one reach their block rows: rows that do not fill one share it with those of
/// other groups. Appends to `drafts`; of one group two that follow each other become partners.
void draft_block_rows(Span<PlannedRows> tier, Span<BlockRowDraft>& drafts) {
  uint32_t open[kJointBlockRows + 1];  // [free rows] a block row that has them
  std::fill(open, open + kJointBlockRows + 1, kAlone);
  uint32_t waiting = kAlone;  // for a partner of its group
  for (PlannedRows& rows : tier) {
    uint32_t room = rows.contested ? kJointBlockRows + 1 : rows.row_count;
    while (room <= kJointBlockRows && open[room] == kAlone) ++room;
    uint32_t block_row;
    if (room <= kJointBlockRows) {
      block_row = open[room];
      open[room] = kAlone;
    } else {
      room = kJointBlockRows;
      block_row = static_cast<uint32_t>(drafts.count++);
      drafts[block_row] = {rows.group, kAlone, 0};
      const bool matches = waiting != kAlone && drafts[waiting].group == rows.group;
      if (matches) {
        drafts[block_row].partner = waiting;
        drafts[waiting].partner = block_row;
      }
      waiting = matches ? kAlone : block_row;
    }
    rows.block_row = block_row;
    rows.first_in_block = static_cast<uint8_t>(kJointBlockRows - room);
    const uint32_t left = rows.contested ? 0 : room - rows.row_count;
    if (left != 0) open[left] = block_row;
  }
}

/// Matches block rows that have no partner yet with one of the next few, whose group reads most of
/// the same controls.
void match_block_rows(const Span<GroupSignature>& signatures, Span<BlockRowDraft> tier,
                      uint32_t first) {
  constexpr int kLook = 16;
  for (size_t a = 0; a < tier.count; ++a) {
    if (tier[a].partner != kAlone) continue;
    size_t best = a;
    uint32_t most = 0;
    int looked = 0;
    for (size_t b = a + 1; b < tier.count && looked < kLook; ++b) {
      if (tier[b].partner != kAlone) continue;
      ++looked;
      const uint32_t same = signatures[tier[a].group].overlap(signatures[tier[b].group]);
      if (best != a && same <= most) continue;
      best = b;
      most = same;
    }
    if (best == a) break;
    tier[a].partner = first + static_cast<uint32_t>(best);
    tier[best].partner = first + static_cast<uint32_t>(a);
  }
}

/// Numbers the block rows of a tier, partners side by side; returns the next number, an even one.
uint32_t number_block_rows(Span<BlockRowDraft>& drafts, size_t first, uint32_t next) {
  for (size_t d = first; d < drafts.count; ++d) {
    BlockRowDraft& draft = drafts[d];
    if (draft.partner != kAlone && draft.partner < d) continue;
    draft.number = next;
    if (draft.partner != kAlone) drafts[draft.partner].number = next + 1;
    next += 2;
  }
  return next;
}

}  // namespace

Status find_nonzeros(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                     Error& error) {
  const auto& groups = view.bhvr.joints.groups;
  const auto words_per_row = [](const dna::JointGroup& group) {
    return (group.input_indices.count + kWordBits - 1) / kWordBits;
  };
  size_t inputs = 0, words = 0;
  for (const dna::JointGroup& group : groups) {
    inputs += group.input_indices.count;
    words += size_t{group.output_indices.count} * words_per_row(group);
  }
  plan.groups = scratch.array<GroupColumns>(groups.count);
  Span<uint16_t> all_inputs = scratch.unwritten_array<uint16_t>(inputs);
  Span<uint64_t> all_words = scratch.unwritten_array<uint64_t>(words);
  if ((groups.count && !plan.groups.data) || (words && !all_words.data) ||
      (inputs && !all_inputs.data)) {
    return no_scratch(error);
  }
  for (uint32_t g = 0; g < groups.count; ++g) {
    const dna::JointGroup& group = groups[g];
    GroupColumns& columns = plan.groups[g];
    columns.row_count = group.output_indices.count;
    columns.words_per_row = words_per_row(group);
    columns.inputs = {all_inputs.data, group.input_indices.count};
    columns.nonzero = {all_words.data, size_t{columns.row_count} * columns.words_per_row};
    all_inputs.data += columns.inputs.count;
    all_words.data += columns.nonzero.count;
    copy_array(group.input_indices, columns.inputs);
    rig.kernels->mark_nonzeros(group.values.data, columns.row_count, columns.inputs.count,
                               columns.nonzero.data);
  }
  return Status::kOk;
}

Status plan_block_rows(const dna::DnaView& view, const Rig& rig, Arena& scratch, JointPlan& plan,
                       Error& error) {
  Status status = find_reaches(view, rig, scratch, plan.reaches, error);
  if (status == Status::kOk) status = choose_rows(view, rig, scratch, plan, error);
  Span<uint16_t> order;
  if (status == Status::kOk) status = order_rows(view, plan.reaches, scratch, order, error);
  if (status != Status::kOk) return status;
  const auto& groups = view.bhvr.joints.groups;
  size_t count = 0;
  uint32_t begin[kMaxLods + 2] = {};  // rows by reach, the farthest first
  for_each_rows(view, plan, order,
                [&](uint32_t, const uint8_t* reaches, const uint16_t* rows, uint32_t, bool) {
                  ++count;
                  ++begin[rig.lod_count - reaches[rows[0]] + 1];
                });
  Span<PlannedRows> drafted = scratch.array<PlannedRows>(count);
  Span<BlockRowDraft> drafts = scratch.array<BlockRowDraft>(count);
  Span<GroupSignature> signatures = scratch.array<GroupSignature>(groups.count);
  if ((count && (!drafted.data || !drafts.data)) || (groups.count && !signatures.data)) {
    return no_scratch(error);
  }
  for (uint32_t l = 0; l <= rig.lod_count; ++l) begin[l + 1] += begin[l];
  for_each_rows(
      view, plan, order,
      [&](uint32_t g, const uint8_t* reaches, const uint16_t* from, uint32_t n, bool contested) {
        PlannedRows& rows = drafted[begin[rig.lod_count - reaches[from[0]]]++];
        rows.group = g;
        rows.row_count = static_cast<uint8_t>(n);
        rows.contested = contested;
        std::copy(from, from + n, rows.rows);
        for (uint32_t k = 0; k < n; ++k) rows.reaches[k] = reaches[from[k]];
      });
  for (uint32_t g = 0; g < groups.count; ++g) {
    for (uint16_t input : plan.groups[g].inputs) {
      const uint32_t bit = input % 1024;
      signatures[g].words[bit / kWordBits] |= uint64_t{1} << bit % kWordBits;
    }
  }

  // By now each begin[] is where the rows of that reach end.
  drafts.count = 0;
  uint32_t tier_ends[kMaxLods + 1] = {}, next = 0;
  for (uint32_t l = 0, first_row = 0; l <= rig.lod_count; first_row = begin[l++]) {
    const auto first = static_cast<uint32_t>(drafts.count);
    draft_block_rows(drafted.slice(first_row, begin[l] - first_row), drafts);
    match_block_rows(signatures, drafts.slice(first, drafts.count - first), first);
    next = number_block_rows(drafts, first, next);
    tier_ends[l] = next;
  }
  if (next > kMaxBlockRows) {
    return fail(error, Status::kDnaLimit, kNoOffset,
                "bhvr.joints.jointGroups: the rows fill %u blocks of %u; at most %u are supported",
                next, kJointBlockRows, kMaxBlockRows);
  }

  plan.block_row_reaches = scratch.array<uint8_t>(next);
  plan.first_rows = scratch.array<uint32_t>(size_t{next} + 1);
  plan.rows = scratch.array<PlannedRows>(count);
  if ((next && !plan.block_row_reaches.data) || !plan.first_rows.data ||
      (count && !plan.rows.data)) {
    return no_scratch(error);
  }
  for (uint32_t l = 0, b = 0; l <= rig.lod_count; ++l) {
    for (; b < tier_ends[l]; ++b) {
      plan.block_row_reaches[b] = static_cast<uint8_t>(rig.lod_count - l);
    }
  }
  // Sorted by block row; those of one block stay in order. Filling moves each first to that of the
  // next block row: back again afterwards.
  Span<uint32_t>& firsts = plan.first_rows;
  for (PlannedRows& rows : drafted) {
    rows.block_row = drafts[rows.block_row].number;
    ++firsts[rows.block_row + 1];
  }
  for (uint32_t b = 0; b < next; ++b) firsts[b + 1] += firsts[b];
  for (const PlannedRows& rows : drafted) plan.rows[firsts[rows.block_row]++] = rows;
  for (uint32_t b = next; b > 0; --b) firsts[b] = firsts[b - 1];
  firsts[0] = 0;
  return Status::kOk;
}

}  // namespace mien
