// SPDX-License-Identifier: MIT
#include "integrations/program/render/skin_texture.h"

namespace mien::render {

using namespace math;

namespace {

// Noise ------------------------------------------------------------------------------------------

uint32_t hash_cell(int x, int y, int z) {
  uint32_t h = uint32_t(x) * 73856093u ^ uint32_t(y) * 19349663u ^ uint32_t(z) * 83492791u;
  h = (h ^ h >> 16) * 2246822519u;
  h = (h ^ h >> 13) * 3266489917u;
  return h ^ h >> 16;
}

/// 0 ... 1 from 8 bits of a hash.
float share_of_hash(uint32_t hash, int byte) {
  return float(hash >> (8 * byte) & 255) * (1.0f / 255);
}

float eased(float t) { return t * t * (3 - 2 * t); }

/// Smooth noise, -1 ... 1, one wave per unit.
float noise(Vec3 p) {
  const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const int x = int(fx), y = int(fy), z = int(fz);
  const float u = eased(p.x - fx), v = eased(p.y - fy), w = eased(p.z - fz);
  const auto at = [&](int i, int j, int k) {
    return float(hash_cell(x + i, y + j, z + k) & 65535) * (2.0f / 65535) - 1;
  };
  const auto along_x = [&](int j, int k) { return at(0, j, k) + (at(1, j, k) - at(0, j, k)) * u; };
  const float low = along_x(0, 0) + (along_x(1, 0) - along_x(0, 0)) * v;
  const float high = along_x(0, 1) + (along_x(1, 1) - along_x(0, 1)) * v;
  return low + (high - low) * w;
}

/// Round spots at random places, one in each cell of size 1 at most: 1 in the middle of one, 0 outside of `radius`.
/// `share` of the cells have one.
float spots(Vec3 p, float radius, float share) {
  const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  // Neighbors only where their spots reach; the margin is for rounding.
  const float reach = radius + 0.01f;
  const auto first = [reach](float within) { return within < reach ? -1 : 0; };
  const auto last = [reach](float within) { return 1 - within < reach ? 1 : 0; };
  const int left = first(p.x - fx), right = last(p.x - fx);
  const int low = first(p.y - fy), high = last(p.y - fy);
  const int back = first(p.z - fz), front = last(p.z - fz);
  float most = 0;
  for (int k = back; k <= front; ++k) {
    for (int j = low; j <= high; ++j) {
      for (int i = left; i <= right; ++i) {
        const uint32_t h = hash_cell(int(fx) + i, int(fy) + j, int(fz) + k);
        if (share_of_hash(h, 3) >= share) continue;
        const Vec3 d =
            Vec3{fx + float(i) + share_of_hash(h, 0), fy + float(j) + share_of_hash(h, 1),
                 fz + float(k) + share_of_hash(h, 2)} -
            p;
        const float t = 1 - dot(d, d) / (radius * radius);
        most = std::max(most, t);
      }
    }
  }
  return most;
}

// The surface in the texture --------------------------------------------------------------------

struct Texel {
  Vec3 place, color;  // sRGB, 0 ... 255
  bool covered = false;
};

class SkinMap {
 public:
  SkinMap(const Surface& surface, const SkinLayout& layout, int width, int height)
      : surface_(surface), layout_(layout), width_(width), height_(height),
        texels_(size_t(width) * size_t(height)) {
    for (size_t t = 0; t < surface.triangle_count; ++t) draw(surface.triangles + 3 * t);
    spread();
    reference_ =
        at(int(layout.skin_u * float(width)), int((1 - layout.skin_v) * float(height))).color;
    reference_.y = std::max(reference_.y, 1.0f);
  }

  SkinMaps make() const;

 private:
  const Texel& at(int x, int y) const {
    x = std::min(std::max(x, 0), width_ - 1);
    y = std::min(std::max(y, 0), height_ - 1);
    return texels_[size_t(y) * size_t(width_) + size_t(x)];
  }
  uint32_t position_of(uint32_t vertex) const {
    return surface_.vertex_position_indices ? surface_.vertex_position_indices[vertex] : vertex;
  }
  void draw(const uint32_t* corners);
  void spread();
  float lips_at(float u, float v, const Texel& texel) const;
  Vec3 color_at(int x, int y, float v) const;

  struct Detail {
    float height;  // cm
    Vec3 tint;     // times the color
    float roughness;
  };
  Detail detail(float u, float v, const Texel& texel) const;

