// SPDX-License-Identifier: MIT
// Coordinate systems that a rig may be asked for, and what becomes of numbers on the way from one
// system to another (dna-format 11).
//
// An axis points left, right, up, down, to the front or to the back of the character. So the axes
// of any two systems lie along each other, and a change of axes moves and negates numbers but never
// mixes them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien {

/// What becomes of the order in which Euler angles turn, and of their signs.
enum class RotationRule : uint32_t {
  kCarried,    // the file's order, about the axes as they are now called: always exact
  kExact,      // the order named; refused where sums of angles cannot follow
  kPerColumn,  // the order named, for each column of a joint matrix by itself
};

/// The numbers are those of the format (dna-format 7.1).
struct CoordinateSystem {
  uint32_t axes[3] = {0, 2, 4};
  uint32_t translation_unit = 0, rotation_unit = 0;
  RotationRule rotation_rule = RotationRule::kCarried;
  uint32_t rotation_sequence = 0;
  int32_t rotation_signs[3] = {1, 1, 1};  // of a target also 0: angles keep their numbers
  uint32_t face_winding = 0;
};

/// True if the axes are directions that span space.
bool spans_space(const uint32_t axes[3]);

/// From one system to another: what is called axis d now was axis from[d], and the other way round
/// to[from[d]] is d.
struct CoordinateChange {
  uint8_t from[3], to[3];
  double vector[3];  // factors by new axis: of positions, translations, deltas
  float normal[3];   // of directions: their signs alone
  float turn[3];     // of x, y, z of quaternions: signs, the same for all if handedness changes
  double angle[3];   // of Euler angles, if the order is carried or there is only one
  double length_unit, angle_unit;
  bool moves_axes;      // axes are not what they were
  bool carries_angles;  // angles only move and change signs and unit
  bool reverses_faces;
};

/// `wanted` with the sequence and the signs that the rig will have.
CoordinateSystem resolve_system(const CoordinateSystem& from, const CoordinateSystem& wanted);

/// The axes of both systems span space, and all their numbers have a meaning. `to` is settled.
CoordinateChange coordinate_change(const CoordinateSystem& from, const CoordinateSystem& to);

/// Systems of engines and tools.
struct NamedSystem {
  const char* name;
  CoordinateSystem system;
};
constexpr size_t kNamedSystemCount = 10;
extern const NamedSystem kNamedSystems[kNamedSystemCount];

}  // namespace mien
