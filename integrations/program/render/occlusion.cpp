// SPDX-License-Identifier: MIT
#include "integrations/program/render/occlusion.h"

namespace mien::render {

using namespace math;

namespace {

constexpr int kProbes = 12;
constexpr int kTile = 4;  // pixels of a tile probe in different directions; a blur evens them out

struct Probes {
  float x[kTile * kTile][kProbes], y[kTile * kTile][kProbes];

  Probes() {
    constexpr float kGoldenAngle = 2.399963f;
    for (int turn = 0; turn < kTile * kTile; ++turn) {
      // Neighbors in a tile are far from each other in turn.
      const float start = float(turn * 7 % 16) / 16 * 6.2831853f;
      for (int i = 0; i < kProbes; ++i) {
        const float share = (float(i) + 0.5f) / kProbes;
        const float reach = share * share;  // denser near the pixel
        const float angle = start + kGoldenAngle * float(i);
        x[turn][i] = reach * std::cos(angle);
        y[turn][i] = reach * std::sin(angle);
      }
    }
  }
};

float probe_pixel(const PixelLayer& layer, const Lens& lens, float radius, int x, int y,
                  const float* dx, const float* dy) {
  const float per_pixel = 1 / lens.focal;
  const auto place = [&](int px, int py, float distance) {
    return Vec3{(float(px) + 0.5f - lens.center_x) * per_pixel * distance,
                (lens.center_y - float(py) - 0.5f) * per_pixel * distance, -distance};
  };
  const size_t at = layer.index(x, y);
  const float distance = layer.distance[at];
  const Vec3 here = place(x, y, distance), normal = layer.normal[at];
  const float reach = std::min(radius * lens.focal / distance, float(layer.width));
  const float start_x = float(x) + 0.5f, start_y = float(y) + 0.5f;
  float blocked = 0;
  for (int i = 0; i < kProbes; ++i) {
    const int px = int(start_x + dx[i] * reach), py = int(start_y + dy[i] * reach);
    if (px < 0 || py < 0 || px >= layer.width || py >= layer.height) continue;
    const float there = layer.distance[layer.index(px, py)];
    if (there == 0) continue;
    const Vec3 step = place(px, py, there) - here;
    const float squared = dot(step, step);
    const float fade = 1 - squared / (radius * radius);
    if (fade <= 0 || squared == 0) continue;
    const float rise = dot(step, normal) / std::sqrt(squared);
    blocked += std::max(rise - 0.08f, 0.0f) * fade;
  }
  return std::max(1 - 2.4f * blocked / kProbes, 0.0f);
}

/// Means of as many pixels as a tile is wide, along rows or columns; those apart in depth are left
/// out.
void blur(const PixelLayer& layer, const std::vector<float>& from, std::vector<float>& to,
          float depth, bool along_rows) {
  const size_t step = along_rows ? 1 : size_t(layer.width);
  const int count = along_rows ? layer.width : layer.height;
  size_t at = 0;
  for (int y = 0; y < layer.height; ++y) {
    for (int x = 0; x < layer.width; ++x, ++at) {
      const float distance = layer.distance[at];
      to[at] = 1;
      if (distance == 0) continue;
      const int place = along_rows ? x : y;
      const int first = std::max(place - kTile / 2, 0), end = std::min(place + kTile / 2, count);
      size_t near = at - size_t(place - first) * step;
      float sum = 0, weight = 0;
      for (int i = first; i < end; ++i, near += step) {
        const float w = std::fabs(layer.distance[near] - distance) < depth ? 1.0f : 0.0f;
        sum += w * from[near];
        weight += w;
      }
      to[at] = sum / weight;
    }
  }
}

}  // namespace

std::vector<float> find_openness(const PixelLayer& layer, const Lens& lens, float radius) {
  static const Probes probes;
  std::vector<float> openness(layer.distance.size(), 1.0f);
  for (int y = 0; y < layer.height; ++y) {
    for (int x = 0; x < layer.width; ++x) {
      const size_t at = layer.index(x, y);
      if (layer.distance[at] == 0) continue;
      const int turn = turn_of(x, y);
      openness[at] = probe_pixel(layer, lens, radius, x, y, probes.x[turn], probes.y[turn]);
    }
  }
  even_out(layer, openness, radius * 0.2f);
  return openness;
}

void even_out(const PixelLayer& layer, std::vector<float>& values, float depth) {
  // Any window of the size of a tile holds each direction once.
  std::vector<float> row_wise(values.size());
  blur(layer, values, row_wise, depth, true);
  blur(layer, row_wise, values, depth, false);
}

namespace {

constexpr int kTaps = 16;

/// Places in a disk of radius 1, spread evenly (Vogel 1979), for each turn of a tile.
struct Disk {
  float x[kTile * kTile][kTaps], y[kTile * kTile][kTaps];

