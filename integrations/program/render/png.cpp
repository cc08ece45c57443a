// SPDX-License-Identifier: MIT
#include "integrations/program/render/png.h"

#include <png.h>

#include <stdexcept>

namespace mien::render {

namespace {

/// `format` of libpng.
std::string png_of(const Image& size, png_uint_32 format, const uint8_t* pixels) {
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  head.width = png_uint_32(size.width);
  head.height = png_uint_32(size.height);
  head.format = format;
  const auto write = [&](void* memory, png_alloc_size_t* bytes) {
    return png_image_write_to_memory(&head, memory, bytes, 0, pixels, 0, nullptr) != 0;
  };

  // Asking for the size first would compress twice; a bound is cheap memory for a moment.
  png_alloc_size_t count = PNG_IMAGE_PNG_SIZE_MAX(head);
  std::string bytes(count, '\0');
  const bool good = write(bytes.data(), &count);
  const std::string message = head.message;
  png_image_free(&head);
  if (!good) throw std::runtime_error("libpng: " + message);
  bytes.resize(count);
  return bytes;
}

}  // namespace

std::string to_png(const Image& image) {
  return png_of(image, PNG_FORMAT_RGB, image.pixels.data());
}

std::string to_gray_png(const Image& gray, const std::vector<uint8_t>& alpha) {
  std::vector<uint8_t> pixels(2 * alpha.size());
  for (size_t i = 0; i < alpha.size(); ++i) {
    pixels[2 * i] = gray.pixels[3 * i];
    pixels[2 * i + 1] = alpha[i];
  }
  return png_of(gray, PNG_FORMAT_GA, pixels.data());
}

}  // namespace mien::render
