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
    active[j] = j != f.jaw && lane.energy[j] > fitter.options.support * largest[f.facial[j]];
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

/// The further motion of these vertices is done.
void take_off(const Fitter& fitter, Span<const Influenced> entries, const Affine& before,
              const Affine& after, FitLane& lane) {
  Affine further;
  for (int r = 0; r < 3; ++r) further.rows[r] = after.rows[r] - before.rows[r];
  further.shift = after.shift - before.shift;
  for (const Influenced& e : entries) {
    lane.rest[e.vertex] =
        lane.rest[e.vertex] - further(fitter.positions[e.vertex]) * double{e.weight};
  }
}

/// a times the transpose of b.
void turn_back(const Vec3 a[3], const Vec3 b[3], Vec3 out[3]) {
  for (int r = 0; r < 3; ++r) out[r] = {dot(a[r], b[0]), dot(a[r], b[1]), dot(a[r], b[2])};
}

/// The rigid motion of these vertices with the smallest remaining displacement, everything else held:
/// weighted Procrustes with masses w^2 towards y = M v + rest / w. As w y = w M v + rest, no vertex is
/// divided by its weight. It turns by no more than `max_half_sine` from `parent`, and is damped by a share
/// `hold` of the footprint.
Affine fit_rigid(const Fitter& fitter, Span<const Influenced> entries, const Moments& m,
                 const Affine& motion, const Affine& parent, double max_half_sine, double hold,
                 const FitLane& lane) {
  Vec3 force, torque[3];
  for (const Influenced& e : entries) {
    const Vec3 pull = lane.rest[e.vertex] * double{e.weight};
    const Vec3 arm = fitter.positions[e.vertex] - m.center;
    force = force + pull;
    torque[0] = torque[0] + arm * pull.x;
    torque[1] = torque[1] + arm * pull.y;
    torque[2] = torque[2] + arm * pull.z;
  }
  Vec3 map[3], own[3], turn[3];
  for (int r = 0; r < 3; ++r) {
    const Vec3 row = motion.rows[r];
    map[r] = m.spread[0] * row.x + m.spread[1] * row.y + m.spread[2] * row.z + torque[r] +
             row * (hold * m.size());
  }
  turn_back(map, parent.rows, own);
  closest_rotation(own, max_half_sine, turn);
  Affine next;
  for (int r = 0; r < 3; ++r) {
    next.rows[r] =
        parent.rows[0] * turn[r].x + parent.rows[1] * turn[r].y + parent.rows[2] * turn[r].z;
  }
  next.shift = motion(m.center) + force * (1 / m.mass) - next.turn(m.center);
  return next;
}

/// Whether the vertex is on the one bone only.
bool is_whole(const Fitter& fitter, const Influenced& e) {
  const double scale = fitter.scales.empty() ? 1 : fitter.scales[e.vertex];
  return double{e.weight} > 0.999 * scale;
}

/// The rigid motion that fits vertices entirely on the jaw, such as teeth: in rounds, each vertex is
/// weighted by the inverse of its residual. Starts from `motion`, which is the result without teeth.
Affine fit_teeth(const Fitter& fitter, Affine motion, const FitLane& lane) {
  constexpr int kRounds = 20;
  constexpr size_t kTeeth = 20;     // vertices at least
  constexpr double kAgreed = 0.02;  // of the motion: off by less is not off
  const Span<const Influenced> entries = fitter.footprints.of(fitter.footprints.jaw);
  size_t count = 0;
  double energy = 0, masses = 0;
  for (const Influenced& e : entries) {
    if (!is_whole(fitter, e)) continue;
    ++count;
    energy += dot(lane.rest[e.vertex], lane.rest[e.vertex]);
    masses += double{e.weight} * double{e.weight};
  }
  if (count < kTeeth || !(energy > 0)) return motion;
  const double least = kAgreed * std::sqrt(energy / masses);
  for (int round = 0; round < kRounds; ++round) {
    // First the mean, then moments about it.
    Moments m;
    Vec3 force, map[3];
    const auto count_of = [&](const Influenced& e) {
      const Vec3 p = fitter.positions[e.vertex];
      return 1 / (length(lane.rest[e.vertex] - (motion(p) - p) * double{e.weight}) + least);
    };
    for (const Influenced& e : entries) {
      if (!is_whole(fitter, e)) continue;
      const double share = count_of(e), mass = share * double{e.weight} * double{e.weight};
      m.mass += mass;
      m.center = m.center + fitter.positions[e.vertex] * mass;
      force = force + lane.rest[e.vertex] * (share * double{e.weight});
    }
    if (!(m.mass > 0)) return motion;
    m.center = m.center * (1 / m.mass);
    for (const Influenced& e : entries) {
      if (!is_whole(fitter, e)) continue;
      const double share = count_of(e), weight = double{e.weight};
      const Vec3 arm = fitter.positions[e.vertex] - m.center;
      // Towards arm + rest / weight.
      const Vec3 to = arm * (share * weight * weight) + lane.rest[e.vertex] * (share * weight);
      map[0] = map[0] + arm * to.x;
      map[1] = map[1] + arm * to.y;
      map[2] = map[2] + arm * to.z;
    }
    closest_rotation(map, 1, motion.rows);
    motion.shift = m.center + force * (1 / m.mass) - motion.turn(m.center);
  }
  return motion;
}

