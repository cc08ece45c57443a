// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/material.h"

#include <cmath>

#include "integrations/program/math/srgb.h"

namespace mien::gltf {

namespace {

Material base_material(cli::MeshClass mesh_class) {
  using cli::MeshClass;
  switch (mesh_class) {
    case MeshClass::kEye: return {"eyes", {0.85, 0.84, 0.82, 1}, 0.08, false};
    case MeshClass::kTeeth: return {"teeth", {0.80, 0.74, 0.62, 1}, 0.30, false};
    case MeshClass::kGums: return {"gums", {0.55, 0.20, 0.19, 1}, 0.35, false};
    case MeshClass::kTongue: return {"tongue", {0.55, 0.18, 0.18, 1}, 0.40, false};
    case MeshClass::kMouth: return {"mouth", {0.32, 0.09, 0.09, 1}, 0.50, true};
    case MeshClass::kBrow: return {"brows", {0.06, 0.035, 0.02, 1}, 0.80, true};
    case MeshClass::kHair: return {"hair", {0.06, 0.035, 0.02, 1}, 0.60, true};
    case MeshClass::kLash: return {"lashes", {0.02, 0.015, 0.01, 1}, 0.70, true};
    case MeshClass::kFilm: return {"film", {1, 1, 1, 0.1}, 0.05, false};
    case MeshClass::kCartilage: return {"cartilage", {0.62, 0.28, 0.24, 1}, 0.40, true};
    case MeshClass::kSkin: break;
  }
  return {"skin", {0.74, 0.49, 0.39, 1}, 0.55, false};
}

}  // namespace

Material material_for(cli::MeshClass mesh_class, bool has_vertex_colors) {
  Material material = base_material(mesh_class);
  if (has_vertex_colors) {
    material.name += " (vertex colors)";
    material.color = {1, 1, 1, material.color[3]};
  }
  return material;
}

std::array<uint16_t, 4> linear_color(const uint8_t* rgb) {
  std::array<uint16_t, 4> result{0, 0, 0, 65535};
  for (size_t i = 0; i < 3; ++i) {
    const double linear = math::srgb_to_linear(rgb[i] / 255.0);
    result[i] = static_cast<uint16_t>(std::lround(linear * 65535));
  }
  return result;
}

}  // namespace mien::gltf
