// SPDX-License-Identifier: MIT
#include "integrations/program/render/skin_texture.h"

#include "integrations/program/render/noise.h"

namespace mien::render {

using namespace math;

namespace {

// The surface in the texture --------------------------------------------------------------------

struct Texel {
  Vec3 place, color;  // sRGB, 0 ... 255
  bool covered = false;
  bool spread = false;  // has what a texel beside it has
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
  bool is_wet(int x, int y, float u, float v) const;
  Vec3 color_at(int x, int y, float v) const;

  struct Detail {
    float height;  // cm
    Vec3 tint;     // times the color
    float roughness;
  };
  Detail detail(int x, int y, float u, float v) const;

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
  const auto take = [](Texel& texel, const Texel& from) {
    texel = from;
    texel.spread = true;
  };
  for (int y = 0; y < height_; ++y) {
    Texel* row = &texels_[size_t(y) * size_t(width_)];
    for (int x = 1; x < width_; ++x) {
      if (!row[x].covered && row[x - 1].covered) take(row[x], row[x - 1]);
    }
    for (int x = width_ - 1; x-- > 0;) {
      if (!row[x].covered && row[x + 1].covered) take(row[x], row[x + 1]);
    }
    if (row[0].covered || y == 0) continue;
    const Texel* above = row - width_;
    for (int x = 0; x < width_; ++x) take(row[x], above[x]);
  }
  int top = 0;
  while (top + 1 < height_ && !texels_[size_t(top) * size_t(width_)].covered) ++top;
  const Texel* first = &texels_[size_t(top) * size_t(width_)];
  for (size_t i = 0; i < size_t(top) * size_t(width_); ++i)
    take(texels_[i], first[i % size_t(width_)]);
}

float redness(Vec3 color) { return color.x / std::max(color.y, 1.0f); }

float SkinMap::lips_at(float u, float v, const Texel& texel) const {
  if (u < layout_.lips_low_u || u > layout_.lips_high_u || v < layout_.lips_low_v ||
      v > layout_.lips_high_v) {
    return 0;
  }
  return eased(saturate((redness(texel.color) / redness(reference_) - 1.06f) / 0.12f));
}

/// On the rim of a lid, within two texels of the slit, stands a line of tears.
bool SkinMap::is_wet(int x, int y, float u, float v) const {
  u = 0.5f + std::fabs(u - 0.5f);
  if (u < layout_.lids_low_u || u > layout_.lids_high_u || v < layout_.lids_low_v ||
      v > layout_.lids_high_v) {
    return false;
  }
  for (int by = -2; by <= 2; ++by) {
    if (at(x, y + by).spread) return true;
  }
  return false;
}

SkinMap::Detail SkinMap::detail(int x, int y, float u, float v) const {
  const Texel& texel = at(x, y);
  const Vec3 p = texel.place;
  if (v < layout_.cloth_below) {
    // Threads would be finer than a pixel of most pictures, and make patterns of their own there.
    const float fine = noise(p * 9);
    return {layout_.hem + 0.006f * fine + 0.004f * noise(p * 3),
            Vec3{1, 1, 1} * (1 + 0.03f * fine + 0.04f * noise(p * 2)), 0.92f};
  }
  const float lips = lips_at(u, v, texel), skin = 1 - lips;
  float oil = 0, pores = 0.5f;
  for (const SkinZone& zone : layout_.zones) {
    const float du = (std::fabs(u - 0.5f) - zone.u) / zone.half_u, dv = (v - zone.v) / zone.half_v;
    const float inside = saturate(1 - du * du - dv * dv);
    oil += zone.oil * inside;
    pores += zone.pores * inside;
  }
  const float seen =
      eased(0.12f, 0, std::fabs(u - 0.5f) - layout_.plain_u) * eased(0.08f, 0, v - layout_.plain_v);
  pores = std::max(pores, 0.0f) * skin * seen;

  // Pores are a third of a millimeter wide and a millimeter and more apart; between them runs a net of fine creases.
  const float pore = pores > 0 ? pores * spots(p * 9, 0.34f, 0.85f) : 0;
  const float coarse = noise(p * 3.5f);
  const float fine = seen > 0 ? noise(p * 11) * seen : 0;
  const float net = seen > 0 ? std::fabs(noise(p * 7)) * seen : 0;
  // The lips have folds across them.
  const float fold = lips > 0 ? std::fabs(noise({p.x * 8, p.y * 1.2f, p.z * 2})) : 0;
  Detail d;
  d.height = skin * (0.0020f * coarse + 0.0020f * fine + 0.0030f * net - 0.0050f * pore) +
             lips * (0.010f * fold + 0.002f * fine);
  // Blood and pigment vary over centimeters, and again over millimeters: little, or it would look like dirt.
  const float blood = noise(p * 0.8f) + 0.7f * noise(p * 2.1f);
  const float pigment = noise(p * 1.4f + Vec3{9, 4, 7});
  const float shade = 1 +
                      skin * (0.008f * pigment + 0.008f * coarse + 0.012f * fine - 0.035f * pore) +
                      lips * (0.07f * fold - 0.035f);
  d.tint = Vec3{1, 1 - 0.010f * blood, 1 - 0.011f * blood - 0.006f * pigment} * shade;
  if (layout_.freckles > 0 && v > layout_.freckles_low_v && v < layout_.freckles_high_v) {
    const float middle =
        (v - layout_.freckles_low_v) / (layout_.freckles_high_v - layout_.freckles_low_v);
    const float dense = layout_.freckles * eased(1 - std::fabs(2 * middle - 1));
    const float spot = skin * saturate(1.5f * spots(p * 4.5f, 0.28f, dense)) *
                       (0.6f + 0.4f * noise(p * 1.7f + Vec3{40, 2, 8}));
    d.tint = d.tint * (Vec3{1, 1, 1} - Vec3{0.12f, 0.21f, 0.26f} * spot);
  }
  d.roughness = (0.54f - oil + 0.05f * coarse + 0.05f * net + 0.12f * pore) * skin +
                (0.30f + 0.12f * fold + 0.05f * coarse) * lips;
  // In nostrils, ears and the throat there are few texels, and too little light to shine.
  const float lit = saturate((texel.color.y / reference_.y - 0.35f) / 0.4f);
  d.height *= lit;
  d.roughness += 0.4f * saturate(1 - 2 * lit);
  if (is_wet(x, y, u, v)) d.roughness = 0.08f, d.height = 0;
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
      const float u = (float(x) + 0.5f) / float(width_), v = 1 - (float(y) + 0.5f) / float(height_);
      const Detail d = detail(x, y, u, v);
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

Image make_tongue_normals(int width, int height) {
  // Half around it is about 3 cm, along it 6 cm.
  const auto surface = [&](int x, int y) {
    const float u = (float(x) + 0.5f) / float(width), v = 1 - (float(y) + 0.5f) / float(height);
    const float around = 2 * std::fabs(u - 0.5f);
    const Vec3 p = {around * 3, v * 6, 0};
    const float above = eased(0.45f, 0.60f, around);
    // Most are pointed and close to each other; a few larger ones are round.
    return above * (0.012f * spots(p * 11, 0.5f, 0.9f) + 0.016f * spots(p * 4, 0.3f, 0.5f)) +
           0.008f * noise(p * 3);
  };
  Image normals(width, height, {});
  const float across = 12.0f / float(width), along = 12.0f / float(height);  // of two texels, cm
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float slope_u =
          (surface((x + 1) % width, y) - surface((x + width - 1) % width, y)) / across;
      const float slope_v = (surface(x, y - 1) - surface(x, y + 1)) / along;
      const Vec3 n = normalized(Vec3{-slope_u, -slope_v, 1}, {0, 0, 1}) + Vec3{1, 1, 1};
      const auto byte = [](float value) { return uint8_t(std::lround(127.5f * value)); };
      normals.set(x, y, {byte(n.x), byte(n.y), byte(n.z)});
    }
  }
  return normals;
}

}  // namespace mien::render
