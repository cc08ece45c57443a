// SPDX-License-Identifier: MIT
// One run of k-means with its memory: shared by the starts, the rounds and the swaps.
#pragma once

#include "author/base/random.h"
#include "author/place/kmeans.h"

namespace mien::author {

struct Gap {
  double distance;
  uint32_t mean;
};

/// One run with its memory.
struct RunArrays {
  Span<uint32_t> group;    // per point
  Span<uint32_t> sizes;    // points of each group
  Span<double> distances;  // per point, squared, to its mean
  Span<Vec3> sums;         // per mean
  Span<double> sum_weights;
  Span<uint32_t> neighbors;  // per mean, the others by distance
  Span<double> gaps;         // beside neighbors
  Span<Gap> row;             // of one mean
  Span<double> passed;       // per point: sum of shares up to it
};

struct LloydRun : RunArrays {
  const KMeansProblem& problem;
  Span<Vec3> means;

  uint32_t n() const { return static_cast<uint32_t>(problem.points.count); }
  uint32_t k() const { return static_cast<uint32_t>(means.count); }
  bool on_plane(uint32_t mean) const { return mean >= problem.free_means; }
  Vec3 held(uint32_t mean, Vec3 at) const {
    if (on_plane(mean)) at.x = 0;
    return at;
  }
  /// Free means of a symmetric problem start beside the plane, plane means at it.
  bool may_start(bool plane, Vec3 at) const {
    return problem.plane_means == 0 || (at.x <= problem.plane_width) == plane;
  }

  void start_dense(bool plane, uint32_t from, uint32_t to, double median, Random* random);
  void start_plus_plus(bool plane, uint32_t from, uint32_t to, Random& random);
  void sort_neighbors();
  bool assign();
  double objective() const;
  void move_means();
  void fill_empty_groups();
  void gather();
  void lloyd(KMeansRun& out);
  double gain_of_split(uint32_t split, bool plane, Vec3& second) const;
};

/// Allocates all memory of a run; false if there is not enough.
bool make_arrays(const KMeansProblem& problem, Arena& arena, RunArrays& run);

}  // namespace mien::author
