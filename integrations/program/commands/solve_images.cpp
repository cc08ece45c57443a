// SPDX-License-Identifier: MIT
// Images of a solve: some frames, each as its target, what was solved, and the distance between them.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "integrations/program/commands/solve_output.h"
#include "integrations/program/render/marks.h"
#include "integrations/program/render/png.h"
#include "integrations/program/render/sheet.h"
#include "integrations/program/scene/camera_target.h"
#include "integrations/program/scene/heat_map.h"

namespace mien::cli {

namespace {

using math::Vec3;
using render::Image;
using Colors = std::vector<std::vector<uint8_t>>;  // of each mesh of the scene

constexpr size_t kMostShownFrames = 6;
constexpr render::Size kSolveTile = {320, 360};
constexpr render::Backdrop kSolveBackdrop = {{228, 230, 232}, {228, 230, 232}};
constexpr render::Color kSolveInk = {40, 42, 46}, kDot = {40, 150, 235};

/// Positions of each mesh of the scene; empty where the target has none.
using Shapes = std::vector<std::vector<float>>;

/// What draws: the scene in the pose that was solved, and the target of the same frame.
struct SolveDrawing {
  const SolvedTake& take;
  const SolveTarget& target;
  const SolvedRig& solved;
  PosedScene& scene;
  render::Camera camera;
  render::RenderOptions options;
  Instance instance;
  DeformerInstance pose;  // of joints that are the target
  std::vector<float> row;

  Image draw(const Shapes& shapes, const Colors& colors) const {
    std::vector<render::Surface> surfaces = scene.surfaces();
    for (size_t m = 0; m < surfaces.size(); ++m) {
      if (!shapes.empty() && !shapes[m].empty()) {
        surfaces[m].positions = shapes[m].data();
        surfaces[m].normals = nullptr;
      }
      if (!colors.empty()) surfaces[m].colors = colors[m].data();
    }
    return render_image(surfaces, camera, options);
  }

  Frame frame_of(size_t f) const {
    Frame frame;
    for (uint32_t c = 0; c < take.controls.size(); ++c) frame.raw.push_back({c, take.row(f)[c]});
    return frame;
  }

  /// A point of the target in the space of the rig.
  Vec3 placed(size_t f, const float* p) const {
    const SolvedFrame& frame = take.frames[f];
    float out[3] = {};
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 3; ++c) {
        out[c] += frame.rotation[3 * r + c] * (p[r] - frame.translation[r]);
      }
    }
    return {out[0], out[1], out[2]};
  }

  Shapes shapes_of_joints(size_t f) {
    const char* what = "cannot draw";
    MienInstance* const at = instance.get();
    check(mien_instance_reset(at), nullptr, what, solved.shown);
    apply_frame(frame_of(f), solved.rig, at);
    check(mien_rig_evaluate(solved.rig, at, 0), nullptr, what, solved.shown);
    MienFloatView channels{};
    check(mien_instance_blend_shapes(at, &channels), nullptr, what, solved.shown);
    check(mien_deformer_instance_update_from_values(pose.get(), row.data(), row.size(),
                                                    channels.data, channels.count),
          nullptr, what, solved.shown);
    Shapes shapes;
    for (const SceneMesh& mesh : scene.meshes) {
      uint32_t number = 0;
      check(mien_rig_find(solved.rig, MIEN_KIND_MESH, mesh.name.c_str(), &number), nullptr, what,
            solved.shown);
      check(mien_deformer_instance_deform(pose.get(), number, MIEN_NORMALS_NONE, nullptr), nullptr,
            what, solved.shown);
      MienFloatView view{};
      check(mien_deformer_instance_positions(pose.get(), number, &view), nullptr, what,
            solved.shown);
      shapes.emplace_back(view.data, view.data + size_t{3} * mesh.neutral.position_count);
    }
    return shapes;
  }

  /// The shapes of the target in frame f; none for landmarks.
  Shapes read_target(size_t f) {
    row.resize(target.width);
    target.read(f, row.data());
    if (target.points.empty()) return shapes_of_joints(f);
    Shapes shapes(scene.meshes.size());
    if (is_landmarks()) return shapes;
    const std::string name = rig_name(solved.rig, MIEN_KIND_MESH, target.points[0].mesh);
    for (size_t m = 0; m < shapes.size(); ++m) {
      if (scene.meshes[m].name != name) continue;
      for (size_t i = 0; i < row.size(); i += 3) {
        const Vec3 p = placed(f, row.data() + i);
        shapes[m].insert(shapes[m].end(), {p.x, p.y, p.z});
      }
    }
    return shapes;
  }

  bool is_landmarks() const {
    return target.kind == TargetKind::kLandmarks3 || target.kind == TargetKind::kLandmarks2;
  }

  /// Of each position, where there is a target.
  std::vector<std::vector<float>> distances(const Shapes& shapes) const {
    std::vector<std::vector<float>> all(scene.meshes.size());
    for (size_t m = 0; m < all.size(); ++m) {
      const float* own = scene.positions(scene.meshes[m]);
      all[m].resize(scene.meshes[m].neutral.position_count);
      for (size_t p = 0; p < all[m].size() && !shapes[m].empty(); ++p) {
        all[m][p] = length(math::load3(own, p) - math::load3(shapes[m].data(), p));
      }
    }
    return all;
  }

