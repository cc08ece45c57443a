// SPDX-License-Identifier: MIT
// Blend shape targets: their deltas, sorted by block of positions, then by target.
#include <cmath>

#include "runtime/load/compile/compile_deformer.h"

namespace mien {
namespace {

using dna::BlendShapeTarget;

bool is_nonzero(const BlendShapeTarget& target, uint32_t i) {
  return target.deltas.xs[i] != 0 || target.deltas.ys[i] != 0 || target.deltas.zs[i] != 0;
}

}  // namespace

Status plan_targets(const MeshSource& source, MeshPlan& plan) {
  struct Block {
    uint32_t last = 0;  // last target, + 1
  };
  const uint32_t positions = source.mesh.positions.xs.count;
  const size_t block_count = (positions + kBlockPositions - 1) / kBlockPositions;
  const Span<Block> blocks = source.scratch.array<Block>(block_count);
  if (block_count != 0 && !blocks.data) return source.no_memory();
  const auto& targets = source.mesh.blend_shape_targets;
  for (uint32_t t = 0; t < targets.count; ++t) {
    const BlendShapeTarget& target = targets[t];
    for (uint32_t i = 0; i < target.vertex_indices.count; ++i) {
      if (!std::isfinite(target.deltas.xs[i]) || !std::isfinite(target.deltas.ys[i]) ||
          !std::isfinite(target.deltas.zs[i])) {
        return fail(source.error, Status::kDnaValue,
                    source.view.offset_of(target.deltas.xs.data + i * sizeof(float)),
                    "geom.meshes[%u].blendShapeTargets[%u].deltas: element %u is not finite",
                    source.index, t, i);
      }
      if (!is_nonzero(target, i)) continue;
      ++plan.delta_count;
      Block& block = blocks[plan.sorted_indices[target.vertex_indices[i]] / kBlockPositions];
      plan.target_run_count += block.last != t + 1;
      block.last = t + 1;
    }
  }
  plan.fixed_targets = source.options.half_storage && plan.delta_count <= kMaxFixedDeltas;
  return plan.fixed_targets ? plan_fixed_targets(source, plan) : Status::kOk;
}

void place_targets(const MeshPlan& plan, Placer& placer, DeformMesh& mesh) {
  const size_t alignment = mesh.array_alignment();
  mesh.target_channels = placer.array<uint16_t>(mesh.target_count);
  mesh.first_target_run = placer.array<uint32_t>(size_t{mesh.block_count()} + 1);
  mesh.target_runs = placer.array<TargetRun>(plan.target_run_count);
  if (plan.fixed_targets) {
    const size_t words = plan.fixed_words == 0 ? 0 : plan.fixed_words + kDeltaPadding;
    mesh.fixed_deltas = placer.array<int16_t>(words, alignment);
    mesh.fixed_runs = placer.array<FixedRun>(plan.target_run_count);
  } else {
    mesh.deltas = placer.array<float>(plan.delta_count * 3 + 1, alignment);
    mesh.delta_indices = placer.array<uint16_t>(plan.delta_count, alignment);
  }
}

// A counting sort with two passes over all deltas: the first counts the runs and deltas of each
// block, the second writes them.
// Targets are visited in ascending order, so a block's runs ascend too.
Status fill_targets(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh) {
  struct Block {
    uint32_t last;  // last target, + 1
    uint32_t run, delta;
  };
  const auto& targets = source.mesh.blend_shape_targets;
  for (uint32_t t = 0; t < targets.count; ++t) mesh.target_channels[t] = targets[t].channel_index;
  if (plan.fixed_targets) return fill_fixed_targets(source, plan, mesh);
  const Span<Block> blocks = source.scratch.array<Block>(mesh.block_count());
  if (mesh.block_count() != 0 && !blocks.data) return source.no_memory();

  const auto for_each_delta = [&](auto&& f) {
    for (uint32_t t = 0; t < targets.count; ++t) {
      for (uint32_t i = 0; i < targets[t].vertex_indices.count; ++i) {
        if (is_nonzero(targets[t], i)) f(t, i, plan.sorted_indices[targets[t].vertex_indices[i]]);
      }
    }
  };
  for_each_delta([&](uint32_t t, uint32_t, uint32_t sorted_index) {
    Block& block = blocks[sorted_index / kBlockPositions];
    block.run += block.last != t + 1;
    block.last = t + 1;
    ++block.delta;
  });
  uint32_t run = 0, delta = 0;
  for (uint32_t b = 0; b < mesh.block_count(); ++b) {
    mesh.first_target_run[b] = run;
    run += blocks[b].run;
    delta += blocks[b].delta;
    blocks[b] = {0, mesh.first_target_run[b], delta - blocks[b].delta};
  }
  mesh.first_target_run[mesh.block_count()] = run;

  for_each_delta([&](uint32_t t, uint32_t i, uint32_t sorted_index) {
    Block& block = blocks[sorted_index / kBlockPositions];
    if (block.last != t + 1) {
      mesh.target_runs[block.run++] = {t, targets[t].channel_index, block.delta, 0};
    }
    block.last = t + 1;
    ++mesh.target_runs[block.run - 1].count;
    mesh.delta_indices[block.delta] = static_cast<uint16_t>(sorted_index % kBlockPositions);
    const size_t at = size_t{block.delta++} * 3;
    mesh.deltas[at] = targets[t].deltas.xs[i];
    mesh.deltas[at + 1] = targets[t].deltas.ys[i];
    mesh.deltas[at + 2] = targets[t].deltas.zs[i];
  });
  return Status::kOk;
}

}  // namespace mien
