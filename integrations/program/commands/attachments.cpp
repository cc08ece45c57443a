// SPDX-License-Identifier: MIT
#include "integrations/program/commands/attachments.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include "integrations/program/gltf/attachment.h"
#include "integrations/program/gltf/material.h"
#include "integrations/program/io/text.h"
#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

namespace {

/// One mesh: faces from `first` on, cut into triangles. A position with several texture coordinates becomes
/// several.
gltf::Attachment attachment_of(const MeshFile& file, const MeshObject& object, size_t first_corner,
                               const std::string& name) {
  gltf::Attachment result;
  result.name = name;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> known;
  const auto vertex = [&](size_t corner) {
    const uint32_t position = file.corners[corner];
    const uint32_t uv = file.corner_uvs.empty() ? 0 : file.corner_uvs[corner];
    const auto [found, is_new] =
        known.try_emplace({position, uv}, static_cast<uint32_t>(result.positions.size()));
    if (is_new) {
      const double* p = file.positions.data() + size_t{3} * position;
      result.positions.push_back(
          {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
      if (!file.corner_uvs.empty()) {
        const double* t = file.uvs.data() + size_t{2} * uv;
        result.uvs.push_back({static_cast<float>(t[0]), static_cast<float>(1 - t[1])});
      }
    }
    return found->second;
  };
  for (uint32_t f = object.first_face; f < object.first_face + object.face_count; ++f) {
    for (uint32_t k = 2; k < file.face_sizes[f]; ++k) {
      result.triangles.push_back(vertex(first_corner));
      result.triangles.push_back(vertex(first_corner + k - 1));
      result.triangles.push_back(vertex(first_corner + k));
    }
    first_corner += file.face_sizes[f];
  }
  return result;
}

uint32_t material_number(const std::string& name, gltf::Scene& scene) {
  const gltf::Material material = gltf::material_for(mesh_class(name), false);
  for (uint32_t m = 0; m < scene.materials.size(); ++m) {
    if (scene.materials[m].name == material.name) return m;
  }
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

/// The material of an object for the meshes of the scene from `first` on.
void keep_material(const std::string& path, const MeshFile& file, uint32_t number, size_t first,
                   const gltf::Scene& scene, Attachments& all) {
  if (number == kNoMaterial) return;
  const MeshMaterial& from = file.materials[number];
  SurfaceMaterial material = from.surface;
  for (size_t k = 0; k < kTextureKinds; ++k) {
    if (from.images[k] == kNoMaterial) continue;
    material.textures[k] = path + "#" + std::to_string(from.images[k]);
    all.images.emplace(material.textures[k], file.images[from.images[k]]);
  }
  for (size_t m = first; m < scene.meshes.size(); ++m) {
    const std::string& name = scene.meshes[m].name;
    const auto same_name = [&](const gltf::Mesh& mesh) { return mesh.name == name; };
    const auto begin = scene.meshes.begin();
    // Materials are found by names.
    if (std::any_of(begin, begin + static_cast<std::ptrdiff_t>(m), same_name)) continue;
    all.materials.of_mesh[name] = all.materials.list.size();
  }
  all.materials.list.push_back(std::move(material));
}

void add_file(const std::string& path, bool rigid, gltf::Scene& scene, Attachments& all,
              const Session& session) {
  const MeshFile file = read_mesh_file(path);
  for (const std::string& problem : file.material_problems) note(session, one_line(problem));
  const std::string stem = std::filesystem::path(path).stem().string();
  std::vector<MeshObject> objects = file.objects;
  if (objects.empty()) {
    objects.push_back({stem, 0, static_cast<uint32_t>(file.face_sizes.size())});
  }
  for (const MeshObject& object : objects) {
    if (object.face_count == 0) continue;
    size_t first_corner = 0;
    for (uint32_t f = 0; f < object.first_face; ++f) first_corner += file.face_sizes[f];
    const std::string name = object.name.empty() ? stem : object.name;
    gltf::Attachment attachment = attachment_of(file, object, first_corner, name);
    attachment.rigid = rigid;
    const size_t first = scene.meshes.size();
    gltf::Attached attached = gltf::attach(attachment, material_number(name, scene), scene);
    keep_material(path, file, object.material, first, scene, all);
    char text[160];
    std::snprintf(text, sizeof(text), ", %.2g mm from it on average, %.2g mm at most",
                  attached.mean * 1000, attached.max * 1000);
    std::string line = one_line(path) + ": " + one_line(name) + " follows " +
                       one_line(scene.meshes[attached.base].name) + text;
    if (rigid) line += "; " + std::to_string(attached.parts) + " rigid parts";
    note(session, line);
    all.meshes.push_back(std::move(attached));
  }
}

}  // namespace

Attachments add_attachments(const AttachmentOptions& options, gltf::Scene& scene,
                            const Session& session) {
  Attachments attached;
  const size_t first = scene.meshes.size();
  for (const std::string& path : options.soft) add_file(path, false, scene, attached, session);
  for (const std::string& path : options.rigid) add_file(path, true, scene, attached, session);
  // In an animation they have the weights of what they follow, whose targets they have.
  gltf::Animation& animation = scene.animation;
  for (size_t m = first; m < scene.meshes.size(); ++m) {
    for (size_t t = 0; t < animation.weights.size(); ++t) {
      const gltf::WeightTrack track = animation.weights[t];
      const auto& of = scene.meshes[track.mesh].targets;
      const auto& mine = scene.meshes[m].targets;
      const bool same = !mine.empty() &&
                        std::equal(of.begin(), of.end(), mine.begin(), mine.end(),
                                   [](const auto& a, const auto& b) { return a.name == b.name; });
      if (!same || track.mesh >= first) continue;
      animation.weights.push_back({static_cast<uint32_t>(m), track.weights});
      break;
    }
  }
  return attached;
}

void add_attached_materials(const Attachments& attachments, gltf::ImageOptions options,
                            gltf::Scene& scene, const Session& session) {
  Materials materials = attachments.materials;
  options.held = &attachments.images;
  for (SurfaceMaterial& material : materials.list) {
    for (std::string& path : material.textures) {
      if (path.empty()) continue;
      const bool held = attachments.images.count(path) != 0;
      if (held ? options.embed : std::filesystem::is_regular_file(path)) continue;
      note(session, "material " + one_line(material.name) + ": " +
                        (held ? "its image is within " + one_line(path) +
                                    ", so this format cannot name it: it is left out"
                              : "there is no file " + one_line(path) + ", which is left out"));
      path.clear();
    }
  }
  for (const std::string& mesh : apply_materials(materials, options, scene)) {
    note(session,
         "attached mesh " + one_line(mesh) + " has no texture coordinates, so it gets no textures");
  }
}

}  // namespace mien::cli
