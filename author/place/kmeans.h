// SPDX-License-Identifier: MIT
// Bones of the face: means of k groups of points that minimize the weighted sum of squared
// distances (Lloyd's algorithm), from several starts.
//
// With a plane of symmetry all work is done on one half: points are folded onto x >= 0, and a mean
// stands for a mirrored pair, or is held on the plane. The nearest mean of a point with x >= 0 is
// never the far one of a pair, so the folded sum is the whole sum under the constraint, to the bit.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/base/parallel_for.h"
#include "runtime/base/vector.h"

namespace mien::author {

struct KMeansProblem {
  Span<const Vec3> points;     // with symmetry: folded, the plane at x = 0
  Span<const double> weights;  // positive
  Span<const double> density;  // of the surface at each point
  uint32_t free_means = 0;     // with symmetry: pairs
  uint32_t plane_means = 0;    // with symmetry: means with x = 0
  double plane_width = 0;      // points with x below it are where plane means start
};

/// How a run starts.
enum class Start : uint8_t {
  kDenseSpread,        // as in the paper: dense regions, well separated
  kDenseSpreadRandom,  // the same from a random first point
  kPlusPlus,           // candidates drawn in proportion to the squared distance to earlier means;
                       // the one that leaves the least sum is taken
  kSwaps               // from another run: means that contribute little move to where they are
};

struct KMeansRun {
  Start start = Start::kPlusPlus;
  double objective = 0;
  uint32_t rounds = 0;
  bool converged = false;  // no point changed its group in the last round
  bool never_rose = true;  // the objective, from round to round
  Span<Vec3> means;        // free ones first
};

constexpr uint32_t kMaxRounds = 300;

/// Runs start[i] for each i, with streams of `seed`. Memory of the runs comes from `arena`. The
/// same bits for any threads. False if memory ran out.
bool run_kmeans(const KMeansProblem& problem, uint64_t seed, const ParallelFor& parallel,
                Arena& arena, const Allocator& allocator, Span<KMeansRun> runs);

/// Continues from `from`: as long as the sum falls, the means whose removal costs least move into
/// the groups that gain most from a second mean, and rounds follow. The same memory and bits as for
/// run_kmeans().
bool improve_kmeans(const KMeansProblem& problem, const KMeansRun& from, Arena& arena,
                    const Allocator& allocator, KMeansRun& out);

/// For each point the nearest mean and the next nearest (the same if there is one mean only).
void nearest_means(Span<const Vec3> points, Span<const Vec3> means, Span<uint32_t> nearest,
                   Span<uint32_t> next);

/// 1 / squared distance of the 16th nearest neighbor of each point. False if memory ran out.
bool surface_density(Span<const Vec3> points, const ParallelFor& parallel, Arena& scratch,
                     Span<double> out);

}  // namespace mien::author
