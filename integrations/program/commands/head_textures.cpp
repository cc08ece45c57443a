// SPDX-License-Identifier: MIT
#include "integrations/program/commands/head_textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include "integrations/program/io/materials.h"
#include "integrations/program/io/output.h"
#include "integrations/program/render/eye_texture.h"
#include "integrations/program/render/hair_texture.h"
#include "integrations/program/render/png.h"
#include "integrations/program/render/skin_texture.h"
#include "integrations/program/render/teeth_texture.h"
#include "integrations/program/scene/posed_scene.h"

namespace mien::cli {

namespace {

/// Texels of skin are 0.25 mm wide and 0.3 mm high in front. A GLB with them has less than 6 MB.
constexpr int kSkinWidth = 1152, kSkinHeight = 768, kEyeSize = 512;
constexpr int kTongueWidth = 192, kTongueHeight = 256, kTeethWidth = 512, kTeethHeight = 256;

// Places in the texture, as author/generate/head/skin.h has them.
float denser(float even) { return even * 1.8f / (1 + 0.8f * std::fabs(even)); }

/// v of a row of the head at a height in centimeters.
float row_v(float y) {
  const float span = y > -3 ? 15.6f : 19;
  return (19 + span * denser((y + 3) / span)) / 34.6f;
}

/// How far beside the middle a place is in u that many degrees around the head.
float beside(float degrees) { return 0.5f * denser(degrees / 180); }

render::SkinZone zone(float degrees, float y, float half_degrees, float half_y, float oil,
                      float pores) {
  const float u = beside(degrees), v = row_v(y);
  return {u, v, beside(degrees + half_degrees) - u, row_v(y + half_y) - v, oil, pores};
}

render::SkinLayout head_layout(uint64_t seed) {
  render::SkinLayout layout;
  // Sebum makes the middle of the face shine: nose, chin and forehead. A little: the texture has square roots of
  // roughness, plain skin 0.54. With 0.44 the forehead looked like plastic where skin is dark, as little else comes back.
  // Pores are largest on the nose and beside it.
  layout.zones = {zone(0, 5.2f, 40, 3.2f, 0.02f, 0.2f),    zone(0, -2.4f, 13, 3.4f, 0.08f, 0.5f),
                  zone(0, -9.6f, 16, 1.8f, 0.05f, 0.3f),   zone(24, -2.6f, 15, 2.6f, 0.03f, 0.5f),
                  zone(27, 0.9f, 16, 1.6f, 0.05f, -0.5f),  zone(27, -1.2f, 15, 1.0f, 0.01f, -0.5f),
                  zone(100, -1.0f, 22, 4.0f, 0.04f, -0.6f)};
  layout.plain_u = beside(95), layout.plain_v = row_v(8.5f);
  layout.lids_low_u = 0.5f + beside(10), layout.lids_high_u = 0.5f + beside(42);
  layout.lids_low_v = row_v(-0.9f), layout.lids_high_v = row_v(1.5f);
  layout.cloth_below = row_v(-17.5f);
  layout.collar = row_v(-17.05f) - row_v(-17.5f), layout.hem = 0.03f;
  layout.skin_u = 0.5f, layout.skin_v = row_v(5);
  layout.lips_low_u = 0.5f - beside(33), layout.lips_high_u = 0.5f + beside(33);
  layout.lips_low_v = row_v(-7.3f), layout.lips_high_v = row_v(-4.9f);
  layout.freckles_low_v = row_v(-5), layout.freckles_high_v = row_v(2);
  layout.freckles = seed % 3 == 1 ? 0.7f : 0;  // one in three
  return layout;
}

/// The color of an iris in plain light, from the vertices between its rim and the ring around the pupil.
render::Color iris_color(const SceneMesh& mesh) {
  double sums[3] = {}, count = 0;
  for (uint32_t i = 0; i < mesh.neutral.vertex_count; ++i) {
    const float u = mesh.texture_coordinates[2 * i] - 0.5f;
    const float v = mesh.texture_coordinates[2 * i + 1] - 0.5f;
    const float angle = std::sqrt(u * u + v * v) * (1.25f / 0.45f);
    if (angle < 0.28f || angle > 0.36f || v > 0) continue;
    const uint32_t position = mesh.neutral.vertex_position_indices.data[i];
    for (size_t k = 0; k < 3; ++k) sums[k] += mesh.colors[3 * position + k];
    ++count;
  }
  const auto mean = [&](size_t k) { return uint8_t(std::lround(sums[k] / std::max(count, 1.0))); };
  return {mean(0), mean(1), mean(2)};
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
  const auto write_maps = [&](SurfaceMaterial& material, const auto& made) {
    const std::array<const render::Image*, kTextureKinds> images = {&made.base_color, &made.normal,
                                                                    &made.roughness};
    static constexpr const char* kNames[kTextureKinds] = {"_basecolor.png", "_normal.png",
                                                          "_roughness.png"};
    for (size_t k = 0; k < kTextureKinds; ++k) {
      material.textures[k] = out.file(material.name + kNames[k]);
      outputs.push_back(std::make_unique<Output>(material.textures[k]));
      const bool gray = k == size_t(TextureKind::kRoughness);
      outputs.back()->write(gray ? render::to_gray_png(*images[k], {})
                                 : render::to_png(*images[k]));
    }
  };
  write_maps(skin, maps);
  SurfaceMaterial teeth;
  teeth.name = "teeth";
  write_maps(teeth, render::make_teeth_maps(kTeethWidth, kTeethHeight));
  const render::EyeMaps eyes = render::make_eye_maps(
      iris_color(scene.meshes[mesh_named(scene, "eyeLeft_lod0_mesh")]), kEyeSize);
  SurfaceMaterial eye;
  eye.name = "eyes";
  eye.roughness = 0.12;
  eye.has_roughness = true;
  // The height of a cornea of 11.8 mm above the iris is 2.6 mm (Kwok 1984, "Calculation and application of the anterior
  // surface area of a model human cornea", Journal of Theoretical Biology 108).
  eye.cornea_depth = 0.44, eye.cornea_iris = 0.158;
  eye.textures[size_t(TextureKind::kBaseColor)] = out.file("eyes_basecolor.png");
  eye.textures[size_t(TextureKind::kNormal)] = out.file("eyes_normal.png");
  outputs.push_back(std::make_unique<Output>(eye.texture(TextureKind::kBaseColor)));
  outputs.back()->write(render::to_png(eyes.base_color));
  outputs.push_back(std::make_unique<Output>(eye.texture(TextureKind::kNormal)));
  outputs.back()->write(render::to_png(eyes.normal));
  SurfaceMaterial tongue;
  tongue.name = "tongue";
  tongue.roughness = 0.36;
  tongue.has_roughness = true;
  tongue.textures[size_t(TextureKind::kNormal)] = out.file("tongue_normal.png");
  outputs.push_back(std::make_unique<Output>(tongue.texture(TextureKind::kNormal)));
  outputs.back()->write(render::to_png(render::make_tongue_normals(kTongueWidth, kTongueHeight)));
  Materials materials;
  materials.list = {skin, eye, tongue, teeth};
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
    materials.of_mesh["eyeLeft" + of_lod] = materials.of_mesh["eyeRight" + of_lod] = 1;
    for (size_t m = 2; m < materials.list.size(); ++m) {
      materials.of_mesh[materials.list[m].name + of_lod] = m;
    }
  }
  outputs.push_back(std::make_unique<Output>(materials_path(path)));
  outputs.back()->write(materials_json(materials, fs::path(path).parent_path().string()));
  for (const auto& output : outputs) output->commit();
}

}  // namespace mien::cli
