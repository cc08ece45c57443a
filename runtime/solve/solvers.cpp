// SPDX-License-Identifier: MIT
#include "runtime/solve/solvers.h"

#include <cmath>

#include "runtime/anim/clip.h"
#include "runtime/solve/rotation.h"

namespace mien {

using namespace solve;

namespace {

Vec3 vector3(const float* v) { return {v[0], v[1], v[2]}; }
Vec3 origin_of(const float* model) { return vector3(model + 12); }

/// Of column vectors.
Vec3 transformed(const float* m, Vec3 v, double w) {
  return {m[0] * v.x + m[4] * v.y + m[8] * v.z + m[12] * w,
          m[1] * v.x + m[5] * v.y + m[9] * v.z + m[13] * w,
          m[2] * v.x + m[6] * v.y + m[10] * v.z + m[14] * w};
}

/// Solves m * x = v, without the translation of m. Zero if m is flat.
Vec3 solved(const float* m, Vec3 v) {
  const Vec3 x = vector3(m), y = vector3(m + 4), z = vector3(m + 8);
  const double volume = dot(x, cross(y, z));
  if (volume == 0) return {};
  return Vec3{dot(v, cross(y, z)), dot(v, cross(z, x)), dot(v, cross(x, y))} * (1 / volume);
}

const float* matrix(const float* models, uint32_t joint) {
  return models + size_t{joint} * kMatrixFloats;
}
const float* model(const SolverPose& pose, uint32_t joint) { return matrix(pose.models, joint); }

float* local(const SolverPose& pose, uint32_t joint) {
  return pose.locals + size_t{joint} * kLocalTransformFloats;
}
Rotation rotation(const float* local) { return unit({local[3], local[4], local[5], local[6]}); }
void set_rotation(float* local, const Rotation& q) {
  const double values[4] = {q.x, q.y, q.z, q.w};
  for (int k = 0; k < 4; ++k) local[3 + k] = static_cast<float>(values[k]);
}
void set_place(float* local, Vec3 p) {
  const double values[3] = {p.x, p.y, p.z};
  for (int k = 0; k < 3; ++k) local[k] = static_cast<float>(values[k]);
}

bool is_root(const Skeleton& skeleton, uint32_t joint) { return skeleton.parents[joint] == joint; }

Rotation parent_rotation(const Skeleton& skeleton, const SolverPose& pose, uint32_t joint) {
  return is_root(skeleton, joint) ? Rotation{} : rotation_of(model(pose, skeleton.parents[joint]));
}
Vec3 to_parent(const Skeleton& skeleton, const SolverPose& pose, uint32_t joint, Vec3 place) {
  if (is_root(skeleton, joint)) return place;
  const float* m = model(pose, skeleton.parents[joint]);
  return solved(m, place - origin_of(m));
}
/// Of the neutral pose, in model space.
Rotation bind_rotation(const Skeleton& skeleton, uint32_t joint) {
  return rotation_of(matrix(skeleton.bind.data, joint));
}
Rotation bind_parent_rotation(const Skeleton& skeleton, uint32_t joint) {
  return is_root(skeleton, joint) ? Rotation{} : bind_rotation(skeleton, skeleton.parents[joint]);
}
Rotation neutral_rotation(const Skeleton& skeleton, uint32_t joint) {
  return unit(inverse(bind_parent_rotation(skeleton, joint)) * bind_rotation(skeleton, joint));
}
Vec3 neutral_place(const Skeleton& skeleton, uint32_t joint) {
  const Vec3 at = origin_of(matrix(skeleton.bind.data, joint));
  if (is_root(skeleton, joint)) return at;
  const float* m = matrix(skeleton.bind.data, skeleton.parents[joint]);
  return solved(m, at - origin_of(m));
}

double seconds(int64_t ticks) { return static_cast<double>(ticks) / kTicksPerSecond; }

/// create_stack() refuses joints that do not exist.
bool exists(const Skeleton& skeleton, uint32_t joint) { return joint < skeleton.joint_count; }
uint16_t parent_of(const Skeleton& skeleton, uint16_t joint) {
  return exists(skeleton, joint) ? skeleton.parents[joint] : joint;
}

template <class Params>
SolverDesc basic(const char* name, SolverFunction* function, const Params& params,
                 Span<const uint16_t> reads, Span<const uint16_t> writes, size_t state_size = 0,
                 uint32_t output_count = 0) {
  SolverDesc desc;
  desc.name = name;
  desc.solve = function;
  desc.params = &params;
  desc.params_size = sizeof(Params);
  desc.reads = reads;
  desc.writes = writes;
  desc.state_size = static_cast<uint32_t>(state_size);
  desc.output_count = output_count;
  return desc;
}

// Aim
// ------------------------------------------------------------------------------------------------

/// `wanted`, or where the way there leaves the cone; both unit.
Vec3 within_cone(Vec3 wanted, Vec3 axis, double cosine) {
  const double along = dot(wanted, axis);
  if (along >= cosine) return wanted;
  Vec3 across = normalized(wanted - axis * along);
  if (is_zero(across)) across = turn(between({0, 0, 1}, axis), {1, 0, 0});
  return normalized(axis * cosine + across * std::sqrt(std::fmax(0, 1 - cosine * cosine)));
}

void solve_aim(const SolverArgs& args) {
  const AimSolver& p = *static_cast<const AimSolver*>(args.params);
  for (uint32_t i = 0; i < args.count; ++i) {
    const SolverPose& pose = args.poses[i];
    const bool has_target = p.target_joint != kNoSolverJoint || pose.row;
    if (!has_target || !(p.weight > 0)) continue;
    const Vec3 target = p.target_joint != kNoSolverJoint ? origin_of(model(pose, p.target_joint))
                                                         : vector3(pose.row + p.target_curve);
    const float* now = model(pose, p.joint);
    Vec3 wanted = normalized(target - origin_of(now));
    if (is_zero(wanted)) continue;
    const Rotation before = rotation_of(now);
    const Rotation parent = parent_rotation(args.skeleton, pose, p.joint);
    if (p.cone_cosine > -1) {
      wanted = within_cone(wanted, turn(parent, vector3(p.cone_axis)), double{p.cone_cosine});
    }
    Rotation move = between(turn(before, vector3(p.axis)), wanted);
    if (!is_zero(vector3(p.up_axis))) {
      const Vec3 has = turn(move * before, vector3(p.up_axis)), wants = vector3(p.up);
      const Vec3 from = normalized(has - wanted * dot(has, wanted));
      const Vec3 to = normalized(wants - wanted * dot(wants, wanted));
      if (!is_zero(from) && !is_zero(to)) {
        // About the axis, even for half a turn.
        move = (dot(from, to) > -1 + 1e-9 ? between(from, to)
                                          : Rotation{wanted.x, wanted.y, wanted.z, 0}) *
               move;
      }
    }
    move = part_of(unit(move), double{p.weight});
    set_rotation(local(pose, p.joint), unit(inverse(parent) * move * before));
  }
}

// Space switch
// ------------------------------------------------------------------------------------------------

struct SpaceState {
  Vec3 place, off;  // where the joint was after the last step; its offset from where it belongs
  Rotation rotation, turned_off;
  int64_t elapsed;
  uint32_t space, zero;
};

void solve_space(const SolverArgs& args) {
  const SpaceSolver& p = *static_cast<const SpaceSolver*>(args.params);
  const Skeleton& skeleton = args.skeleton;
  for (uint32_t i = 0; i < args.count; ++i) {
    const SolverPose& pose = args.poses[i];
    SpaceState& state = *static_cast<SpaceState*>(pose.state);
    float value = pose.row ? pose.row[p.curve] : 0;
    value = value > 0 ? std::fmin(value + 0.5f, static_cast<float>(p.space_count) - 0.5f) : 0;
    const uint32_t chosen = static_cast<uint32_t>(value);
    // The parent, moved as the space is from the neutral pose.
    const uint16_t space = p.spaces[chosen];
    float* out = local(pose, p.joint);
    Rotation carrier;
    Vec3 target;
    const Vec3 offset = vector3(out);
    const float* bind = matrix(skeleton.bind.data, skeleton.parents[p.joint]);
    const bool root = is_root(skeleton, p.joint);
    const Vec3 in_bind = root ? offset : transformed(bind, offset, 1);
    if (space == kNoSolverJoint) {
      target = in_bind;
      carrier = bind_parent_rotation(skeleton, p.joint);
    } else {
      target = transformed(model(pose, space),
                           transformed(matrix(skeleton.inverse_bind.data, space), in_bind, 1), 1);
      carrier = rotation_of(model(pose, space)) * inverse(bind_rotation(skeleton, space)) *
                bind_parent_rotation(skeleton, p.joint);
    }
    const Rotation wanted = unit(carrier * rotation(out));
    if (pose.reset) {
      state.elapsed = p.ease_ticks;
      state.space = chosen;
    } else if (state.space != chosen) {
      state.space = chosen;
      state.elapsed = 0;
      state.off = state.place - target;
      state.turned_off = unit(state.rotation * inverse(wanted));
    } else if (state.elapsed < p.ease_ticks) {
      state.elapsed =
          args.ticks < p.ease_ticks - state.elapsed ? state.elapsed + args.ticks : p.ease_ticks;
    }
    state.place = target;
    state.rotation = wanted;
    if (state.elapsed < p.ease_ticks) {
      const double u = static_cast<double>(state.elapsed) / static_cast<double>(p.ease_ticks);
      const double left = 1 - u * u * u * (u * (6 * u - 15) + 10);
      state.place = target + state.off * left;
      state.rotation = unit(part_of(state.turned_off, left) * wanted);
    }
    set_place(out, to_parent(skeleton, pose, p.joint, state.place));
    set_rotation(out, unit(inverse(parent_rotation(skeleton, pose, p.joint)) * state.rotation));
  }
}

// Spring
// ------------------------------------------------------------------------------------------------

constexpr double kAtRest = 1e-7;  // in the rig's unit, and in that per second: swinging ends

struct SpringState {
  Vec3 place, velocity, goal;
};

/// exp(A t) of the oscillator x'' = -k x - c x', by halving t until a short series is exact, then
/// squaring: it needs no exponential or sine, and is as stable as the exact solution.
struct Propagator {
  double xx, xv, vx, vv;
};

Propagator operator*(const Propagator& a, const Propagator& b) {
  return {a.xx * b.xx + a.xv * b.vx, a.xx * b.xv + a.xv * b.vv, a.vx * b.xx + a.vv * b.vx,
          a.vx * b.xv + a.vv * b.vv};
}

Propagator propagator(double k, double c, double t) {
  int halvings = 0;
  const double size = std::sqrt(k) + c;
  while (size * t > 0.125 && halvings < 64) t *= 0.5, ++halvings;
  const Propagator step = {0, t, -k * t, -c * t};
  Propagator sum = {0, 0, 0, 0};  // without the identity, to keep the last bits
  for (int n = 14; n > 0; --n) {
    const Propagator next = {1 + sum.xx, sum.xv, sum.vx, 1 + sum.vv};
    sum = step * next;
    const double s = 1.0 / n;
    sum = {sum.xx * s, sum.xv * s, sum.vx * s, sum.vv * s};
  }
  for (int i = 0; i < halvings; ++i) {
    const Propagator square = sum * sum;
    sum = {2 * sum.xx + square.xx, 2 * sum.xv + square.xv, 2 * sum.vx + square.vx,
           2 * sum.vv + square.vv};
  }
  return {1 + sum.xx, sum.xv, sum.vx, 1 + sum.vv};
}

void solve_spring(const SolverArgs& args) {
  const SpringSolver& p = *static_cast<const SpringSolver*>(args.params);
  const double omega = 6.283185307179586 * p.frequency;
  const Propagator step =
      propagator(omega * omega, 2 * double{p.damping} * omega, seconds(args.ticks));
  for (uint32_t i = 0; i < args.count; ++i) {
    const SolverPose& pose = args.poses[i];
    SpringState& s = *static_cast<SpringState*>(pose.state);
    const Vec3 goal = origin_of(model(pose, p.joint)) + vector3(p.rest_offset);
    if (pose.reset || length(goal - s.goal) > double{p.teleport}) s = {goal, {}, goal};
    const Vec3 x = s.place - goal, v = s.velocity;
    Vec3 off = x * step.xx + v * step.xv;
    s.velocity = x * step.vx + v * step.vv;
    const double distance = length(off);
    if (distance > double{p.stretch}) {
      const Vec3 way = off * (1 / distance);
      off = way * p.stretch;
      s.velocity = s.velocity - way * std::fmax(dot(s.velocity, way), 0);
    }
    if (length(off) < kAtRest && length(s.velocity) < kAtRest) off = s.velocity = {};
    s.goal = goal;
    s.place = goal + off;
    pose.outputs[0] = static_cast<float>(length(s.velocity));
    set_place(local(pose, p.joint), to_parent(args.skeleton, pose, p.joint, s.place));
  }
}

// Twist
// ------------------------------------------------------------------------------------------------

void solve_twist(const SolverArgs& args) {
  const TwistSolver& p = *static_cast<const TwistSolver*>(args.params);
  const Vec3 axis = vector3(p.axis);
  const Rotation from_neutral = inverse(neutral_rotation(args.skeleton, p.source));
  for (uint32_t i = 0; i < args.count; ++i) {
    const SolverPose& pose = args.poses[i];
    const Rotation twist = twist_of(from_neutral * rotation(local(pose, p.source)), axis);
    const double sign = twist.w < 0 ? -1 : 1;
    pose.outputs[0] = static_cast<float>(sign * dot({twist.x, twist.y, twist.z}, axis));
    for (uint32_t k = 0; k < p.joint_count; ++k) {
      const Rotation neutral = neutral_rotation(args.skeleton, p.joints[k]);
      const Rotation now = inverse(neutral) * rotation(local(pose, p.joints[k]));
      const Rotation swing = now * inverse(twist_of(now, axis));
      const Rotation part = part_of(twist, std::fabs(double{p.shares[k]}));
      set_rotation(local(pose, p.joints[k]),
                   unit(neutral * swing * (p.shares[k] < 0 ? inverse(part) : part)));
    }
  }
}

// Copy, mirror
// ------------------------------------------------------------------------------------------------

void solve_copy(const SolverArgs& args) {
  const CopySolver& p = *static_cast<const CopySolver*>(args.params);
  const Skeleton& skeleton = args.skeleton;
  const Rotation source_axes = bind_parent_rotation(skeleton, p.source);
  const Rotation axes = bind_parent_rotation(skeleton, p.joint);
  const Rotation source_neutral = neutral_rotation(skeleton, p.source);
  const Rotation neutral = neutral_rotation(skeleton, p.joint);
  const Vec3 across = vector3(p.mirror_axis);
  for (uint32_t i = 0; i < args.count; ++i) {
    const SolverPose& pose = args.poses[i];
    const float* from = local(pose, p.source);
    // What moved, along the axes of model space in the neutral pose.
    Rotation q = source_axes * rotation(from) * inverse(source_neutral) * inverse(source_axes);
    Vec3 shift = turn(source_axes, vector3(from) - neutral_place(skeleton, p.source));
    if (p.mirrored) {
      shift = shift - across * (2 * dot(shift, across));
      Vec3 v = {q.x, q.y, q.z};
      v = across * (2 * dot(v, across)) - v;
      q = {v.x, v.y, v.z, q.w};
    }
    float* out = local(pose, p.joint);
    const Rotation wanted = unit(inverse(axes) * q * axes * neutral);
    const Rotation before = rotation(out);
    const Vec3 place = neutral_place(skeleton, p.joint) + turn(inverse(axes), shift);
    const Vec3 start = vector3(out);
    set_place(out, start + (place - start) * double{p.weight});
    set_rotation(out, unit(before * part_of(unit(inverse(before) * wanted), double{p.weight})));
  }
}

}  // namespace

SolverDesc describe(const Skeleton& skeleton, AimSolver& s) {
  const bool valid = exists(skeleton, s.joint);
  set_place(s.cone_axis,
            valid ? turn(neutral_rotation(skeleton, s.joint), vector3(s.axis)) : Vec3{0, 0, 1});
  s.reads[0] = s.joint;
  s.reads[1] = parent_of(skeleton, s.joint);
  s.reads[2] = s.target_joint;
  const size_t reads = s.target_joint == kNoSolverJoint ? 2 : 3;
  return basic("aim", solve_aim, s, {s.reads, reads}, {&s.joint, 1});
}

SolverDesc describe(const Skeleton& skeleton, SpaceSolver& s) {
  const uint16_t parent = parent_of(skeleton, s.joint);
  if (s.space_count > kMaxSolverJoints) s.space_count = kMaxSolverJoints;
  if (s.space_count == 0) s.spaces[s.space_count++] = parent;
  size_t reads = 0;
  s.reads[reads++] = parent;
  for (uint32_t i = 0; i < s.space_count; ++i) {
    if (s.spaces[i] != kNoSolverJoint) s.reads[reads++] = s.spaces[i];
  }
  return basic("space", solve_space, s, {s.reads, reads}, {&s.joint, 1}, sizeof(SpaceState));
}

SolverDesc describe(const Skeleton& skeleton, SpringSolver& s) {
  s.reads[0] = s.joint;
  s.reads[1] = parent_of(skeleton, s.joint);
  return basic("spring", solve_spring, s, {s.reads, 2}, {&s.joint, 1}, sizeof(SpringState), 1);
}

SolverDesc describe(const Skeleton&, TwistSolver& s) {
  if (s.joint_count > kMaxSolverJoints) s.joint_count = kMaxSolverJoints;
  s.reads[0] = s.source;
  return basic("twist", solve_twist, s, {s.reads, 1}, {s.joints, s.joint_count}, 0, 1);
}

SolverDesc describe(const Skeleton&, CopySolver& s) {
  s.reads[0] = s.source;
  return basic("copy", solve_copy, s, {s.reads, 1}, {&s.joint, 1});
}

}  // namespace mien
