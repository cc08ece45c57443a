// SPDX-License-Identifier: MIT
// Images of how a rig was made: groups in depth, face mask, bones, weights, LODs, input shapes beside those
// of the rig.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "integrations/program/mesh/mesh_file.h"
#include "integrations/program/render/image.h"
#include "integrations/program/scene/posed_scene.h"

namespace mien::cli {

struct AuthorImage {
  std::string name;  // of the file
  render::Image image;
};

/// The input of a rig, and the result.
struct MadeRig {
  const MeshFile& mesh;
  double unit;  // centimeters of one unit of the mesh
  const nlohmann::ordered_json& report;
  PosedScene& scene;  // of the rig; is posed
};

/// Images that have something to show: no shapes.png without shapes, no groups.png where there are none.
std::vector<AuthorImage> draw_author_images(const MadeRig& made, const Session& session);

}  // namespace mien::cli
