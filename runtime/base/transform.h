// SPDX-License-Identifier: MIT
// Rotations: quaternions (x, y, z, w) and Euler angles in the conventions of DNA files
// (docs/rig-evaluation.md, 4.6 "Euler angles and quaternions"). a * b rotates by b first.
#pragma once

#include <cstdint>

namespace mien {

struct Quaternion {
  float x = 0, y = 0, z = 0, w = 1;
};

Quaternion operator*(const Quaternion& a, const Quaternion& b);

/// Rotation sequence, signs and unit of Euler angles.
struct RotationConvention {
  uint8_t axes[3] = {0, 1, 2};  // first, second, third axis to turn about
  float signs[3] = {1, 1, 1};   // of the angles about x, y, z
  float parity = 1;             // of `axes` as a permutation: 1 or -1
  float to_radians = 1;         // from the file's unit
};

/// `sequence` 0 ... 5: xyz xzy yxz yzx zxy zyx; `unit` 0: degrees, 1: radians.
RotationConvention rotation_convention(uint32_t sequence, const int32_t signs[3], uint32_t unit);

/// From angles about x, y, z.
Quaternion quaternion_from_euler(const RotationConvention& convention, const float angles[3]);

/// Rotation matrix for row vectors, v * m.
struct Matrix3 {
  double m[3][3];
};
/// From angles about x, y, z.
Matrix3 matrix_from_euler(const RotationConvention& convention, const float angles[3]);
/// The length of `q` does not matter; zero gives the identity.
Matrix3 matrix_from_quaternion(const Quaternion& q);
/// To angles about x, y, z. In gimbal lock the free angle is 0.
void euler_from_matrix(const RotationConvention& convention, const Matrix3& matrix,
                       float angles[3]);
Matrix3 operator*(const Matrix3& a, const Matrix3& b);
Matrix3 transposed(const Matrix3& a);

/// From the axes `from` to the axes `to`, for row vectors; an axis is a direction 0 ... 5: left,
/// right, up, down, front, back (docs/dna-format.md, 7.1 "Descriptor" and 11 "Coordinate systems").
Matrix3 change_of_axes(const uint32_t from[3], const uint32_t to[3]);

/// Unit length; identity if there is no direction.
Quaternion normalized(const Quaternion& q);

/// The part of a rotation about an axis (0, 1, 2: x, y, z), or the rest of the rotation, as RBF solvers
/// compare them (docs/rig-evaluation.md, 6.2 "Preparation of inputs and targets"). Not a number if `q` has
/// no such part.
Quaternion rotation_part(const Quaternion& q, uint32_t axis, bool swing);

}  // namespace mien
