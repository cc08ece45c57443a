// SPDX-License-Identifier: MIT
// Meshes and expression shapes from files, as mien_author.h takes them.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "integrations/program/io/materials.h"

namespace mien::cli {

constexpr uint32_t kNoMaterial = UINT32_MAX;
constexpr size_t kMaxMeshMaterials = 4096;

struct MeshObject {
  std::string name;
  uint32_t first_face = 0, face_count = 0;
  uint32_t material = kNoMaterial;
};

/// Textures are files, by their paths, or images that the mesh file holds.
struct MeshMaterial {
  SurfaceMaterial surface;
  std::array<uint32_t, kTextureKinds> images = {kNoMaterial, kNoMaterial, kNoMaterial};
};

/// Displacements of some positions; or of all, if `vertices` is empty.
struct MeshShape {
  std::string name;
  std::vector<uint32_t> vertices;
  std::vector<double> displacements;  // 3 each
};

struct MeshFile {
  std::vector<double> positions;  // 3 each, in the file's unit and axes
  std::vector<uint32_t> face_sizes, corners;
  std::vector<double> uvs;           // 2 each
  std::vector<uint32_t> corner_uvs;  // empty: not every corner has a UV
  std::vector<MeshObject> objects;   // in the order of their faces
  std::vector<MeshShape> shapes;
  std::vector<MeshMaterial> materials;
  std::vector<TextureFile> images;              // that materials name
  std::vector<std::string> material_libraries;  // as an OBJ names them
  std::set<std::string> lost_materials;         // of faces in objects that have another material
  std::vector<std::string> material_problems;   // files and images that are missing, for notes

  std::string material_name(uint32_t material) const {
    return material == kNoMaterial ? "no material" : materials[material].surface.name;
  }

  bool in_meters = false;  // y up, z to the front: glTF, and OBJ of `mien export`

  size_t position_count() const { return positions.size() / 3; }
};

/// A mesh, and with GLB its morph targets as shapes; with OBJ the materials of its libraries. An object whose parts
/// have different materials and share no positions is one object for each; otherwise it has the material of
/// most of its faces. Fails with kInvalid.
MeshFile read_mesh_file(const std::string& path);

/// Shapes for `mesh`: a folder of OBJ or .target files, each an expression of the file's name; an
/// .mshp; the morph targets of a GLB with the same positions.
std::vector<MeshShape> read_shapes(const std::string& path, const MeshFile& mesh);

/// How much neighbors move apart in a shape: near 0 where they move together, 1 where they have nothing
/// to do with each other, as in a shape of another mesh.
double find_incoherence(const MeshFile& mesh, const MeshShape& shape);

// Of each format; `path` is for messages ----------------------------------------------------------

MeshFile read_obj(const std::string& bytes, const std::string& path);
MeshFile read_glb(const std::string& bytes, const std::string& path);
/// Fills in the materials of the mesh that an MTL file at `path` has: Kd, d, Tr, Ns, Pr, and the images map_Kd,
/// map_Pr, norm and, if it is named as a normal map, map_Bump or bump.
void read_mtl(const std::string& bytes, const std::string& path, MeshFile& mesh);
/// Lines `index dx dy dz`, with comments after #.
MeshShape read_target(const std::string& bytes, size_t position_count, const std::string& path);
std::vector<MeshShape> read_mshp(const std::string& bytes, size_t position_count,
                                 const std::string& path);

/// "invalid mesh, PATH, WHERE: why; what_to_do"
[[noreturn]] void fail_mesh(const std::string& path, const std::string& where,
                            const std::string& why, const std::string& what_to_do);

}  // namespace mien::cli
