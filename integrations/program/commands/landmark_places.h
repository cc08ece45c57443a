// SPDX-License-Identifier: MIT
// Landmarks of a face on the mesh of a rig, by surface correspondence: a face with known landmarks is bent until it
// lies on the mesh.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "integrations/program/commands/moving_mesh.h"

namespace mien::cli {

constexpr size_t kFaceMotions = 11;

/// A face in centimeters, x to its left, y up, z to the front.
struct FaceSurface {
  std::vector<math::Vec3d> positions, normals;
  std::vector<std::array<uint32_t, 3>> triangles;
  /// How far some controls move each position, as a share of the largest distance. Empty: not a rig.
  std::vector<std::array<float, kFaceMotions>> motions;
  std::array<bool, kFaceMotions> has_motion = {};
  /// Middle of the edge of each upper lid, middle between the lips, tip of the nose, front of the chin.
  math::Vec3d left_lid, right_lid, mouth, nose, chin;

  double eye_distance() const { return length(left_lid - right_lid); }
};

/// The neutral mesh of a rig that can open its jaw and close its eyes. Fails with kInvalid.
FaceSurface read_face(const SolvedRig& rig, uint32_t mesh);
/// A mesh without a rig, whose lids and lips the caller knows.
FaceSurface make_face(const std::vector<math::Vec3d>& positions,
                      const std::vector<std::array<uint32_t, 3>>& triangles, math::Vec3d left_lid,
                      math::Vec3d right_lid, math::Vec3d mouth);

/// A point of a mesh: `mesh` of the result is 0.
using FacePoint = MienSolvePoint;
FacePoint face_point(uint32_t position);

/// Where points of `from` are on `to`.
std::vector<FacePoint> transfer_points(const FaceSurface& from,
                                       const std::vector<FacePoint>& points, const FaceSurface& to);

}  // namespace mien::cli
