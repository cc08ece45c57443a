// SPDX-License-Identifier: MIT
// Materials and colors of glTF for the meshes of a rig.
#pragma once

#include "integrations/program/gltf/scene.h"
#include "integrations/program/io/mesh_appearance.h"

namespace mien::gltf {

/// With vertex colors, the base color of the material is white.
Material material_for(cli::MeshClass mesh_class, bool has_vertex_colors);

/// sRGB to linear, 16 bits: 8 would be too few for dark colors. `rgb` are three bytes.
std::array<uint16_t, 4> linear_color(const uint8_t* rgb);

}  // namespace mien::gltf
