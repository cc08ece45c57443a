// SPDX-License-Identifier: MIT
#include "author/place/rank.h"

#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"
#include "author/place/kmeans.h"

namespace mien::author {

bool rank_by_deletion(Span<const Vec3> points, Span<const double> weights, Span<const Vec3> means,
                      Span<const uint32_t> joints, Arena& scratch, Span<uint32_t> order,
                      Span<double> objectives) {
  const uint32_t n = static_cast<uint32_t>(points.count), k = static_cast<uint32_t>(means.count);
  Span<uint32_t> near, next, left;
  Span<double> loss;
  if (!make(scratch, n, near) || !make(scratch, n, next) || !make(scratch, k, left) ||
      !make(scratch, k, loss)) {
    return false;
  }
  nearest_means(points, means, near, next);
  double objective = 0;
  for (uint32_t i = 0; i < n; ++i) {
    objective += weights[i] * squared_distance(points[i], means[near[i]]);
  }
  uint32_t left_count = k;
  for (uint32_t c = 0; c < k; ++c) left[c] = c;
  while (left_count > 0) {
    objectives[left_count - 1] = objective;
    if (left_count == 1) {
      order[0] = left[0];
      return true;
    }
    for (double& value : loss) value = 0;
    for (uint32_t i = 0; i < n; ++i) {
      loss[near[i]] += weights[i] * (squared_distance(points[i], means[next[i]]) -
                                     squared_distance(points[i], means[near[i]]));
    }
    uint32_t slot = 0;
    for (uint32_t s = 1; s < left_count; ++s) {
      if (loss[left[s]] / joints[left[s]] < loss[left[slot]] / joints[left[slot]]) slot = s;
    }
    const uint32_t removed = left[slot];
    objective += loss[removed];
    order[--left_count] = removed;
    for (uint32_t s = slot; s < left_count; ++s) left[s] = left[s + 1];  // stays ascending
    for (uint32_t i = 0; i < n; ++i) {
      if (near[i] != removed && next[i] != removed) continue;
      if (near[i] == removed) near[i] = next[i];
      double best = std::numeric_limits<double>::infinity();
      next[i] = near[i];
      for (uint32_t s = 0; s < left_count; ++s) {
        if (left[s] == near[i]) continue;
        const double d = squared_distance(points[i], means[left[s]]);
        if (!(d < best)) continue;
        best = d;
        next[i] = left[s];
      }
    }
  }
  return true;
}

void joint_ladder(uint32_t top, Span<uint32_t> out) {
  constexpr double kSteps[] = {240, 160, 110, 75, 50, 32, 20, 12};
  constexpr size_t kStepCount = sizeof(kSteps) / sizeof(kSteps[0]);
  constexpr uint32_t kLeast = 6;
  for (size_t lod = 0; lod < out.count; ++lod) {
    // After the last step each LOD keeps two thirds.
    double share = kSteps[lod < kStepCount ? lod : kStepCount - 1] / kSteps[0];
    for (size_t beyond = kStepCount; beyond <= lod; ++beyond) share *= 2.0 / 3;
    // At least six in the last LOD, and one more in each LOD before it.
    const uint32_t least = kLeast + static_cast<uint32_t>(out.count - 1 - lod);
    uint32_t count = static_cast<uint32_t>(top * share + 0.5);
    if (count < least) count = least;
    if (lod > 0 && count >= out[lod - 1]) count = out[lod - 1] > 1 ? out[lod - 1] - 1 : 1;
    out[lod] = count > top ? top : count;
  }
}

void joint_ladder(uint32_t top, Span<const uint32_t> own, Span<uint32_t> out) {
  if (own.empty()) return joint_ladder(top, out);
  out[0] = top;
  for (size_t lod = 1; lod < out.count; ++lod) out[lod] = std::min(own[lod], out[lod - 1]);
}

}  // namespace mien::author
