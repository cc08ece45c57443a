// SPDX-License-Identifier: MIT
#include "integrations/program/render/scene.h"

#include "integrations/program/render/light.h"
#include "integrations/program/render/texture.h"

namespace mien::render {

using namespace math;

namespace {

constexpr Vec3 kTowardsViewer = {0, 0, 1};
constexpr float kTranslucent = 0.1f;  // softness from which on light goes through
constexpr float kBustSize = 600;      // mm: diagonal of the box around a head with a bust

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

/// How much normals turn along the edges around each position. Only skin and flesh need it.
void find_bends(PlacedSurface& placed, float millimeter) {
  const Surface& s = placed.surface;
  const TriangleList list = placed.triangles();
  std::vector<float> turned(s.position_count), lengths(s.position_count);
  size_t at[3];
  for (size_t t = 0; t < s.triangle_count; ++t) {
    if (!list.corner_indices(t, at)) continue;
    for (size_t k = 0; k < 3; ++k) {
      const size_t a = at[k], b = at[(k + 1) % 3];
      const Vec3 turn =
          placed.normal(s.triangles[3 * t + (k + 1) % 3]) - placed.normal(s.triangles[3 * t + k]);
      const Vec3 way = placed.places[b] - placed.places[a];
      const float by = length(turn), along = length(way);
      if (!std::isfinite(by) || !std::isfinite(along)) continue;
      turned[a] += by, turned[b] += by;
      lengths[a] += along, lengths[b] += along;
    }
  }
  placed.bends.resize(s.position_count);
  for (size_t i = 0; i < s.position_count; ++i) {
    if (lengths[i] > 0) placed.bends[i] = std::min(turned[i] / lengths[i] * millimeter, 1.0f);
  }
}

/// A place of a triangle on the image, and how the image lies on the triangle in view space.
struct Painted {
  float u, v;
  Vec3 along_u, along_v;  // directions of growing coordinates, of length 1
  float texels;  // pixels of an image of size 1 x 1 within one of the picture; times its size
};

Painted find_paint(const Surface& s, const uint32_t* corners, const Vec3 (&p)[3],
                   const float (&w)[3], float footprint) {
  float u[3], v[3];
  Painted at{};
  for (size_t k = 0; k < 3; ++k) {
    u[k] = s.texture_coordinates[2 * size_t{corners[k]}];
    v[k] = s.texture_coordinates[2 * size_t{corners[k]} + 1];
    at.u += u[k] * w[k];
    at.v += v[k] * w[k];
  }
  const Vec3 a = p[1] - p[0], b = p[2] - p[0];
  const float du1 = u[1] - u[0], dv1 = v[1] - v[0], du2 = u[2] - u[0], dv2 = v[2] - v[0];
  const float twice = du1 * dv2 - du2 * dv1;
  const float turn = twice < 0 ? -1.0f : 1.0f;
  at.along_u = normalized((a * dv2 - b * dv1) * turn, {});
  at.along_v = normalized((b * du1 - a * du2) * turn, {});
  const float area = length(cross(a, b));
  if (area > 0) at.texels = std::sqrt(std::fabs(twice) / area) * footprint;
  return at;
}

Vec3 linear(Vec3 stored) {
  return to_linear(Color{uint8_t(std::lround(stored.x * 255)), uint8_t(std::lround(stored.y * 255)),
                         uint8_t(std::lround(stored.z * 255))});
}

Vec3 look_up(const Texture& texture, float u, float v, float texels) {
  const float size = std::sqrt(float(texture.width()) * float(texture.height()));
  return texture.at(u, v, texels * size);
}

/// Turns the normal as a texture says there.
void turn_normal(Vec3 stored, const Painted& at, Fragment& f) {
  // Perpendicular to the smooth normal. Without an image on the triangle there is no direction.
  const Vec3 u = normalized(at.along_u - f.normal * dot(at.along_u, f.normal), {});
  const Vec3 v = normalized(at.along_v - f.normal * dot(at.along_v, f.normal), {});
  const Vec3 turned = u * (2 * stored.x - 1) + v * (2 * stored.y - 1) +
                      f.normal * std::max(2 * stored.z - 1, 0.05f);
  f.normal = normalized(turned, f.normal);
}

/// Where the surface is a clear cornea, the iris behind it, which lies in its plane.
void see_through(const PlacedSurface& on, const Painted& at, Fragment& f) {
  const float clear = on.iris.radius > 0 ? clearness(on.iris, at.u, at.v) : 0;
  if (clear == 0) return;
  const Surface& s = on.surface;
  const SeenIris seen = seen_iris(on.iris, f.place, f.normal, f.to_eye, key_direction());
  const Vec3 color = linear(look_up(*s.color_texture, seen.u, seen.v, at.texels)) *
                     to_linear(s.material.color) * seen.light;
  f.color = mix(f.color, color, clear);
  f.smooth = normalized(mix(f.smooth, on.iris.axis, clear), f.smooth);
}

/// Colors, roughness and normal of the textures.
void paint(const PlacedSurface& on, const Painted& at, Fragment& f) {
  const Surface& s = on.surface;
  const auto look_up_here = [&](const Texture& texture) {
    return look_up(texture, at.u, at.v, at.texels);
  };
  if (s.color_texture) {
    f.color = linear(look_up_here(*s.color_texture)) * to_linear(s.material.color);
  }
  if (s.roughness_texture) f.roughness = std::max(look_up_here(*s.roughness_texture).y, 0.05f);
  if (s.normal_texture) turn_normal(look_up_here(*s.normal_texture), at, f);
  see_through(on, at, f);
}

/// Weights of the corners where a ray meets a triangle: volumes between the ray and each edge, which hold for corners
/// behind the viewer too.
void weights_along(Vec3 ray, const Vec3 (&p)[3], float (&w)[3]) {
  w[0] = dot(ray, cross(p[1], p[2]));
  w[1] = dot(ray, cross(p[2], p[0]));
  w[2] = dot(ray, cross(p[0], p[1]));
  const float sign = w[0] + w[1] + w[2] < 0 ? -1.0f : 1.0f;
  float sum = 0;
  for (float& weight : w) sum += weight = std::max(weight * sign, 0.0f);
  const bool good = sum > 0 && std::isfinite(sum);
  for (float& weight : w) weight = good ? weight / sum : 1 / 3.0f;
}

}  // namespace

bool PlacedSurface::hides_all() const {
  const bool painted = surface.texture_coordinates && surface.color_texture;
  return surface.material.alpha >= 1 && !(painted && surface.color_texture->has_alpha());
}

TriangleList PlacedSurface::triangles() const {
  return list_triangles(surface, places.data(), first_number);
}

Vec3 PlacedSurface::normal(size_t vertex) const {
  if (surface.normals) return load3(surface.normals, vertex);
  return own_normals[surface.vertex_position_indices ? surface.vertex_position_indices[vertex]
                                                     : vertex];
}

Scene::Scene(const std::vector<Surface>& surfaces, const Camera& camera, float pixel, float scale)
    : camera_(camera), pixel_(pixel) {
  Box box;
  uint32_t number = 1;
  for (const Surface& s : surfaces) {
    PlacedSurface placed{s, {}, {}, {}, {}, {}, to_linear(s.material.color), 1, number};
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
    placed.iris = find_iris(s, placed.places);
    surfaces_.push_back(std::move(placed));
  }
  if (!box.empty()) scale_ = std::max(length(box.size()), 1e-20f);
  if (scale > 0) scale_ = scale;
  for (PlacedSurface& placed : surfaces_) {
    if (placed.surface.material.softness >= kTranslucent) find_bends(placed, scale_ / kBustSize);
  }
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

  float w[3];
  weights_along(ray, p, w);

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
  // Seen from behind, the other side is what takes the light. Cards of hair are lit as the body that their normals are
  // of, which looks from behind its edge as it does before it.
  const bool card = on.surface.normals && !on.hides_all();
  if (dot(flat, f.to_eye) < 0 && !card) normal = -normal;
  if (card) normal = normal - f.to_eye * (2 * std::min(dot(normal, f.to_eye), 0.0f));
  // A smooth normal may look away where its triangle does not.
  const float away = dot(normal, f.to_eye);
  if (away < 0.02f) normal = normalized(normal + f.to_eye * (0.02f - away), f.to_eye);
  f.normal = f.smooth = normal;

  for (int k = 0; k < 3 && !on.bends.empty(); ++k) {
    f.bend +=
        on.bends[s.vertex_position_indices ? s.vertex_position_indices[corners[k]] : corners[k]] *
        w[k];
  }

  f.color = on.color;
  f.roughness = s.material.roughness;
  if (s.texture_coordinates && (s.color_texture || s.normal_texture || s.roughness_texture)) {
    const float slope = std::max(std::fabs(dot(flat, f.to_eye)), 0.1f);
    paint(on, find_paint(s, corners, p, w, pixel_ * length(f.place) / slope), f);
  }
  if (!on.colors.empty() && !s.color_texture) {
    f.color = {};
    for (int k = 0; k < 3; ++k) {
      const uint32_t position =
          s.vertex_position_indices ? s.vertex_position_indices[corners[k]] : corners[k];
      f.color += on.colors[position] * w[k];
    }
  }
  return f;
}

float Scene::alpha(uint32_t number, Vec3 origin, Vec3 ray) const {
  const PlacedSurface& on = surface_of(number);
  const Surface& s = on.surface;
  if (!s.texture_coordinates || !s.color_texture) return s.material.alpha;
  const size_t triangle = number - on.first_number;
  Vec3 p[3];
  on.triangles().corner_positions(triangle, p);
  const Vec3 from[3] = {p[0] - origin, p[1] - origin, p[2] - origin};
  float w[3];
  weights_along(ray, from, w);
  const Vec3 place = p[0] * w[0] + p[1] * w[1] + p[2] * w[2];
  const Vec3 flat = normalized(cross(p[1] - p[0], p[2] - p[0]), kTowardsViewer);
  const float slope = std::max(std::fabs(dot(flat, normalized(place, kTowardsViewer))), 0.1f);
  const Painted at =
      find_paint(s, s.triangles + 3 * triangle, p, w, pixel_ * length(place) / slope);
  const float size = std::sqrt(float(s.color_texture->width()) * float(s.color_texture->height()));
  return s.material.alpha * s.color_texture->alpha_at(at.u, at.v, at.texels * size);
}

}  // namespace mien::render
