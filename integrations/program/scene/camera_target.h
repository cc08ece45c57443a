// SPDX-License-Identifier: MIT
// Parts of a face that a camera can look at, found by the names of meshes and joints.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/scene/posed_scene.h"

namespace mien::cli {

/// Points around the face, the eyes, the mouth, or the meshes or joints that match a pattern, in
/// the neutral pose; around everything if `target` is empty. Fails if nothing is found.
std::vector<math::Vec3> find_target(const PosedScene& scene, const std::string& target);

/// Whether target "face" can be found: there are eyes and a mouth.
bool has_face(const PosedScene& scene);

/// The camera for all images of a scene, whatever its pose.
render::Camera aim_camera(const PosedScene& scene, const std::string& target,
                          const render::View& view, render::Size size);

}  // namespace mien::cli