void fit_bone(const Fitter& fitter, uint32_t bone, FitLane& lane, Span<Affine> motions) {
  const Footprints& f = fitter.footprints;
  const Moments& m = f.moments[bone];
  if (!(m.mass > 0)) return;
  const bool is_rigid = !f.facial[bone];
  const double half = fitter.options.max_degrees * kPi / 360;
  // A term towards where the bone is now damps footprints that hardly tell rotations apart.
  const Affine next = fit_rigid(fitter, f.of(bone), m, motions[bone], motions[f.parents[bone]],
                                is_rigid ? 1 : exact_sine(half), is_rigid ? 1e-6 : 0.05, lane);
  take_off(fitter, f.of(bone), motions[bone], next, lane);
  motions[bone] = next;
}

/// Bones that go with their parents, after those have moved.
void take_along(const Fitter& fitter, FitLane& lane, Span<const uint8_t> active,
                Span<Affine> motions) {
  const Footprints& f = fitter.footprints;
  for (uint32_t j = 0; j < f.bone_count; ++j) {
    const Affine& parent = motions[f.parents[j]];
    if (active[j] || motions[j] == parent) continue;
    take_off(fitter, f.of(j), motions[j], parent, lane);
    motions[j] = parent;
  }
}

void descend(const Fitter& fitter, FitLane& lane, Span<const uint8_t> active,
             Span<Affine> motions) {
  for (uint32_t sweep = 0; sweep < fitter.options.sweeps; ++sweep) {
    for (uint32_t j = 0; j < fitter.footprints.bone_count; ++j) {
      if (active[j] && j != fitter.footprints.jaw) fit_bone(fitter, j, lane, motions);
    }
    take_along(fitter, lane, active, motions);
  }
}

/// The rotation about `joint`, or the rigid motion if there is none, that takes these vertices nearest to where they
/// go, each as if it was entirely on the bone: weights and angle could otherwise make up for each other.
Affine carry_whole(const Fitter& fitter, Span<const Influenced> entries, const Vec3* joint,
                   double max_half_sine, const FitLane& lane) {
  double masses = 0;
  Vec3 center, shift, map[3];
  const auto visit = [&](const auto& add) {
    for (const Influenced& e : entries) {
      const double scale = fitter.scales.empty() ? 1 : fitter.scales[e.vertex];
      add(fitter.positions[e.vertex], lane.rest[e.vertex] * (1 / scale),
          double{e.weight} * double{e.weight});
    }
  };
  if (!joint) {
    visit([&](Vec3 from, Vec3 way, double mass) {
      masses += mass;
      center = center + from * mass;
      shift = shift + way * mass;
    });
    if (!(masses > 0)) return Affine::identity();
    center = center * (1 / masses);
    shift = shift * (1 / masses);
  } else {
    center = *joint;
  }
  visit([&](Vec3 from, Vec3 way, double mass) {
    const Vec3 arm = from - center, to = (arm + way) * mass;
    map[0] = map[0] + arm * to.x;
    map[1] = map[1] + arm * to.y;
    map[2] = map[2] + arm * to.z;
  });
  Affine out;
  closest_rotation(map, max_half_sine, out.rows);
  out.shift = center + shift - out.turn(center);
  return out;
}

