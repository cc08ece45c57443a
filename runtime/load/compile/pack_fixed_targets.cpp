// SPDX-License-Identifier: MIT
// Blend shape targets in 16-bit storage: groups and integers, as FixedRun says.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>

#include "runtime/load/compile/compile_deformer.h"
#include "simd/deform_kernels.h"

namespace mien {
namespace {

using dna::BlendShapeTarget;

constexpr float kPackedLimit = 511;  // largest number of 10 bits
constexpr uint32_t kGroups = kBlockPositions / kGroupPositions;

/// Packed numbers are off by at most 2^-18 of the size of the mesh, or as much as the caller allows.
float largest_packed_of(const dna::Vec3Array& positions, double delta_error) {
  float size = 0;
  for (const auto* axis : {&positions.xs, &positions.ys, &positions.zs}) {
    float least = INFINITY, most = -INFINITY;
    for (uint32_t i = 0; i < axis->count; ++i) {
      least = std::min(least, (*axis)[i]);
      most = std::max(most, (*axis)[i]);
    }
    size = std::max(size, most - least);
  }
  const double asked = std::min(delta_error * 2 * double{kPackedLimit}, double{FLT_MAX});
  return std::max(size * (2 * kPackedLimit / 0x1p18f), static_cast<float>(asked));
}

/// One target, spread over the positions of its mesh.
struct SpreadTarget {
  struct Block {
    uint8_t masks[kGroups];
    bool touched;
  };
  Span<float> deltas;  // [sorted index] x y z, where a mask says so
  Span<Block> blocks;
  Span<uint32_t> touched;  // blocks, ascending
  size_t touched_count = 0;

  /// False if memory ran out.
  bool start(const MeshSource& source) {
    const uint32_t positions = source.mesh.positions.xs.count;
    const size_t block_count = (positions + kBlockPositions - 1) / kBlockPositions;
    deltas = source.scratch.array<float>(size_t{positions} * 3);
    blocks = source.scratch.array<Block>(block_count);
    touched = source.scratch.array<uint32_t>(block_count);
    return block_count == 0 || (deltas.data && blocks.data && touched.data);
  }
  /// Deltas that a file lists for the same position are added.
  void spread(const BlendShapeTarget& target, Span<const uint32_t> sorted_indices) {
    for (size_t k = 0; k < touched_count; ++k) blocks[touched[k]] = {};
    touched_count = 0;
    for (uint32_t i = 0; i < target.vertex_indices.count; ++i) {
      const float xyz[3] = {target.deltas.xs[i], target.deltas.ys[i], target.deltas.zs[i]};
      if (xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0) continue;
      const uint32_t at = sorted_indices[target.vertex_indices[i]];
      Block& block = blocks[at / kBlockPositions];
      if (!block.touched) touched[touched_count++] = at / kBlockPositions;
      block.touched = true;
      uint8_t& mask = block.masks[at % kBlockPositions / kGroupPositions];
      const auto bit = static_cast<uint8_t>(1u << at % kGroupPositions);
      float* to = deltas.data + size_t{at} * 3;
      for (int k = 0; k < 3; ++k) {
        const float sum = (mask & bit) != 0 ? to[k] + xyz[k] : xyz[k];
        to[k] = std::clamp(sum, -FLT_MAX, FLT_MAX);
      }
      mask = static_cast<uint8_t>(mask | bit);
    }
    std::sort(touched.data, touched.data + touched_count);
  }
  /// Calls f(x y z) for each delta of a block.
  template <class F>
  void for_each(uint32_t block, F&& f) const {
    for (uint32_t g = 0; g < kGroups; ++g) {
      const size_t first = size_t{block} * kBlockPositions + g * kGroupPositions;
      for (uint32_t bits = blocks[block].masks[g]; bits != 0; bits &= bits - 1) {
        f(static_cast<const float*>(deltas.data + (first + lowest_bit(bits)) * 3));
      }
    }
  }
};

/// The run that a target makes in a block.
struct SpreadRun {
  uint32_t groups = 0, count = 0;
  float largest = 0;
  bool packed = false;

