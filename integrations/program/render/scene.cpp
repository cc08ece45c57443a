// SPDX-License-Identifier: MIT
#include "integrations/program/render/scene.h"

namespace mien::render {

using namespace math;

namespace {

constexpr Vec3 kTowardsViewer = {0, 0, 1};

TriangleList list_triangles(const Surface& s, const Vec3* positions, uint32_t first_number) {
  return {positions,      s.position_count, s.vertex_position_indices,
          s.vertex_count, s.triangles,      s.triangle_count,
          first_number};
}

/// Sum of the area vectors around each position.
std::vector<Vec3> make_normals(const Surface& s, const std::vector<Vec3>& positions) {
  std::vector<Vec3> normals(s.position_count);
  const TriangleList list = list_triangles(s, positions.data(), 0);
  Vec3 p[3];
  for (size_t t = 0; t < s.triangle_count; ++t) {
    if (!list.corner_positions(t, p)) continue;
    const Vec3 area = cross(p[1] - p[0], p[2] - p[0]);
    if (!is_finite(area)) continue;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = s.triangles[3 * t + k];
      normals[s.vertex_position_indices ? s.vertex_position_indices[vertex] : vertex] += area;
    }
  }
  for (Vec3& normal : normals) normal = normalized(normal, {});
  return normals;
}

}  // namespace

TriangleList PlacedSurface::triangles() const {
  return list_triangles(surface, places.data(), first_number);
}

Vec3 PlacedSurface::normal(size_t vertex) const {
  if (surface.normals) return load3(surface.normals, vertex);
  return own_normals[surface.vertex_position_indices ? surface.vertex_position_indices[vertex]
                                                     : vertex];
}

Scene::Scene(const std::vector<Surface>& surfaces, const Camera& camera) : camera_(camera) {
  Box box;
  uint32_t number = 1;
  for (const Surface& s : surfaces) {
    PlacedSurface placed{s, {}, {}, {}, to_linear(s.material.color), 1, number};
    number += uint32_t(s.triangle_count);
    placed.places.resize(s.position_count);
    std::vector<Vec3> positions;
    if (!s.normals) positions.resize(s.position_count);
    for (size_t i = 0; i < s.position_count; ++i) {
      const Vec3 p = load3(s.positions, i);
      box.add(p);
      if (!s.normals) positions[i] = p;
      placed.places[i] = camera.to_view(p);
    }
    if (!s.normals) placed.own_normals = make_normals(s, positions);
    if (s.colors) {
      placed.colors.resize(s.position_count);
      for (size_t i = 0; i < s.position_count; ++i) {
        placed.colors[i] = to_linear({s.colors[3 * i], s.colors[3 * i + 1], s.colors[3 * i + 2]});
      }
    }

    // Files do not always wind their faces as they say. Normals know better what is outside.
    const TriangleList list = placed.triangles();
    Vec3 p[3];
    long agreed = 0;
    for (size_t t = 0; t < s.triangle_count; t += 1 + s.triangle_count / 4096) {
      if (!list.corner_positions(t, p)) continue;
      const Vec3 area = cross(p[1] - p[0], p[2] - p[0]);
      agreed += dot(area, camera.turn(placed.normal(s.triangles[3 * t]))) >= 0 ? 1 : -1;
    }
    placed.facing = agreed >= 0 ? 1.0f : -1.0f;
    surfaces_.push_back(std::move(placed));
  }
  if (!box.empty()) scale_ = std::max(length(box.size()), 1e-20f);
}

const PlacedSurface& Scene::surface_of(uint32_t number) const {
  size_t i = surfaces_.size() - 1;
  while (surfaces_[i].first_number > number) --i;
  return surfaces_[i];
}

Fragment Scene::fragment(uint32_t number, Vec3 ray) const {
  const PlacedSurface& on = surface_of(number);
  Fragment f{};
  f.on = &on;
  f.triangle = number - on.first_number;
  Vec3 p[3];
  on.triangles().corner_positions(f.triangle, p);

  // Volumes between the ray and each edge: weights that hold for corners behind the viewer too.
  float w[3] = {dot(ray, cross(p[1], p[2])), dot(ray, cross(p[2], p[0])),
                dot(ray, cross(p[0], p[1]))};
  const float sign = w[0] + w[1] + w[2] < 0 ? -1.0f : 1.0f;
  float sum = 0;
  for (float& weight : w) sum += weight = std::max(weight * sign, 0.0f);
  const bool good = sum > 0 && std::isfinite(sum);
  for (int k = 0; k < 3; ++k) w[k] = good ? w[k] / sum : 1 / 3.0f;

  const Surface& s = on.surface;
  const uint32_t* corners = s.triangles + 3 * size_t{f.triangle};
  Vec3 normal;
  for (int k = 0; k < 3; ++k) {
    f.place += p[k] * w[k];
    normal += on.normal(corners[k]) * w[k];
  }
  f.to_eye = normalized(-f.place, kTowardsViewer);
  const Vec3 flat = normalized(cross(p[1] - p[0], p[2] - p[0]) * on.facing, kTowardsViewer);
  normal = normalized(camera_.turn(normal), flat);
  // Seen from behind, the other side is what takes the light.
  if (dot(flat, f.to_eye) < 0) normal = -normal;
  // A smooth normal may look away where its triangle does not.
  const float away = dot(normal, f.to_eye);
  if (away < 0.02f) normal = normalized(normal + f.to_eye * (0.02f - away), f.to_eye);
  f.normal = normal;

  f.color = on.color;
  if (!on.colors.empty()) {
    f.color = {};
    for (int k = 0; k < 3; ++k) {
      const uint32_t position =
          s.vertex_position_indices ? s.vertex_position_indices[corners[k]] : corners[k];
      f.color += on.colors[position] * w[k];
    }
  }
  return f;
}

}  // namespace mien::render
