// SPDX-License-Identifier: MIT
// Text in pictures, in a typeface of strokes that is part of this program: no font file is needed,
// and every machine draws the same letters.
#pragma once

#include <string>
#include <string_view>

#include "integrations/program/render/image.h"

namespace mien::render {

/// `size` is that of a line, in pixels; capitals have 0.7 of it. Text is UTF-8; what is not
/// printable ASCII shows as a box.
float text_width(std::string_view text, float size);

void draw_text(Image& image, float x, float baseline, std::string_view text, float size,
               Color color);

/// `text`, or as much of its beginning and end as fits into `width`, with ".." between.
std::string fit_text(std::string_view text, float size, float width);

}  // namespace mien::render
