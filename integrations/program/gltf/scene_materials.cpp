// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/scene_materials.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "integrations/program/gltf/material.h"

namespace mien::gltf {

namespace fs = std::filesystem;

std::string path_from(const std::string& folder, const std::string& path) {
  std::error_code ignored;
  const fs::path from = fs::absolute(folder.empty() ? fs::path(".") : fs::path(folder), ignored);
  const fs::path to = fs::absolute(path, ignored).lexically_normal();
  const fs::path relative = to.lexically_relative(from.lexically_normal());
  return (relative.empty() ? to : relative).generic_string();
}

namespace {

struct KnownImage {
  uint32_t number;
  bool has_alpha;
};
using KnownImages = std::map<std::string, KnownImage>;  // by path

/// Whether a PNG file has an alpha channel: the third bit of its color type.
bool has_alpha(const cli::TextureFile& file) {
  return file.is_png && file.bytes.size() > 25 && (file.bytes[25] & 4) != 0;
}

/// Number of the image of a file, which is read if it is new.
uint32_t image_number(const std::string& path, const ImageOptions& options, KnownImages& known,
                      Scene& scene) {
  const auto [found, is_new] =
      known.try_emplace(path, KnownImage{static_cast<uint32_t>(scene.images.size()), false});
  if (!is_new) return found->second.number;
  const bool held = options.held && options.held->count(path) != 0;
  cli::TextureFile file = held ? options.held->at(path) : cli::read_texture(path);
  found->second.has_alpha = has_alpha(file);
  Image image{
      fs::path(path).stem().string(), file.mime_type(), {}, path_from(options.folder, path)};
  if (options.embed) image.bytes = std::move(file.bytes);
  scene.images.push_back(std::move(image));
  return found->second.number;
}

bool same(const Material& a, const Material& b) {
  return a.color == b.color && a.roughness == b.roughness && a.double_sided == b.double_sided &&
         a.see_through == b.see_through && a.alpha_cutoff == b.alpha_cutoff &&
         a.cornea_depth == b.cornea_depth && a.cornea_iris == b.cornea_iris &&
         a.color_image == b.color_image && a.normal_image == b.normal_image &&
         a.roughness_image == b.roughness_image;
}

uint32_t material_number(const Material& material, Scene& scene) {
  for (uint32_t m = 0; m < scene.materials.size(); ++m) {
    if (scene.materials[m].name == material.name && same(scene.materials[m], material)) return m;
  }
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

/// Those that no mesh has any more.
void drop_unused_materials(Scene& scene) {
  std::vector<uint32_t> numbers(scene.materials.size(), kNone);
  std::vector<Material> kept;
  for (Mesh& mesh : scene.meshes) {
    uint32_t& number = numbers[mesh.material];
    if (number == kNone) {
      number = static_cast<uint32_t>(kept.size());
      kept.push_back(scene.materials[mesh.material]);
    }
    mesh.material = number;
  }
  scene.materials = std::move(kept);
}

}  // namespace

std::vector<std::string> apply_materials(const cli::Materials& materials,
                                         const ImageOptions& options, Scene& scene) {
  std::vector<std::string> without_uvs;
  KnownImages known;
  for (Mesh& mesh : scene.meshes) {
    const cli::SurfaceMaterial* from = materials.find(mesh.name);
    if (!from) continue;
    Material material = scene.materials[mesh.material];
    material.name = from->name;
    if (from->has_color) material.color = from->color;
    if (from->has_roughness) material.roughness = from->roughness;
    const bool has_textures = std::any_of(from->textures.begin(), from->textures.end(),
                                          [](const std::string& path) { return !path.empty(); });
    if (has_textures && mesh.uvs.empty()) without_uvs.push_back(mesh.name);
    if (has_textures && !mesh.uvs.empty()) {
      const auto image = [&](cli::TextureKind kind) {
        const std::string& path = from->texture(kind);
        return path.empty() ? kNone : image_number(path, options, known, scene);
      };
      material.color_image = image(cli::TextureKind::kBaseColor);
      material.normal_image = image(cli::TextureKind::kNormal);
      material.roughness_image = image(cli::TextureKind::kRoughness);
      material.cornea_depth = from->cornea_depth, material.cornea_iris = from->cornea_iris;
      // The textures say it alone, unless something was given to multiply them by.
      if (material.color_image != kNone) {
        if (!from->has_color) material.color = {1, 1, 1, 1};
        material.see_through = known.at(from->texture(cli::TextureKind::kBaseColor)).has_alpha;
        if (from->alpha_cutoff > 0 && material.see_through) {
          material.alpha_cutoff = from->alpha_cutoff;
          material.double_sided = true;
        }
        mesh.colors.clear();
      }
      if (material.roughness_image != kNone && !from->has_roughness) material.roughness = 1;
    } else if (from->has_color) {
      mesh.colors.clear();
    }
    mesh.material = material_number(material, scene);
  }
  drop_unused_materials(scene);
  return without_uvs;
}

}  // namespace mien::gltf
