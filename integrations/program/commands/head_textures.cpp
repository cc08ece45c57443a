// SPDX-License-Identifier: MIT
#include "integrations/program/commands/head_textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include "integrations/program/io/materials.h"
#include "integrations/program/io/output.h"
#include "integrations/program/render/hair_texture.h"
#include "integrations/program/render/png.h"
#include "integrations/program/render/skin_texture.h"
#include "integrations/program/scene/posed_scene.h"

namespace mien::cli {

namespace {

/// Texels are 0.3 mm wide in front and 0.5 mm high. A GLB with them has less than 6 MB.
constexpr int kSkinWidth = 1280, kSkinHeight = 640;

/// v of a row of the head at a height in centimeters, as author/generate/head/skin.h has it.
constexpr float row_v(double y) { return float(0.06 + 0.94 * (y + 22.0) / 34.6); }

render::SkinLayout head_layout(uint64_t seed) {
  render::SkinLayout layout;
  layout.inner_below = row_v(-22);
  layout.cloth_below = row_v(-17.5);
  layout.collar = row_v(0.45f) - row_v(0), layout.hem = 0.03f;
  layout.skin_u = 0.5f, layout.skin_v = row_v(5);
  layout.lips_low_u = 0.41f, layout.lips_high_u = 0.59f;
  layout.lips_low_v = row_v(-7.3), layout.lips_high_v = row_v(-4.9);
  layout.freckles_low_v = row_v(-5), layout.freckles_high_v = row_v(2);
  layout.freckles = seed % 3 == 1 ? 0.7f : 0;  // one in three
  return layout;
}

size_t mesh_named(const PosedScene& scene, const std::string& name) {
  size_t i = 0;
  while (i < scene.meshes.size() && scene.meshes[i].name != name) ++i;
  if (i == scene.meshes.size() || scene.meshes[i].colors.empty()) {
    fail(kInternal, "cannot make textures", scene.shown, "there is no " + name + " with colors",
         "");
  }
  return i;
}

/// The gray texture times the color of the hair, which the first vertex of such a mesh has.
SurfaceMaterial hair_material(const char* name, const std::vector<uint8_t>& colors,
                              const std::string& texture) {
  const render::Color c = {colors[0], colors[1], colors[2]};
  const math::Vec3 linear = render::to_linear(c);
  SurfaceMaterial material;
  material.name = name;
  // The grays are about 0.75, which is half of the light.
  const auto lighter = [](float share) {
    return std::min(std::round(share * 2 * 1000) / 1000.0, 1.0);
  };
  material.color = {lighter(linear.x), lighter(linear.y), lighter(linear.z), 1};
  material.roughness = 0.6;
  // From afar a texel is the mean of hairs and gaps: thin brows and lashes would vanish.
  material.alpha_cutoff = std::string(name) == "hair" ? 0.3 : 0.25;
  material.has_color = material.has_roughness = true;
  material.textures[size_t(TextureKind::kBaseColor)] = texture;
  return material;
}

}  // namespace

void write_head_textures(Dna dna, uint64_t seed, const std::string& path, const std::string& folder,
                         const Session& session) {
  namespace fs = std::filesystem;
  auto info = sized<MienDnaInfo>();
  check(mien_dna_info(dna.get(), &info), nullptr, "cannot make textures", path);
  RigFile file{path, {}, std::move(dna), info};
  PosedScene scene = open_scene(std::move(file), session);
  pose_scene(scene, Frame{});
  const std::vector<render::Surface> surfaces = scene.surfaces();
  const size_t head = mesh_named(scene, "head_lod0_mesh");
  const render::SkinMaps maps =
      render::make_skin_maps(surfaces[head], head_layout(seed), kSkinWidth, kSkinHeight);

  const OutputFolder out(folder);
  SurfaceMaterial skin;
  skin.name = "skin";
  std::vector<std::unique_ptr<Output>> outputs;
  const std::array<const render::Image*, kTextureKinds> images = {&maps.base_color, &maps.normal,
                                                                  &maps.roughness};
  static constexpr const char* kNames[kTextureKinds] = {"skin_basecolor.png", "skin_normal.png",
                                                        "skin_roughness.png"};
  for (size_t k = 0; k < kTextureKinds; ++k) {
    skin.textures[k] = out.file(kNames[k]);
    outputs.push_back(std::make_unique<Output>(skin.textures[k]));
    const bool gray = k == size_t(TextureKind::kRoughness);
    outputs.back()->write(gray ? render::to_gray_png(*images[k], {}) : render::to_png(*images[k]));
  }
  Materials materials;
  materials.list.push_back(skin);
  const render::HairMap hair = render::make_hair_map();
  const std::string hair_path = out.file("hair.png");
  outputs.push_back(std::make_unique<Output>(hair_path));
  outputs.back()->write(render::to_gray_png(hair.gray, hair.alpha));
  for (const char* name : {"hair", "brows", "lashes"}) {
    const size_t mesh = mesh_named(scene, std::string(name) + "_lod0_mesh");
    materials.list.push_back(hair_material(name, scene.meshes[mesh].colors, hair_path));
  }
  for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
    const std::string of_lod = "_lod" + std::to_string(lod) + "_mesh";
    materials.of_mesh["head" + of_lod] = 0;
    for (size_t m = 1; m < materials.list.size(); ++m) {
      materials.of_mesh[materials.list[m].name + of_lod] = m;
    }
  }
  outputs.push_back(std::make_unique<Output>(materials_path(path)));
  outputs.back()->write(materials_json(materials, fs::path(path).parent_path().string()));
  for (const auto& output : outputs) output->commit();
}

}  // namespace mien::cli
