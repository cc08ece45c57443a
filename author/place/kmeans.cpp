// SPDX-License-Identifier: MIT
#include "author/place/kmeans.h"

#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"
#include "author/mesh/point_tree.h"
#include "author/place/kmeans_run.h"

namespace mien::author {

// Starts: distances hold the squared distance to the means chosen so far -------------------------

/// Candidates are the denser half: those of the median density and more.
void LloydRun::start_dense(bool plane, uint32_t from, uint32_t to, double median, Random* random) {
  const auto candidate = [&](uint32_t i) {
    return may_start(plane, problem.points[i]) && problem.density[i] >= median;
  };
  uint32_t candidates = 0;
  for (uint32_t i = 0; i < n(); ++i) candidates += candidate(i);
  // If no point is dense, all are candidates.
  const bool any = candidates < to - from;
  uint32_t first_random = random && candidates > 0 ? random->below(candidates) : 0;
  for (uint32_t i = 0; i < n(); ++i) distances[i] = std::numeric_limits<double>::infinity();
  for (uint32_t mean = from; mean < to; ++mean) {
    double best = -1;
    uint32_t chosen = 0;
    for (uint32_t i = 0; i < n(); ++i) {
      if (any ? !may_start(plane, problem.points[i]) : !candidate(i)) continue;
      const double density = problem.density[i] / median;
      double score = density;
      if (mean > from) {
        score = std::sqrt(distances[i]) * std::sqrt(std::sqrt(density < 0.1  ? 0.1
                                                              : density > 10 ? 10
                                                                             : density));
      } else if (random) {
        score = first_random-- == 0 ? 1 : 0;
      }
      if (score > best) {
        best = score;
        chosen = i;
      }
    }
    means[mean] = held(mean, problem.points[chosen]);
    for (uint32_t i = 0; i < n(); ++i) {
      distances[i] = std::min(distances[i], squared_distance(problem.points[i], means[mean]));
    }
  }
}

/// Draws several candidates, each with a probability in proportion to its squared distance, and
/// takes the one that leaves the least sum.
void LloydRun::start_plus_plus(bool plane, uint32_t from, uint32_t to, Random& random) {
  uint32_t candidates = 2;
  for (uint32_t left = to - from; left > 2; left = left * 3 / 8) ++candidates;  // 2 + log(means)
  for (uint32_t i = 0; i < n(); ++i) distances[i] = may_start(plane, problem.points[i]) ? 1 : 0;
  for (uint32_t mean = from; mean < to; ++mean) {
    double total = 0;
    for (uint32_t i = 0; i < n(); ++i) {
      total += problem.weights[i] * distances[i];
      passed[i] = total;
    }
    double least = std::numeric_limits<double>::infinity();
    Vec3 best;
    for (uint32_t c = 0; c < candidates; ++c) {
      const double drawn = random.real() * total;
      const double* found = std::upper_bound(passed.begin(), passed.end(), drawn);
      if (found == passed.end()) found = std::lower_bound(passed.begin(), passed.end(), total);
      // No candidates are left: the group stays empty and is filled later.
      const Vec3 at = held(mean, problem.points[total > 0 ? found - passed.begin() : 0]);
      double sum = 0;
      for (uint32_t i = 0; i < n() && mean > from; ++i) {
        sum += problem.weights[i] * std::min(distances[i], squared_distance(problem.points[i], at));
      }
      if (!(sum < least)) continue;
      least = sum;
      best = at;
    }
    means[mean] = best;
    for (uint32_t i = 0; i < n(); ++i) {
      if (!may_start(plane, problem.points[i])) continue;
      const double d = squared_distance(problem.points[i], best);
      distances[i] = mean == from ? d : std::min(distances[i], d);
    }
  }
}

// Lloyd's rounds
// -------------------------------------------------------------------------------------

void LloydRun::sort_neighbors() {
  const uint32_t others = k() - 1;
  for (uint32_t a = 0; a < k(); ++a) {
    uint32_t count = 0;
    for (uint32_t b = 0; b < k(); ++b) {
      if (b != a) row[count++] = {squared_distance(means[b], means[a]), b};
    }
    std::sort(row.data, row.data + others, [](const Gap& x, const Gap& y) {
      return x.distance != y.distance ? x.distance < y.distance : x.mean < y.mean;
    });
    for (uint32_t i = 0; i < others; ++i) {
      neighbors[size_t{a} * others + i] = row[i].mean;
      gaps[size_t{a} * others + i] = row[i].distance;
    }
  }
}

/// True if a point changed its group. A mean that is more than twice as far from a point's mean as
/// the point is cannot be nearer, so the search among sorted neighbors ends early.
bool LloydRun::assign() {
  sort_neighbors();
  const uint32_t others = k() - 1;
  bool changed = false;
  for (uint32_t i = 0; i < n(); ++i) {
    const Vec3 p = problem.points[i];
    const uint32_t old = group[i];
    const double own = squared_distance(p, means[old]);
    const double reach = 4 * own * (1 + 1e-9);  // rounding must not end the search too early
    uint32_t best = old;
    double best_distance = own;
    const uint32_t* list = neighbors.data + size_t{old} * others;
    const double* gap = gaps.data + size_t{old} * others;
    for (uint32_t c = 0; c < others && gap[c] <= reach; ++c) {
      const double d = squared_distance(p, means[list[c]]);
      if (d < best_distance || (d == best_distance && list[c] < best)) {
        best = list[c];
        best_distance = d;
      }
    }
    distances[i] = best_distance;
    if (best == old) continue;
    --sizes[old];
    ++sizes[best];
    group[i] = best;
    changed = true;
  }
  return changed;
}

double LloydRun::objective() const {
  double sum = 0;
  for (uint32_t i = 0; i < n(); ++i) sum += problem.weights[i] * distances[i];
  return sum;
}

void LloydRun::move_means() {
  for (Vec3& sum : sums) sum = {};
  for (double& weight : sum_weights) weight = 0;
  for (uint32_t i = 0; i < n(); ++i) {
    sums[group[i]] = sums[group[i]] + problem.points[i] * problem.weights[i];
    sum_weights[group[i]] += problem.weights[i];
  }
  for (uint32_t c = 0; c < k(); ++c) {
    if (sum_weights[c] > 0) means[c] = held(c, sums[c] * (1 / sum_weights[c]));
  }
}

/// Assigns all points to groups by the current means.
void LloydRun::gather() {
  for (uint32_t& g : group) g = 0;
  for (uint32_t& size : sizes) size = 0;
  sizes[0] = n();
  for (uint32_t i = 0; i < n(); ++i) distances[i] = squared_distance(problem.points[i], means[0]);
  assign();
}

/// Repeats rounds until no point changes its group.
void LloydRun::lloyd(KMeansRun& out) {
  double before = std::numeric_limits<double>::infinity();
  for (uint32_t round = 0; round < kMaxRounds; ++round, ++out.rounds) {
    fill_empty_groups();
    move_means();
    const bool changed = assign();
    out.objective = objective();
    // The last digits may differ although no group changed.
    if (out.objective > before * (1 + 1e-12)) out.never_rose = false;
    before = out.objective;
    out.converged = !changed;
    if (!changed) break;
  }
}

/// The point farthest from its mean becomes a new group.
void LloydRun::fill_empty_groups() {
  for (uint32_t c = 0; c < k(); ++c) {
    if (sizes[c] > 0) continue;
    double worst = 0;
    uint32_t chosen = n();
    for (uint32_t pass = 0; pass < 2 && chosen == n(); ++pass) {
      for (uint32_t i = 0; i < n(); ++i) {
        // A mean that is held on the plane gets a point near the plane; any point if there are
        // none.
        if (pass == 0 && on_plane(c) && !may_start(true, problem.points[i])) continue;
        const double error = problem.weights[i] * distances[i];
        if (sizes[group[i]] < 2 || !(error > worst)) continue;
        worst = error;
        chosen = i;
      }
    }
    if (chosen == n()) return;  // every point is a mean
    const Vec3 at = held(c, problem.points[chosen]);
    const double moved = squared_distance(at, problem.points[chosen]);
    if (!(moved < distances[chosen])) continue;  // held too far away to improve the sum
    means[c] = at;
    --sizes[group[chosen]];
    group[chosen] = c;
    sizes[c] = 1;
    distances[chosen] = moved;
  }
}

namespace {

struct Task {
  const KMeansProblem* problem;
  uint64_t seed;
  Span<KMeansRun> runs;
  Span<RunArrays> arrays;  // per run
  double median;           // of the densities
};

void run_one(void* context, uint32_t index) {
  Task& task = *static_cast<Task*>(context);
  const KMeansProblem& problem = *task.problem;
  KMeansRun& out = task.runs[index];
  LloydRun run = {task.arrays[index], problem, out.means};
  Random random = Random::from_seed(task.seed, 0x6B6D65616E73u + index);
  for (uint32_t plane = 0; plane < 2; ++plane) {
    const uint32_t from = plane ? problem.free_means : 0, to = plane ? run.k() : problem.free_means;
    if (from == to) continue;
    if (out.start == Start::kPlusPlus) {
      run.start_plus_plus(plane != 0, from, to, random);
    } else {
      run.start_dense(plane != 0, from, to, task.median,
                      out.start == Start::kDenseSpreadRandom ? &random : nullptr);
    }
  }
  run.gather();
  run.lloyd(out);
}

}  // namespace

bool make_arrays(const KMeansProblem& problem, Arena& arena, RunArrays& run) {
  const size_t n = problem.points.count, k = problem.free_means + problem.plane_means;
  return make(arena, k, run.row) && make(arena, n, run.passed) && make(arena, n, run.group) &&
         make(arena, k, run.sizes) && make(arena, n, run.distances) && make(arena, k, run.sums) &&
         make(arena, k, run.sum_weights) && make(arena, k * (k - 1), run.neighbors) &&
         make(arena, k * (k - 1), run.gaps);
}

bool run_kmeans(const KMeansProblem& problem, uint64_t seed, const ParallelFor& parallel,
                Arena& arena, const Allocator& allocator, Span<KMeansRun> runs) {
  Arena scratch(allocator);
  const uint32_t n = static_cast<uint32_t>(problem.points.count);
  Span<double> sorted;
  // Allocated before the tasks start: the caller's allocator is used on the calling thread only.
  Task task = {&problem, seed, runs, {}, 0};
  if (!make(scratch, n, sorted) || !make(scratch, runs.count, task.arrays)) return false;
  for (uint32_t i = 0; i < runs.count; ++i) {
    if (!make(arena, problem.free_means + problem.plane_means, runs[i].means) ||
        !make_arrays(problem, scratch, task.arrays[i])) {
      return false;
    }
  }
  for (uint32_t i = 0; i < n; ++i) sorted[i] = problem.density[i];
  std::sort(sorted.begin(), sorted.end());
  task.median = sorted[n / 2];
  run_tasks(parallel, static_cast<uint32_t>(runs.count), run_one, &task);
  return true;
}

void nearest_means(Span<const Vec3> points, Span<const Vec3> means, Span<uint32_t> nearest,
                   Span<uint32_t> next) {
  for (size_t i = 0; i < points.count; ++i) {
    double near = std::numeric_limits<double>::infinity(), second = near;
    nearest[i] = next[i] = 0;
    for (uint32_t c = 0; c < means.count; ++c) {
      const double d = squared_distance(points[i], means[c]);
      if (d < near) {
        second = near;
        next[i] = nearest[i];
        near = d;
        nearest[i] = c;
      } else if (d < second) {
        second = d;
        next[i] = c;
      }
    }
  }
}

namespace {

struct DensityTask {
  Span<const Vec3> points;
  const PointTree* tree;
  Span<double> out;
};
constexpr uint32_t kDensityBlock = 1024;

void density_of_block(void* context, uint32_t block) {
  const DensityTask& task = *static_cast<const DensityTask*>(context);
  constexpr uint32_t kNeighbors = 16;
  Near near[kNeighbors + 1];  // and itself
  const size_t end = std::min(task.points.count, (size_t{block} + 1) * kDensityBlock);
  for (size_t i = size_t{block} * kDensityBlock; i < end; ++i) {
    const uint32_t found = task.tree->nearest(task.points[i], kNeighbors + 1, near);
    const double d = near[found - 1].squared_distance;
    task.out[i] = d > 0 ? 1 / d : 0;
  }
}

}  // namespace

bool surface_density(Span<const Vec3> points, const ParallelFor& parallel, Arena& scratch,
                     Span<double> out) {
  PointTree tree;
  if (!tree.build(points, scratch)) return false;
  DensityTask task = {points, &tree, out};
  run_tasks(parallel, static_cast<uint32_t>((points.count + kDensityBlock - 1) / kDensityBlock),
            density_of_block, &task);
  return true;
}

}  // namespace mien::author
