// SPDX-License-Identifier: MIT
// Skin weights: the order of places, and rows of equal length.
#include <algorithm>
#include <cmath>

#include "runtime/compile/compile_deformer.h"

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

/// Calls f(joint, weight) for the influences that count.
template <class F>
void for_each_influence(const MeshSource& source, uint32_t position, F&& f) {
  const VertexSkinWeights& skin = weights_at(source.mesh, position);
  const auto used = [&](float weight) { return source.fix_weights ? weight > 0 : weight != 0; };
  float scale = 1;
  if (source.fix_weights) {
    double sum = 0;
    for (uint32_t i = 0; i < skin.weights.count; ++i) {
      if (used(skin.weights[i])) sum += skin.weights[i];
    }
    // Sums this small can only be dirt: the position is held by nothing.
    if (!(sum > 1e-6)) return;
    scale = static_cast<float>(1 / sum);
  }
  for (uint32_t i = 0; i < skin.weights.count; ++i) {
    const float weight = skin.weights[i];
    if (used(weight)) f(skin.joint_indices[i], weight * scale);
  }
}

}  // namespace

Status plan_skin(const MeshSource& source, MeshPlan& plan) {
  const uint32_t count = source.mesh.positions.xs.count;
  plan.order = source.scratch.array<uint64_t>(count);
  plan.place_of = source.scratch.array<uint32_t>(count);
  if (count != 0 && (!plan.order.data || !plan.place_of.data)) return source.no_memory();

  for (uint32_t p = 0; p < count; ++p) {
    const VertexSkinWeights& skin = weights_at(source.mesh, p);
    for (uint32_t i = 0; i < skin.weights.count; ++i) {
      if (std::isfinite(skin.weights[i])) continue;
      return fail(source.error, Status::kDnaValue,
                  source.view.offset_of(skin.weights.data + i * sizeof(float)),
                  "geom.meshes[%u].skinWeights[%u].weights: element %u is not finite",
                  source.number, p, i);
    }
    uint32_t influences = 0;
    uint64_t joint = 0;
    float most = 0;
    for_each_influence(source, p, [&](uint16_t j, float weight) {
      ++influences;
      if (weight > most) {
        most = weight;
        joint = j;
      }
    });
    if (influences > kMaxInfluences) {
      return fail(source.error, Status::kDnaLimit, source.view.offset_of(skin.weights.data),
                  "geom.meshes[%u].skinWeights[%u]: %u influences; %u are allowed", source.number,
                  p, influences, kMaxInfluences);
    }
    plan.order[p] = uint64_t{influences} << 48 | joint << 32 | p;
    plan.weight_count += influences;
    plan.max_influences = std::max(plan.max_influences, influences);
  }
  std::sort(plan.order.begin(), plan.order.end());
  for (uint32_t place = 0; place < count; ++place) {
    const uint64_t key = plan.order[place];
    plan.place_of[position_of(key)] = place;
    if (place == 0 || influences_of(key) != influences_of(plan.order[place - 1])) ++plan.run_count;
  }
  return Status::kOk;
}

void place_skin(const MeshPlan& plan, Placer& placer, DeformMesh& mesh) {
  const size_t count = mesh.position_count;
  mesh.neutral = placer.array<float>(count * 4, kBlockAlignment);
  mesh.weights = placer.array<float>(plan.weight_count, kBlockAlignment);
  mesh.joints = placer.array<uint16_t>(plan.weight_count, kBlockAlignment);
  mesh.position_at = placer.array<uint32_t>(count, kBlockAlignment);
  mesh.place_of = placer.array<uint32_t>(count);
  mesh.runs = placer.array<SkinRun>(plan.run_count);
}

void fill_skin(const MeshSource& source, const MeshPlan& plan, DeformMesh& mesh) {
  const dna::Vec3Array& positions = source.mesh.positions;
  std::copy(plan.place_of.begin(), plan.place_of.end(), mesh.place_of.begin());
  uint32_t run = 0;
  size_t weight = 0;
  for (uint32_t place = 0; place < mesh.position_count; ++place) {
    const uint32_t p = position_of(plan.order[place]);
    const uint32_t influences = influences_of(plan.order[place]);
    mesh.position_at[place] = p;
    float* at = mesh.neutral.data + size_t{place} * 4;
    at[0] = positions.xs[p];
    at[1] = positions.ys[p];
    at[2] = positions.zs[p];
    if (place == 0 || mesh.runs[run - 1].influences != influences) {
      mesh.runs[run++] = {weight, place, 0, influences, 0};
    }
    ++mesh.runs[run - 1].count;
    for_each_influence(source, p, [&](uint16_t joint, float value) {
      mesh.joints[weight] = joint;
      mesh.weights[weight++] = value;
    });
  }
}

}  // namespace mien
