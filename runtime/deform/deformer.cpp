// SPDX-License-Identifier: MIT
#include "runtime/deform/deformer.h"

#include <algorithm>
#include <cstring>

#include "simd/deform_kernels.h"
#include "simd/kernels.h"

namespace mien {

void mark_mesh_lods(const Rig& rig, const Span<DeformMesh>& meshes) {
  // LODs that are alike share a row, which is read once for all of them.
  const Span<uint16_t>& rows = rig.lod_meshes.row_of_lod;
  for (uint32_t l = 0; l < rows.count; ++l) {
    if (std::find(rows.begin(), rows.begin() + l, rows[l]) != rows.begin() + l) continue;
    uint64_t lods = 0;
    for (uint32_t k = l; k < rows.count; ++k) lods |= uint64_t{rows[k] == rows[l]} << k;
    for (const uint16_t mesh : rig.lod_meshes.at(l)) meshes[mesh].lods |= lods;
  }
}

const SkinRun* skin_run_of(const DeformMesh& mesh, uint32_t sorted_index) {
  const auto starts_after = [](uint32_t index, const SkinRun& run) { return index < run.first; };
  return std::upper_bound(mesh.skin_runs.begin(), mesh.skin_runs.end(), sorted_index,
                          starts_after) -
         1;
}

const float* neutral_positions(const DeformMesh& mesh, uint32_t block, float* scratch) {
  const uint32_t first = block * kBlockPositions;
  if (!mesh.sorted_positions.empty()) return mesh.sorted_positions.data + size_t{first} * 4;
  const uint32_t* indices = mesh.position_indices.data + first;
  const uint32_t count = std::min(kBlockPositions, mesh.position_count - first);
  for (uint32_t i = 0; i < count; ++i) {
    memcpy(scratch + size_t{i} * 4, mesh.positions.data + size_t{indices[i]} * 3,
           4 * sizeof(float));
  }
  return scratch;
}

void add_target_run(const KernelTable& kernels, const DeformMesh& mesh, const TargetRun& run,
                    float weight, float* positions) {
  TargetArgs args;
  args.indices = mesh.delta_indices.data + run.first_delta;
  args.positions = positions;
  args.count = run.count;
  const size_t first = size_t{run.first_delta} * 3;
  if (mesh.fixed_deltas.empty()) {
    args.deltas = mesh.deltas.data + first;
    args.weight = weight;
    kernels.add_target(args);
  } else {
    args.deltas = mesh.fixed_deltas.data + first;
    args.weight = weight * mesh.scale_of(run);
    kernels.add_target_fixed(args);
  }
}

void expand_fixed(const KernelTable& kernels, const int16_t* from, float scale, size_t count,
                  float* to) {
  kernels.floats_from_fixed(from, scale, count, to);
}

void find_influences(const DeformMesh& mesh, uint32_t position, Span<const uint16_t>& joints,
                     Span<const float>& weights) {
  const uint32_t sorted_index = mesh.sorted_indices[position];
  const SkinRun& run = *skin_run_of(mesh, sorted_index);
  const size_t row = run.first_weight + size_t{sorted_index - run.first} * run.influences;
  joints = mesh.joints.slice(row, run.influences);
  weights = mesh.weights.slice(row, run.influences);
}

void write_target(const DeformMesh& mesh, uint32_t target, float* out) {
  std::fill(out, out + size_t{mesh.position_count} * 3, 0.0f);
  const auto is_before = [](const TargetRun& run, uint32_t t) { return run.target < t; };
  for (uint32_t block = 0; block < mesh.block_count(); ++block) {
    const TargetRun* const begin = mesh.target_runs.data + mesh.first_target_run[block];
    const TargetRun* const end = mesh.target_runs.data + mesh.first_target_run[block + 1];
    for (const TargetRun* run = std::lower_bound(begin, end, target, is_before);
         run != end && run->target == target; ++run) {
      for (size_t d = run->first_delta; d < size_t{run->first_delta} + run->count; ++d) {
        const uint32_t sorted_index = block * kBlockPositions + mesh.delta_indices[d];
        float* at = out + size_t{mesh.position_indices[sorted_index]} * 3;
        for (size_t k = d * 3; k < d * 3 + 3; ++k) {
          *at++ += mesh.fixed_deltas.empty() ? mesh.deltas[k]
                                             : float(mesh.fixed_deltas[k]) * mesh.scale_of(*run);
        }
      }
    }
  }
}

}  // namespace mien
