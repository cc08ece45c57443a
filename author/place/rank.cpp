// SPDX-License-Identifier: MIT
#include "author/place/rank.h"

#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"

namespace mien::author {

namespace {

struct Ranking {
  Span<const Vec3> points;
  Span<const double> weights;
  Span<const Vec3> means;
  Span<const uint32_t> joints;
  Span<uint32_t> near, next;      // per point, of the means that are left
  Span<double> to_near, to_next;  // squared distances
  Span<double> loss;              // per mean

  double distance(uint32_t point, uint32_t mean) const {
    return squared_distance(points[point], means[mean]);
  }

  /// The two nearest ones of `left` to the point.
  void find_nearest(uint32_t i, Span<const uint32_t> left) {
    near[i] = next[i] = left[0];
    to_near[i] = to_next[i] = std::numeric_limits<double>::infinity();
    for (const uint32_t mean : left) {
      const double d = distance(i, mean);
      if (d < to_near[i]) {
        next[i] = near[i];
        to_next[i] = to_near[i];
        near[i] = mean;
        to_near[i] = d;
      } else if (d < to_next[i]) {
        next[i] = mean;
        to_next[i] = d;
      }
    }
    if (left.count == 1) to_next[i] = to_near[i];
  }

  double find_all_nearest(Span<const uint32_t> left) {
    double objective = 0;
    for (uint32_t i = 0; i < points.count; ++i) {
      find_nearest(i, left);
      objective += weights[i] * to_near[i];
    }
    return objective;
  }

  /// Removes means until as many joints are left; those that are removed first get the last places of `left`. Returns
  /// how many means remain.
  size_t remove(Span<uint32_t> left, uint32_t most_joints, double& objective) {
    std::sort(left.begin(), left.end());
    objective = find_all_nearest(left);
    uint32_t joint_count = 0;
    for (const uint32_t mean : left) joint_count += joints[mean];
    while (left.count > 1 && joint_count > most_joints) {
      for (const uint32_t mean : left) loss[mean] = 0;
      for (uint32_t i = 0; i < points.count; ++i) {
        loss[near[i]] += weights[i] * (to_next[i] - to_near[i]);
      }
      size_t slot = 0;
      for (size_t s = 1; s < left.count; ++s) {
        if (loss[left[s]] / joints[left[s]] < loss[left[slot]] / joints[left[slot]]) slot = s;
      }
      const uint32_t removed = left[slot];
      objective += loss[removed];
      joint_count -= joints[removed];
      std::rotate(left.begin() + slot, left.begin() + slot + 1, left.end());  // stays ascending
      --left.count;
      for (uint32_t i = 0; i < points.count; ++i) {
        if (near[i] == removed || next[i] == removed) find_nearest(i, left);
      }
    }
    return left.count;
  }

  /// Exchanges means of `left` for `dropped` ones of as many joints, one pair at a time.
  double exchange(Span<uint32_t> left, Span<uint32_t> dropped, double objective) {
    constexpr uint32_t kPasses = 10;
    bool changed = true;
    for (uint32_t pass = 0; pass < kPasses && changed; ++pass) {
      changed = false;
      for (uint32_t& candidate : dropped) {
        // What the sum gains with the candidate; and, for each mean, what it then loses without that mean.
        double gain = 0;
        for (const uint32_t mean : left) loss[mean] = 0;
        for (uint32_t i = 0; i < points.count; ++i) {
          const double d = distance(i, candidate), here = std::min(d, to_near[i]);
          gain += weights[i] * (to_near[i] - here);
          loss[near[i]] += weights[i] * (std::min(d, to_next[i]) - here);
        }
        uint32_t* least = nullptr;
        for (uint32_t& mean : left) {
          if (joints[mean] == joints[candidate] && (!least || loss[mean] < loss[*least])) {
            least = &mean;
          }
        }
        if (!least || !(gain - loss[*least] > 1e-9 * objective)) continue;
        std::swap(*least, candidate);
        objective = find_all_nearest(left);
        changed = true;
      }
    }
    return objective;
  }
};

}  // namespace

bool rank_means(Span<const Vec3> points, Span<const double> weights, Span<const Vec3> means,
                Span<const uint32_t> joints, Arena& scratch, Span<uint32_t> order,
                Span<uint32_t> counts, Span<double> objectives) {
  const size_t n = points.count, k = means.count;
  Ranking ranking = {points, weights, means, joints, {}, {}, {}, {}, {}};
  if (!make(scratch, n, ranking.near) || !make(scratch, n, ranking.next) ||
      !make(scratch, n, ranking.to_near) || !make(scratch, n, ranking.to_next) ||
      !make(scratch, k, ranking.loss)) {
    return false;
  }
  for (uint32_t c = 0; c < k; ++c) order[c] = c;
  size_t left = k;
  for (size_t lod = 0; lod < counts.count; ++lod) {
    const size_t before = left;
    left = ranking.remove(order.first(left), counts[lod], objectives[lod]);
    const Span<uint32_t> dropped = order.slice(left, before - left);
    objectives[lod] = ranking.exchange(order.first(left), dropped, objectives[lod]);
    counts[lod] = 0;
    for (size_t rank = 0; rank < left; ++rank) counts[lod] += joints[order[rank]];
  }
  double last = 0;
  ranking.remove(order.first(left), 0, last);
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
