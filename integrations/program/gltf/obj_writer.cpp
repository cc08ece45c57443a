// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/obj_writer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <set>

#include "integrations/program/gltf/material.h"
#include "integrations/program/gltf/rig_source.h"
#include "integrations/program/gltf/scene_materials.h"
#include "integrations/program/io/obj_space.h"
#include "integrations/program/math/srgb.h"

namespace mien::gltf {

namespace {

/// The fewest digits that give the same float back.
void append(std::string& text, float value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
  text += ' ';
  text.append(digits, end);
}

void append(std::string& text, const char* tag, const math::Vec3d& values,
            const std::string& mesh) {
  text += tag;
  for (const double value : {values.x, values.y, values.z}) {
    if (!std::isfinite(value)) {
      throw ExportError(MIEN_ERROR_DNA_VALUE, "mesh " + mesh, "a position is not a finite number",
                        "give smaller controls");
    }
    append(text, static_cast<float>(value));
  }
}

/// Line breaks and spaces would end a name.
std::string word_of(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) <= ' ') c = '_';
  }
  return name.empty() ? "mesh" : name;
}

/// Corners of the faces as the file has them, each face as `count` vertices.
class Faces {
 public:
  Faces(const MienDna* dna, uint32_t mesh)
      : dna_(dna), path_("geom.meshes[" + std::to_string(mesh) + "].faces") {
    count_ = field_count(path_);
  }

  uint64_t count() const { return count_; }

  void read(uint64_t face, std::vector<int64_t>& corners) const {
    const std::string path = path_ + "[" + std::to_string(face) + "].layoutIndices";
    corners.resize(field_count(path));
    if (corners.empty()) return;
    check(mien_dna_read_integers(dna_, path.c_str(), 0, corners.size(), corners.data(), nullptr),
          "cannot read faces");
  }

 private:
  uint64_t field_count(const std::string& path) const {
    auto field = sized<MienDnaField>();
    check(mien_dna_field(dna_, path.c_str(), &field, nullptr), "cannot read faces");
    return field.count;
  }

  const MienDna* dna_;
  std::string path_;
  uint64_t count_;
};

/// Numbers of OBJ count from 1 through the whole file.
struct Base {
  uint64_t position = 1, vertex = 1;
};

/// Without the colors of positions, which stand in the OBJ file.
Material material_of(const std::string& mesh, const cli::Materials& materials) {
  Material material = material_for(cli::mesh_class(mesh), false);
  const cli::SurfaceMaterial* from = materials.find(mesh);
  if (!from) return material;
  material.name = word_of(from->name);
  const bool has_image = !from->texture(cli::TextureKind::kBaseColor).empty();
  if (from->has_color || has_image) material.color = from->color;
  if (from->has_roughness) material.roughness = from->roughness;
  return material;
}

/// Lines of the textures of a mesh's material.
std::string texture_lines(const std::string& mesh, const cli::Materials& materials,
                          const std::string& folder) {
  const cli::SurfaceMaterial* from = materials.find(mesh);
  std::string lines;
  if (!from) return lines;
  const std::pair<const char*, cli::TextureKind> keywords[] = {
      {"map_Kd ", cli::TextureKind::kBaseColor},
      {"map_Pr ", cli::TextureKind::kRoughness},
      {"norm ", cli::TextureKind::kNormal}};
  for (const auto& [keyword, kind] : keywords) {
    const std::string& path = from->texture(kind);
    if (!path.empty()) lines += keyword + path_from(folder, path) + "\n";
  }
  return lines;
}

bool has_faces(const MienMesh& mesh) { return mesh.vertex_count != 0 && mesh.triangle_count != 0; }

