// SPDX-License-Identifier: MIT
// What a rig should give in another coordinate system, computed a second time: from matrices of the
// directions that axes point to, in double precision, with no code of the library.
#pragma once

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "tests/support/rig_handles.h"

namespace mien {

struct Mat3 {
  double m[3][3] = {};
};

inline Mat3 operator*(const Mat3& a, const Mat3& b) {
  Mat3 p;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 3; ++k) p.m[r][c] += a.m[r][k] * b.m[k][c];
    }
  }
  return p;
}
inline Mat3 transposed(const Mat3& a) {
  Mat3 t;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) t.m[r][c] = a.m[c][r];
  }
  return t;
}

/// The system that a rig is in.
inline MienCoordinateSystem system_of(const MienDna* dna) {
  MienDnaInfo info = sized<MienDnaInfo>();
  EXPECT_EQ(mien_dna_info(dna, &info), MIEN_OK);
  MienCoordinateSystem out = sized<MienCoordinateSystem>();
  std::copy(info.axes, info.axes + 3, out.axes);
  std::copy(info.rotation_signs, info.rotation_signs + 3, out.rotation_signs);
  out.translation_unit = info.translation_unit;
  out.rotation_unit = info.rotation_unit;
  out.rotation_sequence = info.rotation_sequence;
  out.face_winding = info.face_winding;
  return out;
}

/// A rig's system as mien_dna_info() tells it.
struct Space {
  uint32_t axes[3];
  double centimeters, radians;  // in one unit
  uint32_t sequence;
  int32_t signs[3];
  uint32_t winding;

  explicit Space(const MienDna* dna) {
    MienDnaInfo info = sized<MienDnaInfo>();
    EXPECT_EQ(mien_dna_info(dna, &info), MIEN_OK);
    for (int i = 0; i < 3; ++i) {
      axes[i] = info.axes[i];
      signs[i] = info.rotation_signs[i];
    }
    centimeters = info.translation_unit == MIEN_TRANSLATION_UNIT_METERS ? 100 : 1;
    radians = info.rotation_unit == MIEN_ROTATION_UNIT_RADIANS ? 1 : std::acos(-1.0) / 180;
    sequence = info.rotation_sequence;
    winding = info.face_winding;
  }

  /// Rows: the axes, in the canonical frame.
  Mat3 basis() const {
    constexpr double kDirections[6][3] = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                          {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    Mat3 b;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) b.m[i][k] = kDirections[axes[i]][k];
    }
    return b;
  }

  /// Of Euler angles, for row vectors.
  Mat3 rotation(const double angles[3]) const {
    constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                   {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    Mat3 product;
    for (int i = 0; i < 3; ++i) product.m[i][i] = 1;
    for (int axis : kOrders[sequence]) {
      const double a = angles[axis] * signs[axis] * radians;
      const int j = (axis + 1) % 3, k = (axis + 2) % 3;
      Mat3 turn;
      turn.m[axis][axis] = 1;
      turn.m[j][j] = turn.m[k][k] = std::cos(a);
      turn.m[j][k] = std::sin(a);
      turn.m[k][j] = -std::sin(a);
      product = product * turn;
    }
    return product;
  }
};

inline Mat3 rotation_of_quaternion(const float q[4]) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double s = 2 / (x * x + y * y + z * z + w * w);
  Mat3 r;
  const double rows[3][3] = {{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
                             {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
                             {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)}};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) r.m[i][k] = rows[i][k];
  }
  return r;
}

/// From one system to another, for row vectors: docs/dna-format.md, 11 "Coordinate systems".
struct SpaceChange {
  Space from, to;
  Mat3 change;

  SpaceChange(const MienDna* a, const MienDna* b)
      : from(a), to(b), change(from.basis() * mien::transposed(to.basis())) {}

  double determinant() const {
    const auto& m = change.m;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  }
  void vector(const double in[3], double out[3]) const {
    for (int c = 0; c < 3; ++c) {
      out[c] = 0;
      for (int r = 0; r < 3; ++r) out[c] += in[r] * change.m[r][c];
      out[c] *= from.centimeters / to.centimeters;
    }
  }
  Mat3 rotation(const Mat3& r) const { return mien::transposed(change) * r * change; }
  /// A quaternion's axis is mirrored with space, and its sense with the handedness.
  void quaternion(float q[4]) const {
    double v[3];
    for (int c = 0; c < 3; ++c) {
      v[c] = 0;
      for (int r = 0; r < 3; ++r) v[c] += double{q[r]} * change.m[r][c] * determinant();
    }
    for (int i = 0; i < 3; ++i) q[i] = static_cast<float>(v[i]);
  }
};

/// Inputs that are quaternions: what twists, swings and solvers read, and what is named so.
inline std::set<std::vector<uint16_t>> quaternion_inputs(const dna::DnaView& view) {
  std::set<std::vector<uint16_t>> found;
  const uint32_t raw = view.defn.raw_control_names.count;
  const auto add = [&](const dna::Array<uint16_t>& controls) {
    for (uint32_t i = 0; i + 4 <= controls.count; i += 4) {
      const std::vector<uint16_t> four = {controls[i], controls[i + 1], controls[i + 2],
                                          controls[i + 3]};
      if (four[0] < raw) found.insert(four);
    }
  };
  for (const dna::Twist& twist : view.twsw.twists) add(twist.input_control_indices);
  for (const dna::Swing& swing : view.twsw.swings) add(swing.input_control_indices);
  for (const dna::RbfSolver& solver : view.rbfb.solvers) {
    if (solver.distance_method != 0) add(solver.raw_control_indices);
  }
  for (uint16_t i = 0; i + 4u <= raw; ++i) {
    const dna::String& name = view.defn.raw_control_names[i];
    if (name.count > 3 && memcmp(name.data + name.count - 3, ".qx", 3) == 0) {
      found.insert({i, uint16_t(i + 1), uint16_t(i + 2), uint16_t(i + 3)});
    }
  }
  return found;
}

}  // namespace mien
