// SPDX-License-Identifier: MIT
#include "author/fit/footprints.h"

#include <algorithm>

#include "author/base/dna_making.h"

namespace mien::author {

namespace {

// Of the translations, as a share of the mean diagonal of the Gram matrix. Footprints overlap
// widely: with less damping, neighbors move far in opposite directions, which cancels out only with
// the weights of LOD 0.
constexpr double kDamping = 0.3;

}  // namespace

bool make_footprints(size_t vertex_count, const Placement& placement, uint32_t influences,
                     Arena& arena, Footprints& out) {
  const size_t bones = placement.bones.count;
  out.bone_count = static_cast<uint32_t>(bones);
  if (!make(arena, bones + 1, out.starts) || !make(arena, vertex_count * influences, out.entries) ||
      !make(arena, bones * bones, out.gram) || !make(arena, bones, out.moments) ||
      !make(arena, bones, out.fitted) || !make(arena, bones, out.facial) ||
      !make(arena, bones, out.parents) || !make(arena, bones, out.below_jaw) ||
      !make(arena, bones, out.on_jaw)) {
    return false;
  }
  for (uint32_t j = 0; j < bones; ++j) {
    const Bone& bone = placement.bones[j];
    out.fitted[j] = is_fitted(bone);
    out.facial[j] = bone.kind == BoneKind::kFacial;
    out.parents[j] = bone.parent;
    if (bone.kind == BoneKind::kJaw && out.jaw == kNone) {
      out.jaw = j;
      out.jaw_position = bone.position;
    }
    out.below_jaw[j] = j == out.jaw || (bone.parent < j && out.below_jaw[bone.parent]);
    out.on_jaw[j] = out.below_jaw[j] && bone.kind != BoneKind::kTongue;
  }
  return out.jaw == kNone || make(arena, vertex_count, out.carried);
}

namespace {

void sort_by_bone(size_t vertex_count, const SkinWeights& weights, Footprints& out) {
  std::fill(out.starts.begin(), out.starts.end(), 0u);
  const size_t slots = vertex_count * weights.m;
  for (size_t i = 0; i < slots; ++i) {
    if (weights.weights[i] > 0) ++out.starts[weights.joints[i] + 1];
  }
  for (uint32_t j = 0; j < out.bone_count; ++j) out.starts[j + 1] += out.starts[j];
  for (size_t i = 0; i < slots; ++i) {
    if (!(weights.weights[i] > 0)) continue;
    uint32_t& at = out.starts[weights.joints[i]];
    out.entries[at++] = {static_cast<uint32_t>(i / weights.m), weights.weights[i]};
  }
  // Each start is now the start of the next bone.
  for (uint32_t j = out.bone_count; j > 0; --j) out.starts[j] = out.starts[j - 1];
  out.starts[0] = 0;
}

Moments moments_of(Span<const Vec3> positions, Span<const Influenced> entries) {
  Moments out;
  for (const Influenced& e : entries) {
    const double mass = double{e.weight} * double{e.weight};
    out.mass += mass;
    out.center = out.center + positions[e.vertex] * mass;
  }
  if (out.mass > 0) out.center = out.center * (1 / out.mass);
  for (const Influenced& e : entries) {
    const Vec3 arm = positions[e.vertex] - out.center,
               moment = arm * double{e.weight} * double{e.weight};
    out.spread[0] = out.spread[0] + arm * moment.x;
    out.spread[1] = out.spread[1] + arm * moment.y;
    out.spread[2] = out.spread[2] + arm * moment.z;
  }
  return out;
}

/// Vertices of the jaw and of all bones below it.
void list_carried(Span<const Vec3> positions, const SkinWeights& weights, Footprints& out) {
  out.carried_count = 0;
  if (out.jaw == kNone) return;
  for (uint32_t v = 0; v < positions.count; ++v) {
    double sum = 0;
    for (size_t i = size_t{v} * weights.m; i < size_t{v + 1} * weights.m; ++i) {
      if (out.on_jaw[weights.joints[i]]) sum += double{weights.weights[i]};
    }
    if (sum > 0) out.carried[out.carried_count++] = {v, static_cast<float>(sum)};
  }
  out.carried_moments = moments_of(positions, out.of_jaw());
}

}  // namespace

void fill_footprints(Span<const Vec3> positions, const SkinWeights& weights,
                     const ParallelFor& parallel, Footprints& out) {
  sort_by_bone(positions.count, weights, out);
  list_carried(positions, weights, out);
  struct Task {
    Span<const Vec3> positions;
    const SkinWeights& weights;
    Footprints& out;
  } task = {positions, weights, out};
  // Each task sums one row of the Gram matrix, in the order of the vertices.
  run_tasks(
      parallel, out.bone_count,
      [](void* context, uint32_t bone) {
        const Task& t = *static_cast<const Task*>(context);
        Footprints& f = t.out;
        const Span<double> row = f.gram.slice(size_t{bone} * f.bone_count, f.bone_count);
        std::fill(row.begin(), row.end(), 0.0);
        f.moments[bone] = {};
        if (!f.fitted[bone]) return;
        f.moments[bone] = moments_of(t.positions, f.of(bone));
        for (const Influenced& e : f.of(bone)) {
          const size_t first = size_t{e.vertex} * t.weights.m;
          for (size_t i = first; i < first + t.weights.m; ++i) {
            const uint16_t other = t.weights.joints[i];
            if (f.fitted[other]) row[other] += double{e.weight} * double{t.weights.weights[i]};
          }
        }
      },
      &task);
  double trace = 0;
  uint32_t fitted = 0;
  for (uint32_t j = 0; j < out.bone_count; ++j) {
    trace += out.gram[size_t{j} * out.bone_count + j];
    fitted += out.fitted[j];
  }
  out.damping = fitted > 0 ? kDamping * trace / fitted : 0;
}

}  // namespace mien::author
