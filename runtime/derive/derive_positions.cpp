// SPDX-License-Identifier: MIT
// Derivatives of positions by skin matrices and channel weights (docs/derivatives.md, 7):
//
//     position = S p + t,  p = neutral + sum of weight * delta
//     forward    dS p + dt + S dp, by the kernels that deform
//     reverse    gradients of S and t, and of p, which give those of the weights
//
// One direction at a time; a block whose positions do not move is skipped.
#include <cmath>
#include <cstring>

#include "runtime/deform/deform.h"
#include "runtime/derive/derive_stages.h"
#include "simd/deform_kernels.h"
#include "simd/derivative_kernels.h"

namespace mien {
namespace {

/// Calls f(run, first sorted position, count) for the parts of skin runs in a block.
template <class F>
void for_each_run(const DeformMesh& mesh, uint32_t block, F&& f) {
  const uint32_t first = block * kBlockPositions;
  const uint32_t end = std::min(first + kBlockPositions, mesh.position_count);
  for (const SkinRun* run = skin_run_of(mesh, first);
       run != mesh.skin_runs.end() && run->first < end; ++run) {
    const uint32_t from = std::max(run->first, first);
    f(*run, from, std::min(run->first + run->count, end) - from);
  }
}

template <class F>
void for_each_target(const DeformMesh& mesh, uint32_t block, F&& f) {
  for (uint32_t i = mesh.first_target_run[block]; i < mesh.first_target_run[block + 1]; ++i) {
    f(mesh.target_runs[i]);
  }
}

/// The positions of a block before skinning; `shaped` has room for them.
const float* shape(const Derivatives& d, const DeformMesh& mesh, uint32_t block) {
  const uint32_t first = block * kBlockPositions;
  const float* neutral = neutral_positions(mesh, block, d.shaped.data);
  const size_t count = std::min(kBlockPositions, mesh.position_count - first);
  const float* positions = neutral;
  for_each_target(mesh, block, [&](const TargetRun& run) {
    const float weight = d.channels[run.channel];
    if (std::fabs(weight) < kMinChannelWeight) return;
    if (positions != d.shaped.data) {
      memcpy(d.shaped.data, neutral, count * 4 * sizeof(float));
      positions = d.shaped.data;
    }
    add_target_run(*d.deformer->kernels, mesh, run, weight, d.shaped.data);
  });
  return positions;
}

/// Skins part of a run of positions, given from the beginning of its block, into `out` in file order.
void skin(const Derivatives& d, const DeformMesh& mesh, const SkinRun& run, uint32_t first,
          uint32_t count, const float* positions, const float* matrices, float* out) {
  SkinArgs args = {};
  args.matrices = matrices;
  args.out_positions = out + size_t{window_of(first)} * 3;
  args.vertices = mesh.vertices.data;
  args.influences = run.influences;
  args.mode = SkinNormals::kNone;
  const KernelTable& kernels = *d.deformer->kernels;
  for_each_weights(
      kernels, mesh, run, first, count, [&](uint32_t at, uint32_t part, const float* weights) {
        args.positions = positions + size_t{at % kBlockPositions} * 4;
        args.weights = weights;
        args.joints = mesh.joints.data + run.first_weight + size_t{at - run.first} * run.influences;
        args.position_indices = mesh.position_indices.data + at;
        args.first_vertex = mesh.first_vertex.data + at;
        args.count = part;
        kernels.skin_positions(args);
      });
}

/// Skin matrices without their translation.
void set_linear_matrices(Derivatives& d) {
  std::copy(d.pose.skin.begin(), d.pose.skin.end(), d.linear_matrices.begin());
  for (size_t i = 0; i < d.linear_matrices.count; i += kMatrixFloats) {
    std::fill(d.linear_matrices.data + i + 12, d.linear_matrices.data + i + 15, 0.0f);
  }
}

}  // namespace

void push_positions(Derivatives& d, uint32_t mesh_index, uint32_t lane, uint32_t lanes,
                    float* out) {
  const DeformMesh& mesh = d.deformer->meshes[mesh_index];
  const size_t joints = d.deformer->skeleton.joint_count;
  for (size_t j = 0; j < joints; ++j) {
    const float* from = d.skins.data + j * kMatrixParts * lanes + lane;
    float* to = d.matrices.data + j * kMatrixFloats;
    for (size_t c = 0; c < 4; ++c) {
      for (size_t r = 0; r < 3; ++r) to[4 * c + r] = from[(3 * c + r) * lanes];
      to[4 * c + 3] = 0.0f;
    }
  }
  bool any_weight = false;
  for (size_t c = 0; c < d.rig->channel_count; ++c) any_weight |= d.weights[c * lanes + lane] != 0;
  if (any_weight) set_linear_matrices(d);
  for (uint32_t block = 0; block < mesh.block_count(); ++block) {
    const float* positions = shape(d, mesh, block);
    const size_t count = std::min(kBlockPositions, mesh.position_count - block * kBlockPositions);
    bool moved = false;
    if (any_weight) {
      for_each_target(mesh, block, [&](const TargetRun& run) {
        const float weight = d.weights[size_t{run.channel} * lanes + lane];
        if (weight == 0.0f) return;
        if (!moved) memset(d.shaped_change.data, 0, count * 4 * sizeof(float));
        moved = true;
        add_target_run(*d.deformer->kernels, mesh, run, weight, d.shaped_change.data);
      });
    }
    for_each_run(mesh, block, [&](const SkinRun& run, uint32_t first, uint32_t n) {
      const auto at = [&](uint32_t i) { return out + size_t{mesh.position_of(first + i)} * 3; };
      const float* change = d.shaped_change.data + size_t{first % kBlockPositions} * 4;
      if (run.influences == 0) {
        for (uint32_t i = 0; i < n; ++i) {
          for (size_t r = 0; r < 3; ++r) {
            at(i)[r] = moved ? change[size_t{i} * 4 + r] : 0.0f;
          }
        }
        return;
      }
      skin(d, mesh, run, first, n, positions, d.matrices.data, out);
      if (!moved) return;
      float* rest = d.skinned_change.data;
      skin(d, mesh, run, first, n, d.shaped_change.data, d.linear_matrices.data, rest);
      for (uint32_t i = 0; i < n; ++i) {
        float* to = at(i);
        for (size_t r = 0; r < 3; ++r) to[r] += rest[to - out + r];
      }
    });
  }
}

void pull_positions(Derivatives& d, uint32_t mesh_index, uint32_t lane, uint32_t lanes,
                    const float* gradients) {
  const DeformMesh& mesh = d.deformer->meshes[mesh_index];
  const size_t joints = d.deformer->skeleton.joint_count;
  // The kernel reads a float past the last one.
  std::copy(gradients, gradients + size_t{mesh.position_count} * 3, d.skinned_change.data);
  d.skinned_change[size_t{mesh.position_count} * 3] = 0.0f;
  std::fill(d.matrices.data, d.matrices.data + joints * kMatrixParts, 0.0f);
  const bool has_targets = mesh.target_count != 0;
  for (uint32_t block = 0; block < mesh.block_count(); ++block) {
    const bool shapes =
        has_targets && mesh.first_target_run[block] != mesh.first_target_run[block + 1];
    const float* positions = shape(d, mesh, block);
    for_each_run(mesh, block, [&](const SkinRun& run, uint32_t first, uint32_t n) {
      float* change = d.shaped_change.data + size_t{first % kBlockPositions} * 4;
      if (run.influences == 0) {
        for (uint32_t i = 0; i < n; ++i) {
          const float* g = d.skinned_change.data + size_t{mesh.position_of(first + i)} * 3;
          for (size_t r = 0; r < 3; ++r) change[size_t{i} * 4 + r] = g[r];
        }
        return;
      }
      SkinTransposedArgs args;
      args.gradients = d.skinned_change.data + size_t{window_of(first)} * 3;
      args.skins = d.pose.skin.data;
      args.matrices = d.matrices.data;
      args.influences = run.influences;
      const KernelTable& kernels = *d.deformer->kernels;
      for_each_weights(
          kernels, mesh, run, first, n, [&](uint32_t at, uint32_t part, const float* weights) {
            args.positions = positions + size_t{at % kBlockPositions} * 4;
            args.weights = weights;
            args.joints =
                mesh.joints.data + run.first_weight + size_t{at - run.first} * run.influences;
            args.position_indices = mesh.position_indices.data + at;
            args.out_positions = shapes ? change + size_t{at - first} * 4 : nullptr;
            args.count = part;
            kernels.skin_transposed(args);
          });
    });
    if (!shapes) continue;
    for_each_target(mesh, block, [&](const TargetRun& run) {
      float sum = 0;
      for_each_delta(mesh, run, [&](uint32_t index, const float* delta) {
        const float* g = d.shaped_change.data + size_t{index} * 4;
        sum += delta[0] * g[0] + delta[1] * g[1] + delta[2] * g[2];
      });
      d.weights[size_t{run.channel} * lanes + lane] += sum;
    });
  }
  for (size_t j = 0; j < joints; ++j) {
    const float* from = d.matrices.data + j * kMatrixParts;
    float* to = d.skins.data + j * kMatrixParts * lanes + lane;
    for (size_t c = 0; c < 4; ++c) {
      for (size_t r = 0; r < 3; ++r) to[(3 * c + r) * lanes] += from[4 * r + c];
    }
  }
}

}  // namespace mien
