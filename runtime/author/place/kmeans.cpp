// SPDX-License-Identifier: MIT
#include "runtime/author/place/kmeans.h"

#include <algorithm>
#include <limits>

#include "runtime/author/dna_making.h"
#include "runtime/author/mesh/point_tree.h"
#include "runtime/author/random.h"

namespace mien::author {

namespace {

double squared_distance(Vec3 a, Vec3 b) {
  const Vec3 d = a - b;
  return dot(d, d);
}

/// One run with its memory.
struct RunArrays {
  Span<uint32_t> group;    // per point
  Span<uint32_t> sizes;    // points of each group
  Span<double> distances;  // per point, squared, to its mean
  Span<Vec3> sums;         // per mean
  Span<double> sum_weights;
  Span<uint32_t> neighbors;  // per mean, the others by distance
  Span<double> gaps;         // beside neighbors
};

struct Run : RunArrays {
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

  void start_dense(bool plane, uint32_t from, uint32_t to, Span<const double> cut, Random* random);
  void start_plus_plus(bool plane, uint32_t from, uint32_t to, Random& random);
  void sort_neighbors();
  bool assign();
  double objective() const;
  void move_means();
  void fill_empty_groups();
};

// Starts: distances hold the squared distance to the means chosen so far -------------------------

/// cut[0]: density that half of the points have; cut[1]: the median of those.
void Run::start_dense(bool plane, uint32_t from, uint32_t to, Span<const double> cut,
                      Random* random) {
  const auto candidate = [&](uint32_t i) {
    return may_start(plane, problem.points[i]) && problem.density[i] >= cut[0];
  };
  uint32_t candidates = 0;
  for (uint32_t i = 0; i < n(); ++i) candidates += candidate(i);
  // Where every point is sparse, all of them will do.
  const bool any = candidates < to - from;
  uint32_t first_random = random && candidates > 0 ? random->below(candidates) : 0;
  for (uint32_t i = 0; i < n(); ++i) distances[i] = std::numeric_limits<double>::infinity();
  for (uint32_t mean = from; mean < to; ++mean) {
    double best = -1;
    uint32_t chosen = 0;
    for (uint32_t i = 0; i < n(); ++i) {
      if (any ? !may_start(plane, problem.points[i]) : !candidate(i)) continue;
      const double density = problem.density[i] / cut[1];
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

void Run::start_plus_plus(bool plane, uint32_t from, uint32_t to, Random& random) {
  for (uint32_t i = 0; i < n(); ++i) distances[i] = may_start(plane, problem.points[i]) ? 1 : 0;
  for (uint32_t mean = from; mean < to; ++mean) {
    double total = 0;
    for (uint32_t i = 0; i < n(); ++i) total += problem.weights[i] * distances[i];
    const double drawn = random.real() * total;
    uint32_t chosen = n();
    double passed = 0;
    for (uint32_t i = 0; i < n() && (chosen == n() || passed <= drawn); ++i) {
      const double share = problem.weights[i] * distances[i];
      if (share > 0) chosen = i;
      passed += share;
    }
    // Nothing left to choose from: an empty group, to be filled later.
    means[mean] = held(mean, problem.points[chosen == n() ? 0 : chosen]);
    for (uint32_t i = 0; i < n(); ++i) {
      if (!may_start(plane, problem.points[i])) continue;
      const double d = squared_distance(problem.points[i], means[mean]);
      distances[i] = mean == from ? d : std::min(distances[i], d);
    }
  }
}

// Lloyd's rounds -------------------------------------------------------------------------------------

void Run::sort_neighbors() {
  const uint32_t others = k() - 1;
  for (uint32_t a = 0; a < k(); ++a) {
    uint32_t* list = neighbors.data + size_t{a} * others;
    uint32_t count = 0;
    for (uint32_t b = 0; b < k(); ++b) {
      if (b != a) list[count++] = b;
    }
    const Vec3 at = means[a];
    std::sort(list, list + others, [&](uint32_t b, uint32_t c) {
      const double to_b = squared_distance(means[b], at), to_c = squared_distance(means[c], at);
      return to_b != to_c ? to_b < to_c : b < c;
    });
    for (uint32_t i = 0; i < others; ++i) {
      gaps[size_t{a} * others + i] = squared_distance(means[list[i]], at);
    }
  }
}

/// True if a point changed its group. A mean that is more than twice as far from a point's mean as the
/// point is cannot be nearer, so the search among sorted neighbors ends early.
bool Run::assign() {
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

double Run::objective() const {
  double sum = 0;
  for (uint32_t i = 0; i < n(); ++i) sum += problem.weights[i] * distances[i];
  return sum;
}

void Run::move_means() {
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

/// The worst served point becomes a group of its own.
void Run::fill_empty_groups() {
  for (uint32_t c = 0; c < k(); ++c) {
    if (sizes[c] > 0) continue;
    double worst = 0;
    uint32_t chosen = n();
    for (uint32_t pass = 0; pass < 2 && chosen == n(); ++pass) {
      for (uint32_t i = 0; i < n(); ++i) {
        // A mean that is held on the plane serves points near it; any point if there are none.
        if (pass == 0 && on_plane(c) && !may_start(true, problem.points[i])) continue;
        const double error = problem.weights[i] * distances[i];
        if (sizes[group[i]] < 2 || !(error > worst)) continue;
        worst = error;
        chosen = i;
      }
    }
    if (chosen == n()) return;  // every point has a mean of its own
    const Vec3 at = held(c, problem.points[chosen]);
    const double moved = squared_distance(at, problem.points[chosen]);
    if (!(moved < distances[chosen])) continue;  // held too far away to be of use
    means[c] = at;
    --sizes[group[chosen]];
    group[chosen] = c;
    sizes[c] = 1;
    distances[chosen] = moved;
  }
}

bool make_arrays(const KMeansProblem& problem, Arena& arena, RunArrays& run) {
  const size_t n = problem.points.count, k = problem.free_means + problem.plane_means;
  return make(arena, n, run.group) && make(arena, k, run.sizes) && make(arena, n, run.distances) &&
         make(arena, k, run.sums) && make(arena, k, run.sum_weights) &&
         make(arena, k * (k - 1), run.neighbors) && make(arena, k * (k - 1), run.gaps);
}

struct Task {
  const KMeansProblem* problem;
  uint64_t seed;
  Span<KMeansRun> runs;
  Span<RunArrays> arrays;  // per run
  double cut[2];
};

void run_one(void* context, uint32_t index) {
  Task& task = *static_cast<Task*>(context);
  const KMeansProblem& problem = *task.problem;
  KMeansRun& out = task.runs[index];
  Run run = {task.arrays[index], problem, out.means};
  Random random = Random::from_seed(task.seed, 0x6B6D65616E73u + index);
  for (uint32_t plane = 0; plane < 2; ++plane) {
    const uint32_t from = plane ? problem.free_means : 0, to = plane ? run.k() : problem.free_means;
    if (from == to) continue;
    if (out.start == Start::kPlusPlus) {
      run.start_plus_plus(plane != 0, from, to, random);
    } else {
      run.start_dense(plane != 0, from, to, {task.cut, 2},
                      out.start == Start::kDenseSpreadRandom ? &random : nullptr);
    }
  }
  for (uint32_t i = 0; i < run.n(); ++i) run.group[i] = 0;
  run.sizes[0] = run.n();
  run.assign();
  double before = std::numeric_limits<double>::infinity();
  for (; out.rounds < kMaxRounds; ++out.rounds) {
    run.fill_empty_groups();
    run.move_means();
    const bool changed = run.assign();
    out.objective = run.objective();
    // The last digits may differ although no group changed.
    if (out.objective > before * (1 + 1e-12)) out.never_rose = false;
    before = out.objective;
    out.converged = !changed;
    if (!changed) break;
  }
}

}  // namespace

bool run_kmeans(const KMeansProblem& problem, uint64_t seed, const ParallelFor& parallel,
                Arena& arena, const Allocator& allocator, Span<KMeansRun> runs) {
  Arena scratch(allocator);
  const uint32_t n = static_cast<uint32_t>(problem.points.count);
  Span<double> sorted;
  // Before the tasks: the caller's allocator serves the calling thread.
  Task task = {&problem, seed, runs, {}, {}};
  if (!make(scratch, n, sorted) || !make(scratch, runs.count, task.arrays)) return false;
  for (uint32_t i = 0; i < runs.count; ++i) {
    if (!make(arena, problem.free_means + problem.plane_means, runs[i].means) ||
        !make_arrays(problem, scratch, task.arrays[i])) {
      return false;
    }
  }
  for (uint32_t i = 0; i < n; ++i) sorted[i] = problem.density[i];
  std::sort(sorted.begin(), sorted.end());
  task.cut[0] = task.cut[1] = sorted[n / 2];
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
