// SPDX-License-Identifier: MIT
// Joint groups -> columns of pieces (rig-evaluation 4.3, 4.4).
//
//     rows of the groups  ->  rows that count  ->  blocks of 8  ->  chunks  ->  pieces by column
#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/dna/turn_columns.h"
#include "runtime/rig/compile_rig.h"

namespace mien {
namespace {

/// Where a row's result goes. Rows of joints represented by quaternions go nowhere: their columns
/// are turns. With quaternion outputs the attributes behind the rotation move up by one, and angles
/// stand behind all joints until they are made into quaternions.
uint32_t output_of(const dna::DnaView& view, const Rig& rig, uint32_t file_output) {
  const uint32_t joint = file_output / kFileAttributes, attribute = file_output % kFileAttributes;
  if (dna::is_rotation(file_output) && dna::is_quaternion_joint(view, joint)) return kNoOutput;
  if (!rig.quaternion_outputs) return file_output;
  if (dna::is_rotation(file_output)) return rig.joint_value_count() + joint * 3 + attribute - 3;
  return joint * rig.joint_attributes + attribute + (attribute >= 6);
}

uint32_t output_limit(const Rig& rig) {
  return rig.joint_value_count() + (rig.quaternion_outputs ? rig.joint_count * 3 : 0);
}

/// Bits of a big-endian float, but for its sign; zero if it is zero.
uint32_t magnitude_bits(const uint8_t* value) {
  uint32_t bits;
  memcpy(&bits, value, sizeof(bits));
  return bits & to_big_endian(uint32_t{0x7FFFFFFF});
}

const uint8_t* row_values(const dna::JointGroup& group, uint32_t row) {
  return group.values.data + size_t{row} * group.input_indices.count * sizeof(float);
}

// Scans go by strips of columns: a count that the compiler knows, so that it makes vector code.
constexpr uint32_t kStrip = 32;

bool is_zero(const dna::JointGroup& group, uint32_t row) {
  const uint8_t* values = row_values(group, row);
  const uint32_t columns = group.input_indices.count;
  uint32_t c = 0, any = 0;
  for (; c + kStrip <= columns && any == 0; c += kStrip) {
    for (uint32_t i = 0; i < kStrip; ++i) any |= magnitude_bits(values + size_t{c + i} * 4);
  }
  for (; c < columns && any == 0; ++c) any |= magnitude_bits(values + size_t{c} * 4);
  return any == 0;
}

Status no_scratch(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory to compile the joint groups");
}

// Which rows count ------------------------------------------------------------------------------

enum RowUse : uint8_t {
  kUnused,  // zeros, out of reach, or overridden wherever it is reached
  kUsed,
  kContested,  // another row writes the same value at some LODs
};

/// Of rows with the same output the last one counts, at each LOD anew: a row is overridden where a
/// later one is reached. Rows of zeros write nothing, so that they override nothing.
Status choose_rows(const dna::DnaView& view, const Rig& rig, Arena& scratch, Span<uint8_t>& uses,
                   Error& error) {
  const auto& groups = view.bhvr.joints.groups;
  size_t row_count = 0;
  for (const dna::JointGroup& group : groups) row_count += group.output_indices.count;
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
      const uint8_t reach = lod_reach(group.lods, rig.lod_count, r);
      if (output == kNoOutput || reach == 0 || is_zero(group, r)) continue;
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

// Blocks and chunks -----------------------------------------------------------------------------

/// Calls f(group number, rows, row count) for every block, in file order: neighbouring rows that
/// count, of one group. A contested row is alone in its block, so that blocks in order of their
/// reach write in the right order.
template <class F>
void for_each_block(const dna::DnaView& view, const Span<uint8_t>& uses, F&& f) {
  size_t first_row = 0;
  const auto& groups = view.bhvr.joints.groups;
  for (uint32_t g = 0; g < groups.count; ++g) {
    uint16_t rows[kPieceRows];
    uint32_t count = 0;
    const uint32_t row_count = groups[g].output_indices.count;
    for (uint32_t r = 0; r < row_count; ++r) {
      const uint8_t use = uses[first_row + r];
      const auto row = static_cast<uint16_t>(r);
      if (use == kContested) f(g, &row, 1u);
      if (use != kUsed) continue;
      rows[count++] = row;
      if (count == kPieceRows) f(g, rows, count);
      count %= kPieceRows;
    }
    if (count != 0) f(g, rows, count);
    first_row += row_count;
  }
}

Status plan_blocks(const dna::DnaView& view, const Rig& rig, const Span<uint8_t>& uses,
                   Arena& scratch, JointPlan& plan, Error& error) {
  size_t block_count = 0;
  uint32_t begin[kMaxLods + 2] = {};  // blocks by reach, the farthest first
  for_each_block(view, uses, [&](uint32_t g, const uint16_t* rows, uint32_t) {
    ++block_count;
    ++begin[rig.lod_count - lod_reach(view.bhvr.joints.groups[g].lods, rig.lod_count, rows[0]) + 1];
  });
  if (block_count > kMostBlocks) {
    return fail(error, Status::kDnaLimit, kNoOffset,
                "bhvr.joints.jointGroups: rows make up %zu blocks of %u; %u are allowed",
                block_count, kPieceRows, kMostBlocks);
  }
  plan.blocks = scratch.array<PlannedBlock>(block_count);
  if (block_count && !plan.blocks.data) return no_scratch(error);
  for (uint32_t l = 0; l <= rig.lod_count; ++l) begin[l + 1] += begin[l];
  for_each_block(view, uses, [&](uint32_t g, const uint16_t* rows, uint32_t count) {
    const uint8_t reach = lod_reach(view.bhvr.joints.groups[g].lods, rig.lod_count, rows[0]);
    PlannedBlock& block = plan.blocks[begin[rig.lod_count - reach]++];
    block.group = g;
    block.row_count = static_cast<uint8_t>(count);
    std::copy(rows, rows + count, block.rows);
    for (uint32_t k = 0; k < count; ++k) {
      block.reaches[k] = lod_reach(view.bhvr.joints.groups[g].lods, rig.lod_count, rows[k]);
    }
  });
  return Status::kOk;
}

/// How many blocks a chunk has at most. Small chunks tell changes apart; their table has an entry
/// for each column, though, and shall stay small beside the pieces.
uint32_t chunk_size(size_t block_count, size_t piece_count, size_t column_count) {
  constexpr size_t kMarks = 48;  // of the 64 bits of a set of chunks: LODs divide some once more
  const size_t affordable = column_count ? std::max<size_t>(piece_count / column_count / 2, 1) : 1;
  const size_t count = std::min(kMarks, affordable);
  return static_cast<uint32_t>(
      std::clamp<size_t>((block_count + count - 1) / count, 1, kMostChunkBlocks));
}

/// Calls f(first block) for each chunk, and once more for the end.
template <class F>
void for_each_chunk(const JointPlan& plan, F&& f) {
  const auto block_count = static_cast<uint32_t>(plan.blocks.count);
  for (uint32_t b = 0, first = 0; b < block_count; ++b) {
    const bool begins = b == 0 || plan.blocks[b].reach() != plan.blocks[b - 1].reach() ||
                        b - first == plan.chunk_size;
    if (!begins) continue;
    first = b;
    f(b);
  }
  f(block_count);
}

// Pieces ----------------------------------------------------------------------------------------

/// Where the rows of a block stand in the file.
struct BlockRows {
  const uint8_t* at[kPieceRows];
  uint32_t count;

  BlockRows(const dna::JointGroup& group, const PlannedBlock& block) : count(block.row_count) {
    for (uint32_t k = 0; k < count; ++k) at[k] = row_values(group, block.rows[k]);
  }
  const uint8_t* value(uint32_t row, uint32_t column) const {
    return at[row] + size_t{column} * sizeof(float);
  }
};

constexpr uint32_t kWordBits = 64;

uint32_t words_of(const dna::JointGroup& group) {
  return (group.input_indices.count + kWordBits - 1) / kWordBits;
}

/// Bit c: some row of the block is not zero in column `first` + c, of `count` columns.
uint64_t columns_used(const BlockRows& rows, uint32_t first, uint32_t count) {
  uint32_t used[kWordBits] = {};
  for (uint32_t k = 0; k < rows.count; ++k) {
    const uint8_t* row = rows.value(k, first);
    uint32_t c = 0;
    for (; c + kStrip <= count; c += kStrip) {
      for (uint32_t i = 0; i < kStrip; ++i) used[c + i] |= magnitude_bits(row + size_t{c + i} * 4);
    }
    for (; c < count; ++c) used[c] |= magnitude_bits(row + size_t{c} * 4);
  }
  uint8_t flags[kWordBits];
  for (uint32_t c = 0; c < kWordBits; ++c) flags[c] = used[c] != 0;
  uint64_t bits = 0;
  for (uint32_t c = 0; c < kWordBits; c += 8) {
    // The product brings byte i, which is 0 or 1, to bit 56 + i.
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < 8; ++i) bytes |= uint64_t{flags[c + i]} << 8 * i;
    bits |= (bytes * 0x0102040810204080u >> 56) << c;
  }
  return bits;
}

/// Which pieces are not all zeros: the one pass over the numbers that planning takes.
Status find_pieces(const dna::DnaView& view, Arena& scratch, JointPlan& plan, Error& error) {
  size_t words = 0;
  for (const PlannedBlock& block : plan.blocks) {
    words += words_of(view.bhvr.joints.groups[block.group]);
  }
  plan.pieces = scratch.array<uint64_t>(words);
  if (words && !plan.pieces.data) return no_scratch(error);
  uint64_t* word = plan.pieces.data;
  for (const PlannedBlock& block : plan.blocks) {
    const dna::JointGroup& group = view.bhvr.joints.groups[block.group];
    const BlockRows rows(group, block);
    const uint32_t columns = group.input_indices.count;
    for (uint32_t c = 0; c < columns; c += kWordBits) {
      *word++ = columns_used(rows, c, std::min(columns - c, kWordBits));
    }
  }
  return Status::kOk;
}

uint32_t lowest_bit(uint64_t bits) {
#if defined(__GNUC__)
  return static_cast<uint32_t>(__builtin_ctzll(bits));
#else
  uint32_t at = 0;
  while (!(bits >> at & 1)) ++at;
  return at;
#endif
}

/// Calls f(block number, rows, column of the group, first) for every piece that is not all zeros,
/// by ascending blocks. `first` is false if the group lists the control once more: those pieces are
/// one. Needs plan.pieces and plan.last_block.
template <class F>
void for_each_piece(const dna::DnaView& view, const JointPlan& plan, F&& f) {
  std::fill(plan.last_block.begin(), plan.last_block.end(), 0u);
  const uint64_t* word = plan.pieces.data;
  for (uint32_t b = 0; b < plan.blocks.count; ++b) {
    const PlannedBlock& block = plan.blocks[b];
    const dna::JointGroup& group = view.bhvr.joints.groups[block.group];
    const BlockRows rows(group, block);
    for (uint32_t from = 0; from < group.input_indices.count; from += kWordBits) {
      for (uint64_t bits = *word++; bits != 0; bits &= bits - 1) {
        const uint32_t c = from + lowest_bit(bits);
        uint32_t& last_block = plan.last_block[group.input_indices[c]];
        f(b, rows, c, last_block != b + 1);
        last_block = b + 1;
      }
    }
  }
}

/// Rows of a block whose sums go to neighbouring values: three, or one.
struct Target {
  uint32_t row;  // of the block
  uint32_t output;
  uint32_t row_count;
};

/// Calls f(target) for all targets of a block, in order of their rows.
template <class F>
void for_each_target(const dna::DnaView& view, const Rig& rig, const PlannedBlock& block, F&& f) {
  const dna::JointGroup& group = view.bhvr.joints.groups[block.group];
  uint32_t outputs[kPieceRows];
  for (uint32_t k = 0; k < block.row_count; ++k) {
    outputs[k] = output_of(view, rig, group.output_indices[block.rows[k]]);
  }
  for (uint32_t k = 0; k < block.row_count;) {
    const bool three = k + 2 < block.row_count && outputs[k + 1] == outputs[k] + 1 &&
                       outputs[k + 2] == outputs[k] + 2 && block.reaches[k + 2] == block.reaches[k];
    const Target target = {k, outputs[k], three ? 3u : 1u};
    f(target);
    k += target.row_count;
  }
}

/// Calls f(target, number of rows, reach) for all targets of a chunk, in order of their slots.
template <class F>
void for_each_target_of_chunk(const dna::DnaView& view, const JointPlan& plan, const Rig& rig,
                              uint32_t chunk, F&& f) {
  const uint32_t first = rig.joints.chunks[chunk].first_block;
  const uint32_t end = rig.joints.chunks[chunk + 1].first_block;
  for (uint32_t b = first; b < end; ++b) {
    const PlannedBlock& block = plan.blocks[b];
    for_each_target(view, rig, block, [&](const Target& target) {
      const JointTarget joint_target = {
          static_cast<uint16_t>((b - first) * kPieceRows + target.row),
          static_cast<uint16_t>(target.output), static_cast<uint16_t>(block.group)};
      f(joint_target, target.row_count, block.reaches[target.row]);
    });
  }
}

void fill_targets(const dna::DnaView& view, const JointPlan& plan, uint32_t chunk, Rig& rig) {
  JointMatrix& joints = rig.joints;
  // Where targets of each kind and reach begin, the farthest first.
  uint32_t begin[2][kMaxLods + 2] = {};
  for_each_target_of_chunk(view, plan, rig, chunk,
                           [&](const JointTarget&, uint32_t rows, uint8_t reach) {
                             ++begin[rows == 1][rig.lod_count - reach + 1];
                           });
  uint32_t count = 0;
  for (int one = 0; one < 2; ++one) {
    uint32_t* kind = begin[one];
    for (uint32_t l = 0; l <= rig.lod_count; ++l) kind[l + 1] += kind[l];
    Span<uint16_t>& at_lod = one ? joints.ones_at_lod : joints.threes_at_lod;
    for (uint32_t l = 0; l < rig.lod_count; ++l) {
      at_lod[size_t{chunk} * rig.lod_count + l] = static_cast<uint16_t>(kind[rig.lod_count - l]);
    }
    const uint32_t of_kind = kind[rig.lod_count];
    for (uint32_t l = 0; l <= rig.lod_count; ++l) kind[l] += count;
    count += of_kind;
  }
  const uint32_t first = joints.chunks[chunk].first_target;
  joints.chunks[chunk + 1].first_target = first + count;
  for_each_target_of_chunk(
      view, plan, rig, chunk, [&](const JointTarget& target, uint32_t rows, uint8_t reach) {
        joints.targets[first + begin[rows == 1][rig.lod_count - reach]++] = target;
      });
}

/// The largest number of a row becomes the largest of 16 bits.
void fill_scales(const dna::DnaView& view, const JointPlan& plan, JointMatrix& joints) {
  for (uint32_t b = 0; b < plan.blocks.count; ++b) {
    const PlannedBlock& block = plan.blocks[b];
    const dna::JointGroup& group = view.bhvr.joints.groups[block.group];
    for (uint32_t k = 0; k < block.row_count; ++k) {
      const uint8_t* row = row_values(group, block.rows[k]);
      float largest = 0.0f;
      for (uint32_t c = 0; c < group.input_indices.count; ++c) {
        const float size = std::fabs(load_big_endian<float>(row + size_t{c} * sizeof(float)));
        if (size <= 3.4e38f) largest = std::max(largest, size);
      }
      joints.scales[size_t{b} * kPieceRows + k] = largest / 32767.0f;
    }
  }
}

int16_t add_fixed(int16_t to, float value, float scale) {
  if (!(scale > 0.0f)) return 0;
  const float steps = static_cast<float>(to) + std::nearbyint(value / scale);
  return static_cast<int16_t>(steps >= 32767.0f ? 32767.0f
                                                : (steps > -32767.0f ? steps : -32767.0f));
}

/// A piece comes into memory that nobody has written yet.
void add_piece(const BlockRows& rows, uint32_t column, bool first, float* piece) {
  if (first && rows.count == kPieceRows) {
    for (uint32_t k = 0; k < kPieceRows; ++k) {
      piece[k] = load_big_endian<float>(rows.value(k, column));
    }
    return;
  }
  if (first) std::fill(piece, piece + kPieceRows, 0.0f);
  for (uint32_t k = 0; k < rows.count; ++k) {
    piece[k] += load_big_endian<float>(rows.value(k, column));
  }
}

void add_fixed_piece(const BlockRows& rows, uint32_t column, const float* scales, int16_t* piece) {
  for (uint32_t k = 0; k < rows.count; ++k) {
    const float value = load_big_endian<float>(rows.value(k, column));
    piece[k] = add_fixed(piece[k], value, scales[k]);
  }
}

/// The first of the rows that is not zero reaches farthest.
void mark_reach(const PlannedBlock& block, const BlockRows& rows, uint32_t column,
                uint8_t& control_reach) {
  for (uint32_t k = 0; k < rows.count && block.reaches[k] > control_reach; ++k) {
    if (magnitude_bits(rows.value(k, column)) != 0) control_reach = block.reaches[k];
  }
}

/// Rows that are not in the matrix (they turn joints, or are overridden) mark what they read, too.
void mark_other_rows(const dna::DnaView& view, const JointPlan& plan, const Rig& rig,
                     Span<uint8_t> reach) {
  size_t at = 0;
  for (const dna::JointGroup& group : view.bhvr.joints.groups) {
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      if (plan.uses[at++] != kUnused) continue;
      if (is_zero(group, r)) continue;
      const uint8_t row_reach = lod_reach(group.lods, rig.lod_count, r);
      const uint8_t* values = row_values(group, r);
      for (uint32_t c = 0; c < group.input_indices.count; ++c) {
        if (magnitude_bits(values + size_t{c} * sizeof(float)) == 0) continue;
        uint8_t& control_reach = reach[group.input_indices[c]];
        control_reach = std::max(control_reach, row_reach);
      }
    }
  }
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
  const auto& groups = view.bhvr.joints.groups;
  Status status = choose_rows(view, rig, scratch, plan.uses, error);
  if (status == Status::kOk) status = plan_blocks(view, rig, plan.uses, scratch, plan, error);
  if (status == Status::kOk) status = find_pieces(view, scratch, plan, error);
  if (status != Status::kOk) return status;