  void mark_landmarks(size_t f, Image& image) const {
    if (target.kind != TargetKind::kLandmarks3) return;
    for (size_t i = 0; i < row.size(); i += 3) {
      const Vec3 p = placed(f, row.data() + i);
      if (is_finite(p)) draw_dot(image, find_spot(camera, kSolveTile, p), 2.5f, kDot);
    }
  }
};

float largest(const std::vector<std::vector<float>>& distances) {
  float most = 0;
  for (const std::vector<float>& mesh : distances) {
    for (const float d : mesh) most = std::max(most, d);
  }
  return most;
}

std::string distance_text(float distance, const PosedScene& scene) {
  char text[48];
  std::snprintf(text, sizeof text, "%.2g %s", static_cast<double>(distance), scene.unit().c_str());
  return text;
}

SolveDrawing open_drawing(const SolvedTake& take, const SolveTarget& target,
                          const SolvedRig& solved, PosedScene& scene) {
  SolveDrawing drawing = {take, target, solved, scene, {}, {}, {}, {}, {}};
  drawing.options.width = kSolveTile.width;
  drawing.options.height = kSolveTile.height;
  drawing.options.backdrop = kSolveBackdrop;
  drawing.options.scale = length(scene.neutral_box().size());
  const render::View view = {20, 2, 22, 1};
  drawing.camera = aim_camera(scene, has_face(scene) ? "face" : "", view, kSolveTile);
  if (!target.points.empty()) return drawing;
  auto error = sized<MienError>();
  MienInstance* instance = nullptr;
  check(mien_instance_create(solved.rig, nullptr, &instance, &error), &error, "cannot draw",
        solved.shown);
  drawing.instance.reset(instance);
  MienDeformerInstance* pose = nullptr;
  check(mien_deformer_instance_create(solved.deformer, nullptr, &pose, &error), &error,
        "cannot draw", solved.shown);
  drawing.pose.reset(pose);
  return drawing;
}

}  // namespace

std::string draw_solve(const SolvedTake& take, const SolveTarget& target, const SolvedRig& solved,
                       const std::string& rig, const Session& session) {
  PosedSceneOptions how;
  how.rig = rig;
  if (!target.points.empty()) {
    how.meshes = rig_name(solved.rig, MIEN_KIND_MESH, target.points[0].mesh);
  }
  PosedScene scene = open_scene(how, session);
  SolveDrawing drawing = open_drawing(take, target, solved, scene);
  const size_t count = take.frames.size(), shown = std::min(count, kMostShownFrames);
  std::vector<size_t> frames;
  for (size_t i = 0; i < shown; ++i) {
    frames.push_back(shown == 1 ? 0 : i * (count - 1) / (shown - 1));
  }
  // One scale for all, so that they can be compared, and one that does not exaggerate invisible differences.
  float most = 0.001f * drawing.options.scale;
  for (const size_t f : frames) {
    pose_scene(scene, drawing.frame_of(f));
    most = std::max(most, largest(drawing.distances(drawing.read_target(f))));
  }
  const size_t columns = drawing.is_landmarks() ? 1 : 3;
  render::Sheet sheet(
      {columns * shown, columns == 1 ? std::min(shown, size_t{3}) : columns, kSolveTile, true},
      kSolveBackdrop);
  Progress progress(session, "image", shown);
  for (size_t i = 0; i < shown; ++i) {
    progress.at(i);
    const size_t f = frames[i];
    pose_scene(scene, drawing.frame_of(f));
    const Shapes shapes = drawing.read_target(f);
    const std::string label = "frame " + std::to_string(f);
    Image image = drawing.draw({}, {});
    if (columns == 1) {
      drawing.mark_landmarks(f, image);
      sheet.add(image, label);
      continue;
    }
    sheet.add(drawing.draw(shapes, {}), label + ": target");
    sheet.add(image, "solved");
    const std::vector<std::vector<float>> distances = drawing.distances(shapes);
    Colors colors;
    for (const std::vector<float>& mesh : distances) {
      std::vector<uint8_t>& painted = colors.emplace_back();
      for (const float d : mesh) {
        const render::Color color = heat_color(d * d / (most * most));
        painted.insert(painted.end(), {color.r, color.g, color.b});
      }
    }
    Image heat = drawing.draw({}, colors);
    if (i == 0) {
      std::vector<render::LegendLine> lines;
      for (const float share : {0.0f, 0.25f, 0.5f, 1.0f}) {
        lines.push_back(
            {heat_color(share * share), share > 0 ? distance_text(share * most, scene) : "0"});
      }
      draw_legend(heat, lines, 14, kSolveInk);
    }
    sheet.add(heat, "distance: up to " + distance_text(largest(distances), scene));
  }
  return render::to_png(sheet.image());
}

}  // namespace mien::cli
