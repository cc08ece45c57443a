// SPDX-License-Identifier: MIT
// A finished picture: 8-bit sRGB, rows from the top.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "integrations/program/math/vector.h"

namespace mien::render {

struct Color {
  uint8_t r = 0, g = 0, b = 0;
};

inline bool operator==(Color a, Color b) { return a.r == b.r && a.g == b.g && a.b == b.b; }
inline bool operator!=(Color a, Color b) { return !(a == b); }

/// Light is added up in linear values; a picture holds the sRGB curve of them.
math::Vec3 to_linear(Color color);
/// Clamps to 0..1.
Color to_srgb(math::Vec3 linear);

struct Image {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;  // r g b

  Image() = default;
  Image(int w, int h, Color color);

  Color at(int x, int y) const {
    const uint8_t* p = &pixels[(size_t(y) * size_t(width) + size_t(x)) * 3];
    return {p[0], p[1], p[2]};
  }
  void set(int x, int y, Color color) {
    uint8_t* p = &pixels[(size_t(y) * size_t(width) + size_t(x)) * 3];
    p[0] = color.r;
    p[1] = color.g;
    p[2] = color.b;
  }

  /// Lets `color` cover a pixel by 0..1; outside of the picture nothing happens.
  void blend(int x, int y, Color color, float cover);

  /// Copies a picture to (x, y); what lies outside is cut off.
  void paste(const Image& other, int x, int y);

  /// Fills a rectangle; what lies outside is cut off.
  void fill(int x, int y, int w, int h, Color color);
};

}  // namespace mien::render
