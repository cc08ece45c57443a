// SPDX-License-Identifier: MIT
#include <algorithm>

#include "author/base/cholesky.h"
#include "author/base/dna_making.h"
#include "author/fit/fit_shapes.h"
#include "author/weights/carriers.h"

namespace mien::author {

namespace {

constexpr uint32_t kMaxInfluences = 16;
static_assert(kMaxInfluences >= kMaxAuthorInfluences + kMaxSharedBones, "");
constexpr uint32_t kVertexBlock = 1024;
// Rounds after the first; they pull the weights of a vertex to those of its neighbors in the round
// before.
constexpr uint32_t kSmoothRounds = 4;
// Vertices that hardly move are smoothed as if they moved by this multiple of the mean, because
// shapes say little about their weights.
constexpr double kTypical = 4;
// How much it counts, beside each shape, that the jaw takes the chin all the way.
constexpr double kCarried = 1;

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
    // The unconstrained optimum over the free unknowns, or as far toward it as all stay positive.
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

/// Least squares of one vertex: unknown i is the weight of joints[i].
struct VertexWeights {
  SmallSystem system;
  uint16_t joints[kMaxInfluences];
  double x[kMaxInfluences];
  double sum = 1;  // of the unknowns

  void add(uint16_t joint, double value) {
    joints[system.size] = joint;
    x[system.size++] = value;
  }
  bool has(uint16_t joint) const {
    return std::find(joints, joints + system.size, joint) != joints + system.size;
  }
  /// The last one takes the place of unknown i.
  void remove(uint32_t i) {
    SmallSystem& s = system;
    const uint32_t last = --s.size;
    joints[i] = joints[last];
    x[i] = x[last];
    s.right[i] = s.right[last];
    for (uint32_t k = 0; k <= last; ++k) s.matrix[i][k] = s.matrix[last][k];
    for (uint32_t k = 0; k < last; ++k) s.matrix[k][i] = s.matrix[k][last];
    s.matrix[i][i] = s.matrix[last][last];
  }
};

/// Stores the largest weights that fit, without those below 1e-4; they sum to one in float. False
/// if there are none, as after numbers beyond what doubles hold.
bool store(const VertexWeights& w, uint32_t vertex, SkinWeights& out) {
  uint16_t* joints = &out.joints[size_t{vertex} * out.m];
  float* weights = &out.weights[size_t{vertex} * out.m];
  uint32_t order[kMaxInfluences], count = 0;
  for (uint32_t i = 0; i < w.system.size; ++i) {
    if (w.x[i] >= 1e-4) order[count++] = i;
  }
  std::sort(order, order + count, [&w](uint32_t a, uint32_t b) {
    return w.x[a] != w.x[b] ? w.x[a] > w.x[b] : w.joints[a] < w.joints[b];
  });
  count = std::min(count, out.m);
  double sum = 0, rest = 1;
  for (uint32_t i = 0; i < count; ++i) sum += w.x[order[i]];
  if (!(sum > 0)) return false;
  for (uint32_t i = 0; i < out.m; ++i) {
    joints[i] = i < count ? w.joints[order[i]] : uint16_t{0};
    weights[i] = i < count ? static_cast<float>(w.x[order[i]] / sum) : 0;
    rest -= double{weights[i]};
  }
  weights[0] = static_cast<float>(double{weights[0]} + rest);
  return true;
}

struct RefitTask {
  const AuthorMesh& mesh;
  const SurfaceGraph& graph;
  const Motions& motions;
  Span<const uint16_t> shared;
  const BoneRoles& roles;
  const SkinWeights& from;
  SkinWeights before;  // of the last round; empty in the first
  double smoothness = 0;
  double pull = 0;     // pull to previous weights
  double typical = 0;  // squared displacements of a vertex, all shapes together, in the mean
  SkinWeights& out;
  Span<double> sums;  // over the shapes, of each vertex: the first round keeps them for the others
  uint32_t sums_each = 0;
};

double weight_of(const SkinWeights& weights, uint32_t vertex, uint16_t joint) {
  for (size_t i = size_t{vertex} * weights.m; i < size_t{vertex + 1} * weights.m; ++i) {
    if (weights.joints[i] == joint && weights.weights[i] > 0) return double{weights.weights[i]};
  }
  return 0;
}

/// Mean weight of each joint at the neighbors. False without neighbors.
bool find_neighbors_mean(const RefitTask& task, uint32_t v, const VertexWeights& w, double* mean) {
  const uint32_t place = task.mesh.welded[v];
  const uint32_t first = task.graph.starts[place], end = task.graph.starts[place + 1];
  if (first == end) return false;
  double sum = 0;
  for (uint32_t i = 0; i < w.system.size; ++i) mean[i] = 0;
  for (uint32_t e = first; e < end; ++e) {
    const double share = 1 / task.graph.lengths[e];
    sum += share;
    for (uint32_t i = 0; i < w.system.size; ++i) {
      mean[i] += share * weight_of(task.before, task.graph.neighbors[e], w.joints[i]);
    }
  }
  for (uint32_t i = 0; i < w.system.size; ++i) mean[i] /= sum;
  return true;
}

/// Adds the equations of all shapes for the vertex.
void sum_shapes(const RefitTask& task, uint32_t v, VertexWeights& w) {
  SmallSystem& s = w.system;
  const Vec3 p = task.mesh.positions[v];
  for (size_t shape = 0; shape < task.mesh.shapes.count; ++shape) {
    Vec3 moved[kMaxInfluences];
    bool moves = false;
    for (uint32_t i = 0; i < s.size; ++i) {
      const Affine& motion = task.motions.of(shape)[w.joints[i]];
      if (motion.is_identity()) continue;
      moved[i] = motion(p) - p;
      moves = true;
    }
    if (!moves) continue;
    const Vec3f wanted = task.mesh.shapes[shape].displacements[v];
    const Vec3 d = {double{wanted.x}, double{wanted.y}, double{wanted.z}};
    for (uint32_t i = 0; i < s.size; ++i) {
      s.right[i] += dot(moved[i], d);
      for (uint32_t k = 0; k <= i; ++k) s.matrix[i][k] += dot(moved[i], moved[k]);
    }
    // Where skin goes with the jaw, the jaw alone should take it all the way: bones below it could make up for less.
    if (shape != task.roles.opens) continue;
    const Vec3 carried = task.motions.of(shape)[task.roles.jaw](p) - p;
    const double all = dot(carried, carried), along = dot(carried, d);
    if (!(all > 0)) continue;
    const double counts = kCarried * smooth_step(0.8 * all, all, along);
    for (uint32_t i = 0; i < s.size; ++i) {
      if (!task.roles.below_jaw[w.joints[i]]) continue;
      s.right[i] += counts * along;
      for (uint32_t k = 0; k <= i; ++k) {
        if (task.roles.below_jaw[w.joints[k]]) s.matrix[i][k] += counts * all;
      }
    }
  }
}

/// The same; after the first round from its sums.
void find_sums(const RefitTask& task, uint32_t v, VertexWeights& w) {
  SmallSystem& s = w.system;
  const bool is_first = task.before.m == 0;
  if (is_first) sum_shapes(task, v, w);
  if (task.sums.empty()) return;
  double* sum = &task.sums[size_t{v} * task.sums_each];
  const auto keep = [&](double& value) {
    if (is_first) {
      *sum++ = value;
    } else {
      value = *sum++;
    }
  };
  for (uint32_t i = 0; i < s.size; ++i) {
    keep(s.right[i]);
    for (uint32_t k = 0; k <= i; ++k) keep(s.matrix[i][k]);
  }
}

/// The least squares problem of the vertex. False if none of its bones moves.
bool make_system(const RefitTask& task, uint32_t v, VertexWeights& w) {
  SmallSystem& s = w.system;
  find_sums(task, v, w);
  double trace = 0;
  for (uint32_t i = 0; i < s.size; ++i) trace += s.matrix[i][i];
  if (!(trace > 0)) return false;
  const double scale = trace / s.size, sum_row = 100.0 * 100.0 * scale, pull = task.pull * scale;
  double mean[kMaxInfluences];
  const double smooth = task.before.m > 0 && find_neighbors_mean(task, v, w, mean)
                            ? task.smoothness * (scale + kTypical * task.typical)
                            : 0;
  for (uint32_t i = 0; i < s.size; ++i) {
    s.right[i] += sum_row * w.sum + pull * w.x[i] + (smooth > 0 ? smooth * mean[i] : 0);
    for (uint32_t k = 0; k <= i; ++k) {
      s.matrix[i][k] += sum_row + (i == k ? pull + smooth : 0);
      s.matrix[k][i] = s.matrix[i][k];
    }
  }
  return true;
}

VertexWeights weights_of(const SkinWeights& from, uint32_t v) {
  VertexWeights w;
  for (size_t i = size_t{v} * from.m; w.system.size < from.m; ++i) {
    if (!(from.weights[i] > 0)) break;
    w.add(from.joints[i], double{from.weights[i]});
  }
  return w;
}

void refit_vertex(const RefitTask& task, uint32_t v) {
  const VertexWeights given = weights_of(task.from, v);
  VertexWeights w, held;
  for (uint32_t i = 0; i < given.system.size; ++i) {
    const bool is_held = !task.roles.held.empty() && task.roles.held[given.joints[i]];
    (is_held ? held : w).add(given.joints[i], given.x[i]);
    if (is_held) w.sum -= given.x[i];
  }
  // A vertex on the neck that no other bone moves keeps its weights.
  const bool is_rigid = given.system.size < 2 || w.system.size == 0 ||
                        (w.system.size == 1 && !task.shared.empty() && w.has(task.shared[0])) ||
                        held.system.size >= task.out.m;
  for (size_t i = 0; i < task.shared.count && !is_rigid; ++i) {
    if (!w.has(task.shared[i])) w.add(task.shared[i], 0);
  }
  if (is_rigid || !make_system(task, v, w)) {
    store(given, v, task.out);
    return;
  }
  solve_nonnegative(w.system, w.x);
  // Removes the smallest unknown as long as there are too many, and solves for the others again.
  for (;;) {
    uint32_t used = 0, lightest = 0;
    for (uint32_t i = 0; i < w.system.size; ++i) {
      if (!(w.x[i] > 0)) continue;
      if (used++ == 0 || w.x[i] < w.x[lightest]) lightest = i;
    }
    if (used + held.system.size <= task.out.m) break;
    w.remove(lightest);
    solve_nonnegative(w.system, w.x);
  }
  double found = 0;
  for (uint32_t i = 0; i < w.system.size; ++i) found += w.x[i];
  for (uint32_t i = 0; i < w.system.size && found > 0; ++i) w.x[i] *= w.sum / found;
  for (uint32_t i = 0; i < held.system.size; ++i) w.add(held.joints[i], held.x[i]);
  if (!(found > 0) || !store(w, v, task.out)) store(given, v, task.out);
}

}  // namespace

bool refit_weights(const AuthorMesh& mesh, const SurfaceGraph& graph, const Motions& motions,
                   Span<const uint16_t> shared, const BoneRoles& roles, double smoothness,
                   double pull, const ParallelFor& parallel, Arena& scratch,
                   const SkinWeights& from, SkinWeights& out) {
  SkinWeights given = from, before;
  before.m = out.m;
  if (!make(scratch, from.joints.count, given.joints) ||
      !make(scratch, from.weights.count, given.weights) ||
      !make(scratch, out.joints.count, before.joints) ||
      !make(scratch, out.weights.count, before.weights)) {
    return false;
  }
  std::copy(from.joints.begin(), from.joints.end(), given.joints.begin());
  std::copy(from.weights.begin(), from.weights.end(), given.weights.begin());
  RefitTask task = {mesh,       graph, motions, shared, roles, given, {},
                    smoothness, pull,  0,       out,    {},    0};
  if (smoothness > 0) {
    const size_t unknowns = from.m + shared.count;
    task.sums_each = static_cast<uint32_t>(unknowns * (unknowns + 3) / 2);
    if (!make(scratch, mesh.positions.count * task.sums_each, task.sums)) return false;
  }
  for (const Shape& shape : mesh.shapes) {
    for (const uint32_t v : shape.moving) {
      const Vec3f d = shape.displacements[v];
      task.typical += double{d.x} * d.x + double{d.y} * d.y + double{d.z} * d.z;
    }
  }
  task.typical /= static_cast<double>(mesh.positions.count);
  const uint32_t count = static_cast<uint32_t>(mesh.positions.count);
  const uint32_t rounds = smoothness > 0 ? kSmoothRounds : 0;
  for (uint32_t round = 0; round <= rounds; ++round) {
    if (round > 0) {
      std::copy(out.joints.begin(), out.joints.end(), before.joints.begin());
      std::copy(out.weights.begin(), out.weights.end(), before.weights.begin());
      task.before = before;
    }
    run_tasks(
        parallel, (count + kVertexBlock - 1) / kVertexBlock,
        [](void* context, uint32_t block) {
          const RefitTask& t = *static_cast<const RefitTask*>(context);
          const uint32_t end = std::min<uint32_t>(static_cast<uint32_t>(t.mesh.positions.count),
                                                  (block + 1) * kVertexBlock);
          for (uint32_t v = block * kVertexBlock; v < end; ++v) refit_vertex(t, v);
        },
        &task);
  }
  return true;
}

namespace {

bool find_roles(const Placement& placement, const Motions& motions, Arena& scratch,
                BoneRoles& out) {
  const Span<const Bone> bones = placement.bones;
  if (!make(scratch, bones.count, out.held) || !make(scratch, bones.count, out.below_jaw)) {
    return false;
  }
  for (uint32_t b = 0; b < bones.count; ++b) {
    const BoneKind kind = bones[b].kind;
    out.held[b] = kind == BoneKind::kChest || kind == BoneKind::kNeck;
    if (kind == BoneKind::kJaw && out.jaw == kNone) out.jaw = b;
    out.below_jaw[b] = b == out.jaw || (bones[b].parent < b && out.below_jaw[bones[b].parent]);
  }
  double least = 3 - 1e-6;  // of the rotation's trace
  const size_t shapes = bones.empty() ? 0 : motions.items.count / bones.count;
  for (uint32_t shape = 0; shape < shapes && out.jaw != kNone; ++shape) {
    const Affine& jaw = motions.of(shape)[out.jaw];
    const double trace = jaw.rows[0].x + jaw.rows[1].y + jaw.rows[2].z;
    if (!(trace < least)) continue;
    least = trace;
    out.opens = shape;
  }
  return true;
}

/// Edges of the mask.
double mean_length(const Placement& placement, const SurfaceGraph& graph, double otherwise) {
  double sum = 0;
  size_t count = 0;
  for (const uint32_t v : placement.mask) {
    for (uint32_t e = graph.starts[v]; e < graph.starts[v + 1]; ++e) sum += graph.lengths[e];
    count += graph.starts[v + 1] - graph.starts[v];
  }
  return sum > 0 ? sum / static_cast<double>(count) : otherwise;
}

}  // namespace

bool refit_finest(const AuthorMesh& mesh, const Placement& placement, const Motions& motions,
                  Span<const uint16_t> shared, const FitOptions& options,
                  const ParallelFor& parallel, const Allocator& allocator, SkinWeights& weights) {
  Arena scratch(allocator);
  SurfaceGraph graph;
  BoneRoles roles;
  double spacing = 0;
  if (!find_roles(placement, motions, scratch, roles) ||
      !make_surface_graph(mesh, scratch, scratch, graph) ||
      !find_median_spacing(placement, placement.facial_count, mesh.diagonal, scratch, spacing)) {
    return false;
  }
  // With more edges between two bones, weights may change less along each.
  const double edges = spacing / mean_length(placement, graph, mesh.diagonal);
  return refit_weights(mesh, graph, motions, shared, roles, options.smoothness * edges,
                       options.pull, parallel, scratch, weights, weights) &&
         connect_supports(mesh, graph, placement, bone_of_kind(placement, BoneKind::kHead, 0),
                          scratch, weights);
}

bool refit_lod(const AuthorMesh& mesh, const Placement& placement, const Motions& motions,
               Span<const uint16_t> shared, const FitOptions& options, const ParallelFor& parallel,
               const Allocator& allocator, const SkinWeights& from, SkinWeights& out) {
  Arena scratch(allocator);
  SurfaceGraph graph;
  BoneRoles roles;
  return find_roles(placement, motions, scratch, roles) &&
         make_surface_graph(mesh, scratch, scratch, graph) &&
         refit_weights(mesh, graph, motions, shared, roles, options.lod_smoothness,
                       options.lod_pull, parallel, scratch, from, out);
}

}  // namespace mien::author
