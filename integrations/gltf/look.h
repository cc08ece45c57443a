// SPDX-License-Identifier: MIT
// How a mesh looks: a material by its name, and colors of its vertices, where the file has some.
#pragma once

#include "integrations/gltf/rig_source.h"

namespace mien::gltf {

/// By what is in the name: teeth, tongue, lashes, brows, eyes, ... ; skin otherwise. Where vertices
/// have colors, the material is white and keeps its finish.
Material material_for(const std::string& mesh_name, bool has_vertex_colors);

using Color = std::array<uint8_t, 3>;

/// One sRGB color per position from the descriptor's metadata: the pair of key
/// "mien.colors.<mesh name>" and red, green, blue bytes in base64. Empty without such a pair.
std::vector<Color> position_colors(const RigSource& source, const std::string& mesh_name,
                                   size_t position_count);

/// Color on a linear scale, of 16 bits: 8 would not do for dark tones.
std::array<uint16_t, 4> linear_color(const Color& color);

}  // namespace mien::gltf
