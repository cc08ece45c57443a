// SPDX-License-Identifier: MIT
// Blend shape targets: their deltas, sorted by block of positions, then by target.
#include <algorithm>
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
  const uint32_t positions = source.mesh.positions.xs.count;
  const size_t blocks = (positions + kBlockPositions - 1) / kBlockPositions;
  const Span<uint32_t> previous = source.scratch.array<uint32_t>(blocks);  // its last target, + 1
  if (blocks != 0 && !previous.data) return source.no_memory();
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
      uint32_t& last = previous[plan.sorted_indices[target.vertex_indices[i]] / kBlockPositions];
      plan.target_run_count += last != t + 1;
      last = t + 1;
    }
  }
  return Status::kOk;
}

void place_targets(const MeshPlan& plan, bool half_storage, Placer& placer, DeformMesh& mesh) {
  const size_t alignment = mesh.array_alignment();
  mesh.target_channels = placer.array<uint16_t>(mesh.target_count);
  mesh.first_target_run = placer.array<uint32_t>(size_t{mesh.block_count()} + 1);
  mesh.target_runs = placer.array<TargetRun>(plan.target_run_count);
  const size_t numbers = plan.delta_count * 3 + 1;
  mesh.deltas = placer.array<float>(half_storage ? 0 : numbers, alignment);
  mesh.fixed_deltas = placer.array<int16_t>(half_storage ? numbers : 0, alignment);
  mesh.delta_scales = placer.array<float>(half_storage ? plan.target_run_count : 0);
  mesh.delta_indices = placer.array<uint16_t>(plan.delta_count, alignment);
}

// A counting sort with two passes over all deltas: the first counts the runs and deltas of each
// block, the second writes them. 16-bit storage takes a third one: the second finds the scales of runs.
// Targets are visited in ascending order, so a block's runs ascend too.
Status fill_targets(const MeshSource& source, DeformMesh& mesh) {
  struct Block {
    uint32_t last;  // last target, + 1
    uint32_t run, delta;
  };
  const auto& targets = source.mesh.blend_shape_targets;
  const Span<Block> blocks = source.scratch.array<Block>(mesh.block_count());
  if (mesh.block_count() != 0 && !blocks.data) return source.no_memory();

  const auto for_each_delta = [&](auto&& f) {
    for (uint32_t t = 0; t < targets.count; ++t) {
      for (uint32_t i = 0; i < targets[t].vertex_indices.count; ++i) {
        if (is_nonzero(targets[t], i)) f(t, i, mesh.sorted_indices[targets[t].vertex_indices[i]]);
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
    const float xyz[] = {targets[t].deltas.xs[i], targets[t].deltas.ys[i], targets[t].deltas.zs[i]};
    const size_t at = size_t{block.delta++} * 3;
    if (mesh.fixed_deltas.empty()) {
      std::copy(xyz, xyz + 3, mesh.deltas.data + at);
      return;
    }
    float& scale = mesh.delta_scales[block.run - 1];
    for (const float part : xyz) scale = std::max(scale, std::fabs(part) / 32767);
  });
  if (!mesh.fixed_deltas.empty()) {
    for (uint32_t b = 0; b < mesh.block_count(); ++b) {
      const uint32_t first = mesh.first_target_run[b];
      const bool any = first != mesh.first_target_run[b + 1];
      blocks[b] = {0, first, any ? mesh.target_runs[first].first_delta : 0};
    }
    for_each_delta([&](uint32_t t, uint32_t i, uint32_t sorted_index) {
      Block& block = blocks[sorted_index / kBlockPositions];
      block.run += block.last != t + 1;
      block.last = t + 1;
      const float scale = mesh.delta_scales[block.run - 1];
      int16_t* const at = mesh.fixed_deltas.data + size_t{block.delta++} * 3;
      at[0] = in_units(double{targets[t].deltas.xs[i]}, scale);
      at[1] = in_units(double{targets[t].deltas.ys[i]}, scale);
      at[2] = in_units(double{targets[t].deltas.zs[i]}, scale);
    });
  }
  for (uint32_t t = 0; t < targets.count; ++t) mesh.target_channels[t] = targets[t].channel_index;
  return Status::kOk;
}

}  // namespace mien
