// SPDX-License-Identifier: MIT
// Where a picture is taken from.
#pragma once

#include <cstddef>
#include <vector>

#include "integrations/picture/vector.h"

namespace mien::picture {

/// Directions of a subject in its own space; unit vectors at right angles. Left is the subject's.
struct Stand {
  Vec3 left = {1, 0, 0}, up = {0, 1, 0}, front = {0, 0, 1};
};

struct Camera {
  Vec3 right = {1, 0, 0}, up = {0, 1, 0}, back = {0, 0, 1};  // of the viewer, unit length
  Vec3 eye;
  float field_of_view = 22;  // degrees, of the shorter side of the picture
  float distance = 1;        // from the eye to what it looks at

  Vec3 to_view(Vec3 p) const { return turn(p - eye); }
  Vec3 turn(Vec3 d) const { return {dot(d, right), dot(d, up), dot(d, back)}; }
};

/// What a camera looks at.
struct View {
  float yaw = 0;             // degrees; 90 looks at the subject's left side
  float pitch = 0;           // degrees; 90 looks down from above
  float field_of_view = 22;  // degrees; a portrait lens of 85 mm has about that
  float zoom = 1;            // 2 shows everything twice as large
};

/// Looks at `center` from that far away.
Camera look_at(const Stand& stand, const View& view, Vec3 center, float distance);

/// Looks at the points from where they just fit the picture, in its middle, with `margin` of its
/// size left free on each side.
Camera frame_points(const Stand& stand, const View& view, const std::vector<Vec3>& points,
                    int width, int height, float margin = 0.05f);

/// Looks at `center` from where the points fit the picture whatever the yaw: the camera of one
/// picture of a turntable.
Camera frame_turning(const Stand& stand, const View& view, Vec3 center,
                     const std::vector<Vec3>& points, int width, int height, float margin = 0.05f);

}  // namespace mien::picture
