// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"
#include "author/weights/carriers.h"
#include "author/weights/skin_weights.h"

namespace mien::author {

bool find_median_spacing(const Placement& placement, uint32_t facial, double diagonal,
                         Arena& scratch, double& out) {
  Span<double> gaps;
  out = diagonal / 4;
  if (facial < 2) return true;
  if (!make(scratch, facial, gaps)) return false;
  for (uint32_t a = 0; a < facial; ++a) {
    gaps[a] = std::numeric_limits<double>::infinity();
    for (uint32_t b = 0; b < facial; ++b) {
      if (a == b) continue;
      gaps[a] = std::min(gaps[a], length(placement.bones[placement.first_facial + a].position -
                                         placement.bones[placement.first_facial + b].position));
    }
  }
  std::sort(gaps.begin(), gaps.end());
  out = std::max(gaps[facial / 2], 1e-6 * diagonal);
  return true;
}

uint32_t bone_of_kind(const Placement& placement, BoneKind kind, uint32_t otherwise) {
  for (uint32_t b = 0; b < placement.bones.count; ++b) {
    if (placement.bones[b].kind == kind) return b;
  }
  return otherwise;
}

bool measure_weights(const AuthorMesh& mesh, const Placement& placement, const SkinWeights& weights,
                     const Allocator& allocator, WeightReport& out) {
  out = WeightReport();
  Arena scratch(allocator);
  const size_t n = mesh.positions.count;
  const uint32_t m = weights.m;
  SurfaceGraph graph;
  Span<uint32_t> seen, stack, dominant, pieces;
  Span<double> steps;
  if (!make_surface_graph(mesh, scratch, scratch, graph) || !make(scratch, n, seen) ||
      !make(scratch, n, stack) || !make(scratch, placement.bones.count, dominant) ||
      !make(scratch, placement.bones.count, pieces) ||
      !make(scratch, graph.neighbors.count, steps)) {
    return false;
  }
  for (uint32_t v = 0; v < n; ++v) {
    double sum = 0;
    uint32_t used = 0;
    for (uint32_t i = 0; i < m; ++i) {
      const float weight = weights.weights[size_t{v} * m + i];
      sum += double{weight};
      if (weight != 0) out.least = std::min(out.least, double{weight});
      used += weight > 0;
    }
    out.worst_sum = std::max(out.worst_sum, std::abs(sum - 1));
    out.max_influences = std::max(out.max_influences, used);
    if (mesh.is_skin[v] && m > 0) ++dominant[weights.joints[size_t{v} * m]];
  }
  const auto weight_of = [&](uint32_t v, uint32_t bone) {
    for (uint32_t i = 0; i < m; ++i) {
      if (weights.joints[size_t{v} * m + i] == bone && weights.weights[size_t{v} * m + i] > 0) {
        return double{weights.weights[size_t{v} * m + i]};
      }
    }
    return 0.0;
  };
  // Pieces of each facial bone's vertices on the skin.
  uint32_t stamp = 0;
  for (uint32_t b = placement.first_facial; b < placement.first_facial + placement.facial_count;
       ++b) {
    ++stamp;
    for (uint32_t v = 0; v < n; ++v) {
      if (!mesh.is_skin[v] || mesh.welded[v] != v || seen[v] == stamp || !(weight_of(v, b) > 0)) {
        continue;
      }
      ++pieces[b];
      uint32_t count = 0;
      stack[count++] = v;
      seen[v] = stamp;
      while (count > 0) {
        const uint32_t from = stack[--count];
        for (uint32_t e = graph.starts[from]; e < graph.starts[from + 1]; ++e) {
          const uint32_t to = graph.neighbors[e];
          if (seen[to] == stamp || !(weight_of(to, b) > 0)) continue;
          seen[to] = stamp;
          stack[count++] = to;
        }
      }
    }
    out.split_supports += pieces[b] > 1;
    out.idle_bones += dominant[b] == 0;
  }
  double spacing = 0;
  if (!find_median_spacing(placement, placement.facial_count, mesh.diagonal, scratch, spacing)) {
    return false;
  }
  size_t edges = 0;
  for (uint32_t v = 0; v < n; ++v) {
    for (uint32_t e = graph.starts[v]; e < graph.starts[v + 1] && mesh.is_skin[v]; ++e) {
      const uint32_t to = graph.neighbors[e];
      if (to < v || !(graph.lengths[e] > 0)) continue;
      double difference = 0;
      for (uint32_t i = 0; i < m; ++i) {
        const uint32_t a = weights.joints[size_t{v} * m + i],
                       b = weights.joints[size_t{to} * m + i];
        const double in_a = double{weights.weights[size_t{v} * m + i]};
        const double in_b = double{weights.weights[size_t{to} * m + i]};
        if (in_a > 0) difference += std::abs(in_a - weight_of(to, a));
        if (in_b > 0 && !(weight_of(v, b) > 0)) difference += in_b;
      }
      steps[edges++] = difference * spacing / graph.lengths[e];
    }
  }
  if (edges > 0) {
    std::sort(steps.data, steps.data + edges);
    out.roughness = steps[std::min(edges - 1, edges * 95 / 100)];
  }
  const uint32_t head = bone_of_kind(placement, BoneKind::kHead, 0);
  SkinWeights none;
  return carry_components(mesh, placement, head, scratch, none, &out);
}

}  // namespace mien::author
