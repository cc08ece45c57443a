// SPDX-License-Identifier: MIT
#include "integrations/program/render/cornea.h"

#include <algorithm>
#include <cmath>

namespace mien::render {

using namespace math;

namespace {

// Of the aqueous humor, in Gullstrand's eye. The cornea before it has 1.376, but its two sides are nearly parallel, so
// that it changes the direction behind it hardly at all.
constexpr float kIndex = 1.336f;
// Pictures of irises are taken through a cornea, which shows what lies at that depth larger: by 1 / (1 - depth / radius
// of the cornea * (1 - 1 / index)), with 2.6 and 7.8 mm.
constexpr float kMagnified = 1.09f;
// The lens of the cornea gathers light on the side that is away from the lamp.
constexpr float kGathered = 0.55f;

/// Vector along which a change in one coordinate moves a place on the plane, by itself.
Vec3 dual(Vec3 of, Vec3 other, Vec3 axis) {
  const Vec3 across = cross(other, axis);
  return across * (1 / dot(of, across));
}

}  // namespace

IrisPlane find_iris(const Surface& s, const std::vector<Vec3>& places) {
  if (!(s.cornea.depth > 0) || !s.texture_coordinates || !s.color_texture) return {};
  // The plane that fits the front of the eye best, as far as the iris goes: places by texture coordinates.
  const auto each = [&](auto use) {
    for (size_t i = 0; i < s.vertex_count; ++i) {
      const float u = s.texture_coordinates[2 * i] - 0.5f;
      const float v = s.texture_coordinates[2 * i + 1] - 0.5f;
      const size_t at = s.vertex_position_indices ? s.vertex_position_indices[i] : i;
      if (!(u * u + v * v < 1.1f * s.cornea.iris * s.cornea.iris) || at >= places.size()) continue;
      if (is_finite(places[at])) use(u, v, places[at]);
    }
  };
  float count = 0, u_sum = 0, v_sum = 0;
  Vec3 sum;
  each([&](float u, float v, Vec3 p) { ++count, u_sum += u, v_sum += v, sum += p; });
  if (count < 4) return {};
  const float u_mean = u_sum / count, v_mean = v_sum / count;
  const Vec3 mean = sum * (1 / count);
  float uu = 0, uv = 0, vv = 0;
  Vec3 by_u, by_v;
  each([&](float u, float v, Vec3 p) {
    u -= u_mean, v -= v_mean;
    uu += u * u, uv += u * v, vv += v * v;
    by_u += (p - mean) * u;
    by_v += (p - mean) * v;
  });
  const float d = uu * vv - uv * uv;
  if (!(d > 1e-6f * uu * vv)) return {};
  const Vec3 along_u = (by_u * vv - by_v * uv) * (1 / d);
  const Vec3 along_v = (by_v * uu - by_u * uv) * (1 / d);

  IrisPlane iris;
  iris.axis = normalized(cross(along_u, along_v), {});
  // What is in the middle of the texture stands out.
  const Vec3 front = mean - along_u * u_mean - along_v * v_mean;
  float out = 0, high = -1e30f, low = 1e30f;
  each([&](float u, float v, Vec3 p) {
    const float h = dot(p - front, iris.axis);
    out += h * (u * u + v * v - (uu + vv) / count);
    high = std::max(high, h), low = std::min(low, h);
  });
  if (out > 0) iris.axis = -iris.axis;
  const float apex = out > 0 ? -low : high;
  iris.to_u = dual(along_u, along_v, iris.axis);
  iris.to_v = dual(along_v, along_u, iris.axis);
  iris.middle = front + iris.axis * (apex - s.cornea.depth * s.cornea.iris / length(iris.to_u));
  if (is_finite(iris.middle) && is_finite(iris.to_v)) iris.radius = s.cornea.iris;
  return iris;
}

SeenIris seen_iris(const IrisPlane& iris, Vec3 place, Vec3 normal, Vec3 to_eye, Vec3 light) {
  constexpr float kRatio = 1 / kIndex;
  const float cosine = saturate(dot(normal, to_eye));
  const float inside = std::sqrt(1 - kRatio * kRatio * (1 - cosine * cosine));
  const Vec3 ray = to_eye * -kRatio + normal * (kRatio * cosine - inside);
  const float height = std::max(dot(place - iris.middle, iris.axis), 0.0f);
  const Vec3 hit = place + ray * (height / std::max(-dot(ray, iris.axis), 0.2f)) - iris.middle;
  float u = dot(hit, iris.to_u) * kMagnified, v = dot(hit, iris.to_v) * kMagnified;
  // Beside the iris is its root, as dark as its border.
  const float most = 0.97f * iris.radius, r = std::sqrt(u * u + v * v);
  if (r > most) u *= most / r, v *= most / r;

  const float across_u = dot(light, iris.to_u), across_v = dot(light, iris.to_v);
  const float away = -(u * across_u + v * across_v) / (iris.radius * length(iris.to_u));
  return {0.5f + u, 0.5f + v, 1 + kGathered * away};
}

float clearness(const IrisPlane& iris, float u, float v) {
  const float x = u - 0.5f, y = v - 0.5f;
  const float t = saturate((1.06f - std::sqrt(x * x + y * y) / iris.radius) / 0.14f);
  return t * t * (3 - 2 * t);
}

}  // namespace mien::render
