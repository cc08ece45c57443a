// SPDX-License-Identifier: MIT
// Hair cards, brows, beards, glasses: meshes of other files that follow the face.
#pragma once

#include "integrations/program/gltf/scene.h"

namespace mien::gltf {

/// A mesh in the axes and units of the scene. Vertices of one position are one here.
struct Attachment {
  std::string name;
  std::vector<Float3> positions;
  std::vector<uint32_t> triangles;
  std::vector<Float2> uvs;  // one for each position, or empty; v points down
  bool rigid = false;       // connected parts keep their shape
};

/// A mesh that was attached: what it follows, and how.
struct Attached {
  uint32_t mesh = 0, base = 0;  // numbers in the scene
  double mean = 0, max = 0;     // how far its vertices were from the surface, meters
  size_t parts = 0;             // that move rigidly

  /// Places of its vertices when the vertices of the base are here.
  std::vector<math::Vec3d> follow(const std::vector<math::Vec3d>& base_positions) const;

  struct Binding {
    std::vector<math::Vec3d> neutral,
        locals;  // of each vertex; locals in the frame of its triangle
    std::vector<std::array<uint32_t, 3>> corners;  // of this triangle, in the base
    std::vector<std::array<double, 3>> weights;    // of the corners
    std::vector<uint32_t> parts;                   // of each vertex; empty unless rigid
  } binding;
};

/// Adds a mesh to each LOD of the scene that shows its base: of the finest LOD, the mesh that is nearest to most of
/// its vertices. Each vertex is bound to the nearest point of a triangle of the base, and keeps its place in the
/// frame of this triangle. So it has
/// the targets of the base, and its skin weights. Of a rigid part, each target moves all of it by the rotation
/// and translation that best agree with this, and its weights are those of its middle.
///
/// Throws ExportError if the scene has no triangles to bind to.
Attached attach(const Attachment& attachment, uint32_t material, Scene& scene);

}  // namespace mien::gltf
