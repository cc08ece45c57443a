// SPDX-License-Identifier: MIT
// Neutral transforms of the joints of a view, for row vectors: model = local * model of the parent.
#pragma once

#include <algorithm>

#include "author/mesh/topology.h"
#include "runtime/base/transform.h"
#include "runtime/base/vector.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::author {

/// v * turn + place.
struct Rigid {
  Matrix3 turn = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 place;
};

inline Vec3 turned(const Vec3& v, const Matrix3& m) {
  return {v.x * m.m[0][0] + v.y * m.m[1][0] + v.z * m.m[2][0],
          v.x * m.m[0][1] + v.y * m.m[1][1] + v.z * m.m[2][1],
          v.x * m.m[0][2] + v.y * m.m[1][2] + v.z * m.m[2][2]};
}
inline Vec3 apply(const Vec3& v, const Rigid& to) { return turned(v, to.turn) + to.place; }
/// a, then b.
inline Rigid operator*(const Rigid& a, const Rigid& b) {
  return {a.turn * b.turn, apply(a.place, b)};
}
inline Rigid inverse(const Rigid& a) {
  const Matrix3 back = transposed(a.turn);
  return {back, turned(a.place, back) * -1};
}

/// Makes the box large enough for a point.
inline void add(Box& box, const Vec3& p) {
  box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
  box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
}

inline RotationConvention convention_of(const dna::DnaView& view) {
  const int32_t signs[3] = {view.dsce.rotation_sign.x, view.dsce.rotation_sign.y,
                            view.dsce.rotation_sign.z};
  return rotation_convention(view.dsce.rotation_sequence, signs, view.desc.rotation_unit);
}

inline Vec3 vector_of(const dna::Vec3Array& vectors, uint32_t i) {
  return {double{vectors.xs[i]}, double{vectors.ys[i]}, double{vectors.zs[i]}};
}

inline Rigid neutral_of(const dna::DnaView& view, const RotationConvention& convention,
                        uint32_t joint) {
  const dna::Vec3Array& angles = view.defn.neutral_rotations;
  const float about[3] = {angles.xs[joint], angles.ys[joint], angles.zs[joint]};
  return {matrix_from_euler(convention, about), vector_of(view.defn.neutral_translations, joint)};
}

/// Relative to the model. Expects a hierarchy without circles.
inline Rigid model_of(const dna::DnaView& view, const RotationConvention& convention,
                      uint32_t joint) {
  Rigid model = neutral_of(view, convention, joint);
  while (view.defn.joint_hierarchy[joint] != joint) {
    joint = view.defn.joint_hierarchy[joint];
    model = model * neutral_of(view, convention, joint);
  }
  return model;
}

}  // namespace mien::author
