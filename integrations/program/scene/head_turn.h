// SPDX-License-Identifier: MIT
// Turns the head of a posed rig, for which faces have no controls: between update and deform.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "integrations/program/io/frames.h"
#include "integrations/program/io/handles.h"
#include "integrations/program/render/camera.h"

namespace mien::cli {

using SolverStack =
    std::unique_ptr<MienSolverStack, Destroy<MienSolverStack, mien_solver_stack_destroy>>;
using SolverState =
    std::unique_ptr<MienSolverState, Destroy<MienSolverState, mien_solver_state_destroy>>;

/// The farthest that a head turns, in radians: 60 degrees.
constexpr double kMaxHeadTurn = 1.0471975511965976;

/// Left, up and front in the axes of the file; the usual ones if two axes of the file have the same
/// direction.
render::Axes axes_of(const MienRigInfo& info);

/// What a rig turns. The joints are the one named head and those named neck that it hangs from, with or
/// without a side, a prefix and a number ("C_Head", "neck_01"); each turns by an equal share. A rig without
/// such names turns with all its roots, about the neck base.
class HeadTurn {
 public:
  HeadTurn(const MienRig* rig, const MienDeformer* deformer, const std::string& shown);
  HeadTurn(const HeadTurn&) = delete;

  /// `pose` was updated and is not deformed yet.
  void apply(MienDeformerInstance* pose, const HeadPose& head) const;
  /// Ten floats per joint after apply(), as mien_deformer_instance_local_transforms() gives them.
  MienFloatView transforms() const;

 private:
  static void solve(void* self, const MienSolverCall* call);
  void find_joints(const MienRig* rig, const uint16_t* parents);
  void find_neck_base(const MienRig* rig, const MienDeformer* deformer);

  std::string shown_;
  render::Axes axes_;
  std::vector<uint16_t> joints_, parents_;  // parents_: of joints_
  bool rigid_ = false;
  math::Vec3 neck_base_;  // of a rig that turns rigidly
  SolverStack stack_;
  SolverState state_;
};

}  // namespace mien::cli
