// SPDX-License-Identifier: MIT
// The effect of single controls of a rig on its joints and vertices: the behavior layer and the geometry of
// LOD 0 in double precision, for measuring. Without networks, RBF solvers, twists and swings.
//
// A pose has some raw controls at 1, and the correctives that they activate: pose p, for p below the number
// of raw controls, has raw control p alone; each further pose has all raw controls that one corrective
// multiplies.
#pragma once

#include "author/document/pose.h"
#include "runtime/base/arena.h"

namespace mien::author {

/// Control numbers have 16 bits, and may belong to layers that are missing.
constexpr uint32_t kMaxControls = 65536;

class ControlPoses {
 public:
  /// Keeps `view`, which passed the checks. False if memory ran out.
  bool prepare(const dna::DnaView& view, Arena& arena);

  uint32_t count() const { return view_->first_ml(); }

  /// Values of all controls in a pose. `out` has kMaxControls elements.
  void controls(uint32_t pose, Span<double> out) const;

  /// Skin matrices of all joints, v * m, where controls have these values (docs/deformation.md, 1 "Joint
  /// transforms", MIEN_COMPOSE_PRODUCT). False if memory ran out.
  bool skin(Span<const double> controls, Arena& scratch, Span<Rigid> out) const;

  /// Weights of channels at LOD 0.
  void channels(Span<const double> controls, Span<double> out) const;

  /// Positions of a mesh with these joints and channels.
  void deform(uint32_t mesh, Span<const Rigid> skin, Span<const double> channels,
              Span<Vec3> out) const;

  /// A position with these weights and skin matrices.
  static Vec3 skinned(const dna::VertexSkinWeights& vertex, Span<const Rigid> skin, Vec3 position);

  const Rigid& bind(uint32_t joint) const { return binds_[joint]; }
  /// Parents come before children.
  uint32_t ordered(uint32_t i) const { return order_[i]; }

 private:
  bool add_quaternions(const dna::JointGroup& group, uint32_t rows, Span<const double> controls,
                       Arena& scratch, Span<Quaternion> out) const;

  const dna::DnaView* view_ = nullptr;
  RotationConvention convention_;
  Span<uint32_t> order_;
  Span<Rigid> binds_, neutrals_;
  bool quaternions_ = false;  // some joint is represented by one
};

}  // namespace mien::author
