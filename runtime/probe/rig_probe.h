// SPDX-License-Identifier: MIT
// A rig on which raw controls are tried out, to measure what they do to joints and meshes.
#pragma once

#include <initializer_list>

#include "runtime/base/arena.h"
#include "runtime/base/vector.h"
#include "runtime/deform/deformer_instance.h"
#include "runtime/eval/instance.h"

namespace mien {

constexpr uint32_t kOfJoints = ~uint32_t{0};

/// A point of the face: the mean of some positions of a mesh that LOD 0 shows, or of some joints.
struct Landmark {
  uint32_t mesh = kOfJoints;
  Span<const uint32_t> points;
};

/// One character at LOD 0. For use before the first frame, not during frames: it allocates when it is
/// created, and deforms whole meshes.
class RigProbe {
 public:
  RigProbe(const Deformer& deformer, const Allocator& allocator);
  ~RigProbe();
  RigProbe(const RigProbe&) = delete;
  RigProbe& operator=(const RigProbe&) = delete;

  /// False if memory ran out; then no other function may be called.
  bool ready() const { return ready_; }
  const Rig& rig() const { return *deformer_.rig; }

  /// Sets all raw controls to their initial values.
  void clear();
  void set(uint16_t control, float value) { instance_->controls[control] = value; }
  const float* row() const { return instance_->controls.data; }

  /// Evaluates the row. The functions below return results for this pose.
  void pose();
  Span<const float> joint_values() const { return instance_->joints; }
  /// Model matrix: four columns of four.
  const float* joint(uint32_t joint) const;
  /// Where a point of the neutral pose is if it moves with a joint.
  Vec3 skinned(uint32_t joint, Vec3 place) const;
  Span<const float> positions(uint32_t mesh);
  /// Where a landmark is, in the rig's unit and axes.
  Vec3 place(const Landmark& landmark);

  /// The axis that points left, up or front (a direction 0, 2 or 4).
  Vec3 axis(uint32_t direction) const;
  double millimeters() const { return rig().units.translation == 0 ? 10 : 1000; }

 private:
  const Deformer& deformer_;
  Arena arena_;
  Instance* instance_ = nullptr;
  DeformerInstance* deformed_ = nullptr;
  Span<uint8_t> fresh_;  // [mesh] 1: its positions are those of the current pose
  bool ready_ = false;
};

constexpr uint16_t kNoJoint = 0xFFFF;

/// Finds the first raw control with one of the names, ignoring case and any prefix that ends with a dot;
/// kNoControl if there is none.
uint16_t find_raw_control(const Rig& rig, std::initializer_list<const char*> names);
/// The same for joints, but by their whole names; kNoJoint if there is none.
uint16_t find_joint(const Rig& rig, std::initializer_list<const char*> names);

}  // namespace mien
