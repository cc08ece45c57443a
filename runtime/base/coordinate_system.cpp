// SPDX-License-Identifier: MIT
#include "runtime/base/coordinate_system.h"

#include "runtime/base/transform.h"

namespace mien {
namespace {

enum Direction : uint32_t { kLeft, kRight, kUp, kDown, kFront, kRear };
enum Length : uint32_t { kCentimeters, kMeters };
enum Angle : uint32_t { kDegrees, kRadians };
enum Sequence : uint32_t { kXyz, kXzy, kYxz, kYzx, kZxy, kZyx };
constexpr RotationRule kCarried = RotationRule::kCarried;

constexpr double kRadiansPerDegree = 0.017453292519943295;

// Which side of the character an axis points along: left or right, up or down, front or back.
uint32_t line_of(uint32_t direction) { return direction / 2; }

/// 1 or -1 along left, up and front.
int sense_of(uint32_t direction) { return direction % 2 == 0 ? 1 : -1; }

/// The same rotation sequence in terms of the axes to[...].
uint32_t carried_sequence(uint32_t sequence, const uint8_t to[3]) {
  constexpr int32_t kPlain[3] = {1, 1, 1};
  const RotationConvention old = rotation_convention(sequence, kPlain, kRadians);
  for (uint32_t s = kXyz; s <= kZyx; ++s) {
    const RotationConvention now = rotation_convention(s, kPlain, kRadians);
    if (now.axes[0] == to[old.axes[0]] && now.axes[1] == to[old.axes[1]]) return s;
  }
  return sequence;  // not reached: `to` is a permutation
}

}  // namespace

// Directions are the character's own. Winding is told by the plain cross product in the system's
// numbers (see mien.h), so an engine with left-handed axes that draws clockwise triangles has 0.
//
//   maya         Maya help: y up (default), right-handed, centimeters, rotate order xyz; characters
//                look along +z
//   unreal       Unreal Engine documentation, coordinate system: left-handed, x forward, y right,
//                z up, centimeters; FRotator turns by roll, pitch, yaw, positive pitch up and
//                positive roll to the right, so against the sense of the formulas about x and y
//   unreal-mesh  the same for skeletal meshes, which look along +y
//   unity        Unity Manual and Transform.eulerAngles: left-handed, y up, z forward, meters;
//                turns about z, then x, then y; clockwise triangles
//   godot        Godot documentation, model export considerations and Node3D.rotation_order:
//                right-handed, y up, models look along +z, meters, radians; YXZ of the local axes
//                is z, x, y about fixed ones; clockwise triangles
//   blender      Blender manual: right-handed, z up, front view along +y, so characters look along
//                -y; meters; XYZ Euler turns about x first; radians in its Python interface
//   gltf         glTF 2.0 specification 3.4: right-handed, y up, front +z, -x right, meters,
//                radians; rotations are quaternions; counter-clockwise triangles
//   opengl       OpenGL 2.1 reference, gluLookAt and glFrontFace: right-handed, looking along -z
//                with x to the right; it has no units
//   directx      Direct3D documentation, coordinate systems: left-handed, z forward; clockwise
//                triangles; XMMatrixRotationRollPitchYaw turns about z, x, y, in radians
//   houdini      Houdini documentation: right-handed, y up, meters, degrees, Rx Ry Rz; characters
//                look along +z
const NamedSystem kNamedSystems[kNamedSystemCount] = {
    {"maya", {{kLeft, kUp, kFront}, kCentimeters, kDegrees, kCarried, kXyz, {1, 1, 1}, 0}},
    {"unreal", {{kFront, kRight, kUp}, kCentimeters, kDegrees, kCarried, kXyz, {-1, -1, 1}, 1}},
    {"unreal-mesh", {{kLeft, kFront, kUp}, kCentimeters, kDegrees, kCarried, kXyz, {-1, -1, 1}, 1}},
    {"unity", {{kRight, kUp, kFront}, kMeters, kDegrees, kCarried, kZxy, {1, 1, 1}, 0}},
    {"godot", {{kLeft, kUp, kFront}, kMeters, kRadians, kCarried, kZxy, {1, 1, 1}, 1}},
    {"blender", {{kLeft, kRear, kUp}, kMeters, kRadians, kCarried, kXyz, {1, 1, 1}, 0}},
    {"gltf", {{kLeft, kUp, kFront}, kMeters, kRadians, kCarried, kXyz, {1, 1, 1}, 0}},
    {"opengl", {{kRight, kUp, kRear}, kMeters, kRadians, kCarried, kXyz, {1, 1, 1}, 0}},
    {"directx", {{kRight, kUp, kFront}, kMeters, kRadians, kCarried, kZxy, {1, 1, 1}, 0}},
    {"houdini", {{kLeft, kUp, kFront}, kMeters, kDegrees, kCarried, kXyz, {1, 1, 1}, 0}},
};

bool spans_space(const uint32_t axes[3]) {
  uint32_t lines = 0;
  for (int i = 0; i < 3; ++i) {
    if (axes[i] > kRear) return false;
    lines |= 1u << line_of(axes[i]);
  }
  return lines == 7;
}

CoordinateChange coordinate_change(const CoordinateSystem& from, const CoordinateSystem& to) {
  CoordinateChange change = {};
  double sign[3];
  for (uint8_t d = 0; d < 3; ++d) {
    for (uint8_t s = 0; s < 3; ++s) {
      if (line_of(to.axes[d]) != line_of(from.axes[s])) continue;
      change.from[d] = s;
      change.to[s] = d;
      sign[d] = sense_of(to.axes[d]) * sense_of(from.axes[s]);
    }
    change.moves_axes |= to.axes[d] != from.axes[d];
  }
  const bool even = (change.from[0] + 1) % 3 == change.from[1];
  const double handedness = sign[0] * sign[1] * sign[2] * (even ? 1 : -1);

  constexpr double kCentimetersOf[] = {1, 100}, kRadiansOf[] = {kRadiansPerDegree, 1};
  change.length_unit = kCentimetersOf[from.translation_unit] / kCentimetersOf[to.translation_unit];
  change.angle_unit = kRadiansOf[from.rotation_unit] / kRadiansOf[to.rotation_unit];
  for (int d = 0; d < 3; ++d) {
    change.normal[d] = static_cast<float>(sign[d]);
    change.vector[d] = sign[d] * change.length_unit;
    change.turn[d] = static_cast<float>(sign[d] * handedness);
    change.angle[d] = from.rotation_signs[change.from[d]] * sign[d] * handedness *
                      to.rotation_signs[d] * change.angle_unit;
  }
  change.carries_angles =
      to.rotation_sequence == carried_sequence(from.rotation_sequence, change.to);
  change.reverses_faces = (from.face_winding ^ (handedness < 0 ? 1u : 0u)) != to.face_winding;
  return change;
}

CoordinateSystem resolve_system(const CoordinateSystem& from, const CoordinateSystem& wanted) {
  const CoordinateChange change = coordinate_change(from, wanted);
  CoordinateSystem settled = wanted;
  if (wanted.rotation_rule == RotationRule::kCarried) {
    settled.rotation_sequence = carried_sequence(from.rotation_sequence, change.to);
  }
  for (int d = 0; d < 3; ++d) {
    if (wanted.rotation_signs[d] != 0) continue;
    settled.rotation_signs[d] =
        from.rotation_signs[change.from[d]] * static_cast<int32_t>(change.turn[d]);
  }
  return settled;
}

}  // namespace mien
