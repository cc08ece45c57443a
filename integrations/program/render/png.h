// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "integrations/program/render/image.h"

namespace mien::render {

/// A PNG file (8-bit RGB, sRGB). The same picture gives the same bytes with the same libpng and
/// zlib. Throws std::bad_alloc if memory is short, std::runtime_error with libpng's own words
/// otherwise.
std::string to_png(const Image& image);

/// The same in gray, of an image of which only the red is used; with an alpha for each pixel if there are any.
std::string to_gray_png(const Image& gray, const std::vector<uint8_t>& alpha);

}  // namespace mien::render