  const Surface& surface_;
  const SkinLayout& layout_;
  const int width_, height_;
  std::vector<Texel> texels_;
  Vec3 reference_;  // the color of plain skin
};

void SkinMap::draw(const uint32_t* corners) {
  Vec3 p[3], c[3];
  float x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    const uint32_t position = position_of(corners[k]);
    p[k] = load3(surface_.positions, position);
    const uint8_t* color = surface_.colors + size_t{3} * position;
    c[k] = {float(color[0]), float(color[1]), float(color[2])};
    x[k] = surface_.texture_coordinates[2 * corners[k]] * float(width_) - 0.5f;
    y[k] = (1 - surface_.texture_coordinates[2 * corners[k] + 1]) * float(height_) - 0.5f;
  }
  const float twice = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
  // About 800 texels are a square centimeter; thin triangles between parts of the texture have far more.
  constexpr float kMostTexels = 24000;
  if (twice == 0 || std::fabs(twice) > kMostTexels * std::sqrt(dot(n, n))) return;
  const auto low = [](float a, float b, float d) { return int(std::floor(std::min({a, b, d}))); };
  const auto high = [](float a, float b, float d) { return int(std::ceil(std::max({a, b, d}))); };
  const int left = std::max(low(x[0], x[1], x[2]), 0);
  const int right = std::min(high(x[0], x[1], x[2]), width_ - 1);
  const int top = std::max(low(y[0], y[1], y[2]), 0);
  const int bottom = std::min(high(y[0], y[1], y[2]), height_ - 1);
  for (int row = top; row <= bottom; ++row) {
    for (int column = left; column <= right; ++column) {
      float w[3];
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        w[k] = ((x[a] - float(column)) * (y[b] - float(row)) -
                (x[b] - float(column)) * (y[a] - float(row))) /
               twice;
      }
      if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
      Texel& texel = texels_[size_t(row) * size_t(width_) + size_t(column)];
      texel.place = p[0] * w[0] + p[1] * w[1] + p[2] * w[2];
      texel.color = c[0] * w[0] + c[1] * w[1] + c[2] * w[2];
      texel.covered = true;
    }
  }
}

/// Texels that no triangle covers take what is beside them, so that blends at borders find skin.
void SkinMap::spread() {
  for (int y = 0; y < height_; ++y) {
    Texel* row = &texels_[size_t(y) * size_t(width_)];
    for (int x = 1; x < width_; ++x) {
      if (!row[x].covered && row[x - 1].covered) row[x] = row[x - 1];
    }
    for (int x = width_ - 1; x-- > 0;) {
      if (!row[x].covered && row[x + 1].covered) row[x] = row[x + 1];
    }
    if (row[0].covered || y == 0) continue;
    const Texel* above = row - width_;
    for (int x = 0; x < width_; ++x) row[x] = above[x];
  }
}

float redness(Vec3 color) { return color.x / std::max(color.y, 1.0f); }

float SkinMap::lips_at(float u, float v, const Texel& texel) const {
  if (u < layout_.lips_low_u || u > layout_.lips_high_u || v < layout_.lips_low_v ||
      v > layout_.lips_high_v) {
    return 0;
  }
  return eased(saturate((redness(texel.color) / redness(reference_) - 1.06f) / 0.12f));
}

