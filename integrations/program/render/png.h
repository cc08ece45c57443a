// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "integrations/program/render/image.h"

namespace mien::render {

/// A PNG file (8-bit RGB, sRGB). The same picture gives the same bytes with the same libpng and
/// zlib. Throws std::bad_alloc if memory is short, std::runtime_error with libpng's own words
/// otherwise.
std::string to_png(const Image& image);

}  // namespace mien::render
