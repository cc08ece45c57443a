// SPDX-License-Identifier: MIT
// Controls whose values depend on the coordinate system, and how to read them in another.
//
// Most controls are plain numbers. But twists, swings and RBF solvers read the rotation of a joint
// from four controls, a quaternion x y z w. The caller sets raw controls in the rig's system. ML
// controls that move a joint are converted to the rig's system after the networks have run
// (docs/rig-evaluation.md, 8.6 "ML joints"). Anything else that reads such a control must read
// another one, or negate it, when the system changes.
#pragma once

#include "runtime/base/coordinate_system.h"
#include "runtime/base/status.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::dna {

/// How to read an old control after the change: its value is sign * the value of `control`.
/// Sign 0: it has no equivalent.
struct Reading {
  uint16_t control = 0;
  int8_t sign = 1;

  bool same(uint32_t old) const { return control == old && sign == 1; }
};

class RotationControls {
 public:
  /// DNA_VALUE if a control would have to be two parts of a quaternion, or to move two joints.
  Status find(const DnaView& view, const CoordinateChange& change, bool ml_joints_change,
              Arena& arena, Error& error);

  Reading read(uint32_t control) const;

  /// False if every control is read and written as it was.
  bool any() const { return any_; }

  /// True for controls that hold the ML joints' own system until the networks have run.
  bool moves_ml_joint(uint32_t control) const;

  /// The four controls are one quaternion, in this order.
  bool is_quaternion(const uint16_t controls[4]) const;

  /// Factor for what networks give to a control: other than 1 if it moves an ML joint and its unit
  /// changes.
  double unit_of(uint32_t control) const;

 private:
  struct Role {
    Reading reading;
    uint8_t part = 0;  // 1 ... 4: x y z w; 0: no part of a quaternion
    bool moves_joint = false;
    uint16_t first = 0;  // control that is the x of the same quaternion
    double unit = 1;
  };

  const Role* role_of(uint32_t control) const;
  Role* role_of(uint32_t control) {
    return const_cast<Role*>(const_cast<const RotationControls*>(this)->role_of(control));
  }
  Status add_quaternion(const DnaView& view, const CoordinateChange& change,
                        const uint16_t controls[4], Error& error);
  Status add_named(const DnaView& view, const CoordinateChange& change, Error& error);
  Status add_solvers(const DnaView& view, const CoordinateChange& change, Error& error);
  template <class Setups>
  Status add_setups(const DnaView& view, const CoordinateChange& change, const Setups& setups,
                    Error& error);
  Status add_ml_joints(const DnaView& view, const CoordinateChange& change, Arena& arena,
                       Error& error);

  Span<Role> raw_, ml_;
  uint32_t first_ml_ = 0;
  bool any_ = false;
};

}  // namespace mien::dna
