// SPDX-License-Identifier: MIT
#pragma once

#include <mien_author.h>

#include <vector>

#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

/// The mesh as the library takes it; refers to `file`.
struct MeshView {
  MienAuthorMesh mesh = mien_author_mesh_default();
  std::vector<MienAuthorObject> objects;
  std::vector<MienAuthorShape> shapes;

  explicit MeshView(const MeshFile& file) {
    for (const MeshObject& object : file.objects) {
      objects.push_back(
          {{object.name.data(), object.name.size()}, object.first_face, object.face_count});
    }
    for (const MeshShape& shape : file.shapes) {
      shapes.push_back({{shape.name.data(), shape.name.size()},
                        shape.vertices.empty() ? nullptr : shape.vertices.data(),
                        shape.displacements.size() / 3,
                        shape.displacements.data()});
    }
    mesh.positions = file.positions.data();
    mesh.position_count = file.position_count();
    mesh.face_sizes = file.face_sizes.data();
    mesh.face_count = file.face_sizes.size();
    mesh.corners = file.corners.data();
    mesh.corner_count = file.corners.size();
    mesh.uvs = file.uvs.data();
    mesh.uv_count = file.uvs.size() / 2;
    mesh.corner_uvs = file.corner_uvs.empty() ? nullptr : file.corner_uvs.data();
    mesh.objects = objects.data();
    mesh.object_count = objects.size();
    mesh.shapes = shapes.data();
    mesh.shape_count = shapes.size();
  }
};

}  // namespace mien::cli
