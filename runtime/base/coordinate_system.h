// SPDX-License-Identifier: MIT
// Coordinate systems, and the change of numbers from one to another (docs/dna-format.md, 11
// "Coordinate systems").
//
// An axis points left, right, up, down, to the front or to the back of the character. So the axes of
// any two systems are parallel, and a change of axes permutes and negates numbers but never mixes
// them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien {

/// How the rotation sequence of Euler angles is converted; numbers of MienRotationRule in mien.h.
enum class RotationRule : uint32_t {
  kCarried,    // the file's sequence about the renamed axes: always exact
  kExact,      // the requested sequence; refused where sums of angles have no equivalent
  kPerColumn,  // the requested sequence, for each column of a joint matrix on its own
};

/// The numbers are those of the format (docs/dna-format.md, 7.1 "Descriptor").
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

/// From one system to another: new axis d is old axis from[d], and to[from[d]] is d.
struct CoordinateChange {
  uint8_t from[3], to[3];
  double vector[3];  // factors by new axis: of positions, translations, deltas
  float normal[3];   // of directions: their signs alone
  float turn[3];     // of x, y, z of quaternions: signs; all flip if handedness changes
  double angle[3];   // of Euler angles, if the sequence is carried or there is only one angle
  double length_unit, angle_unit;
  bool moves_axes;      // some axis differs
  bool carries_angles;  // angles only change order, signs and unit
  bool reverses_faces;
};

/// `wanted` with the sequence and the signs that the converted rig has.
CoordinateSystem resolve_system(const CoordinateSystem& from, const CoordinateSystem& wanted);

/// Expects axes that span space, enumerations in range, and `to` from resolve_system().
CoordinateChange coordinate_change(const CoordinateSystem& from, const CoordinateSystem& to);

/// Systems of engines and tools.
struct NamedSystem {
  const char* name;
  CoordinateSystem system;
};
constexpr size_t kNamedSystemCount = 10;
extern const NamedSystem kNamedSystems[kNamedSystemCount];

}  // namespace mien
