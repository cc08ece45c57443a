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

/// Each pixel is the mean of four; at an odd edge, of two. With an alpha, transparent ones count less, because their
/// colors are not meant to be seen.
Image halved(const Image& from, const Image* alpha) {
  Image half(std::max(1, from.width / 2), std::max(1, from.height / 2), {});
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      int sums[3] = {}, weights = 0;
      for (int k = 0; k < 4; ++k) {
        const int from_x = std::min(2 * x + k % 2, from.width - 1);
        const int from_y = std::min(2 * y + k / 2, from.height - 1);
        const Color c = from.at(from_x, from_y);
        const int weight = alpha ? 1 + alpha->at(from_x, from_y).r : 1;
        sums[0] += weight * c.r;
        sums[1] += weight * c.g;
        sums[2] += weight * c.b;
        weights += weight;
      }
      const auto mean = [&](int sum) { return uint8_t((sum + weights / 2) / weights); };
      half.set(x, y, {mean(sums[0]), mean(sums[1]), mean(sums[2])});
    }
  }
  return half;
}

int wrapped(int64_t at, int size) {
  const auto rest = static_cast<int>(at % size);
  return rest < 0 ? rest + size : rest;
}

Vec3 shares(Color c) { return Vec3{float(c.r), float(c.g), float(c.b)} * (1 / 255.0f); }

Vec3 sample(const std::vector<Image>& levels, float u, float v, float texels) {
  size_t number = 0;
  for (float left = texels; left > 1.5f && number + 1 < levels.size(); left /= 2) ++number;
  const Image& level = levels[number];
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

}  // namespace

Texture::Texture(Image image, std::vector<uint8_t> alpha) {
  if (!alpha.empty()) {
    Image gray(image.width, image.height, {});
    for (size_t i = 0; i < alpha.size(); ++i) {
      for (size_t k = 0; k < 3; ++k) gray.pixels[3 * i + k] = alpha[i];
    }
    alpha_levels_.push_back(std::move(gray));
  }
  levels_.push_back(std::move(image));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Image* of = alpha_levels_.empty() ? nullptr : &alpha_levels_.back();
    levels_.push_back(halved(levels_.back(), of));
    if (of) alpha_levels_.push_back(halved(*of, nullptr));
  }
}

Vec3 Texture::at(float u, float v, float texels) const { return sample(levels_, u, v, texels); }

float Texture::alpha_at(float u, float v, float texels) const {
  return has_alpha() ? sample(alpha_levels_, u, v, texels).x : 1;
}

Image read_png(const std::string& bytes, std::vector<uint8_t>& alpha) {
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
  alpha.clear();
  bool opaque = true;
  for (size_t i = 0; i < pixels.size() / 4; ++i) {
    for (size_t k = 0; k < 3; ++k) image.pixels[3 * i + k] = pixels[4 * i + k];
    opaque = opaque && pixels[4 * i + 3] == 255;
  }
  for (size_t i = 0; i < pixels.size() / 4 && !opaque; ++i) alpha.push_back(pixels[4 * i + 3]);
  return image;
}

}  // namespace mien::render
