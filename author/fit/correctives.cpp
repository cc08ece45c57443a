// SPDX-License-Identifier: MIT
#include "author/fit/correctives.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/fit/procrustes.h"

namespace mien::author {

namespace {

/// Half of the motion that both displacements have along the longer one is subtracted once.
Vec3 damped_sum(Vec3 a, Vec3 b) {
  const Vec3 longer = dot(a, a) >= dot(b, b) ? a : b, shorter = dot(a, a) >= dot(b, b) ? b : a;
  const double squares = dot(longer, longer);
  if (!(squares > 0)) return {};
  const double along = std::max(0.0, dot(shorter, longer) / squares);
  return a + b - longer * (0.5 * along);
}

bool includes(Span<const uint32_t> all, Span<const uint32_t> some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

struct PoseLane {
  Span<uint32_t> controls;  // active at the pose
  uint32_t control_count = 0;
  Span<Vec3> from;       // vertices with the offsets of active blend shapes
  Span<Affine> pose;     // of the bones, without the corrective
  Span<Affine> further;  // how the corrective moves each bone from that pose
  Span<uint8_t> active;
};

class CorrectiveFitter {
 public:
  CorrectiveFitter(const CorrectiveInput& input, const JointDeltas& deltas, Span<Target> targets)
      : in_(input), deltas_(deltas), targets_(targets) {}

  bool make(Arena& arena, const Allocator& allocator, CorrectiveReport& report) {
    Arena scratch(allocator);
    const size_t count = in_.combinations.count, bones = in_.placement.bones.count;
    if (!author::make(scratch, count, errors_) || !author::make(scratch, count, counts_)) {
      return false;
    }
    for (PoseLane& lane : lanes_) {
      if (!author::make(scratch, in_.mesh.shapes.count + count, lane.controls) ||
          !author::make(scratch, in_.mesh.positions.count, lane.from) ||
          !author::make(scratch, bones, lane.pose) || !author::make(scratch, bones, lane.further) ||
          !author::make(scratch, bones, lane.active)) {
        return false;
      }
    }
    // Correctives with equally many members do not depend on each other.
    for (first_ = 0; first_ < count; first_ = end_) {
      end_ = first_ + 1;
      while (end_ < count && members(end_).count == members(first_).count) ++end_;
      in_lanes([](CorrectiveFitter& self, size_t lane, size_t c) { self.fit(lane, c); });
      in_lanes([](CorrectiveFitter& self, size_t lane, size_t c) { self.find_offsets(lane, c); });
      for (size_t c = first_; c < end_; ++c) {
        Target& target = target_of(c);
        if (!author::make(arena, counts_[c], target.vertices) ||
            !author::make(arena, counts_[c], target.offsets)) {
          return false;
        }
      }
      in_lanes([](CorrectiveFitter& self, size_t lane, size_t c) { self.find_offsets(lane, c); });
    }
    sum_up(report);
    return true;
  }

 private:
  struct PoseError {
    double energy = 0, before = 0, joints = 0, rig = 0;  // sums of squares
  };

  size_t expressions() const { return in_.mesh.shapes.count; }
  Span<const uint32_t> members(size_t c) const { return in_.combinations[c].members; }
  bool is_given(size_t c) const { return !in_.combinations[c].displacements.empty(); }
  uint32_t control_of(size_t c) const { return static_cast<uint32_t>(expressions() + c); }
  Target& target_of(size_t c) const { return targets_[control_of(c)]; }

  void in_lanes(void (*work)(CorrectiveFitter&, size_t lane, size_t c)) {
    work_ = work;
    run_tasks(
        in_.parallel, kFitLanes,
        [](void* context, uint32_t lane) {
          CorrectiveFitter& self = *static_cast<CorrectiveFitter*>(context);
          for (size_t c = self.first_ + lane; c < self.end_; c += kFitLanes) {
            self.work_(self, lane, c);
          }
        },
        this);
  }

  Vec3 wanted(size_t c, size_t v) const {
    if (is_given(c)) return as_vec3(in_.combinations[c].displacements[v]);
    const Span<const Shape> shapes = in_.mesh.shapes;
    return damped_sum(as_vec3(shapes[members(c)[0]].displacements[v]),
                      as_vec3(shapes[members(c)[1]].displacements[v]));
  }

  Influences influences(size_t v) const {
    const uint32_t m = in_.weights.m;
    return {&in_.weights.joints[v * m], &in_.weights.weights[v * m], m};
  }

  /// The pose with all members and the smaller correctives that they activate.
  void set_pose(PoseLane& lane, size_t c) const {
    lane.control_count = 0;
    for (const uint32_t e : members(c)) lane.controls[lane.control_count++] = e;
    for (size_t d = 0; d < first_; ++d) {
      if (includes(members(c), members(d))) lane.controls[lane.control_count++] = control_of(d);
    }
    for (size_t v = 0; v < lane.from.count; ++v) lane.from[v] = in_.mesh.positions[v];
    for (uint32_t i = 0; i < lane.control_count; ++i) {
      const Target& target = targets_[lane.controls[i]];
      for (size_t k = 0; k < target.vertices.count; ++k) {
        Vec3& at = lane.from[target.vertices[k]];
        at = at + as_vec3(target.offsets[k]);
      }
    }
    pose_bones(in_.placement, in_.mesh.frame, deltas_, lane.controls.first(lane.control_count),
               lane.pose);
  }

  /// The remaining displacements at the pose; returns the sum of their squares.
  double set_rest(const PoseLane& lane, FitLane& fit, size_t c, double* energy) const {
    double squares = 0;
    for (size_t v = 0; v < lane.from.count; ++v) {
      const Vec3 d = wanted(c, v);
      fit.rest[v] = in_.mesh.positions[v] + d - skin(lane.pose.data, influences(v), lane.from[v]);
      squares += dot(fit.rest[v], fit.rest[v]);
      if (energy) *energy += dot(d, d);
    }
    return squares;
  }

  void fit(size_t index, size_t c) {
    PoseLane& lane = lanes_[index];
    FitLane& fit = in_.fitter.lanes[index];
    set_pose(lane, c);
    errors_[c] = {};
    errors_[c].before = set_rest(lane, fit, c, &errors_[c].energy);
    find_support(in_.fitter, fit, lane.active);
    // Fitted twice: to the relevant bones, then to all bones of the regions that it owns.
    for (int round = 0; round < 2; ++round) {
      if (round > 0) set_rest(lane, fit, c, nullptr);
      std::copy(lane.pose.begin(), lane.pose.end(), lane.further.begin());
      fit_motions(in_.fitter, fit, lane.active, lane.further);
      if (round > 0) break;
      for (uint32_t j = 0; j < lane.further.count; ++j) {
        if (lane.active[j]) lane.further[j] = lane.further[j] * inverse(lane.pose[j]);
      }
      Motions one;
      one.items = lane.further;
      one.active = lane.active;
      one.bone_count = static_cast<uint32_t>(lane.further.count);
      prune(in_.placement, in_.fitter.footprints, in_.regions, in_.least_effect, true, 0, one);
    }
    store(lane, c);
  }

  /// Angles add up, so those of a corrective are the angles of its pose minus those already there.
  void store(const PoseLane& lane, size_t c) const {
    for (uint32_t j = 0; j < lane.further.count; ++j) {
      JointDelta& out = deltas_.at(control_of(c), j);
      out = {};
      if (!lane.active[j]) continue;
      const Affine& parent = lane.further[in_.placement.bones[j].parent];
      out = delta_of_motion(in_.placement.bones[j], in_.mesh.frame,
                            inverse(parent) * lane.further[j]);
      for (uint32_t i = 0; i < lane.control_count; ++i) {
        const JointDelta& other = deltas_.at(lane.controls[i], j);
        for (int k = 0; k < 3; ++k) {
          out.translation[k] -= other.translation[k];
          out.rotation[k] -= other.rotation[k];
        }
      }
      for (float& angle : out.rotation) {
        if (angle > 180) angle -= 360;
        if (angle < -180) angle += 360;
      }
    }
  }

  /// Counts offsets in a first pass, and stores them in a second.
  void find_offsets(size_t index, size_t c) {
    PoseLane& lane = lanes_[index];
    FitLane& fit = in_.fitter.lanes[index];
    set_pose(lane, c);
    lane.controls[lane.control_count++] = control_of(c);
    pose_bones(in_.placement, in_.mesh.frame, deltas_, lane.controls.first(lane.control_count),
               lane.pose);
    errors_[c].joints = set_rest(lane, fit, c, nullptr);
    errors_[c].rig = 0;
    Target& target = target_of(c);
    const bool stores = target.vertices.data != nullptr;
    target.energy = 0;
    counts_[c] = 0;
    for (uint32_t v = 0; v < lane.from.count; ++v) {
      const Vec3 rest = fit.rest[v];
      const double left = dot(rest, rest);
      // Generated correctives get no blend shapes, as there is no sculpted shape for them.
      if (!is_given(c) || in_.threshold < 0 || left == 0) {
        errors_[c].rig += left;
        continue;
      }
      const Vec3 to = in_.mesh.positions[v] + wanted(c, v);
      const Vec3 b = residual(lane.pose.data, influences(v), lane.from[v], to);
      if (dot(b, b) <= in_.threshold * in_.threshold) {
        errors_[c].rig += left;
        continue;
      }
      if (stores) {
        target.vertices[counts_[c]] = v;
        target.offsets[counts_[c]] = {static_cast<float>(b.x), static_cast<float>(b.y),
                                      static_cast<float>(b.z)};
        target.energy += dot(b, b);
      }
      ++counts_[c];
    }
  }

  void sum_up(CorrectiveReport& report) const {
    PoseError all;
    for (size_t c = 0; c < errors_.count; ++c) {
      ++(is_given(c) ? report.given : report.made);
      if (!is_given(c)) continue;
      all.energy += errors_[c].energy;
      all.before += errors_[c].before;
      all.joints += errors_[c].joints;
      all.rig += errors_[c].rig;
    }
    if (!(all.energy > 0)) return;
    report.before = std::sqrt(all.before / all.energy);
    report.joints = std::sqrt(all.joints / all.energy);
    report.rig = std::sqrt(all.rig / all.energy);
  }

  const CorrectiveInput& in_;
  const JointDeltas& deltas_;
  const Span<Target> targets_;
  PoseLane lanes_[kFitLanes];
  Span<PoseError> errors_;
  Span<size_t> counts_;
  size_t first_ = 0, end_ = 0;
  void (*work_)(CorrectiveFitter&, size_t, size_t) = nullptr;
};

}  // namespace

bool fit_correctives(const CorrectiveInput& input, Arena& arena, const Allocator& allocator,
                     const JointDeltas& deltas, Span<Target> targets, CorrectiveReport& report) {
  report = {};
  CorrectiveFitter fitter(input, deltas, targets);
  return fitter.make(arena, allocator, report);
}

}  // namespace mien::author
