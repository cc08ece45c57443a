// SPDX-License-Identifier: MIT
// Meshes for authoring, as a caller gives them: the procedural head with its neck, and a way to turn,
// scale and shuffle any mesh.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "author/base/random.h"
#include "author/mesh/mesh_input.h"
#include "tests/support/author_setup.h"

namespace mien::author {

struct TestMesh {
  std::vector<double> positions;
  std::vector<uint32_t> face_sizes, corners;
  std::vector<std::string> shape_names;
  std::vector<std::vector<double>> displacements;
  std::vector<ObjectSource> objects;
  double unit = 1;
  Frame frame;
  std::vector<ShapeSource> shapes;  // of the last source()

  uint32_t vertex(double x, double y, double z) {
    positions.insert(positions.end(), {x, y, z});
    return static_cast<uint32_t>(positions.size() / 3 - 1);
  }
  void face(const std::vector<uint32_t>& at) {
    face_sizes.push_back(static_cast<uint32_t>(at.size()));
    corners.insert(corners.end(), at.begin(), at.end());
  }
  MeshSource source() {
    MeshSource out;
    out.positions = {positions.data(), positions.size()};
    out.face_sizes = {face_sizes.data(), face_sizes.size()};
    out.corners = {corners.data(), corners.size()};
    out.objects = {objects.data(), objects.size()};
    shapes.clear();
    for (size_t s = 0; s < shape_names.size(); ++s) {
      ShapeSource shape;
      shape.name = {shape_names[s].data(), shape_names[s].size()};
      shape.displacements = {displacements[s].data(), displacements[s].size()};
      shapes.push_back(shape);
    }
    out.shapes = {shapes.data(), shapes.size()};
    out.unit = unit;
    out.frame = frame;
    return out;
  }
  /// Applies at(x, y, z) to positions, and without_shift to displacements.
  template <class At>
  void transform(const At& at) {
    const auto apply = [&](std::vector<double>& all, bool is_shift) {
      const std::array<double, 3> zero = at(0.0, 0.0, 0.0);
      for (size_t i = 0; i < all.size(); i += 3) {
        std::array<double, 3> p = at(all[i], all[i + 1], all[i + 2]);
        for (size_t k = 0; k < 3; ++k) all[i + k] = is_shift ? p[k] - zero[k] : p[k];
      }
    };
    apply(positions, false);
    for (std::vector<double>& shape : displacements) apply(shape, true);
  }
  /// Another order of vertices and faces. Returns the new number of each vertex.
  std::vector<uint32_t> shuffle(uint64_t seed) {
    Random random = Random::from_seed(seed, 0);
    const uint32_t n = static_cast<uint32_t>(positions.size() / 3);
    std::vector<uint32_t> to(n);
    for (uint32_t v = 0; v < n; ++v) to[v] = v;
    for (uint32_t v = n; v > 1; --v) std::swap(to[v - 1], to[random.below(v)]);
    const auto move = [&](std::vector<double>& all) {
      std::vector<double> moved(all.size());
      for (uint32_t v = 0; v < n; ++v) {
        for (uint32_t k = 0; k < 3; ++k) moved[3 * to[v] + k] = all[3 * v + k];
      }
      all = moved;
    };
    move(positions);
    for (std::vector<double>& shape : displacements) move(shape);
    for (uint32_t& corner : corners) corner = to[corner];
    // Faces backward, each beginning elsewhere.
    std::vector<uint32_t> sizes, faces;
    size_t end = corners.size();
    for (size_t f = face_sizes.size(); f-- > 0;) {
      const size_t begin = end - face_sizes[f];
      for (size_t k = 0; k < face_sizes[f]; ++k) {
        faces.push_back(corners[begin + (k + 1) % face_sizes[f]]);
      }
      sizes.push_back(face_sizes[f]);
      end = begin;
    }
    face_sizes = sizes;
    corners = faces;
    return to;
  }
};

/// The mesh of a setup, with its expressions if wanted.
inline TestMesh mesh_of(const AuthorSetup& setup, bool with_shapes) {
  TestMesh out;
  for (const Vec3& p : setup.positions) out.vertex(p.x, p.y, p.z);
  for (size_t f = 0; f + 1 < setup.face_starts.size(); ++f) {
    out.face({setup.corners.begin() + setup.face_starts[f],
              setup.corners.begin() + setup.face_starts[f + 1]});
  }
  for (size_t s = 0; with_shapes && s < setup.shape_names.size(); ++s) {
    out.shape_names.push_back(setup.shape_names[s]);
    out.displacements.emplace_back();
    for (const Vec3f& d : setup.displacements[s]) {
      out.displacements.back().insert(out.displacements.back().end(),
                                      {double{d.x}, double{d.y}, double{d.z}});
    }
  }
  return out;
}

/// The skin of the procedural head at a LOD, with its expressions if wanted.
inline TestMesh procedural_mesh(uint32_t lod, bool with_shapes) {
  AuthorSetup setup;
  make_author_head(lod, 8, 4, 1, setup);
  return mesh_of(setup, with_shapes);
}

/// A UV sphere, as an eyeball or a head without a face.
inline void add_sphere(TestMesh& mesh, double x, double y, double z, double radius,
                       uint32_t rows = 12, uint32_t columns = 16) {
  std::vector<std::vector<uint32_t>> rings;
  for (uint32_t r = 1; r < rows; ++r) {
    rings.emplace_back();
    const double up = std::cos(3.14159265358979 * r / rows);
    const double out = std::sin(3.14159265358979 * r / rows);
    for (uint32_t c = 0; c < columns; ++c) {
      const double turn = 2 * 3.14159265358979 * c / columns;
      rings.back().push_back(mesh.vertex(x + radius * out * std::cos(turn), y + radius * up,
                                         z + radius * out * std::sin(turn)));
    }
  }
  const uint32_t top = mesh.vertex(x, y + radius, z), bottom = mesh.vertex(x, y - radius, z);
  for (uint32_t c = 0; c < columns; ++c) {
    const uint32_t next = (c + 1) % columns;
    mesh.face({top, rings.front()[next], rings.front()[c]});
    mesh.face({bottom, rings.back()[c], rings.back()[next]});
    for (size_t r = 0; r + 1 < rings.size(); ++r) {
      mesh.face({rings[r][c], rings[r][next], rings[r + 1][next], rings[r + 1][c]});
    }
  }
}

}  // namespace mien::author
