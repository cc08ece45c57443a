// SPDX-License-Identifier: MIT
// Materials of the renderer for the meshes of a rig.
#pragma once

#include <cstdint>
#include <vector>

#include "integrations/program/io/mesh_appearance.h"
#include "integrations/program/math/vector.h"
#include "integrations/program/render/render.h"

namespace mien::cli {

render::Material mesh_material(MeshClass mesh_class);

/// Colors of an eyeball without any: pupil and iris towards `front`. r g b for each position.
std::vector<uint8_t> paint_eye(const float* positions, uint32_t position_count, math::Vec3 front);

}  // namespace mien::cli
