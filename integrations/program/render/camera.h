// SPDX-License-Identifier: MIT
// Where a picture is taken from.
#pragma once

#include <cstddef>
#include <vector>

#include "integrations/program/math/vector.h"

namespace mien::render {

/// Directions of a subject in its own space; unit vectors at right angles. Left is the subject's.
struct Axes {
  math::Vec3 left = {1, 0, 0}, up = {0, 1, 0}, front = {0, 0, 1};
};

struct Camera {
  math::Vec3 right = {1, 0, 0}, up = {0, 1, 0}, back = {0, 0, 1};  // of the viewer, unit length
  math::Vec3 eye;
  float field_of_view = 22;  // degrees, of the shorter side of the picture
  float distance = 1;        // from the eye to what it looks at

  math::Vec3 to_view(math::Vec3 p) const { return turn(p - eye); }
  math::Vec3 turn(math::Vec3 d) const { return {dot(d, right), dot(d, up), dot(d, back)}; }
};

/// Of an image, in pixels.
struct Size {
  int width = 0, height = 0;
};

/// From where a camera looks.
struct View {
  float yaw = 0;             // degrees; 90 looks at the subject's left side
  float pitch = 0;           // degrees; 90 looks down from above
  float field_of_view = 22;  // degrees; a portrait lens of 85 mm has about that
  float zoom = 1;            // 2 shows everything twice as large
};

/// Looks at `center` from that far away.
Camera look_at(const Axes& axes, const View& view, math::Vec3 center, float distance);

/// Looks at the points from where they just fit the picture, in its middle, with `margin` of its
/// size left free on each side.
Camera frame_points(const Axes& axes, const View& view, const std::vector<math::Vec3>& points,
                    int width, int height, float margin = 0.05f);

/// Looks at `center` from where the points fit the picture whatever the yaw: the camera of one
/// picture of a turntable.
Camera frame_turning(const Axes& axes, const View& view, math::Vec3 center,
                     const std::vector<math::Vec3>& points, int width, int height,
                     float margin = 0.05f);

}  // namespace mien::render