void write_mesh(const RigSource& source, uint32_t number, const MienDeformerInstance* pose,
                Base& base, const cli::Materials* materials, std::string& text) {
  const MienMesh mesh = source.mesh(number);
  const std::string name = source.name(MIEN_KIND_MESH, number);
  MienFloatView positions{}, normals{};
  check(mien_deformer_instance_positions(pose, number, &positions), "cannot deform");
  check(mien_deformer_instance_normals(pose, number, &normals), "cannot deform");
  const std::vector<uint8_t>& colors = source.colors(number);

  text += "\no " + word_of(name) + "\ng " + word_of(name) + "\n";
  if (materials) text += "usemtl " + material_of(name, *materials).name + "\n";
  for (size_t p = 0; p < mesh.position_count; ++p) {
    append(text, "v", source.point(positions.data + 3 * p), name);
    if (!colors.empty()) {
      for (size_t i = 3 * p; i < 3 * p + 3; ++i) append(text, static_cast<float>(colors[i]) / 255);
    }
    text += '\n';
  }
  const float* uvs = mesh.texture_coordinates.data;
  const bool has_uvs = std::any_of(uvs, uvs + mesh.texture_coordinates.count,
                                   [](float value) { return value != 0; });
  for (size_t v = 0; has_uvs && v < mesh.vertex_count; ++v) {
    text += "vt";
    append(text, uvs[2 * v]);
    append(text, uvs[2 * v + 1]);
    text += '\n';
  }
  for (size_t v = 0; v < mesh.vertex_count; ++v) {
    append(text, "vn", source.direction(normals.data + 3 * v), name);
    text += '\n';
  }
  const Faces faces(source.dna(), number);
  const bool turn = source.has_inward_triangles(mesh);
  std::vector<int64_t> corners;
  for (uint64_t f = 0; f < faces.count(); ++f) {
    faces.read(f, corners);
    if (corners.size() < 3) continue;
    if (turn) std::reverse(corners.begin(), corners.end());
    text += 'f';
    for (const int64_t corner : corners) {
      const auto vertex = static_cast<size_t>(corner);
      const std::string shared = std::to_string(base.vertex + vertex);
      text += ' ' + std::to_string(base.position + mesh.vertex_position_indices.data[vertex]);
      text += '/' + (has_uvs ? shared : "") + '/' + shared;
    }
    text += '\n';
  }
  base.position += mesh.position_count;
  base.vertex += mesh.vertex_count;
}

}  // namespace

std::string write_obj(const RigSource& source, MienDeformerInstance* pose,
                      const std::string& material_library, const cli::Materials& materials) {
  std::string text = std::string(cli::kObjInMeters) + "\n";
  if (!material_library.empty()) text += "mtllib " + material_library + "\n";
  Base base;
  for (uint32_t m = 0; m < source.count(MIEN_KIND_MESH); ++m) {
    if (!has_faces(source.mesh(m))) continue;
    check(mien_deformer_instance_deform(pose, m, MIEN_NORMALS_RECOMPUTED, nullptr),
          "cannot deform");
    write_mesh(source, m, pose, base, material_library.empty() ? nullptr : &materials, text);
  }
  return text;
}

std::string write_mtl(const RigSource& source, const cli::Materials& materials,
                      const std::string& folder) {
  std::string text = "# sRGB colors\n";
  std::set<std::string> written;
  for (uint32_t m = 0; m < source.count(MIEN_KIND_MESH); ++m) {
    if (!has_faces(source.mesh(m))) continue;
    const std::string mesh = source.name(MIEN_KIND_MESH, m);
    const Material material = material_of(mesh, materials);
    if (!written.insert(material.name).second) continue;
    char lines[256];
    const auto color = [&](size_t i) { return math::linear_to_srgb(material.color[i]); };
    // The exponent that is usual for a roughness in programs that convert these.
    const double smoothness = 1 - material.roughness;
    std::snprintf(lines, sizeof(lines),
                  "Kd %.4f %.4f %.4f\nKs 0.2 0.2 0.2\nNs %.1f\nd %.2f\nillum 2\n", color(0),
                  color(1), color(2), 1000 * smoothness * smoothness, material.color[3]);
    text += "\nnewmtl " + material.name + "\n" + lines + texture_lines(mesh, materials, folder);
  }
  return text;
}

}  // namespace mien::gltf
