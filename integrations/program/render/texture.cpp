// SPDX-License-Identifier: MIT
#include "integrations/program/render/texture.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace mien::render {

using namespace math;

namespace {

constexpr uint64_t kMaxTexturePixels = uint64_t{1} << 26;

/// Each pixel is the mean of four; at an odd edge, of two.
Image halved(const Image& from) {
  Image half(std::max(1, from.width / 2), std::max(1, from.height / 2), {});
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      int sums[3] = {2, 2, 2};  // rounds
      for (int k = 0; k < 4; ++k) {
        const Color c = from.at(std::min(2 * x + k % 2, from.width - 1),
                                std::min(2 * y + k / 2, from.height - 1));
        sums[0] += c.r;
        sums[1] += c.g;
        sums[2] += c.b;
      }
      half.set(x, y, {uint8_t(sums[0] / 4), uint8_t(sums[1] / 4), uint8_t(sums[2] / 4)});
    }
  }
  return half;
}

int wrapped(int64_t at, int size) {
  const auto rest = static_cast<int>(at % size);
  return rest < 0 ? rest + size : rest;
}

Vec3 shares(Color c) { return Vec3{float(c.r), float(c.g), float(c.b)} * (1 / 255.0f); }

}  // namespace

Texture::Texture(Image image) {
  levels_.push_back(std::move(image));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    levels_.push_back(halved(levels_.back()));
  }
}

Vec3 Texture::at(float u, float v, float texels) const {
  size_t number = 0;
  for (float left = texels; left > 1.5f && number + 1 < levels_.size(); left /= 2) ++number;
  const Image& level = levels_[number];
  // Coordinates of files may be anything.
  if (!(std::fabs(u) < 1e6f && std::fabs(v) < 1e6f)) return shares(level.at(0, 0));
  const float x = (u - std::floor(u)) * float(level.width) - 0.5f;
  const float y = (1 - (v - std::floor(v))) * float(level.height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const int x0 = wrapped(int64_t(left), level.width), x1 = wrapped(x0 + 1, level.width);
  const int y0 = wrapped(int64_t(top), level.height), y1 = wrapped(y0 + 1, level.height);
  const Vec3 above = mix(shares(level.at(x0, y0)), shares(level.at(x1, y0)), x - left);
  const Vec3 below = mix(shares(level.at(x0, y1)), shares(level.at(x1, y1)), x - left);
  return mix(above, below, y - top);
}

Image read_png(const std::string& bytes) {
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  const auto fail = [&](const std::string& why) {
    png_image_free(&head);
    throw std::runtime_error(why);
  };
  if (!png_image_begin_read_from_memory(&head, bytes.data(), bytes.size())) {
    fail(std::string("libpng: ") + head.message);
  }
  if (head.width == 0 || head.height == 0 ||
      uint64_t{head.width} * head.height > kMaxTexturePixels) {
    fail(std::to_string(head.width) + " x " + std::to_string(head.height) +
         " pixels are more than 2^26");
  }
  head.format = PNG_FORMAT_RGBA;  // without it libpng would blend colors with a background
  Image image(int(head.width), int(head.height), {});
  std::vector<uint8_t> pixels(PNG_IMAGE_SIZE(head));
  if (!png_image_finish_read(&head, nullptr, pixels.data(), 0, nullptr)) {
    fail(std::string("libpng: ") + head.message);
  }
  for (size_t i = 0; i < pixels.size() / 4; ++i) {
    for (size_t k = 0; k < 3; ++k) image.pixels[3 * i + k] = pixels[4 * i + k];
  }
  return image;
}

}  // namespace mien::render
