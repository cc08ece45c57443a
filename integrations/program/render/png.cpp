// SPDX-License-Identifier: MIT
#include "integrations/program/render/png.h"

#include <png.h>

#include <stdexcept>

namespace mien::render {

std::string to_png(const Image& image) {
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  head.width = png_uint_32(image.width);
  head.height = png_uint_32(image.height);
  head.format = PNG_FORMAT_RGB;
  const auto write = [&](void* memory, png_alloc_size_t* size) {
    return png_image_write_to_memory(&head, memory, size, 0, image.pixels.data(), 0, nullptr) != 0;
  };

  // Asking for the size first would compress twice; a bound is cheap memory for a moment.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(head);
  std::string bytes(size, '\0');
  const bool good = write(bytes.data(), &size);
  const std::string message = head.message;
  png_image_free(&head);
  if (!good) throw std::runtime_error("libpng: " + message);
  bytes.resize(size);
  return bytes;
}

}  // namespace mien::render
