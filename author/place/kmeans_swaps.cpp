// SPDX-License-Identifier: MIT
#include <algorithm>

#include "author/base/dna_making.h"
#include "author/place/kmeans_run.h"

namespace mien::author {

/// A lower bound of what a second mean, on the plane or off it, takes from the sum of a group.
/// Found by two rounds that start at the point farthest from its mean.
double LloydRun::gain_of_split(uint32_t split, bool plane, Vec3& second) const {
  double own = 0, worst = 0;
  bool found = false;
  for (uint32_t i = 0; i < n(); ++i) {
    if (group[i] != split) continue;
    const double error = problem.weights[i] * distances[i];
    own += error;
    if (!(error > worst) || !may_start(plane, problem.points[i])) continue;
    worst = error;
    second = problem.points[i];
    found = true;
  }
  if (!found) return 0;
  const auto hold = [](bool held_there, Vec3 p) { return held_there ? Vec3{0, p.y, p.z} : p; };
  Vec3 first = means[split];
  double left = own;
  for (int round = 0; round < 3; ++round) {
    Vec3 sum[2];
    double weight[2] = {};
    left = 0;
    second = hold(plane, second);
    for (uint32_t i = 0; i < n(); ++i) {
      if (group[i] != split) continue;
      const Vec3 p = problem.points[i];
      const double a = squared_distance(p, first), b = squared_distance(p, second);
      const int side = b < a;
      sum[side] = sum[side] + p * problem.weights[i];
      weight[side] += problem.weights[i];
      left += problem.weights[i] * (side ? b : a);
    }
    if (!(weight[0] > 0 && weight[1] > 0)) return 0;
    if (round == 2) break;
    first = held(split, sum[0] * (1 / weight[0]));
    second = sum[1] * (1 / weight[1]);
  }
  return own - left;
}

namespace {

constexpr uint32_t kMaxSwapBatches = 40;

struct Choice {
  double value = 0;
  uint32_t mean = 0;
  Vec3 to;

  static bool larger(const Choice& a, const Choice& b) {
    return a.value != b.value ? a.value > b.value : a.mean < b.mean;
  }
};

struct SwapArrays {
  Span<Choice> gains, losses;  // per mean
  Span<Vec3> kept;             // means before
  Span<uint8_t> touched;       // per mean
  Span<uint32_t> nearest, next;
};

/// Moves up to `most` means, each where it takes more from the sum than its loss adds. Returns how
/// many have moved.
uint32_t swap_means(LloydRun& run, SwapArrays& arrays, uint32_t most) {
  const KMeansProblem& problem = run.problem;
  const uint32_t k = run.k();
  nearest_means(problem.points, run.means, arrays.nearest, arrays.next);
  for (uint8_t& t : arrays.touched) t = 0;
  uint32_t moved = 0;
  for (const bool plane : {false, true}) {
    const uint32_t from = plane ? problem.free_means : 0, to = plane ? k : problem.free_means;
    if (from == to) continue;
    for (uint32_t c = 0; c < k; ++c) {
      arrays.gains[c] = {0, c, {}};
      arrays.gains[c].value = run.gain_of_split(c, plane, arrays.gains[c].to);
      arrays.losses[c] = {c >= from && c < to ? 0 : -HUGE_VAL, c, {}};
    }
    for (uint32_t i = 0; i < run.n(); ++i) {
      const uint32_t c = run.group[i];
      const uint32_t other = arrays.nearest[i] == c ? arrays.next[i] : arrays.nearest[i];
      const double apart = squared_distance(problem.points[i], run.means[other]);
      arrays.losses[c].value -= problem.weights[i] * (apart - run.distances[i]);
    }
    // The largest gain and the smallest loss come first; losses are negative.
    std::sort(arrays.gains.begin(), arrays.gains.end(), Choice::larger);
    std::sort(arrays.losses.begin(), arrays.losses.end(), Choice::larger);
    uint32_t lost = 0;
    for (uint32_t g = 0; g < k && moved < most; ++g) {
      const Choice& gain = arrays.gains[g];
      if (arrays.touched[gain.mean]) continue;
      while (lost < k && arrays.touched[arrays.losses[lost].mean]) ++lost;
      if (lost == k || arrays.losses[lost].mean == gain.mean) continue;
      if (!(gain.value > -arrays.losses[lost].value * (1 + 1e-9))) break;
      const uint32_t mean = arrays.losses[lost].mean;
      // The means that would take over its points must not move: the loss was computed with them.
      for (uint32_t i = 0; i < run.n(); ++i) {
        if (run.group[i] != mean) continue;
        arrays.touched[arrays.nearest[i] == mean ? arrays.next[i] : arrays.nearest[i]] = 1;
      }
      if (arrays.touched[gain.mean]) {
        arrays.touched[mean] = 1;
        continue;
      }
      arrays.touched[mean] = arrays.touched[gain.mean] = 1;
      run.means[mean] = run.held(mean, gain.to);
      ++moved;
    }
  }
  return moved;
}

}  // namespace

bool improve_kmeans(const KMeansProblem& problem, const KMeansRun& from, Arena& arena,
                    const Allocator& allocator, KMeansRun& out) {
  Arena scratch(allocator);
  const size_t n = problem.points.count, k = from.means.count;
  RunArrays memory;
  SwapArrays arrays;
  if (!make(arena, k, out.means) || !make_arrays(problem, scratch, memory) ||
      !make(scratch, k, arrays.gains) || !make(scratch, k, arrays.losses) ||
      !make(scratch, k, arrays.kept) || !make(scratch, k, arrays.touched) ||
      !make(scratch, n, arrays.nearest) || !make(scratch, n, arrays.next)) {
    return false;
  }
  out = {Start::kSwaps, from.objective, 0, from.converged, from.never_rose, out.means};
  std::copy(from.means.begin(), from.means.end(), out.means.begin());
  if (k < 2) return true;
  LloydRun run = {memory, problem, out.means};
  run.gather();
  uint32_t most = static_cast<uint32_t>(k) / 10 + 1;
  for (uint32_t batch = 0; batch < kMaxSwapBatches; ++batch) {
    std::copy(run.means.begin(), run.means.end(), arrays.kept.begin());
    if (swap_means(run, arrays, most) == 0) break;
    const KMeansRun before = out;
    run.gather();
    run.lloyd(out);
    if (out.objective < before.objective) continue;
    std::copy(arrays.kept.begin(), arrays.kept.end(), run.means.begin());
    const uint32_t rounds = out.rounds;
    out = before;
    out.rounds = rounds;
    run.gather();
    if (most == 1) break;
    most = 1;
  }
  return true;
}

}  // namespace mien::author
