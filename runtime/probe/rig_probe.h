// SPDX-License-Identifier: MIT
// A rig to try raw controls on: what they do to joints and meshes is measured, not looked up.
#pragma once

#include <initializer_list>

#include "runtime/base/arena.h"
#include "runtime/base/vector.h"
#include "runtime/deform/deformer_instance.h"
#include "runtime/eval/instance.h"

namespace mien {

constexpr uint32_t kOfJoints = ~uint32_t{0};

/// A place of the face: the middle of positions of a mesh that LOD 0 shows, or of joints.
struct Landmark {
  uint32_t mesh = kOfJoints;
  Span<const uint32_t> points;
};

/// One character at LOD 0. All of it is offline: it allocates when it is made, and evaluates and
/// deforms whole meshes.
class RigProbe {
 public:
  RigProbe(const Deformer& deformer, const Allocator& allocator);
  ~RigProbe();
  RigProbe(const RigProbe&) = delete;
  RigProbe& operator=(const RigProbe&) = delete;

  /// False if memory ran out; then nothing else may be called.
  bool ready() const { return ready_; }
  const Rig& rig() const { return *deformer_.rig; }

  /// All raw controls at rest.
  void clear();
  void set(uint16_t control, float value) { instance_->controls[control] = value; }
  const float* row() const { return instance_->controls.data; }

  /// Evaluates the row; what follows is about that pose.
  void pose();
  Span<const float> joint_values() const { return instance_->joints; }
  /// Model matrix: four columns of four.
  const float* joint(uint32_t joint) const;
  /// Where a joint takes a place of the neutral pose.
  Vec3 skinned(uint32_t joint, Vec3 place) const;
  Span<const float> positions(uint32_t mesh);
  /// In the rig's unit and axes.
  Vec3 place(const Landmark& landmark);

  /// The axis that points left, up or front (a direction 0, 2 or 4).
  Vec3 axis(uint32_t direction) const;
  double millimeters() const { return rig().units.translation == 0 ? 10 : 1000; }

 private:
  const Deformer& deformer_;
  Arena arena_;
  Instance* instance_ = nullptr;
  DeformerInstance* deformed_ = nullptr;
  Span<uint8_t> fresh_;  // [mesh] its positions are of the current pose
  bool ready_ = false;
};

constexpr uint16_t kNoJoint = 0xFFFF;

/// The first raw control with one of the names, without regard to case and to a prefix that ends with
/// a dot; kNoControl if there is none.
uint16_t find_raw_control(const Rig& rig, std::initializer_list<const char*> names);
/// The same for joints, by their whole names; kNoJoint.
uint16_t find_joint(const Rig& rig, std::initializer_list<const char*> names);

}  // namespace mien
