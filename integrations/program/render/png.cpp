// SPDX-License-Identifier: MIT
#include "integrations/program/render/png.h"

#include <png.h>

#include <cstdio>
#include <new>
#include <stdexcept>
#include <utility>

namespace mien::render {

namespace {

/// On textures of skin, level 6 (the default) takes twice as long for 3 % fewer bytes.
constexpr int kPngLevel = 5;

struct PngSink {
  std::string bytes;
  bool out_of_memory = false;
  char error[128] = {};  // libpng's words
};

// libpng calls these from C, through which no exception may pass. Jumps leave no handler of one.

void add_bytes(png_structp png, png_bytep data, png_size_t count) {
  auto* sink = static_cast<PngSink*>(png_get_io_ptr(png));
  try {
    sink->bytes.append(reinterpret_cast<const char*>(data), count);
  } catch (const std::bad_alloc&) {
    sink->out_of_memory = true;
  }
  if (sink->out_of_memory) png_longjmp(png, 1);
}

void stop(png_structp png, png_const_charp message) {
  auto* sink = static_cast<PngSink*>(png_get_error_ptr(png));
  std::snprintf(sink->error, sizeof(sink->error), "%s", message);
  png_longjmp(png, 1);
}

/// Has nothing to destroy, because errors jump out of it. False if there was one.
bool write(png_structp png, png_infop info, const Image& size, int type, int channels,
           const uint8_t* pixels, PngSink& sink) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, &sink, add_bytes, [](png_structp) {});
  png_set_IHDR(png, info, png_uint_32(size.width), png_uint_32(size.height), 8, type,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_level(png, kPngLevel);
  png_write_info(png, info);
  for (int y = 0; y < size.height; ++y) {
    png_write_row(png, pixels + size_t(y) * size_t(size.width) * size_t(channels));
  }
  png_write_end(png, info);
  return true;
}

std::string png_of(const Image& size, int type, int channels, const uint8_t* pixels) {
  PngSink sink;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, stop,
                                            [](png_structp, png_const_charp) {});
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (!info) sink.out_of_memory = true;
  const bool good = info && write(png, info, size, type, channels, pixels, sink);
  png_destroy_write_struct(&png, &info);
  if (sink.out_of_memory) throw std::bad_alloc();
  if (!good) throw std::runtime_error(std::string("libpng: ") + sink.error);
  return std::move(sink.bytes);
}

}  // namespace

std::string to_png(const Image& image) {
  return png_of(image, PNG_COLOR_TYPE_RGB, 3, image.pixels.data());
}

std::string to_gray_png(const Image& gray, const std::vector<uint8_t>& alpha) {
  const size_t count = size_t(gray.width) * size_t(gray.height);
  const size_t channels = alpha.empty() ? 1 : 2;
  std::vector<uint8_t> pixels(channels * count);
  for (size_t i = 0; i < count; ++i) {
    pixels[channels * i] = gray.pixels[3 * i];
    if (!alpha.empty()) pixels[channels * i + 1] = alpha[i];
  }
  return png_of(gray, alpha.empty() ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_GRAY_ALPHA,
                int(channels), pixels.data());
}

}  // namespace mien::render
