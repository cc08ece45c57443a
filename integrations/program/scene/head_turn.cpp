// SPDX-License-Identifier: MIT
#include "integrations/program/scene/head_turn.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/joint_names.h"
#include "integrations/program/io/rig_file.h"
#include "integrations/program/math/transform.h"

namespace mien::cli {

namespace {

using math::Vec3;
using math::Vec3d;

constexpr const char* kCannot = "cannot turn the head";
constexpr size_t kLocalFloats = 10, kMatrixFloats = 16;

Vec3d in_doubles(Vec3 v) { return {v.x, v.y, v.z}; }

math::Quaternion turn_about(Vec3d axis, double angle) {
  const Vec3d v = axis * std::sin(angle / 2);
  return {v.x, v.y, v.z, std::cos(angle / 2)};
}

math::Transform load_local(const float* local) {
  return {{local[0], local[1], local[2]}, {local[3], local[4], local[5], local[6]}, {1, 1, 1}};
}

/// Scale stays.
void store_local(const math::Transform& from, float* local) {
  const math::Quaternion q = normalized(from.rotation);
  const double values[] = {
      from.translation.x, from.translation.y, from.translation.z, q.x, q.y, q.z, q.w};
  for (size_t i = 0; i < std::size(values); ++i) local[i] = static_cast<float>(values[i]);
}

/// An axis of model space in the space of a joint.
Vec3d in_joint(const float* model, Vec3d axis) {
  Vec3d result;
  for (int c = 0; c < 3; ++c) {
    const Vec3d column = {model[4 * c], model[4 * c + 1], model[4 * c + 2]};
    result[c] = dot(normalized(column, {}), axis);
  }
  return normalized(result, axis);
}

}  // namespace

render::Axes axes_of(const MienRigInfo& info) {
  constexpr Vec3 kUnit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  render::Axes axes;
  bool left = false, up = false, front = false;
  for (int i = 0; i < 3; ++i) {
    switch (info.axes[i]) {
      case MIEN_DIRECTION_LEFT: axes.left = kUnit[i], left = true; break;
      case MIEN_DIRECTION_RIGHT: axes.left = -kUnit[i], left = true; break;
      case MIEN_DIRECTION_UP: axes.up = kUnit[i], up = true; break;
      case MIEN_DIRECTION_DOWN: axes.up = -kUnit[i], up = true; break;
      case MIEN_DIRECTION_FRONT: axes.front = kUnit[i], front = true; break;
      case MIEN_DIRECTION_BACK: axes.front = -kUnit[i], front = true; break;
      default: break;
    }
  }
  return left && up && front ? axes : render::Axes{};
}

HeadTurn::HeadTurn(const MienRig* rig, const MienDeformer* deformer, const std::string& shown)
    : shown_(shown), axes_(axes_of(rig_info(rig))) {
  MienIndex16View parents{};
  check(mien_rig_joint_parents(rig, &parents), nullptr, kCannot, shown);
  find_joints(rig, parents.data);
  if (rigid_) find_neck_base(rig, deformer);
  for (const uint16_t joint : joints_) parents_.push_back(parents.data[joint]);

  MienUserSolver solver = {};
  solver.user = this;
  solver.solve = solve;
  solver.writes = joints_.data();
  solver.write_count = static_cast<uint32_t>(joints_.size());
  if (!rigid_) {
    solver.reads = parents_.data();
    solver.read_count = static_cast<uint32_t>(parents_.size());
  }
  MienSolver entry = {};
  entry.name = "head";
  entry.custom = &solver;
  auto desc = sized<MienSolverStackDesc>();
  desc.solvers = &entry;
  desc.solver_count = 1;
  desc.curve_count = 2;
  auto error = sized<MienError>();
  MienSolverStack* stack = nullptr;
  check(mien_solver_stack_create(deformer, &desc, &stack, &error), &error, kCannot, shown);
  stack_.reset(stack);
  MienSolverState* state = nullptr;
  check(mien_solver_state_create(stack, nullptr, &state, &error), &error, kCannot, shown);
  state_.reset(state);
}

void HeadTurn::find_joints(const MienRig* rig, const uint16_t* parents) {
  const uint32_t count = rig_count(rig, MIEN_KIND_JOINT);
  const auto is_named = [&](uint32_t joint, const char* word) {
    return is_body_part(rig_name(rig, MIEN_KIND_JOINT, joint), {word});
  };
  for (const char* word : {"head", "neck"}) {
    for (uint32_t j = 0; j < count && joints_.empty(); ++j) {
      if (is_named(j, word)) joints_.push_back(static_cast<uint16_t>(j));
    }
  }
  if (joints_.empty()) {
    rigid_ = true;
    for (uint32_t j = 0; j < count; ++j) {
      if (parents[j] == j) joints_.push_back(static_cast<uint16_t>(j));
    }
    return;
  }
  for (uint32_t j = parents[joints_[0]]; is_named(j, "neck") && j != joints_.back();
       j = parents[j]) {
    joints_.push_back(static_cast<uint16_t>(j));
  }
}

/// The middle of the lowest place of the meshes.
void HeadTurn::find_neck_base(const MienRig* rig, const MienDeformer* deformer) {
  const Vec3 directions[] = {axes_.left, axes_.up, axes_.front};
  math::Box box;
  for (uint32_t m = 0; m < rig_count(rig, MIEN_KIND_MESH); ++m) {
    auto mesh = sized<MienMesh>();
    check(mien_deformer_mesh(deformer, m, &mesh), nullptr, kCannot, shown_);
    for (uint32_t i = 0; i < mesh.position_count; ++i) {
      const Vec3 p = math::load3(mesh.positions.data, i);
      box.add({dot(p, directions[0]), dot(p, directions[1]), dot(p, directions[2])});
    }
  }
  if (box.empty()) return;
  const Vec3 middle = box.center();
  neck_base_ = axes_.left * middle.x + axes_.up * box.min.y + axes_.front * middle.z;
}

void HeadTurn::solve(void* self, const MienSolverCall* call) {
  const HeadTurn& head = *static_cast<const HeadTurn*>(self);
  const Vec3d left = in_doubles(head.axes_.left), up = in_doubles(head.axes_.up);
  for (uint32_t c = 0; c < call->pose_count; ++c) {
    const MienSolverPose& pose = call->poses[c];
    // The shortest way from the front to where the head turns, so that it does not tilt.
    const Vec3d aside = left * pose.row[0] + up * pose.row[1];
    const double tangent = length(aside);
    if (!(tangent > 0)) continue;
    const Vec3d axis = normalized(cross(in_doubles(head.axes_.front), aside), {});
    const double angle = std::min(std::atan(tangent), kMaxHeadTurn);
    const double share = head.rigid_ ? angle : angle / static_cast<double>(head.joints_.size());
    for (size_t i = 0; i < head.joints_.size(); ++i) {
      float* const local = pose.locals + kLocalFloats * head.joints_[i];
      const bool is_root = head.parents_[i] == head.joints_[i];
      const Vec3d about =
          is_root ? axis : in_joint(pose.models + kMatrixFloats * head.parents_[i], axis);
      const math::Transform turn = {{}, turn_about(about, share), {1, 1, 1}};
      math::Transform moved = load_local(local);
      const Vec3d pivot = head.rigid_ ? in_doubles(head.neck_base_) : moved.translation;
      moved.translation = moved.translation - pivot;
      moved = turn * moved;
      moved.translation = moved.translation + pivot;
      store_local(moved, local);
    }
  }
}

void HeadTurn::apply(MienDeformerInstance* pose, const HeadPose& head) const {
  const float row[] = {head.left, head.up};
  const MienSolverInput input = {row, std::size(row), 0, 0};
  check(mien_solver_state_step(state_.get(), pose, &input, 0), nullptr, kCannot, shown_);
}

MienFloatView HeadTurn::transforms() const {
  MienFloatView view{};
  check(mien_solver_state_transforms(state_.get(), &view), nullptr, kCannot, shown_);
  return view;
}

}  // namespace mien::cli
