// SPDX-License-Identifier: MIT
#include "integrations/program/scene/mesh_material.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mien::cli {

using math::Vec3;
using render::Color;

render::Material mesh_material(MeshClass mesh_class) {
  switch (mesh_class) {
    case MeshClass::kEye: return {{232, 228, 222}, 0.45f, 0.12f, 0.040f};
    case MeshClass::kTeeth: return {{228, 219, 200}, 0.30f, 0.22f, 0.040f};
    case MeshClass::kGums:
    case MeshClass::kTongue: return {{172, 92, 88}, 0.40f, 0.30f, 0.035f};
    case MeshClass::kMouth: return {{153, 85, 85}, 0.35f, 0.35f, 0.035f};
    case MeshClass::kBrow:
    case MeshClass::kHair:
    case MeshClass::kLash: return {{62, 46, 38}, 0.05f, 0.55f, 0.030f};
    case MeshClass::kFilm:
    case MeshClass::kCartilage: return {{150, 140, 135}, 0.10f, 0.30f, 0.040f};
    case MeshClass::kSkin: break;
  }
  return {{205, 170, 150}, 0.35f, 0.50f, 0.028f};
}

std::vector<uint8_t> paint_eye(const float* positions, uint32_t position_count, Vec3 front) {
  constexpr Color kWhite = {232, 228, 222}, kIris = {92, 112, 116}, kRim = {40, 50, 54},
                  kPupil = {14, 13, 14};
  math::Box box;
  for (uint32_t i = 0; i < position_count; ++i) box.add(math::load3(positions, i));
  std::vector<uint8_t> colors(size_t{position_count} * 3);
  for (uint32_t i = 0; i < position_count; ++i) {
    const Vec3 from_center = math::load3(positions, i) - box.center();
    const float cosine = dot(normalized(from_center, -front), front);
    // Angles of a human eye: 24 mm across, with an iris of 12 mm and a pupil of 4 mm.
    const float angle = std::acos(std::clamp(cosine, -1.0f, 1.0f)) * 57.29578f;
    Vec3 color = to_linear(kPupil);
    // Soft borders: hard ones would follow the edges of a coarse mesh.
    for (const auto& [border, outside] :
         {std::pair{10.0f, kIris}, std::pair{24.0f, kRim}, std::pair{28.0f, kWhite}}) {
      color = mix(color, to_linear(outside), math::saturate((angle - border) / 3 + 0.5f));
    }
    const Color painted = render::to_srgb(color);
    colors[size_t{i} * 3] = painted.r;
    colors[size_t{i} * 3 + 1] = painted.g;
    colors[size_t{i} * 3 + 2] = painted.b;
  }
  return colors;
}

}  // namespace mien::cli