/// Fits the jaw first, with everything below it, in shapes that move most of that rigidly; the jaw keeps
/// this motion. Returns whether it moves.
bool open_jaw(const Fitter& fitter, FitLane& lane, Span<Affine> motions) {
  const Footprints& f = fitter.footprints;
  if (f.jaw == kNone || !(f.carried_moments.mass > 0)) return false;
  const Span<const Influenced> all = f.of_jaw();
  const auto energy = [&] {
    double sum = 0;
    for (const Influenced& e : all) {
      sum += dot(lane.rest[e.vertex], lane.rest[e.vertex]) * double{e.weight} * double{e.weight};
    }
    return sum;
  };
  const double before = energy();
  if (!(before > 0)) return false;
  const Affine still = motions[f.jaw];
  const double half = fitter.options.rotations ? 1 : 0;
  const auto opens_by = [&](const Affine& motion) {
    take_off(fitter, all, still, motion, lane);
    const bool opens = energy() <= (1 - fitter.options.jaw_share) * before;
    take_off(fitter, all, motion, still, lane);
    return opens;
  };
  // About its joint, if that is enough: on the skin, rotation and translation are hard to tell apart.
  Affine next = carry_whole(fitter, all, &f.jaw_position, half, lane);
  if (!opens_by(next)) {
    next = carry_whole(fitter, all, nullptr, half, lane);
    if (!opens_by(next)) return false;
  }
  if (half > 0) next = fit_teeth(fitter, next, lane);
  take_off(fitter, all, still, next, lane);
  for (uint32_t j = 0; j < f.bone_count; ++j) {
    if (!f.below_jaw[j]) continue;
    if (!f.on_jaw[j]) take_off(fitter, f.of(j), motions[j], next, lane);
    motions[j] = next;
  }
  return true;
}

}  // namespace

void fit_motions(const Fitter& fitter, FitLane& lane, Span<const uint8_t> active,
                 Span<Affine> motions) {
  fit_translations(fitter.footprints, lane, active, motions);
  take_along(fitter, lane, active, motions);
  if (fitter.options.rotations) descend(fitter, lane, active, motions);
}

void follow_parents(const Footprints& footprints, Span<const uint8_t> active,
                    Span<Affine> motions) {
  for (uint32_t j = 0; j < motions.count; ++j) {
    if (!active[j]) motions[j] = j > 0 ? motions[footprints.parents[j]] : Affine::identity();
  }
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

/// Goes on from the motions as they are.
void improve_motions(const Fitter& fitter, FitLane& lane, Span<const uint8_t> active,
                     Span<Affine> motions) {
  follow_parents(fitter.footprints, active, motions);
  for (uint32_t j = 0; j < motions.count; ++j) {
    if (motions[j].is_identity()) continue;
    take_off(fitter, fitter.footprints.of(j), Affine::identity(), motions[j], lane);
  }
  descend(fitter, lane, active, motions);
}

}  // namespace

void fit_all(Fitter& fitter, const AuthorMesh& mesh, const SkinWeights& weights, bool given,
             const ParallelFor& parallel, const Motions& out) {
  fill_footprints(fitter.positions, weights, parallel, fitter.footprints);
  struct Task {
    Fitter& fitter;
    const AuthorMesh& mesh;
    const Motions& out;
    bool given;
  } task = {fitter, mesh, out, given};
  run_tasks(
      parallel, kFitLanes,
      [](void* context, uint32_t index) {
        const Task& t = *static_cast<const Task*>(context);
        FitLane& lane = t.fitter.lanes[index];
        for (size_t s = index; s < t.mesh.shapes.count; s += kFitLanes) {
          const Span<uint8_t> active = t.out.active_in(s);
          const Span<Affine> motions = t.out.of(s);
          start_rest(t.fitter, t.mesh.shapes[s].displacements, lane);
          if (t.given && t.fitter.options.rotations) {
            improve_motions(t.fitter, lane, active, motions);
            continue;
          }
          for (Affine& motion : motions) motion = Affine::identity();
          const uint32_t jaw = t.fitter.footprints.jaw;
          if (t.given) {
            if (jaw != kNone && active[jaw]) open_jaw(t.fitter, lane, motions);
          } else {
            const bool opens = open_jaw(t.fitter, lane, motions);
            find_support(t.fitter, lane, active);
            if (jaw != kNone) active[jaw] = opens;
          }
          fit_motions(t.fitter, lane, active, motions);
        }
      },
      &task);
}

}  // namespace mien::author
