// SPDX-License-Identifier: MIT
// Inputs of authoring for tests: the skin of the procedural head with its own 52 expressions, bones
// spread over it, and simple weights. Everything is made here, so stages are tested one by one.
#pragma once

#include <string>
#include <vector>

#include "author/mesh/author_mesh.h"

namespace mien::author {

struct AuthorSetup {
  std::vector<Vec3> positions;
  std::vector<uint32_t> face_starts{0}, corners, triangles, welded, component;
  std::vector<uint8_t> is_skin;
  std::vector<std::string> shape_names, bone_names;
  std::vector<std::vector<Vec3f>> displacements;
  std::vector<std::vector<uint32_t>> moving;
  std::vector<Shape> shapes;
  std::vector<Part> parts;
  std::vector<Bone> bones;
  std::vector<uint32_t> lod_facial_counts, mask;
  std::vector<uint16_t> joints;
  std::vector<float> weight_values;
  AuthorMesh mesh;
  Placement placement;
  SkinWeights weights;

  AuthorSetup() = default;
  AuthorSetup(const AuthorSetup&) = delete;
  AuthorSetup& operator=(const AuthorSetup&) = delete;

  uint32_t add_vertex(Vec3 p);
  void add_face(const std::vector<uint32_t>& vertices);
  /// Calls at(v) for the displacement of each vertex.
  template <class At>
  void add_shape(const std::string& name, const At& at) {
    shape_names.push_back(name);
    displacements.emplace_back();
    for (uint32_t v = 0; v < positions.size(); ++v) {
      const Vec3 d = at(v);
      displacements.back().push_back(
          {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)});
    }
  }
  void add_bone(const std::string& name, Vec3 at, BoneKind kind, uint32_t parent);
  /// root, neck, head and face below each other.
  void add_trunk();
  /// Inverse squared distance over the `m` nearest facial bones of the first `kept`, falling to 0 at
  /// the next one.
  void weigh(uint32_t m, uint32_t kept, std::vector<uint16_t>& out_joints,
             std::vector<float>& out_weights) const;
  /// Fills `mesh`, `placement` and `weights` from the vectors.
  void finish(uint32_t m);
};

/// The skin of the procedural head at a LOD, with `bones` facial bones and LODs of falling counts.
void make_author_head(uint32_t lod, uint32_t bones, uint32_t influences, uint32_t lods,
                      AuthorSetup& out);

}  // namespace mien::author
