// SPDX-License-Identifier: MIT
// The iris as it is seen through the cornea: the line of sight is refracted where it enters the eye and goes on to the
// plane of the iris, whose place in the color texture it finds (Jimenez 2013, "Next-generation character rendering",
// GDC, on eyes).
#pragma once

#include <vector>

#include "integrations/program/math/vector.h"
#include "integrations/program/render/render.h"

namespace mien::render {

/// Where the iris of a placed surface is, in view space.
struct IrisPlane {
  float radius = 0;   // in the texture; 0: there is none
  math::Vec3 middle;  // of the pupil
  math::Vec3 axis;    // towards the apex of the cornea, of length 1
  math::Vec3 to_u,
      to_v;  // (place - middle) times these is how far it is from the middle of the texture
};

/// `places` are the positions of the surface in view space. None if the surface has no cornea, or if its texture
/// coordinates do not say where the iris is.
IrisPlane find_iris(const Surface& surface, const std::vector<math::Vec3>& places);

/// What shows at a place of the cornea.
struct SeenIris {
  float u, v;   // of the color texture
  float light;  // how much more light than elsewhere the cornea sends there
};

/// `towards_light` is in view space; all directions have length 1.
SeenIris seen_iris(const IrisPlane& iris, math::Vec3 place, math::Vec3 normal, math::Vec3 to_eye,
                   math::Vec3 towards_light);

/// How clear the surface is, 0 to 1, at a place of the texture: the limbus is not a sharp border.
float clearness(const IrisPlane& iris, float u, float v);

}  // namespace mien::render
