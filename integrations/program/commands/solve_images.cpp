// SPDX-License-Identifier: MIT
// Images of a solve: some frames, each as its target, what was solved, and the distance between them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "integrations/program/commands/moving_mesh.h"
#include "integrations/program/commands/solve_compare.h"
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
constexpr render::Color kNoTarget = {96, 104, 122};
/// Positions of each mesh of the scene; empty where the target has none.
using Shapes = std::vector<std::vector<float>>;

/// The target of a frame, and the distances to it.
struct Comparison {
  Shapes shapes;                              // of each mesh of the scene; empty: it has none
  SurfaceMesh surface;                        // of kSurface
  std::vector<SolvedMark> marks;              // of landmarks
  std::vector<std::vector<float>> distances;  // of each position of each mesh; NaN: no target

  float largest() const {
    float most = 0;
    for (const std::vector<float>& mesh : distances) {
      for (const float d : mesh) most = std::max(most, std::isfinite(d) ? d : 0.0f);
    }
    for (const SolvedMark& mark : marks) most = std::max(most, mark.distance);
    return most;
  }
};

render::Color heat_of(float distance, float most) {
  if (!std::isfinite(distance)) return kNoTarget;
  const float share = std::min(distance / most, 1.0f);
  return heat_color(share * share);
}

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
  size_t target_mesh = SIZE_MAX;  // of the scene; none: joints

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

  /// A surface of another topology in place of the mesh that was drawn to it.
  Image draw_surface(const SurfaceMesh& surface) const {
    std::vector<render::Surface> surfaces = scene.surfaces();
    for (size_t m = 0; m < surfaces.size(); ++m) {
      if (m != target_mesh) continue;
      render::Surface drawn;
      drawn.positions = surface.positions.data();
      drawn.position_count = drawn.vertex_count = surface.positions.size() / 3;
      drawn.triangles = surface.triangles.data();
      drawn.triangle_count = surface.triangles.size() / 3;
      drawn.material = surfaces[m].material;
      surfaces[m] = drawn;
    }
    return render_image(surfaces, camera, options);
  }

  Shapes shapes_of_joints(size_t f) {
    const char* what = "cannot draw";
    MienInstance* const at = instance.get();
    check(mien_instance_reset(at), nullptr, what, solved.shown);
    apply_frame(take.pose(f), solved.rig, at);
    check(mien_rig_evaluate(solved.rig, at, 0), nullptr, what, solved.shown);
    MienFloatView channels{}, joints{};
    check(mien_instance_blend_shapes(at, &channels), nullptr, what, solved.shown);
    check(mien_instance_joints(at, &joints), nullptr, what, solved.shown);
    for (size_t i = 0; i < row.size(); ++i) {
      if (!std::isfinite(row[i])) row[i] = joints.data[i];
    }
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

  bool is_landmarks() const {
    return target.kind == TargetKind::kLandmarks3 || target.kind == TargetKind::kLandmarks2;
  }

  SurfaceMesh solved_mesh() const {
    const SceneMesh& mesh = scene.meshes[target_mesh];
    const float* const positions = scene.positions(mesh);
    SurfaceMesh out;
    out.positions.assign(positions, positions + size_t{3} * mesh.neutral.position_count);
    for (const uint32_t vertex : mesh.triangles) {
      out.triangles.push_back(mesh.neutral.vertex_position_indices.data[vertex]);
    }
    return out;
  }

  /// The target of frame f, and how far the scene, which is in its pose, is from it.
  Comparison compare(size_t f) {
    Comparison out;
    out.shapes.resize(scene.meshes.size());
    out.distances.resize(scene.meshes.size());
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
      out.distances[m].resize(scene.meshes[m].neutral.position_count, NAN);
    }
    if (target.kind == TargetKind::kSurface) {
      out.surface = target.read_surface(f);
      for (size_t i = 0; i < out.surface.positions.size(); i += 3) {
        const Vec3 p =
            place_target(take.frames[f], math::load3(out.surface.positions.data(), i / 3));
        for (int k = 0; k < 3; ++k) out.surface.positions[i + static_cast<size_t>(k)] = p[k];
      }
      const float reach = kFarShare * options.scale;
      out.distances[target_mesh] = find_surface_distances(
          solved_mesh(), out.surface, take.reach > 0 ? std::min(take.reach, reach) : reach);
      return out;
    }
    row.resize(target.width);
    target.read(f, row.data());
    if (is_landmarks()) {
      const SurfaceMesh mesh = solved_mesh();
      const uint32_t skin = main_mesh(target);
      MovingMesh posed(solved, skin);
      static_cast<void>(posed.positions(take.pose(f)));
      out.marks = compare_landmarks(take, target, f, row.data(),
                                    [&](uint32_t other) { return posed.positions_of(other); });
      hide_marks(mesh, out.marks);
      // Of the skin, by the landmarks on it.
      std::vector<SolvedMark> own = out.marks;
      own.erase(std::remove_if(
                    own.begin(), own.end(),
                    [&](const SolvedMark& mark) { return target.points[mark.point].mesh != skin; }),
                own.end());
      out.distances[target_mesh] =
          spread_distances(own, mesh.positions.data(), mesh.positions.size() / 3);
      return out;
    }
    if (target.points.empty()) {
      out.shapes = shapes_of_joints(f);
    } else {
      // Vertices without a target are drawn where they were solved.
      const float* const own = scene.positions(scene.meshes[target_mesh]);
      out.shapes[target_mesh].assign(own, own + row.size());
      for (const SolvedMark& mark :
           compare_landmarks(take, target, f, row.data(), [&](uint32_t) { return own; })) {
        const Vec3 p = mark.target;
        std::copy_n(&p.x, 3, out.shapes[target_mesh].data() + size_t{3} * mark.point);
        out.distances[target_mesh][mark.point] = mark.distance;
      }
      return out;
    }
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
      const float* const own = scene.positions(scene.meshes[m]);
      for (size_t p = 0; p < out.shapes[m].size() / 3; ++p) {
        out.distances[m][p] = length(math::load3(own, p) - math::load3(out.shapes[m].data(), p));
      }
    }
    return out;
  }

  /// Those on skin that faces away.
  void hide_marks(const SurfaceMesh& mesh, std::vector<SolvedMark>& marks) const {
    const std::vector<Vec3> normals = outward_normals(mesh);
    for (SolvedMark& mark : marks) {
      size_t nearest = 0;
      float least = INFINITY;
      for (size_t p = 0; p < normals.size(); ++p) {
        const float d = length(math::load3(mesh.positions.data(), p) - mark.solved);
        if (d < least) nearest = p;
        least = std::min(least, d);
      }
      mark.hidden = dot(normals[nearest], camera.eye - mark.solved) < 0;
    }
  }

  void draw_marks(const std::vector<SolvedMark>& marks, float most, Image& image) const {
    for (const SolvedMark& mark : marks) {
      if (mark.hidden) continue;
      draw_dot(image, find_spot(camera, kSolveTile, mark.target), marks.size() > 150 ? 1.5f : 2.5f,
               most > 0 ? heat_of(mark.distance, most) : kDot);
    }
  }

  Colors colors_of(const Comparison& compared, float most) const {
    Colors colors;
    for (const std::vector<float>& mesh : compared.distances) {
      std::vector<uint8_t>& painted = colors.emplace_back();
      for (const float d : mesh) {
        const render::Color color = heat_of(d, most);
        painted.insert(painted.end(), {color.r, color.g, color.b});
      }
    }
    return colors;
  }

  /// How a distance is written.
  std::string text(float distance) const {
    char number[32];
    std::snprintf(number, sizeof number, "%.2g ", static_cast<double>(distance));
    return number + (target.kind == TargetKind::kLandmarks2 ? "px" : scene.unit());
  }
};

