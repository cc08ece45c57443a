// SPDX-License-Identifier: MIT
#include <cmath>

#include "runtime/base/vector.h"
#include "runtime/solve/solvers.h"

namespace mien {
namespace {

bool is_within(float value, float low, float high) { return value >= low && value <= high; }

/// Brings a direction to length 1; 0 0 0 becomes `otherwise`, or is wrong if that is missing.
const char* set_length(float (&direction)[3], const Vec3* otherwise) {
  Vec3 v = {direction[0], direction[1], direction[2]};
  if (!(std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))) {
    return "a direction is not finite";
  }
  v = normalized(v);
  if (is_zero(v)) {
    if (!otherwise) return "a direction has length 0";
    v = *otherwise;
  }
  direction[0] = static_cast<float>(v.x);
  direction[1] = static_cast<float>(v.y);
  direction[2] = static_cast<float>(v.z);
  return nullptr;
}

}  // namespace

const char* set_up(AimSolver& solver, float cone_degrees) {
  const Vec3 none = {}, up = {0, 1, 0};
  if (const char* wrong = set_length(solver.axis, nullptr)) return wrong;
  if (const char* wrong = set_length(solver.up_axis, &none)) return wrong;
  if (const char* wrong = set_length(solver.up, &up)) return wrong;
  if (!is_within(cone_degrees, 0, 180) || !is_within(solver.weight, 0, 1)) {
    return "cone_degrees or weight is out of range";
  }
  if (cone_degrees > 0) {
    constexpr double kRadians = 3.14159265358979323846 / 180;
    solver.cone_cosine = static_cast<float>(std::cos(double{cone_degrees} * kRadians));
  }
  return nullptr;
}

const char* set_up(const SpaceSolver& solver) {
  return solver.ease_ticks < 0 || solver.ease_ticks > kMaxEaseTicks ? "ease_ticks is out of range"
                                                                    : nullptr;
}

const char* set_up(SpringSolver& solver) {
  bool known = solver.frequency > 0 && solver.frequency <= 1000 &&
               is_within(solver.damping, 0, 1000) && is_within(solver.stretch, 0, kFarthest) &&
               is_within(solver.teleport, 0, kFarthest);
  for (float offset : solver.rest_offset) {
    known = known && is_within(offset, -kFarthest, kFarthest);
  }
  if (!known) return "frequency, damping, rest_offset, stretch or teleport is out of range";
  if (solver.stretch == 0) solver.stretch = kFarthest;
  if (solver.teleport == 0) solver.teleport = kFarthest;
  return nullptr;
}

const char* set_up(TwistSolver& solver) {
  if (const char* wrong = set_length(solver.axis, nullptr)) return wrong;
  for (uint32_t i = 0; i < solver.joint_count; ++i) {
    if (!is_within(solver.shares[i], -1, 1)) return "a share is not within -1 to 1";
  }
  return nullptr;
}

const char* set_up(CopySolver& solver) {
  const Vec3 left = {1, 0, 0};
  if (const char* wrong = set_length(solver.mirror_axis, &left)) return wrong;
  return is_within(solver.weight, 0, 1) ? nullptr : "weight is not within 0 to 1";
}

}  // namespace mien