  SpreadRun(const SpreadTarget& target, uint32_t block, float largest_packed) {
    for (const uint8_t mask : target.blocks[block].masks) groups += mask != 0;
    target.for_each(block, [&](const float* xyz) {
      ++count;
      for (int k = 0; k < 3; ++k) largest = std::max(largest, std::fabs(xyz[k]));
    });
    packed = largest <= largest_packed;
  }
  size_t size() const { return groups + size_t{count} * (packed ? 2 : 3); }
};

}  // namespace

Status plan_fixed_targets(const MeshSource& source, MeshPlan& plan) {
  SpreadTarget spread;
  if (source.mesh.blend_shape_targets.count == 0) return Status::kOk;
  if (!spread.start(source)) return source.no_memory();
  plan.fixed_blocks = source.scratch.array<FixedBlock>(spread.blocks.count);
  if (!plan.fixed_blocks.data && spread.blocks.count != 0) return source.no_memory();
  plan.largest_packed = largest_packed_of(source.mesh.positions, source.options.delta_error);
  plan.delta_count = 0;
  for (const BlendShapeTarget& target : source.mesh.blend_shape_targets) {
    spread.spread(target, plan.sorted_indices);
    for (size_t k = 0; k < spread.touched_count; ++k) {
      const SpreadRun run(spread, spread.touched[k], plan.largest_packed);
      FixedBlock& block = plan.fixed_blocks[spread.touched[k]];
      ++block.runs;
      block.deltas += run.count;
      block.words += run.size();
      plan.delta_count += run.count;
      plan.fixed_words += run.size();
    }
  }
  return Status::kOk;
}

Status fill_fixed_targets(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh) {
  SpreadTarget spread;
  if (!spread.start(source)) return source.no_memory();
  // From what each block takes to where its next run begins.
  FixedBlock next;
  for (uint32_t b = 0; b < plan.fixed_blocks.count; ++b) {
    const FixedBlock taken = plan.fixed_blocks[b];
    mesh.first_target_run[b] = next.runs;
    plan.fixed_blocks[b] = next;
    next = {next.runs + taken.runs, next.deltas + taken.deltas, next.words + taken.words};
  }
  mesh.first_target_run[mesh.block_count()] = next.runs;
  const auto& targets = source.mesh.blend_shape_targets;
  for (uint32_t t = 0; t < targets.count; ++t) {
    spread.spread(targets[t], plan.sorted_indices);
    for (size_t k = 0; k < spread.touched_count; ++k) {
      const uint32_t b = spread.touched[k];
      const SpreadRun run(spread, b, plan.largest_packed);
      FixedBlock& at = plan.fixed_blocks[b];
      const float scale = run.largest / (run.packed ? kPackedLimit : 32767);
      mesh.target_runs[at.runs] = {t, targets[t].channel_index, at.deltas, run.count};
      mesh.fixed_runs[at.runs] = {scale, static_cast<uint32_t>(2 * at.words + run.packed),
                                  run.groups};
      int16_t* to = mesh.fixed_deltas.data + at.words;
      for (uint32_t g = 0; g < kGroups; ++g) {
        const uint32_t mask = spread.blocks[b].masks[g];
        if (mask != 0) *to++ = static_cast<int16_t>(g << 4 | mask);
      }
      spread.for_each(b, [&](const float* xyz) {
        int16_t numbers[3];
        for (int axis = 0; axis < 3; ++axis) numbers[axis] = in_units(double{xyz[axis]}, scale);
        if (run.packed) {
          uint32_t bits = 0;
          for (int axis = 0; axis < 3; ++axis) {
            bits |= (static_cast<uint32_t>(numbers[axis]) & 1023) << 10 * axis;
          }
          memcpy(to, &bits, sizeof(bits));
          to += 2;
        } else {
          to = std::copy(numbers, numbers + 3, to);
        }
      });
      ++at.runs;
      at.deltas += run.count;
      at.words += run.size();
    }
  }
  return Status::kOk;
}

}  // namespace mien