  plan.last_block = scratch.array<uint32_t>(rig.control_count);
  plan.pieces_of_control = scratch.array<uint32_t>(rig.control_count);
  if (rig.control_count && (!plan.last_block.data || !plan.pieces_of_control.data)) {
    return no_scratch(error);
  }
  for_each_piece(view, plan, [&](uint32_t b, const BlockRows&, uint32_t column, bool first) {
    plan.pieces_of_control[groups[plan.blocks[b].group].input_indices[column]] += first;
    plan.piece_count += first;
  });
  for (uint32_t count : plan.pieces_of_control) plan.column_count += count != 0;
  for (const PlannedBlock& block : plan.blocks) {
    for_each_target(view, rig, block, [&](const Target&) { ++plan.target_count; });
  }
  plan.chunk_size = chunk_size(plan.blocks.count, plan.piece_count, plan.column_count);
  for_each_chunk(plan, [&](uint32_t) { ++plan.chunk_ends; });
  return Status::kOk;
}

void place_joints(const dna::DnaView& view, const JointPlan& plan, Placer& placer, Rig& rig) {
  JointMatrix& joints = rig.joints;
  const size_t values = plan.piece_count * kPieceRows;
  if (rig.half_storage) {
    joints.fixed_values = placer.array<int16_t>(values, kBlockAlignment);
    joints.scales = placer.array<float>(plan.blocks.count * kPieceRows, kBlockAlignment);
  } else {
    joints.values = placer.unwritten_array<float>(values, kBlockAlignment);
  }
  joints.blocks = placer.array<uint16_t>(plan.piece_count);
  joints.columns = placer.array<uint16_t>(plan.column_count);
  joints.first_piece = placer.array<uint32_t>(plan.column_count + 1);
  joints.chunk_pieces = placer.array<uint16_t>(plan.column_count * plan.chunk_ends);
  joints.chunks = placer.array<JointChunk>(plan.chunk_ends);
  joints.chunks_at_lod = placer.array<uint32_t>(rig.lod_count);
  joints.control_chunks = placer.array<uint64_t>(rig.control_count);
  joints.targets = placer.array<JointTarget>(plan.target_count);
  joints.threes_at_lod = placer.array<uint16_t>((plan.chunk_ends - 1) * rig.lod_count);
  joints.ones_at_lod = placer.array<uint16_t>((plan.chunk_ends - 1) * rig.lod_count);

  const auto& groups = view.bhvr.joints.groups;
  joints.group_rows_at_lod = placer.array<uint16_t>(size_t{groups.count} * rig.lod_count);
  joints.group_count = groups.count;
  for (const dna::JointGroup& group : groups) {
    joints.widest_group = std::max(joints.widest_group, group.input_indices.count);
    joints.tallest_group = std::max(joints.tallest_group, group.output_indices.count);
  }
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
  mark_other_rows(view, plan, rig, reach);

  for (uint8_t use : plan.uses) joints.contested |= use == kContested;
  uint32_t chunk = 0;
  for_each_chunk(plan, [&](uint32_t block) { joints.chunks[chunk++].first_block = block; });
  const uint32_t chunk_count = joints.chunk_count();
  while (chunk_count > uint64_t{64} << joints.chunk_shift) ++joints.chunk_shift;
  for (uint32_t c = 0; c < chunk_count; ++c) {
    fill_targets(view, plan, c, rig);
    const uint8_t chunk_reach = plan.blocks[joints.chunks[c].first_block].reach();
    for (uint32_t l = 0; l < chunk_reach; ++l) joints.chunks_at_lod[l] = c + 1;
  }
  if (rig.half_storage) fill_scales(view, plan, joints);

  // From here on: where the next piece of a control goes.
  uint32_t column = 0, piece = 0;
  for (uint32_t control = 0; control < rig.control_count; ++control) {
    const uint32_t count = plan.pieces_of_control[control];
    plan.pieces_of_control[control] = piece;
    if (count == 0) continue;
    joints.columns[column] = static_cast<uint16_t>(control);
    piece += count;
    joints.first_piece[++column] = piece;
  }
  for_each_piece(view, plan, [&](uint32_t b, const BlockRows& rows, uint32_t c, bool first) {
    const PlannedBlock& block = plan.blocks[b];
    const uint32_t control = groups[block.group].input_indices[c];
    const size_t at = plan.pieces_of_control[control] - !first;
    plan.pieces_of_control[control] += first;
    joints.blocks[at] = static_cast<uint16_t>(b * kBlockUnit);
    mark_reach(block, rows, c, reach[control]);
    if (rig.half_storage) {
      add_fixed_piece(rows, c, joints.scales.data + size_t{b} * kPieceRows,
                      joints.fixed_values.data + at * kPieceRows);
    } else {
      add_piece(rows, c, first, joints.values.data + at * kPieceRows);
    }
  });

  // Where the chunks begin in each column.
  for (uint32_t k = 0; k < joints.columns.count; ++k) {
    const uint32_t first = joints.first_piece[k], end = joints.first_piece[k + 1];
    uint16_t* begins = joints.chunk_pieces.data + size_t{k} * joints.chunks.count;
    uint64_t& marks = joints.control_chunks[joints.columns[k]];
    uint32_t p = first;
    for (uint32_t c = 0; c <= chunk_count; ++c) {
      begins[c] = static_cast<uint16_t>(p - first);
      if (c == chunk_count) break;
      if (p < end && joints.blocks[p] / kBlockUnit < joints.chunks[c + 1].first_block) {
        marks |= uint64_t{1} << (c >> joints.chunk_shift);
      }
      while (p < end && joints.blocks[p] / kBlockUnit < joints.chunks[c + 1].first_block) ++p;
    }
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
    for (const TwistSwingOutput& output : rig.twist_swing.outputs) {
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