SkinMap::Detail SkinMap::detail(float u, float v, const Texel& texel) const {
  const Vec3 p = texel.place;
  if (v < layout_.inner_below) return {0.003f * noise(p * 6), {1, 1, 1}, 0.38f};
  if (v < layout_.cloth_below) {
    // Threads would be finer than a pixel of most pictures, and make patterns of their own there.
    const float fine = noise(p * 9);
    return {layout_.hem + 0.006f * fine + 0.004f * noise(p * 3),
            Vec3{1, 1, 1} * (1 + 0.03f * fine + 0.04f * noise(p * 2)), 0.92f};
  }
  const float lips = lips_at(u, v, texel), skin = 1 - lips;
  // Pores are a third of a millimeter wide and a millimeter and more apart; between them runs a net of fine creases.
  const float pore = spots(p * 9, 0.34f, 0.8f) * skin;
  const float coarse = noise(p * 4), fine = noise(p * 11), net = std::fabs(noise(p * 7));
  // The lips have folds across them.
  const float fold = lips > 0 ? std::fabs(noise({p.x * 9, p.y * 1.6f, p.z * 2})) : 0;
  Detail d;
  d.height = skin * (0.0030f * coarse + 0.0022f * fine + 0.0030f * net - 0.0045f * pore) +
             lips * (0.016f * fold + 0.003f * fine);
  // Blood and pigment vary over centimeters, and again over millimeters.
  const float blood = noise(p * 0.9f) + 0.6f * noise(p * 2.3f),
              pigment = noise(p * 1.4f + Vec3{9, 4, 7});
  const float shade = 1 +
                      skin * (0.030f * pigment + 0.020f * coarse + 0.018f * fine - 0.045f * pore) +
                      lips * (0.10f * fold - 0.05f);
  d.tint = Vec3{1, 1 - 0.018f * blood, 1 - 0.020f * blood - 0.010f * pigment} * shade;
  if (layout_.freckles > 0 && v > layout_.freckles_low_v && v < layout_.freckles_high_v) {
    const float middle =
        (v - layout_.freckles_low_v) / (layout_.freckles_high_v - layout_.freckles_low_v);
    const float dense = layout_.freckles * eased(1 - std::fabs(2 * middle - 1));
    const float spot = skin * saturate(1.6f * spots(p * 2.6f, 0.24f, dense));
    d.tint = d.tint * (Vec3{1, 1, 1} - Vec3{0.13f, 0.22f, 0.28f} * spot);
  }
  // In nostrils and ears there is less of it: few texels, and dark.
  d.height *= saturate((texel.color.y / reference_.y - 0.35f) / 0.4f);
  d.roughness = (0.50f + 0.05f * coarse + 0.10f * pore) * skin + (0.36f + 0.08f * fold) * lips;
  return d;
}

/// Vertices are too far apart for the edge of the collar: up to it the cloth is as it is below, from there on the skin
/// as it is above.
Vec3 SkinMap::color_at(int x, int y, float v) const {
  const float above = v - layout_.cloth_below;
  if (std::fabs(above) >= layout_.collar) return at(x, y).color;
  const float from = layout_.cloth_below + std::copysign(layout_.collar, above);
  return at(x, int((1 - from) * float(height_))).color;
}

SkinMaps SkinMap::make() const {
  SkinMaps maps = {Image(width_, height_, {}), Image(width_, height_, {}),
                   Image(width_ / 2, height_ / 2, {})};
  std::vector<float> heights(texels_.size());
  const auto byte = [](float value) {
    return uint8_t(std::lround(std::min(std::max(value, 0.0f), 255.0f)));
  };
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const Texel& texel = at(x, y);
      const float u = (float(x) + 0.5f) / float(width_), v = 1 - (float(y) + 0.5f) / float(height_);
      const Detail d = detail(u, v, texel);
      heights[size_t(y) * size_t(width_) + size_t(x)] = d.height;
      const Vec3 color = color_at(x, y, v) * d.tint;
      maps.base_color.set(x, y, {byte(color.x), byte(color.y), byte(color.z)});
      const uint8_t rough = byte(255 * d.roughness);
      if (x % 2 == 0 && y % 2 == 0) maps.roughness.set(x / 2, y / 2, {rough, rough, rough});
    }
  }
  // Slopes by differences over the distance on the surface.
  const auto slope = [&](int x0, int y0, int x1, int y1) {
    const Vec3 d = at(x1, y1).place - at(x0, y0).place;
    const float far = std::sqrt(dot(d, d));
    if (far < 0.004f || far > 0.5f) return 0.0f;  // where the texture is torn
    const auto height = [&](int x, int y) {
      return heights[size_t(y) * size_t(width_) + size_t(x)];
    };
    return std::min(std::max((height(x1, y1) - height(x0, y0)) / far, -0.7f), 0.7f);
  };
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const int left = std::max(x - 1, 0), right = std::min(x + 1, width_ - 1);
      const int up = std::max(y - 1, 0), down = std::min(y + 1, height_ - 1);
      const Vec3 n =
          normalized(Vec3{-slope(left, y, right, y), -slope(x, down, x, up), 1}, {0, 0, 1});
      maps.normal.set(
          x, y, {byte(127.5f * (n.x + 1)), byte(127.5f * (n.y + 1)), byte(127.5f * (n.z + 1))});
    }
  }
  return maps;
}

}  // namespace

SkinMaps make_skin_maps(const Surface& surface, const SkinLayout& layout, int width, int height) {
  return SkinMap(surface, layout, width, height).make();
}

}  // namespace mien::render
