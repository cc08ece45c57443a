// SPDX-License-Identifier: MIT
// A rig that libmien-author makes through its C interface.
#pragma once

#include "tests/support/mesh_source.h"
#include "tests/support/rig_handles.h"

namespace mien {

/// The skin of the procedural head at one of its LODs with its 52 expressions.
inline DnaHandle author_head(uint32_t lod, uint32_t facial_joints) {
  author::TestMesh source = author::procedural_mesh(lod, true);
  std::vector<MienAuthorShape> shapes(source.shape_names.size());
  for (size_t s = 0; s < shapes.size(); ++s) {
    shapes[s].name = {source.shape_names[s].data(), source.shape_names[s].size()};
    shapes[s].position_count = source.positions.size() / 3;
    shapes[s].displacements = source.displacements[s].data();
  }
  MienAuthorMesh mesh = sized<MienAuthorMesh>();
  mesh.positions = source.positions.data();
  mesh.position_count = source.positions.size() / 3;
  mesh.face_sizes = source.face_sizes.data();
  mesh.face_count = source.face_sizes.size();
  mesh.corners = source.corners.data();
  mesh.corner_count = source.corners.size();
  mesh.shapes = shapes.data();
  mesh.shape_count = shapes.size();
  MienAuthorDesc desc = sized<MienAuthorDesc>();
  desc.facial_joints = facial_joints;
  desc.lods = 1;
  MienError error = sized<MienError>();
  MienDna* dna = nullptr;
  EXPECT_EQ(mien_author_rig(&mesh, &desc, &dna, nullptr, &error), MIEN_OK) << error.message;
  return DnaHandle(dna);
}

}  // namespace mien