  Disk() {
    constexpr float kGoldenAngle = 2.399963f;
    for (int turn = 0; turn < kTile * kTile; ++turn) {
      const float start = float(turn * 7 % 16) / 16 * kGoldenAngle;
      for (int i = 0; i < kTaps; ++i) {
        const float reach = std::sqrt((float(i) + float(turn * 5 % 16) / 16) / kTaps);
        x[turn][i] = reach * std::cos(start + kGoldenAngle * float(i));
        y[turn][i] = reach * std::sin(start + kGoldenAngle * float(i));
      }
    }
  }
};

}  // namespace

ShadowMap::ShadowMap(const Scene& scene, Vec3 to_light, int size, float softness)
    : softness_(softness), size_(size) {
  back_ = to_light;
  right_ = normalized(cross({0, 1, 0}, back_), {1, 0, 0});
  up_ = cross(back_, right_);
  Box box;
  std::vector<std::vector<Vec3>> turned;
  for (const PlacedSurface& surface : scene.surfaces()) {
    std::vector<Vec3> places(surface.places.size());
    for (size_t i = 0; i < places.size(); ++i) {
      const Vec3 p = surface.places[i];
      places[i] = {dot(p, right_), dot(p, up_), dot(p, back_)};
      box.add(places[i]);
    }
    turned.push_back(std::move(places));
  }
  if (box.empty()) return;

  // A border of some texels stays empty, so that places outside are in the light.
  constexpr float kBorder = 8;
  const float extent = std::max({box.size().x, box.size().y, 1e-20f});
  texel_ = extent / (float(size) - 2 * kBorder);
  search_ = 0.03f * float(size);
  lens_.perspective = false;
  lens_.focal = 1 / texel_;
  lens_.center_x = float(size) / 2 - box.center().x / texel_;
  lens_.center_y = float(size) / 2 + box.center().y / texel_;
  depth_zero_ = box.min.z - std::max(box.size().z, extent);
  const Coverage coverage = [&](uint32_t number, float x, float y) {
    const Vec3 origin =
        right_ * ((x - lens_.center_x) * texel_) + up_ * ((lens_.center_y - y) * texel_);
    return scene.alpha(number, origin, -back_);
  };
  Visibility map;
  map.reset(size, size, 1);
  for (size_t s = 0; s < turned.size(); ++s) {
    for (Vec3& p : turned[s]) p.z -= depth_zero_;
    TriangleList list = scene.surfaces()[s].triangles();
    list.positions = turned[s].data();
    draw(list, lens_, map, scene.surfaces()[s].hides_all() ? Coverage() : coverage);
  }
  depths_.reserve(map.seen.size());
  for (const Seen& seen : map.seen) depths_.push_back(seen.depth);
}

float ShadowMap::depth_at(float x, float y) const {
  const int last = size_ - 1;
  const int column = std::min(std::max(int(x), 0), last), row = std::min(std::max(int(y), 0), last);
  return depths_[size_t(row) * size_t(size_) + size_t(column)];
}

float ShadowMap::light_at(Vec3 place, Vec3 normal, int turn) const {
  static const Disk disk;
  if (texel_ == 0) return 1;
  const Vec3 p = place + normal * (texel_ * (4 - 2 * saturate(dot(normal, back_))));
  const float x = lens_.center_x + dot(p, right_) / texel_;
  const float y = lens_.center_y - dot(p, up_) / texel_;
  if (!(std::fabs(x) < 1e6f && std::fabs(y) < 1e6f)) return 1;
  // Probes compare with the tangent plane, which keeps a surface from shading itself.
  // Where light grazes it, the plane would rise above what hides it.
  const float cosine = dot(normal, back_);
  const float trusted = cosine > 0.1f ? texel_ * std::min(cosine - 0.1f, 0.2f) * 5 / cosine : 0;
  const float slope_x = -dot(normal, right_) * trusted, slope_y = dot(normal, up_) * trusted;
  const float depth = dot(p, back_) - depth_zero_ + texel_;
  const float *dx = disk.x[turn], *dy = disk.y[turn];

  float above = 0;
  int blockers = 0;
  for (int i = 0; i < kTaps; ++i) {
    const float i_x = dx[i] * search_, i_y = dy[i] * search_;
    const float over = depth_at(x + i_x, y + i_y) - (depth + slope_x * i_x + slope_y * i_y);
    if (over > 0) above += over, ++blockers;
  }
  if (blockers == 0) return 1;
  const float radius =
      std::min(std::max(above / float(blockers) * softness_ / texel_, 1.5f), search_);
  int lit = 0;
  for (int i = 0; i < kTaps; ++i) {
    const float i_x = dx[i] * radius, i_y = dy[i] * radius;
    lit += depth_at(x + i_x, y + i_y) > depth + slope_x * i_x + slope_y * i_y ? 0 : 1;
  }
  return float(lit) / kTaps;
}

}  // namespace mien::render
