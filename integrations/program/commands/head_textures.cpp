// SPDX-License-Identifier: MIT
#include "integrations/program/commands/head_textures.h"

#include <array>
#include <filesystem>
#include <memory>

#include "integrations/program/io/materials.h"
#include "integrations/program/io/output.h"
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
  layout.cloth_below = row_v(-17.6);
  layout.skin_u = 0.5f, layout.skin_v = row_v(5);
  layout.lips_low_u = 0.41f, layout.lips_high_u = 0.59f;
  layout.lips_low_v = row_v(-7.3), layout.lips_high_v = row_v(-4.9);
  layout.freckles_low_v = row_v(-5), layout.freckles_high_v = row_v(2);
  layout.freckles = seed % 3 == 1 ? 0.7f : 0;  // one in three
  return layout;
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
  size_t head = 0;
  while (head < scene.meshes.size() && scene.meshes[head].name != "head_lod0_mesh") ++head;
  if (head == scene.meshes.size() || !surfaces[head].colors) {
    fail(kInternal, "cannot make textures", path, "there is no head with colors", "");
  }
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
    outputs.back()->write(render::to_png(*images[k]));
  }
  Materials materials;
  materials.list.push_back(skin);
  for (uint32_t lod = 0; lod < info.lod_count; ++lod) {
    materials.of_mesh["head_lod" + std::to_string(lod) + "_mesh"] = 0;
  }
  outputs.push_back(std::make_unique<Output>(materials_path(path)));
  outputs.back()->write(materials_json(materials, fs::path(path).parent_path().string()));
  for (const auto& output : outputs) output->commit();
}

}  // namespace mien::cli
