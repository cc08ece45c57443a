// SPDX-License-Identifier: MIT
#include "integrations/program/commands/bake_images.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "integrations/program/render/marks.h"
#include "integrations/program/render/png.h"
#include "integrations/program/render/sheet.h"
#include "integrations/program/scene/camera_target.h"
#include "integrations/program/scene/heat_map.h"

namespace mien::cli {

namespace {

constexpr render::Size kBakeTile = {480, 540};
constexpr render::Backdrop kBakeBackdrop = {{228, 230, 232}, {228, 230, 232}};
constexpr render::Color kBakeInk = {40, 42, 46};

/// Distances by mesh of the rig, as colors by mesh of the scene: both have the same names.
std::vector<std::vector<uint8_t>> paint_distances(const PosedScene& scene, const MienRig* rig,
                                                  const std::vector<std::vector<float>>& distances,
                                                  double tolerance) {
  std::vector<std::vector<uint8_t>> colors;
  for (const SceneMesh& mesh : scene.meshes) {
    std::vector<uint8_t>& painted = colors.emplace_back();
    std::vector<float> of_mesh(mesh.neutral.position_count);
    for (uint32_t m = 0; m < distances.size(); ++m) {
      if (rig_name(rig, MIEN_KIND_MESH, m) != mesh.name) continue;
      if (distances[m].size() == of_mesh.size()) of_mesh = distances[m];
    }
    for (const float distance : of_mesh) {
      const double share = std::min(static_cast<double>(distance) / tolerance, 1.0);
      const render::Color color = heat_color(static_cast<float>(share * share));
      painted.insert(painted.end(), {color.r, color.g, color.b});
    }
  }
  return colors;
}

}  // namespace

std::string draw_reduction(const Reduced& reduced, const std::string& path,
                           const Session& session) {
  PosedSceneOptions how;
  how.rig = path;
  PosedScene scene = open_scene(how, session);
  const ProofMap& map = reduced.proof.map;
  const double tolerance = reduced.tolerances.at(0, 0);
  Frame worst;
  for (uint32_t c = 0; c < map.raw.size(); ++c) worst.raw.push_back({c, map.raw[c]});
  render::RenderOptions options;
  options.width = kBakeTile.width;
  options.height = kBakeTile.height;
  options.backdrop = kBakeBackdrop;
  options.scale = length(scene.neutral_box().size());
  const render::Camera camera =
      aim_camera(scene, has_face(scene) ? "face" : "", {20, 2, 22, 1}, kBakeTile);
  const auto text = [&](double distance) {
    char number[32];
    std::snprintf(number, sizeof number, "%.2g ", distance);
    return number + scene.unit();
  };
  const auto draw = [&](const std::vector<std::vector<float>>& distances) {
    const auto colors = paint_distances(scene, reduced.rig.get(), distances, tolerance);
    std::vector<render::Surface> surfaces = scene.surfaces();
    for (size_t m = 0; m < surfaces.size(); ++m) surfaces[m].colors = colors[m].data();
    return render_image(surfaces, camera, options);
  };
  const Progress progress(session, "image");
  render::Sheet sheet({3, 3, kBakeTile, true}, kBakeBackdrop);
  pose_scene(scene, worst);
  sheet.add(render_image(scene.surfaces(), camera, options), "worst pose");
  render::Image heat = draw(map.in_worst_pose);
  std::vector<render::LegendLine> lines;
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    lines.push_back(
        {heat_color(static_cast<float>(share * share)), share > 0 ? text(share * tolerance) : "0"});
  }
  draw_legend(heat, lines, 14, kBakeInk);
  sheet.add(heat, "distance there: up to " + text(reduced.proof.lods[0].worst));
  pose_scene(scene, {});
  sheet.add(draw(map.largest),
            "largest distance in " + std::to_string(reduced.proof.pose_count) + " poses");
  return render::to_png(sheet.image());
}

}  // namespace mien::cli
