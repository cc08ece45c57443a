// SPDX-License-Identifier: MIT
// Joint groups: controls -> joint values (rig-evaluation 4.4).
//
//     controls  ->  those that are not zero  ->  sums, a tile of chunks at a time  ->  joint values
#include <algorithm>

#include "runtime/eval/evaluate.h"

namespace mien {
namespace {

/// Columns whose controls are not zero: a part of them, if a rig has very many.
struct ActiveColumns {
  static constexpr uint32_t kMost = 1024;
  uint16_t columns[kMost];
  float inputs[kMost];
  uint32_t count;
  uint32_t first = ~uint32_t{0};  // of the columns that were looked at

  void find(const JointMatrix& joints, const float* controls, uint32_t from) {
    if (first == from) return;
    first = from;
    const auto all = static_cast<uint32_t>(joints.columns.count);
    const uint32_t end = all - from < kMost ? all : from + kMost;
    count = 0;
    for (uint32_t k = from; k < end; ++k) {
      const float input = controls[joints.columns[k]];
      columns[count] = static_cast<uint16_t>(k);
      inputs[count] = input;
      count += input != 0.0f;
    }
  }
};

/// Sums of neighbouring chunks: of all chunks of a face, so that each column is read in one go.
/// (32 KiB of stack, the most that evaluation takes, beside 6 KiB for the columns.)
struct Tile {
  static constexpr uint32_t kMostBlocks = 1024;
  uint32_t first_chunk, end_chunk;
  alignas(kBlockAlignment) float sums[kMostBlocks * kPieceRows];
};
static_assert(Tile::kMostBlocks >= kMostChunkBlocks, "a chunk fits");

void sum_tile(const Rig& rig, const Instance& instance, ActiveColumns& active, Tile& tile) {
  const JointMatrix& joints = rig.joints;
  const uint32_t first_block = joints.chunks[tile.first_chunk].first_block;
  const uint32_t sum_count = (joints.chunks[tile.end_chunk].first_block - first_block) * kPieceRows;
  std::fill(tile.sums, tile.sums + sum_count, 0.0f);

  JointColumnsArgs args;
  const bool fixed = joints.values.empty();
  args.values = fixed ? static_cast<const void*>(joints.fixed_values.data) : joints.values.data;
  args.blocks = joints.blocks.data;
  args.first_pieces = joints.first_piece.data;
  args.begins = joints.chunk_pieces.data + tile.first_chunk;
  args.ends = joints.chunk_pieces.data + tile.end_chunk;
  args.stride = joints.chunks.count;
  args.columns = active.columns;
  args.inputs = active.inputs;
  args.sums = tile.sums;
  args.first_block = first_block;
  args.portable = rig.portable;
  for (uint32_t k = 0; k < joints.columns.count; k += ActiveColumns::kMost) {
    active.find(joints, instance.controls.data, k);
    args.column_count = active.count;
    (fixed ? rig.kernels->joint_columns_fixed : rig.kernels->joint_columns)(args);
  }
  const float* scales = fixed ? joints.scales.data + size_t{first_block} * kPieceRows : nullptr;
  rig.kernels->finish_sums(tile.sums, scales, sum_count);
}

/// Rows of one group only, or of all.
void write_tile(const Rig& rig, Instance& instance, uint32_t lod, const Tile& tile,
                uint32_t only_group) {
  const JointMatrix& joints = rig.joints;
  const uint32_t first_block = joints.chunks[tile.first_chunk].first_block;
  float* out = instance.joints_and_angles.data;
  for (uint32_t c = tile.first_chunk; c < tile.end_chunk; ++c) {
    const float* sums = tile.sums + size_t{joints.chunks[c].first_block - first_block} * kPieceRows;
    const auto write = [&](const JointTarget& target, int rows) {
      const float* sum = sums + target.slot;
      out[target.output] = sum[0];
      if (rows == 1) return;
      out[target.output + 1] = sum[1];
      out[target.output + 2] = sum[2];
    };
    if (only_group == kAllGroups) {
      for_each_target(rig, lod, c, write);
    } else {
      for_each_target(rig, lod, c, [&](const JointTarget& target, int rows) {
        if (target.group == only_group) write(target, rows);
      });
    }
  }
}

bool holds_group(const JointMatrix& joints, uint32_t chunk, uint32_t group) {
  const uint32_t end = joints.chunks[chunk + 1].first_target;
  for (uint32_t t = joints.chunks[chunk].first_target; t < end; ++t) {
    if (joints.targets[t].group == group) return true;
  }
  return false;
}

}  // namespace

void evaluate_joint_rows(const Rig& rig, Instance& instance, uint32_t lod, uint64_t marks,
                         uint32_t only_group) {
  const JointMatrix& joints = rig.joints;
  const uint32_t chunk_count = joints.chunks_at_lod[lod];
  const auto wanted = [&](uint32_t chunk) {
    return (marks >> (chunk >> joints.chunk_shift) & 1) != 0 &&
           (only_group == kAllGroups || holds_group(joints, chunk, only_group));
  };
  ActiveColumns active;
  Tile tile;
  for (uint32_t c = 0; c < chunk_count;) {
    if (!wanted(c)) {
      ++c;
      continue;
    }
    tile.first_chunk = c;
    const uint32_t end_block = joints.chunks[c].first_block + Tile::kMostBlocks;
    do ++c;
    while (c < chunk_count && wanted(c) && joints.chunks[c + 1].first_block <= end_block);
    tile.end_chunk = c;
    sum_tile(rig, instance, active, tile);
    write_tile(rig, instance, lod, tile, only_group);
  }
}

}  // namespace mien
