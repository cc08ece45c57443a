// SPDX-License-Identifier: MIT
#include "author/fit/targets.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/fit/procrustes.h"

namespace mien::author {

namespace {

Vec3f as_vec3f(Vec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

double& part(Vec3& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }
double part(const Vec3& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

void to_file(const Frame& frame, const Vec3 internal[3], Vec3 file[3]) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      part(file[frame.axis[i]], frame.axis[k]) =
          frame.sign[i] * frame.sign[k] * part(internal[i], k);
    }
  }
}

void to_internal(const Frame& frame, const Vec3 file[3], Vec3 internal[3]) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      part(internal[i], k) =
          frame.sign[i] * frame.sign[k] * part(file[frame.axis[i]], frame.axis[k]);
    }
  }
}

Affine internal_motion(const Frame& frame, Vec3 center, const double turn[3],
                       const double shift[3]) {
  const Affine file = motion(turn, {}, {});
  Affine out;
  to_internal(frame, file.rows, out.rows);
  out.shift = center + frame.to_internal({shift[0], shift[1], shift[2]}) - out.turn(center);
  return out;
}

}  // namespace

JointDelta delta_of_motion(const Bone& bone, const Frame& frame, const Affine& motion) {
  const Vec3 shift = frame.to_file(motion(bone.position) - bone.position);
  Vec3 rows[3];
  to_file(frame, motion.rows, rows);
  const Vec3 turn = euler_angles(rows);
  JointDelta out;
  for (int k = 0; k < 3; ++k) {
    out.translation[k] = static_cast<float>(part(shift, k));
    out.rotation[k] = static_cast<float>(part(turn, k));
  }
  return out;
}

void deltas_of_motions(const Placement& placement, const Frame& frame, Motions& motions,
                       const JointDeltas& out) {
  const uint32_t bones = motions.bone_count;
  for (size_t s = 0; s * bones < motions.items.count; ++s) {
    const uint32_t shape = static_cast<uint32_t>(s);
    for (uint32_t j = 0; j < bones; ++j) {
      const Bone& bone = placement.bones[j];
      const Span<const Affine> all = motions.of(s);
      out.at(shape, j) = motions.active_in(s)[j]
                             ? delta_of_motion(bone, frame, inverse(all[bone.parent]) * all[j])
                             : JointDelta();
    }
    pose_bones(placement, frame, out, {&shape, 1}, motions.of(s));
  }
}

void pose_bones(const Placement& placement, const Frame& frame, const JointDeltas& deltas,
                Span<const uint32_t> controls, Span<Affine> out) {
  for (uint32_t j = 0; j < out.count; ++j) {
    double turn[3] = {}, shift[3] = {};
    bool moves = false;
    for (const uint32_t control : controls) {
      const JointDelta& d = deltas.at(control, j);
      moves = moves || !d.is_zero();
      for (int k = 0; k < 3; ++k) {
        turn[k] += double{d.rotation[k]};
        shift[k] += double{d.translation[k]};
      }
    }
    const Bone& bone = placement.bones[j];
    const Affine above = bone.parent < j ? out[bone.parent] : Affine::identity();
    out[j] = moves ? above * internal_motion(frame, bone.position, turn, shift) : above;
  }
}

namespace {

struct TargetTask {
  const AuthorMesh& mesh;
  const SkinWeights& weights;
  const Motions& motions;
  Span<size_t> counts;
  Span<Target> targets;
  double threshold;

  /// Calls visit(vertex, offset) for each offset that is stored.
  template <class Visit>
  void visit_offsets(uint32_t s, const Visit& visit) const {
    const Affine* pose = motions.of(s).data;
    for (uint32_t v = 0; v < mesh.positions.count; ++v) {
      const Vec3 d = as_vec3(mesh.shapes[s].displacements[v]), p = mesh.positions[v];
      const Influences i = {&weights.joints[size_t{v} * weights.m],
                            &weights.weights[size_t{v} * weights.m], weights.m};
      bool moves = !is_zero(d);
      for (uint32_t k = 0; k < i.count && !moves; ++k) {
        moves = i.weights[k] > 0 && !pose[i.joints[k]].is_identity();
      }
      if (!moves) continue;
      const Vec3f offset = as_vec3f(residual(pose, i, p, p + d));
      const Vec3 b = as_vec3(offset);
      if (dot(b, b) > threshold * threshold) visit(v, offset);
    }
  }
};

}  // namespace

