// SPDX-License-Identifier: MIT
#include "integrations/program/render/image.h"

#include <array>
#include <cstring>

#include "integrations/program/math/srgb.h"

namespace mien::render {

using namespace math;

namespace {

struct Curves {
  std::array<float, 256> linear;
  // 0..1 in steps finer than any step of the encoded value.
  static constexpr int kSteps = 8192;
  std::array<uint8_t, kSteps + 1> encoded;

  Curves() {
    for (int i = 0; i < 256; ++i) linear[size_t(i)] = float(srgb_to_linear(i / 255.0));
    int value = 0;
    for (int i = 0; i <= kSteps; ++i) {
      while (value < 255 && srgb_to_linear((value + 0.5) / 255) < double(i) / kSteps) ++value;
      encoded[size_t(i)] = uint8_t(value);
    }
  }
};

const Curves& curves() {
  static const Curves made;
  return made;
}

}  // namespace

Vec3 to_linear(Color color) {
  const auto& linear = curves().linear;
  return {linear[color.r], linear[color.g], linear[color.b]};
}

Color to_srgb(Vec3 linear) {
  const Curves& all = curves();
  const auto encode = [&](float x) {
    // Written so that a number that is none becomes 0.
    return all.encoded[size_t((x > 0 ? std::min(x, 1.0f) : 0.0f) * Curves::kSteps + 0.5f)];
  };
  return {encode(linear.x), encode(linear.y), encode(linear.z)};
}

Image::Image(int w, int h, Color color) : width(w), height(h) {
  pixels.resize(size_t(w) * size_t(h) * 3);
  fill(0, 0, w, h, color);
}

void Image::blend(int x, int y, Color color, float cover) {
  if (x < 0 || y < 0 || x >= width || y >= height) return;
  set(x, y, to_srgb(mix(to_linear(at(x, y)), to_linear(color), saturate(cover))));
}

void Image::paste(const Image& other, int x, int y) {
  const int left = std::max(x, 0), right = std::min(x + other.width, width);
  if (left >= right) return;
  for (int row = std::max(y, 0); row < std::min(y + other.height, height); ++row) {
    const size_t from = (size_t(row - y) * size_t(other.width) + size_t(left - x)) * 3;
    const size_t to = (size_t(row) * size_t(width) + size_t(left)) * 3;
    std::memcpy(&pixels[to], &other.pixels[from], size_t(right - left) * 3);
  }
}

void Image::fill(int x, int y, int w, int h, Color color) {
  for (int row = std::max(y, 0); row < std::min(y + h, height); ++row) {
    for (int column = std::max(x, 0); column < std::min(x + w, width); ++column) {
      set(column, row, color);
    }
  }
}

}  // namespace mien::render
