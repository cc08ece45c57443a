// SPDX-License-Identifier: MIT
// Skin weights: the sorted order of positions, and its runs of equally many influences.
#include <algorithm>
#include <cmath>

#include "runtime/load/compile/compile_deformer.h"

namespace mien {
namespace {

using dna::Mesh;
using dna::VertexSkinWeights;

const VertexSkinWeights kNoWeights;
constexpr uint32_t kMaxInfluences = 0xFFFF;

const VertexSkinWeights& weights_at(const Mesh& mesh, uint32_t position) {
  return position < mesh.skin_weights.count ? mesh.skin_weights[position] : kNoWeights;
}

uint32_t influences_of(uint64_t key) { return static_cast<uint32_t>(key >> 48); }
uint32_t position_of(uint64_t key) { return static_cast<uint32_t>(key); }

/// A whole number of units is 1, so that sums of 1 stay 1: otherwise positions would move with their distance
/// from the origin. The largest weight is one unit less than an integer can be, because fix_weights() carries.
float scale_of_weights(float max_weight) {
  const double units = std::floor(32766 / double{max_weight});
  return static_cast<float>(units >= 1 ? 1 / units : double{max_weight} / 32766);
}

/// The weights of one position to 16 bits. What rounding takes from one is added to the next, so that their
/// sum is rounded once.
void fix_weights(const float* weights, uint32_t count, float scale, int16_t* fixed) {
  double sum = 0, before = 0;
  for (uint32_t i = 0; i < count; ++i) {
    sum += double{weights[i]};
    fixed[i] = in_units(sum - before, scale);
    before += static_cast<double>(fixed[i]) * double{scale};
  }
}

/// Calls f(joint, weight) for each influence of a position that is not dropped.
template <class F>
void for_each_influence(const MeshSource& source, uint32_t position, F&& f) {
  const VertexSkinWeights& skin = weights_at(source.mesh, position);
  const auto is_used = [&](float weight) {
    return source.options.fix_weights ? weight > 0 : weight != 0;
  };
  float scale = 1;
  if (source.options.fix_weights) {
    double sum = 0;
    for (uint32_t i = 0; i < skin.weights.count; ++i) {
      if (is_used(skin.weights[i])) sum += skin.weights[i];
    }
    // A sum this small is noise of the exporter: the position has no influence.
    if (!(sum > 1e-6)) return;
    scale = static_cast<float>(1 / sum);
  }
  for (uint32_t i = 0; i < skin.weights.count; ++i) {
    const float weight = skin.weights[i];
    if (is_used(weight)) f(skin.joint_indices[i], weight * scale);
  }
}

}  // namespace

Status plan_skin(const MeshSource& source, MeshPlan& plan) {
  const uint32_t count = source.mesh.positions.xs.count;
  plan.order = source.scratch.array<uint64_t>(count);
  plan.sorted_indices = source.scratch.array<uint32_t>(count);
  if (count != 0 && (!plan.order.data || !plan.sorted_indices.data)) return source.no_memory();

  for (uint32_t p = 0; p < count; ++p) {
    const VertexSkinWeights& skin = weights_at(source.mesh, p);
    for (uint32_t i = 0; i < skin.weights.count; ++i) {
      if (std::isfinite(skin.weights[i])) continue;
      return fail(source.error, Status::kDnaValue,
                  source.view.offset_of(skin.weights.data + i * sizeof(float)),
                  "geom.meshes[%u].skinWeights[%u].weights: element %u is not finite", source.index,
                  p, i);
    }
    uint32_t influences = 0;
    uint64_t joint = 0;
    float max_weight = 0;
    for_each_influence(source, p, [&](uint16_t j, float weight) {
      ++influences;
      plan.max_weight = std::max(plan.max_weight, std::fabs(weight));
      if (weight > max_weight) {
        max_weight = weight;
        joint = j;
      }
    });
    if (influences > kMaxInfluences) {
      return fail(source.error, Status::kDnaLimit, source.view.offset_of(skin.weights.data),
                  "geom.meshes[%u].skinWeights[%u]: %u influences; at most %u are supported",
                  source.index, p, influences, kMaxInfluences);
    }
    plan.order[p] = uint64_t{influences} << 48 | joint << 32 | p;
    plan.weight_count += influences;
    plan.max_influences = std::max(plan.max_influences, influences);
  }
  for (uint32_t first = 0; first < count; first += kWindowPositions) {
    const auto window = plan.order.slice(first, std::min(kWindowPositions, count - first));
    std::sort(window.begin(), window.end());
  }
  for (uint32_t i = 0; i < count; ++i) {
    const uint64_t key = plan.order[i];
    plan.sorted_indices[position_of(key)] = i;
    if (i == 0 || influences_of(key) != influences_of(plan.order[i - 1])) ++plan.skin_run_count;
  }
  return Status::kOk;
}

void place_skin(const MeshPlan& plan, bool half_storage, Placer& placer, DeformMesh& mesh) {
  const size_t count = mesh.position_count, alignment = mesh.array_alignment();
  const bool fixed = half_storage && plan.max_influences <= kMaxFixedInfluences;
  mesh.sorted_positions = placer.array<float>(half_storage ? 0 : count * 4, alignment);
  mesh.weights = placer.array<float>(fixed ? 0 : plan.weight_count, alignment);
  mesh.fixed_weights = placer.array<int16_t>(fixed ? plan.weight_count : 0, alignment);
  mesh.joints = placer.array<uint16_t>(plan.weight_count, alignment);
  mesh.position_indices = placer.array<uint16_t>(count, alignment);
  mesh.skin_runs = placer.array<SkinRun>(plan.skin_run_count);
}

void fill_skin(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh) {
  const dna::Vec3Array& positions = source.mesh.positions;
  if (!mesh.fixed_weights.empty()) mesh.weight_scale = scale_of_weights(plan.max_weight);
  float weights[kMaxFixedInfluences];
  uint32_t run = 0;
  size_t weight = 0;
  for (uint32_t i = 0; i < mesh.position_count; ++i) {
    const uint32_t p = position_of(plan.order[i]);
    const uint32_t influences = influences_of(plan.order[i]);
    mesh.position_indices[i] = static_cast<uint16_t>(p - window_of(i));
    if (!mesh.sorted_positions.empty()) {
      float* at = mesh.sorted_positions.data + size_t{i} * 4;
      at[0] = positions.xs[p];
      at[1] = positions.ys[p];
      at[2] = positions.zs[p];
    }
    if (i == 0 || mesh.skin_runs[run - 1].influences != influences) {
      mesh.skin_runs[run++] = {weight, i, 0, influences, 0};
    }
    ++mesh.skin_runs[run - 1].count;
    const bool fixed = !mesh.fixed_weights.empty();
    float* to = fixed ? weights : mesh.weights.data + weight;
    for_each_influence(source, p, [&](uint16_t joint, float value) {
      mesh.joints[weight++] = joint;
      *to++ = value;
    });
    if (fixed) {
      fix_weights(weights, influences, mesh.weight_scale,
                  mesh.fixed_weights.data + weight - influences);
    }
  }
}

}  // namespace mien
