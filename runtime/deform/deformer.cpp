// SPDX-License-Identifier: MIT
#include "runtime/deform/deformer.h"

#include <algorithm>
#include <cstring>

#include "runtime/base/arena.h"
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
  const uint16_t* places = mesh.position_indices.data + first;
  const float* window = mesh.positions.data + size_t{window_of(first)} * 3;
  const uint32_t count = std::min(kBlockPositions, mesh.position_count - first);
  for (uint32_t i = 0; i < count; ++i) {
    memcpy(scratch + size_t{i} * 4, window + size_t{places[i]} * 3, 4 * sizeof(float));
  }
  return scratch;
}

void add_target_run(const KernelTable& kernels, const DeformMesh& mesh, const TargetRun& run,
                    float weight, float* positions) {
  if (mesh.fixed_deltas.empty()) {
    return kernels.add_target({mesh.deltas.data + size_t{run.first_delta} * 3,
                               mesh.delta_indices.data + run.first_delta, positions, weight,
                               run.count});
  }
  const FixedRun& fixed = mesh.fixed_run_of(run);
  const int16_t* const words = mesh.fixed_deltas.data;
  const FixedTargetArgs args = {reinterpret_cast<const uint16_t*>(words + fixed.first_word()),
                                words + fixed.first_delta(), positions, weight * fixed.scale,
                                fixed.groups};
  fixed.is_packed() ? kernels.add_target_packed(args) : kernels.add_target_fixed(args);
}

void read_fixed_delta(const FixedRun& run, const int16_t* words, float* xyz) {
  uint32_t packed;
  memcpy(&packed, words, sizeof(packed));
  for (int k = 0; k < 3; ++k) {
    const int32_t number =
        run.is_packed() ? static_cast<int32_t>(packed << (22 - 10 * k)) >> 22 : words[k];
    xyz[k] = static_cast<float>(number) * run.scale;
  }
}

void expand_fixed(const KernelTable& kernels, const int16_t* from, float scale, size_t count,
                  float* to) {
  kernels.floats_from_fixed(from, scale, count, to);
}

void find_influences(const DeformMesh& mesh, uint32_t position, Span<const uint16_t>& joints,
                     Span<const float>& weights) {
  uint32_t sorted_index = window_of(position);
  while (mesh.position_of(sorted_index) != position) ++sorted_index;
  const SkinRun& run = *skin_run_of(mesh, sorted_index);
  const size_t row = run.first_weight + size_t{sorted_index - run.first} * run.influences;
  joints = mesh.joints.slice(row, run.influences);
  weights = mesh.weights.slice(row, run.influences);
}

bool write_triangles(const DeformMesh& mesh, const Allocator& allocator, uint32_t* out) {
  if (!mesh.triangles_follow()) {
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), out);
    return true;
  }
  constexpr uint32_t kSeveral = ~uint32_t{0};  // or none
  Arena scratch(allocator);
  const Span<uint32_t> vertex_of = scratch.array<uint32_t>(mesh.position_count);
  if (!vertex_of.data && mesh.position_count != 0) return false;
  for (uint32_t i = 0; i < mesh.position_count; ++i) {
    const uint32_t first = mesh.first_vertex[i];
    const bool one = mesh.first_vertex[i + 1] - first == 1;
    vertex_of[mesh.position_of(i)] = one ? mesh.vertices[first] & ~kHardEdge : kSeveral;
  }
  size_t next = 0;
  for (size_t f = 0; f < mesh.face_count(); ++f) {
    uint32_t corners[4];
    const int count = mesh.face_corners(f, corners);
    for (int k = 0; k < count; ++k) {
      uint32_t vertex = vertex_of[corners[k]];
      // A damaged file may list too few.
      if (vertex == kSeveral) {
        vertex = next < mesh.corner_vertices.count ? mesh.corner_vertices[next++] : 0;
      }
      corners[k] = vertex;
    }
    for (int k = 2; k < count; ++k) {
      *out++ = corners[0];
      *out++ = corners[k - 1];
      *out++ = corners[k];
    }
  }
  return true;
}

void write_texture_coordinates(const DeformMesh& mesh, float* out) {
  if (mesh.fixed_coordinates.empty()) {
    std::copy(mesh.texture_coordinates.begin(), mesh.texture_coordinates.end(), out);
    return;
  }
  const float* const origin = mesh.texture_coordinates.data;
  const float* const step = origin + 2;
  for (size_t i = 0; i < mesh.fixed_coordinates.count; ++i) {
    out[i] = origin[i % 2] + static_cast<float>(mesh.fixed_coordinates[i]) * step[i % 2];
  }
}

void write_target(const DeformMesh& mesh, uint32_t target, float* out) {
  std::fill(out, out + size_t{mesh.position_count} * 3, 0.0f);
  const auto is_before = [](const TargetRun& run, uint32_t t) { return run.target < t; };
  for (uint32_t block = 0; block < mesh.block_count(); ++block) {
    const TargetRun* const begin = mesh.target_runs.data + mesh.first_target_run[block];
    const TargetRun* const end = mesh.target_runs.data + mesh.first_target_run[block + 1];
    for (const TargetRun* run = std::lower_bound(begin, end, target, is_before);
         run != end && run->target == target; ++run) {
      for_each_delta(mesh, *run, [&](uint32_t index, const float* delta) {
        float* at = out + size_t{mesh.position_of(block * kBlockPositions + index)} * 3;
        for (int k = 0; k < 3; ++k) at[k] += delta[k];
      });
    }
  }
}

}  // namespace mien
