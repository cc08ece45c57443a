// SPDX-License-Identifier: MIT
#include "author/fit/fit_shapes.h"

#include <algorithm>

#include "author/base/cholesky.h"
#include "author/base/dna_making.h"
#include "author/fit/procrustes.h"

namespace mien::author {

bool make_fitter(Span<const Vec3> positions, const Placement& placement, uint32_t influences,
                 const FitOptions& options, Arena& arena, Fitter& out) {
  out.positions = positions;
  out.options = options;
  const size_t bones = placement.bones.count;
  if (!make_footprints(positions.count, placement, influences, arena, out.footprints)) return false;
  for (FitLane& lane : out.lanes) {
    if (!make(arena, positions.count, lane.rest) || !make(arena, bones * bones, lane.matrix) ||
        !make(arena, bones, lane.steps) || !make(arena, bones, lane.rows) ||
        !make(arena, bones, lane.energy)) {
      return false;
    }
  }
  return true;
}

bool make_motions(size_t shapes, size_t bones, Arena& arena, Motions& out) {
  out.bone_count = static_cast<uint32_t>(bones);
  if (!make(arena, shapes * bones, out.items) || !make(arena, shapes * bones, out.active)) {
    return false;
  }
  for (Affine& a : out.items) a = Affine::identity();
  return true;
}

void find_support(const Fitter& fitter, FitLane& lane, Span<uint8_t> active) {
  const Footprints& f = fitter.footprints;
  double largest[2] = {};  // of joints of teeth and eyeballs; of facial joints
  for (uint32_t j = 0; j < f.bone_count; ++j) {
    double energy = 0;
    if (f.fitted[j]) {
      for (const Influenced& e : f.of(j)) {
        energy +=
            dot(lane.rest[e.vertex], lane.rest[e.vertex]) * double{e.weight} * double{e.weight};
      }
    }
    lane.energy[j] = energy;
    double& most = largest[f.facial[j]];
    most = std::max(most, energy);
  }
  for (uint32_t j = 0; j < f.bone_count; ++j) {
    active[j] = lane.energy[j] > fitter.options.support * largest[f.facial[j]];
  }
}

namespace {

/// (A^T A + damping) T = A^T rest over the active bones.
void fit_translations(const Footprints& f, FitLane& lane, Span<const uint8_t> active,
                      Span<Affine> motions) {
  uint32_t size = 0;
  for (uint32_t j = 0; j < f.bone_count; ++j) {
    if (active[j]) lane.rows[size++] = static_cast<uint16_t>(j);
  }
  for (uint32_t r = 0; r < size; ++r) {
    const double* row = &f.gram[size_t{lane.rows[r]} * f.bone_count];
    for (uint32_t c = 0; c <= r; ++c) lane.matrix[size_t{r} * size + c] = row[lane.rows[c]];
    lane.matrix[size_t{r} * size + r] += f.damping;
    Vec3 sum;
    for (const Influenced& e : f.of(lane.rows[r])) {
      sum = sum + lane.rest[e.vertex] * double{e.weight};
    }
    lane.steps[r] = sum;
  }
  Cholesky system(lane.matrix.data, size);
  system.factor();
  system.solve(lane.steps.data);
  for (uint32_t r = 0; r < size; ++r) {
    const Vec3 step = lane.steps[r];
    motions[lane.rows[r]].shift = motions[lane.rows[r]].shift + step;
    for (const Influenced& e : f.of(lane.rows[r])) {
      lane.rest[e.vertex] = lane.rest[e.vertex] - step * double{e.weight};
    }
  }
}

/// The rigid motion of one bone with the least remaining error while the others are fixed: weighted
/// Procrustes with masses w^2 towards y = M v + rest / w. As w y = w M v + rest, no vertex is
/// divided by its weight.
void fit_bone(const Fitter& fitter, const Footprints& f, uint32_t bone, bool is_rigid,
              FitLane& lane, Affine& motion) {
  const Moments& m = f.moments[bone];
  if (!(m.mass > 0)) return;
  Vec3 force, torque[3];
  for (const Influenced& e : f.of(bone)) {
    const Vec3 pull = lane.rest[e.vertex] * double{e.weight};
    const Vec3 arm = fitter.positions[e.vertex] - m.center;
    force = force + pull;
    torque[0] = torque[0] + arm * pull.x;
    torque[1] = torque[1] + arm * pull.y;
    torque[2] = torque[2] + arm * pull.z;
  }
  // A term toward the current pose of the bone damps footprints that hardly constrain the rotation.
  const double hold = (is_rigid ? 1e-6 : 0.05) * m.size();
  Vec3 map[3];
  for (int r = 0; r < 3; ++r) {
    const Vec3 row = motion.rows[r];
    map[r] =
        m.spread[0] * row.x + m.spread[1] * row.y + m.spread[2] * row.z + torque[r] + row * hold;
  }
  Affine next;
  const double half = fitter.options.max_degrees * kPi / 360;
  closest_rotation(map, is_rigid ? 1 : exact_sine(half), next.rows);
  next.shift = motion(m.center) + force * (1 / m.mass) - next.turn(m.center);
  Affine further;
  for (int r = 0; r < 3; ++r) further.rows[r] = next.rows[r] - motion.rows[r];
  further.shift = next.shift - motion.shift;
  for (const Influenced& e : f.of(bone)) {
    lane.rest[e.vertex] =
        lane.rest[e.vertex] - further(fitter.positions[e.vertex]) * double{e.weight};
  }
  motion = next;
}

void descend(const Fitter& fitter, const Placement& placement, FitLane& lane,
             Span<const uint8_t> active, Span<Affine> motions) {
  const Footprints& f = fitter.footprints;
  for (uint32_t sweep = 0; sweep < fitter.options.sweeps; ++sweep) {
    for (uint32_t j = 0; j < f.bone_count; ++j) {
      if (!active[j]) continue;
      fit_bone(fitter, f, j, placement.bones[j].kind != BoneKind::kFacial, lane, motions[j]);
    }
  }
}

}  // namespace

void fit_motions(const Fitter& fitter, const Placement& placement, FitLane& lane,
                 Span<const uint8_t> active, Span<Affine> motions) {
  fit_translations(fitter.footprints, lane, active, motions);
  if (fitter.options.rotations) descend(fitter, placement, lane, active, motions);
}

namespace {

/// Sets the displacements of the rows for one shape.
void start_rest(const Fitter& fitter, Span<const Vec3f> wanted, FitLane& lane) {
  for (size_t row = 0; row < lane.rest.count; ++row) {
    const Vec3f d = wanted[fitter.vertices.empty() ? row : fitter.vertices[row]];
    lane.rest[row] = {double{d.x}, double{d.y}, double{d.z}};
    if (!fitter.scales.empty()) lane.rest[row] = lane.rest[row] * fitter.scales[row];
  }
}

/// Continues from the current motions.
void improve_motions(const Fitter& fitter, const Placement& placement, FitLane& lane,
                     Span<const uint8_t> active, Span<Affine> motions) {
  for (uint32_t j = 0; j < motions.count; ++j) {
    if (!active[j]) continue;
    for (const Influenced& e : fitter.footprints.of(j)) {
      const Vec3 p = fitter.positions[e.vertex];
      lane.rest[e.vertex] = lane.rest[e.vertex] - (motions[j](p) - p) * double{e.weight};
    }
  }
  descend(fitter, placement, lane, active, motions);
}

}  // namespace

void fit_all(Fitter& fitter, const AuthorMesh& mesh, const Placement& placement,
             const SkinWeights& weights, bool given, const ParallelFor& parallel,
             const Motions& out) {
  fill_footprints(fitter.positions, weights, parallel, fitter.footprints);
  struct Task {
    Fitter& fitter;
    const AuthorMesh& mesh;
    const Placement& placement;
    const Motions& out;
    bool given;
  } task = {fitter, mesh, placement, out, given};
  run_tasks(
      parallel, kFitLanes,
      [](void* context, uint32_t index) {
        const Task& t = *static_cast<const Task*>(context);
        FitLane& lane = t.fitter.lanes[index];
        for (size_t s = index; s < t.mesh.shapes.count; s += kFitLanes) {
          const Span<uint8_t> active = t.out.active_in(s);
          const Span<Affine> motions = t.out.of(s);
          start_rest(t.fitter, t.mesh.shapes[s].displacements, lane);
          if (!t.given) find_support(t.fitter, lane, active);
          const bool goes_on = t.given && t.fitter.options.rotations;
          for (uint32_t j = 0; j < motions.count; ++j) {
            if (!goes_on || !active[j]) motions[j] = Affine::identity();
          }
          if (goes_on) {
            improve_motions(t.fitter, t.placement, lane, active, motions);
          } else {
            fit_motions(t.fitter, t.placement, lane, active, motions);
          }
        }
      },
      &task);
}

}  // namespace mien::author