SolveDrawing open_drawing(const SolvedTake& take, const SolveTarget& target,
                          const SolvedRig& solved, PosedScene& scene) {
  SolveDrawing drawing = {take, target, solved, scene, {}, {}, {}, {}, {}, SIZE_MAX};
  drawing.options.width = kSolveTile.width;
  drawing.options.height = kSolveTile.height;
  drawing.options.backdrop = kSolveBackdrop;
  drawing.options.scale = length(scene.neutral_box().size());
  const render::View view = {20, 2, 22, 1};
  drawing.camera = aim_camera(scene, has_face(scene) ? "face" : "", view, kSolveTile);
  if (!target.points.empty()) {
    drawing.target_mesh = 0;  // the scene has no other
    return drawing;
  }
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
    how.meshes = rig_name(solved.rig, MIEN_KIND_MESH, main_mesh(target));
  }
  PosedScene scene = open_scene(how, session);
  SolveDrawing drawing = open_drawing(take, target, solved, scene);
  const size_t count = take.frames.size(), shown = std::min(count, kMostShownFrames);
  std::vector<size_t> frames;
  for (size_t i = 0; i < shown; ++i) {
    frames.push_back(shown == 1 ? 0 : i * (count - 1) / (shown - 1));
  }
  // One scale for all, so that they can be compared, and one that does not exaggerate invisible differences.
  const bool pixels = target.kind == TargetKind::kLandmarks2;
  float most = pixels ? 0.5f : 0.001f * drawing.options.scale;
  for (const size_t f : frames) {
    pose_scene(scene, take.pose(f));
    most = std::max(most, drawing.compare(f).largest());
  }
  render::Sheet sheet({3 * shown, 3, kSolveTile, true}, kSolveBackdrop);
  Progress progress(session, "image", shown);
  for (size_t i = 0; i < shown; ++i) {
    progress.at(i);
    const size_t f = frames[i];
    pose_scene(scene, take.pose(f));
    const Comparison compared = drawing.compare(f);
    const bool surfaces = target.kind == TargetKind::kSurface;
    Image wanted =
        surfaces ? drawing.draw_surface(compared.surface) : drawing.draw(compared.shapes, {});
    drawing.draw_marks(compared.marks, 0, wanted);
    sheet.add(wanted, "frame " + std::to_string(f) + ": target");
    sheet.add(drawing.draw({}, {}), "solved");
    Image heat = drawing.draw({}, drawing.colors_of(compared, most));
    drawing.draw_marks(compared.marks, most, heat);
    if (i == 0) {
      std::vector<render::LegendLine> lines;
      for (const float share : {0.0f, 0.25f, 0.5f, 1.0f}) {
        lines.push_back({heat_of(share, 1), share > 0 ? drawing.text(share * most) : "0"});
      }
      if (surfaces || !compared.marks.empty()) lines.push_back({kNoTarget, "no target"});
      draw_legend(heat, lines, 14, kSolveInk);
    }
    sheet.add(heat, "distance: up to " + drawing.text(compared.largest()));
  }
  return render::to_png(sheet.image());
}

}  // namespace mien::cli