bool make_targets(const AuthorMesh& mesh, const SkinWeights& weights, const Motions& motions,
                  double threshold, const ParallelFor& parallel, Arena& arena, Span<Target>& out) {
  Span<size_t> counts;
  if (!make(arena, mesh.shapes.count, out) || !make(arena, mesh.shapes.count, counts)) return false;
  TargetTask task = {mesh, weights, motions, counts, out, threshold};
  run_tasks(
      parallel, static_cast<uint32_t>(mesh.shapes.count),
      [](void* context, uint32_t s) {
        const TargetTask& t = *static_cast<const TargetTask*>(context);
        t.visit_offsets(s, [&t, s](uint32_t, Vec3f) { ++t.counts[s]; });
      },
      &task);
  for (size_t s = 0; s < out.count; ++s) {
    if (!make(arena, counts[s], out[s].vertices) || !make(arena, counts[s], out[s].offsets)) {
      return false;
    }
  }
  run_tasks(
      parallel, static_cast<uint32_t>(mesh.shapes.count),
      [](void* context, uint32_t s) {
        const TargetTask& t = *static_cast<const TargetTask*>(context);
        Target& target = t.targets[s];
        size_t n = 0;
        t.visit_offsets(s, [&target, &n](uint32_t v, Vec3f offset) {
          target.vertices[n] = v;
          target.offsets[n++] = offset;
          target.energy += dot(as_vec3(offset), as_vec3(offset));
        });
      },
      &task);
  return true;
}

bool measure_fit(const AuthorMesh& mesh, const SkinWeights& weights, const Motions& motions,
                 Span<const Target> targets, const ParallelFor& parallel, Arena& arena,
                 FitError& out) {
  out = {};
  Span<double> sorted;
  if (!make(arena, mesh.shapes.count, out.shapes) || !make(arena, mesh.shapes.count, sorted)) {
    return false;
  }
  struct Task {
    const AuthorMesh& mesh;
    const SkinWeights& weights;
    const Motions& motions;
    Span<const Target> targets;
    Span<ShapeError> out;
  } task = {mesh, weights, motions, targets, out.shapes};
  run_tasks(
      parallel, static_cast<uint32_t>(mesh.shapes.count),
      [](void* context, uint32_t s) {
        const Task& t = *static_cast<const Task*>(context);
        const Affine* pose = t.motions.of(s).data;
        const Target target = t.targets.empty() ? Target() : t.targets[s];
        ShapeError e;
        size_t next = 0;
        for (uint32_t v = 0; v < t.mesh.positions.count; ++v) {
          Vec3 from = t.mesh.positions[v];
          const Vec3 d = as_vec3(t.mesh.shapes[s].displacements[v]), to = from + d;
          if (next < target.vertices.count && target.vertices[next] == v) {
            from = from + as_vec3(target.offsets[next++]);
          }
          const Influences i = {&t.weights.joints[size_t{v} * t.weights.m],
                                &t.weights.weights[size_t{v} * t.weights.m], t.weights.m};
          const Vec3 rest = to - skin(pose, i, from);
          e.squares += dot(rest, rest);
          e.energy += dot(d, d);
          e.max = std::max(e.max, length(rest));
        }
        e.error = e.energy > 0 ? std::sqrt(e.squares / e.energy) : 0;
        t.out[s] = e;
      },
      &task);
  double squares = 0, energy = 0;
  for (size_t s = 0; s < out.shapes.count; ++s) {
    const ShapeError& e = out.shapes[s];
    squares += e.squares;
    energy += e.energy;
    sorted[s] = e.error;
    out.max = std::max(out.max, e.max);
    if (out.worst_shape == kNone || e.error > out.worst) {
      out.worst = e.error;
      out.worst_shape = static_cast<uint32_t>(s);
    }
  }
  if (out.shapes.empty()) return true;
  std::sort(sorted.begin(), sorted.end());
  const size_t half = sorted.count / 2;
  out.median = sorted.count % 2 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
  out.error = energy > 0 ? std::sqrt(squares / energy) : 0;
  const double terms = static_cast<double>(mesh.positions.count * out.shapes.count);
  out.rms = std::sqrt(squares / terms) / mesh.diagonal;
  out.max /= mesh.diagonal;
  return true;
}

}  // namespace mien::author
