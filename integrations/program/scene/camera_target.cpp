// SPDX-License-Identifier: MIT
#include "integrations/program/scene/camera_target.h"

#include <algorithm>

#include "integrations/program/io/controls.h"

namespace mien::cli {

namespace {

using math::Box;
using math::Vec3;
using render::Axes;

Box box_of_joints(const PosedScene& scene, const std::string& pattern) {
  MienFloatView matrices{};
  check(mien_deformer_bind_matrices(scene.deformer.get(), &matrices), nullptr, "cannot draw",
        scene.shown);
  Box box;
  const uint32_t count = rig_count(scene.rig.get(), MIEN_KIND_JOINT);
  for (uint32_t j = 0; j < count; ++j) {
    if (!matches_pattern(pattern, rig_name(scene.rig.get(), MIEN_KIND_JOINT, j))) continue;
    const float* matrix = matrices.data + size_t{j} * 16;
    box.add({matrix[12], matrix[13], matrix[14]});
  }
  return box;
}

template <class Chosen>
Box box_of_meshes(const PosedScene& scene, Chosen chosen) {
  Box box;
  for (const SceneMesh& mesh : scene.meshes) {
    if (!chosen(mesh)) continue;
    for (uint32_t i = 0; i < mesh.neutral.position_count; ++i) {
      box.add(math::load3(mesh.neutral.positions.data, i));
    }
  }
  return box;
}

Box box_of_eyes(const PosedScene& scene) {
  const Box box =
      box_of_meshes(scene, [](const SceneMesh& m) { return m.mesh_class == MeshClass::kEye; });
  return box.empty() ? box_of_joints(scene, "*eye*") : box;
}

Box box_of_mouth(const PosedScene& scene) {
  const Box box = box_of_joints(scene, "*lip*,*mouth*");
  if (!box.empty()) return box;
  return box_of_meshes(scene, [](const SceneMesh& m) {
    return m.mesh_class == MeshClass::kTeeth || m.mesh_class == MeshClass::kTongue;
  });
}

/// From above the brows to below an open jaw, by the distance of the eyes from the mouth.
Box find_face(const PosedScene& scene) {
  const Box eyes = box_of_eyes(scene), mouth = box_of_mouth(scene);
  if (eyes.empty() || mouth.empty()) return {};
  const Axes& axes = scene.axes;
  const float apart = dot(eyes.center() - mouth.center(), axes.up);
  if (!(apart > 0)) return {};
  const float across = dot(eyes.center(), axes.left), depth = dot(eyes.center(), axes.front);
  const float height = dot(eyes.center() + mouth.center(), axes.up) / 2;
  Box face;
  for (const float side : {-1.45f, 1.45f}) {
    face.add(axes.left * (across + side * apart) + axes.up * (height - 1.55f * apart) +
             axes.front * depth);
    face.add(axes.left * (across + side * apart) + axes.up * (height + 1.35f * apart) +
             axes.front * depth);
  }
  return face;
}

/// Larger on all sides by a share of its longest side.
Box widened(const Box& box, float share) {
  if (box.empty()) return box;
  const Vec3 size = box.size();
  const float by = std::max({size.x, size.y, size.z}) * share;
  Box wide = box;
  wide.add(box.min - Vec3{by, by, by});
  wide.add(box.max + Vec3{by, by, by});
  return wide;
}

}  // namespace

bool has_face(const PosedScene& scene) { return !find_face(scene).empty(); }

std::vector<Vec3> find_target(const PosedScene& scene, const std::string& target) {
  if (target.empty()) return scene.neutral_points();
  Box box;
  if (target == "face") {
    box = find_face(scene);
  } else if (target == "eyes") {
    box = widened(box_of_eyes(scene), 0.18f);
  } else if (target == "mouth") {
    box = widened(box_of_mouth(scene), 0.25f);
  } else {
    box = box_of_meshes(scene, [&](const SceneMesh& m) { return matches_pattern(target, m.name); });
    if (box.empty()) box = widened(box_of_joints(scene, target), 0.25f);
  }
  if (box.empty() || !(length(box.size()) > 0)) {
    const bool part = target == "face" || target == "eyes" || target == "mouth";
    fail(kInvalid, "cannot aim the camera", scene.shown,
         part ? "no mesh or joint is named as " + (target == "face" ? "eyes and a mouth" : target) +
                    " are"
              : "no mesh and no two joints match \"" + target + "\"",
         "give --target a pattern of mesh or joint names; 'mien info RIG --names meshes,joints' "
         "lists them");
  }
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back({i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                       i & 4 ? box.max.z : box.min.z});
  }
  return corners;
}

render::Camera aim_camera(const PosedScene& scene, const std::string& target,
                          const render::View& view, render::Size size) {
  return frame_points(scene.axes, view, find_target(scene, target), size.width, size.height);
}

}  // namespace mien::cli
