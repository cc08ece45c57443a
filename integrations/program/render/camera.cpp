// SPDX-License-Identifier: MIT
#include "integrations/program/render/camera.h"

namespace mien::render {

using namespace math;

namespace {

constexpr float kDegree = 0.017453292519943295f;

/// Half the width and the height of what is seen at distance 1, without the margin.
struct Reach {
  float x, y;
};

Reach reach_of(const View& view, int width, int height, float margin) {
  const float half = std::tan(view.field_of_view * kDegree / 2) * (1 - 2 * margin);
  const float shorter = float(std::min(width, height));
  return {half * float(width) / shorter, half * float(height) / shorter};
}

/// How far in front of `p` (relative to what the camera looks at) the camera has to axes to see
/// it.
float distance_for(Vec3 p, const Reach& reach) {
  return p.z + std::max(std::fabs(p.x) / reach.x, std::fabs(p.y) / reach.y);
}

/// Zooming keeps the place of the camera, as a lens does: perspective stays the same.
Camera zoomed(Camera camera, float zoom) {
  camera.field_of_view =
      2 / kDegree * std::atan(std::tan(camera.field_of_view * kDegree / 2) / zoom);
  return camera;
}

}  // namespace

Camera look_at(const Axes& axes, const View& view, Vec3 center, float distance) {
  const float yaw = view.yaw * kDegree, pitch = view.pitch * kDegree;
  const Vec3 around = axes.front * std::cos(yaw) + axes.left * std::sin(yaw);
  Camera camera;
  camera.right = axes.left * std::cos(yaw) - axes.front * std::sin(yaw);
  camera.back = around * std::cos(pitch) + axes.up * std::sin(pitch);
  camera.up = axes.up * std::cos(pitch) - around * std::sin(pitch);
  camera.eye = center + camera.back * distance;
  camera.field_of_view = view.field_of_view;
  camera.distance = distance;
  return camera;
}

Camera frame_points(const Axes& axes, const View& view, const std::vector<Vec3>& points, int width,
                    int height, float margin) {
  const Reach reach = reach_of(view, width, height, margin);
  Box box;
  for (const Vec3& point : points) box.add(point);
  Vec3 center = box.empty() ? Vec3{} : box.center();

  // What is in the middle changes with the distance, and that with the middle; the lenses are long,
  // so a few rounds settle it.
  float distance = 1;
  for (int round = 0; round < 6; ++round) {
    const Camera camera = look_at(axes, view, center, 0);
    distance = 0;
    for (const Vec3& point : points) {
      const Vec3 p = camera.to_view(point);
      if (is_finite(p)) distance = std::max(distance, distance_for(p, reach));
    }
    if (!(distance > 0)) distance = 1;
    Box seen;
    for (const Vec3& point : points) {
      const Vec3 p = camera.to_view(point);
      const float away = distance - p.z;
      if (away > 0) seen.add({p.x / away, p.y / away, 0});
    }
    if (seen.empty()) break;
    const Vec3 middle = seen.center();
    center += (camera.right * middle.x + camera.up * middle.y) * distance;
  }
  return zoomed(look_at(axes, view, center, distance), view.zoom);
}

Camera frame_turning(const Axes& axes, const View& view, Vec3 center,
                     const std::vector<Vec3>& points, int width, int height, float margin) {
  const Reach reach = reach_of(view, width, height, margin);
  float distance = 0;
  for (float yaw = 0; yaw < 360; yaw += 15) {
    View turned = view;
    turned.yaw = yaw;
    const Camera camera = look_at(axes, turned, center, 0);
    for (const Vec3& point : points) {
      const Vec3 p = camera.to_view(point);
      if (is_finite(p)) distance = std::max(distance, distance_for(p, reach));
    }
  }
  return zoomed(look_at(axes, view, center, distance > 0 ? distance : 1), view.zoom);
}

}  // namespace mien::render
