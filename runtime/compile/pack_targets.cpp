// SPDX-License-Identifier: MIT
// Blend shape targets, cut along the blocks of places.
#include <algorithm>
#include <cmath>

#include "runtime/compile/compile_deformer.h"

namespace mien {
namespace {

using dna::BlendShapeTarget;

bool moves(const BlendShapeTarget& target, uint32_t i) {
  return target.deltas.xs[i] != 0 || target.deltas.ys[i] != 0 || target.deltas.zs[i] != 0;
}

}  // namespace

Status plan_targets(const MeshSource& source, MeshPlan& plan) {
  const uint32_t positions = source.mesh.positions.xs.count;
  const size_t blocks = (positions + kBlockPlaces - 1) / kBlockPlaces;
  const Span<uint32_t> last = source.scratch.array<uint32_t>(blocks);  // target + 1 seen last
  if (blocks != 0 && !last.data) return source.no_memory();
  const auto& targets = source.mesh.blend_shape_targets;
  for (uint32_t t = 0; t < targets.count; ++t) {
    const BlendShapeTarget& target = targets[t];
    for (uint32_t i = 0; i < target.vertex_indices.count; ++i) {
      if (!std::isfinite(target.deltas.xs[i]) || !std::isfinite(target.deltas.ys[i]) ||
          !std::isfinite(target.deltas.zs[i])) {
        return fail(source.error, Status::kDnaValue,
                    source.view.offset_of(target.deltas.xs.data + i * sizeof(float)),
                    "geom.meshes[%u].blendShapeTargets[%u].deltas: element %u is not finite",
                    source.number, t, i);
      }
      if (!moves(target, i)) continue;
      ++plan.delta_count;
      uint32_t& seen = last[plan.place_of[target.vertex_indices[i]] / kBlockPlaces];
      plan.piece_count += seen != t + 1;
      seen = t + 1;
    }
  }
  return Status::kOk;
}

void place_targets(const MeshPlan& plan, Placer& placer, DeformMesh& mesh) {
  mesh.target_channels = placer.array<uint16_t>(mesh.target_count);
  mesh.first_piece = placer.array<uint32_t>(size_t{mesh.block_count()} + 1);
  mesh.pieces = placer.array<TargetPiece>(plan.piece_count);
  mesh.deltas = placer.array<float>(plan.delta_count * 3 + 1, kBlockAlignment);
  mesh.delta_places = placer.array<uint16_t>(plan.delta_count, kBlockAlignment);
}

// Counting sort, twice over all deltas: how many pieces and deltas each block has, then where each
// of them goes. Targets come in ascending order, so the pieces of a block do too.
Status fill_targets(const MeshSource& source, DeformMesh& mesh) {
  struct Block {
    uint32_t last;  // target + 1 seen last
    uint32_t piece, delta;
  };
  const auto& targets = source.mesh.blend_shape_targets;
  const Span<Block> blocks = source.scratch.array<Block>(mesh.block_count());
  if (mesh.block_count() != 0 && !blocks.data) return source.no_memory();

  const auto for_each_delta = [&](auto&& f) {
    for (uint32_t t = 0; t < targets.count; ++t) {
      for (uint32_t i = 0; i < targets[t].vertex_indices.count; ++i) {
        if (moves(targets[t], i)) f(t, i, mesh.place_of[targets[t].vertex_indices[i]]);
      }
    }
  };
  for_each_delta([&](uint32_t t, uint32_t, uint32_t place) {
    Block& block = blocks[place / kBlockPlaces];
    block.piece += block.last != t + 1;
    block.last = t + 1;
    ++block.delta;
  });
  uint32_t piece = 0, delta = 0;
  for (uint32_t b = 0; b < mesh.block_count(); ++b) {
    mesh.first_piece[b] = piece;
    piece += blocks[b].piece;
    delta += blocks[b].delta;
    blocks[b] = {0, mesh.first_piece[b], delta - blocks[b].delta};
  }
  mesh.first_piece[mesh.block_count()] = piece;

  for_each_delta([&](uint32_t t, uint32_t i, uint32_t place) {
    Block& block = blocks[place / kBlockPlaces];
    if (block.last != t + 1) {
      mesh.pieces[block.piece++] = {t, targets[t].channel_index, block.delta, 0};
    }
    block.last = t + 1;
    ++mesh.pieces[block.piece - 1].count;
    float* at = mesh.deltas.data + size_t{block.delta} * 3;
    at[0] = targets[t].deltas.xs[i];
    at[1] = targets[t].deltas.ys[i];
    at[2] = targets[t].deltas.zs[i];
    mesh.delta_places[block.delta++] = static_cast<uint16_t>(place % kBlockPlaces);
  });
  for (uint32_t t = 0; t < targets.count; ++t) mesh.target_channels[t] = targets[t].channel_index;
  return Status::kOk;
}

}  // namespace mien
