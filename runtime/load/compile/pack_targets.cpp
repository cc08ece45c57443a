// SPDX-License-Identifier: MIT
// Blend shape targets: their deltas, sorted by block of positions, then by target.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/load/compile/compile_deformer.h"

namespace mien {
namespace {

using dna::BlendShapeTarget;

constexpr float kPackedLimit = 511;  // largest number of 10 bits

bool is_nonzero(const BlendShapeTarget& target, uint32_t i) {
  return target.deltas.xs[i] != 0 || target.deltas.ys[i] != 0 || target.deltas.zs[i] != 0;
}

/// Packed numbers are off by at most 2^-18 of the size of the mesh.
float largest_packed(const dna::Vec3Array& positions) {
  float size = 0;
  for (const auto* axis : {&positions.xs, &positions.ys, &positions.zs}) {
    float least = INFINITY, most = -INFINITY;
    for (uint32_t i = 0; i < axis->count; ++i) {
      least = std::min(least, (*axis)[i]);
      most = std::max(most, (*axis)[i]);
    }
    size = std::max(size, most - least);
  }
  return size * (2 * kPackedLimit / 0x1p18f);
}

float magnitude(const BlendShapeTarget& target, uint32_t i) {
  return std::max({std::fabs(target.deltas.xs[i]), std::fabs(target.deltas.ys[i]),
                   std::fabs(target.deltas.zs[i])});
}

}  // namespace

Status plan_targets(const MeshSource& source, MeshPlan& plan) {
  struct Block {
    uint32_t last = 0;  // last target, + 1
    uint32_t count = 0;
    float largest = 0;
  };
  const uint32_t positions = source.mesh.positions.xs.count;
  const size_t block_count = (positions + kBlockPositions - 1) / kBlockPositions;
  const Span<Block> blocks = source.scratch.array<Block>(block_count);
  if (block_count != 0 && !blocks.data) return source.no_memory();
  plan.largest_packed = largest_packed(source.mesh.positions);
  const auto end_run = [&](Block& block) {
    plan.fixed_words += size_t{block.count} * (block.largest <= plan.largest_packed ? 2 : 3);
    block.count = 0;
    block.largest = 0;
  };
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
      if (block.last != t + 1) {
        end_run(block);
        ++plan.target_run_count;
      }
      block.last = t + 1;
      ++block.count;
      block.largest = std::max(block.largest, magnitude(target, i));
    }
  }
  for (Block& block : blocks) end_run(block);
  return Status::kOk;
}

void place_targets(const MeshPlan& plan, bool half_storage, Placer& placer, DeformMesh& mesh) {
  const size_t alignment = mesh.array_alignment();
  mesh.target_channels = placer.array<uint16_t>(mesh.target_count);
  mesh.first_target_run = placer.array<uint32_t>(size_t{mesh.block_count()} + 1);
  mesh.target_runs = placer.array<TargetRun>(plan.target_run_count);
  const bool fixed = half_storage && plan.delta_count <= kMaxFixedDeltas;
  mesh.deltas = placer.array<float>(fixed ? 0 : plan.delta_count * 3 + 1, alignment);
  mesh.fixed_deltas = placer.array<int16_t>(fixed ? plan.fixed_words + 1 : 0, alignment);
  mesh.fixed_runs = placer.array<FixedRun>(fixed ? plan.target_run_count : 0);
  mesh.delta_indices = placer.array<uint16_t>(plan.delta_count, alignment);
}

// A counting sort with two passes over all deltas: the first counts the runs and deltas of each
// block, the second writes them. 16-bit storage takes a third one: the second finds the largest
// number of each run.
// Targets are visited in ascending order, so a block's runs ascend too.
Status fill_targets(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh) {
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
    if (mesh.fixed_deltas.empty()) {
      mesh.deltas[at] = targets[t].deltas.xs[i];
      mesh.deltas[at + 1] = targets[t].deltas.ys[i];
      mesh.deltas[at + 2] = targets[t].deltas.zs[i];
    } else {
      float& largest = mesh.fixed_runs[block.run - 1].scale;
      largest = std::max(largest, magnitude(targets[t], i));
    }
  });
  if (!mesh.fixed_deltas.empty()) {
    size_t word = 0;
    for (uint32_t r = 0; r < run; ++r) {
      FixedRun& fixed = mesh.fixed_runs[r];
      const bool packed = fixed.scale <= plan.largest_packed;
      fixed = {fixed.scale / (packed ? kPackedLimit : 32767),
               static_cast<uint32_t>(2 * word + packed)};
      word += mesh.target_runs[r].count * fixed.words_per_delta();
    }
    for (uint32_t b = 0; b < mesh.block_count(); ++b) {
      const uint32_t first = mesh.first_target_run[b];
      const bool any = first != mesh.first_target_run[b + 1];
      blocks[b] = {0, first, any ? mesh.target_runs[first].first_delta : 0};
    }
    for_each_delta([&](uint32_t t, uint32_t i, uint32_t sorted_index) {
      Block& block = blocks[sorted_index / kBlockPositions];
      block.run += block.last != t + 1;
      block.last = t + 1;
      const FixedRun& fixed = mesh.fixed_runs[block.run - 1];
      const uint32_t place = block.delta++ - mesh.target_runs[block.run - 1].first_delta;
      int16_t* const to =
          mesh.fixed_deltas.data + fixed.first_word() + place * fixed.words_per_delta();
      const dna::Vec3Array& deltas = targets[t].deltas;
      const int16_t numbers[] = {in_units(double{deltas.xs[i]}, fixed.scale),
                                 in_units(double{deltas.ys[i]}, fixed.scale),
                                 in_units(double{deltas.zs[i]}, fixed.scale)};
      if (fixed.is_packed()) {
        uint32_t packed = 0;
        for (int k = 0; k < 3; ++k) packed |= static_cast<uint32_t>(numbers[k] + 512) << 10 * k;
        memcpy(to, &packed, sizeof(packed));
      } else {
        std::copy(numbers, numbers + 3, to);
      }
    });
  }
  for (uint32_t t = 0; t < targets.count; ++t) mesh.target_channels[t] = targets[t].channel_index;
  return Status::kOk;
}

}  // namespace mien
