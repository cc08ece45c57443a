// SPDX-License-Identifier: MIT
#include <algorithm>

#include "runtime/author/cholesky.h"
#include "runtime/author/fit/fit_shapes.h"

namespace mien::author {

namespace {

constexpr uint32_t kMaxInfluences = 16;
constexpr uint32_t kVertexBlock = 1024;

/// Least squares over few unknowns that may not become negative: x^T matrix x / 2 - right^T x.
struct SmallSystem {
  double matrix[kMaxInfluences][kMaxInfluences] = {};
  double right[kMaxInfluences] = {};
  uint32_t size = 0;
};

/// By active sets (C. L. Lawson, R. J. Hanson, "Solving Least Squares Problems", 1974, chapter 23).
/// `x` starts feasible.
void solve_nonnegative(const SmallSystem& s, double* x) {
  bool free[kMaxInfluences];
  for (uint32_t i = 0; i < s.size; ++i) free[i] = x[i] > 0;
  for (uint32_t round = 0; round < 4 * s.size; ++round) {
    // The unconstrained optimum over the free unknowns, or as far towards it as all stay positive.
    for (;;) {
      uint32_t index[kMaxInfluences], n = 0;
      double packed[kMaxInfluences * kMaxInfluences], best[kMaxInfluences];
      for (uint32_t i = 0; i < s.size; ++i) {
        if (free[i]) index[n++] = i;
      }
      if (n == 0) break;
      for (uint32_t r = 0; r < n; ++r) {
        for (uint32_t c = 0; c <= r; ++c) packed[r * n + c] = s.matrix[index[r]][index[c]];
        best[r] = s.right[index[r]];
      }
      Cholesky system(packed, n);
      system.factor();
      system.solve(best);
      double share = 1;
      uint32_t leaving = n;
      for (uint32_t r = 0; r < n; ++r) {
        if (best[r] > 0) continue;
        const double here = x[index[r]] / (x[index[r]] - best[r]);
        if (here < share || leaving == n) {
          share = std::min(here, share);
          leaving = r;
        }
      }
      for (uint32_t r = 0; r < n; ++r) x[index[r]] += share * (best[r] - x[index[r]]);
      if (leaving == n) break;
      x[index[leaving]] = 0;
      free[index[leaving]] = false;
    }
    // Free the unknown that would lower the sum most.
    uint32_t entering = s.size;
    double steepest = 0;
    for (uint32_t i = 0; i < s.size; ++i) {
      if (free[i]) continue;
      double slope = s.right[i];
      for (uint32_t k = 0; k < s.size; ++k) slope -= s.matrix[i][k] * x[k];
      if (slope > 1e-12 * s.matrix[i][i] && slope > steepest) {
        steepest = slope;
        entering = i;
      }
    }
    if (entering == s.size) return;
    free[entering] = true;
  }
}

/// Weights below 1e-4 go; the rest sums to one in float, heaviest first.
void store(const double* x, uint16_t* joints, float* weights, uint32_t m) {
  uint32_t order[kMaxInfluences];
  uint16_t old[kMaxInfluences];
  double kept[kMaxInfluences], sum = 0;
  for (uint32_t i = 0; i < m; ++i) {
    order[i] = i;
    old[i] = joints[i];
    kept[i] = x[i] < 1e-4 ? 0 : x[i];
    sum += kept[i];
  }
  if (!(sum > 0)) return;
  std::sort(order, order + m, [&](uint32_t a, uint32_t b) {
    return kept[a] != kept[b] ? kept[a] > kept[b] : old[a] < old[b];
  });
  double rest = 1;
  for (uint32_t i = 0; i < m; ++i) {
    weights[i] = static_cast<float>(kept[order[i]] / sum);
    joints[i] = weights[i] > 0 ? old[order[i]] : uint16_t{0};
    rest -= double{weights[i]};
  }
  weights[0] = static_cast<float>(double{weights[0]} + rest);
}

void refit_vertex(const AuthorMesh& mesh, const Motions& motions, uint32_t v,
                  SkinWeights& weights) {
  uint16_t* joints = &weights.joints[size_t{v} * weights.m];
  float* values = &weights.weights[size_t{v} * weights.m];
  SmallSystem s;
  double x[kMaxInfluences];
  while (s.size < weights.m && values[s.size] > 0) {
    x[s.size] = double{values[s.size]};
    ++s.size;
  }
  if (s.size < 2) return;
  const Vec3 p = mesh.positions[v];
  for (size_t shape = 0; shape < mesh.shapes.count; ++shape) {
    Vec3 moved[kMaxInfluences];
    bool moves = false;
    for (uint32_t i = 0; i < s.size; ++i) {
      if (!motions.active_in(shape)[joints[i]]) continue;
      moved[i] = motions.of(shape)[joints[i]](p) - p;
      moves = true;
    }
    if (!moves) continue;
    const Vec3f wanted = mesh.shapes[shape].displacements[v];
    const Vec3 d = {double{wanted.x}, double{wanted.y}, double{wanted.z}};
    for (uint32_t i = 0; i < s.size; ++i) {
      s.right[i] += dot(moved[i], d);
      for (uint32_t k = 0; k <= i; ++k) s.matrix[i][k] += dot(moved[i], moved[k]);
    }
  }
  double trace = 0;
  for (uint32_t i = 0; i < s.size; ++i) trace += s.matrix[i][i];
  if (!(trace > 0)) return;
  const double scale = trace / s.size, sum_row = 100.0 * 100.0 * scale, pull = 0.05 * 0.05 * scale;
  for (uint32_t i = 0; i < s.size; ++i) {
    s.right[i] += sum_row + pull * x[i];
    for (uint32_t k = 0; k <= i; ++k) {
      s.matrix[i][k] += sum_row + (i == k ? pull : 0);
      s.matrix[k][i] = s.matrix[i][k];
    }
  }
  solve_nonnegative(s, x);
  store(x, joints, values, s.size);
}

}  // namespace

void refit_weights(const AuthorMesh& mesh, const Motions& motions, const ParallelFor& parallel,
                   SkinWeights& weights) {
  struct Task {
    const AuthorMesh& mesh;
    const Motions& motions;
    SkinWeights& weights;
  } task = {mesh, motions, weights};
  const uint32_t count = static_cast<uint32_t>(mesh.positions.count);
  run_tasks(
      parallel, (count + kVertexBlock - 1) / kVertexBlock,
      [](void* context, uint32_t block) {
        const Task& t = *static_cast<const Task*>(context);
        const uint32_t end = std::min<uint32_t>(static_cast<uint32_t>(t.mesh.positions.count),
                                                (block + 1) * kVertexBlock);
        for (uint32_t v = block * kVertexBlock; v < end; ++v) {
          refit_vertex(t.mesh, t.motions, v, t.weights);
        }
      },
      &task);
}

}  // namespace mien::author
