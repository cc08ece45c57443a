// SPDX-License-Identifier: MIT
#include "integrations/program/render/sheet.h"

#include <algorithm>

#include "integrations/program/render/label.h"

namespace mien::render {

using namespace math;

PageColors page_colors(const Backdrop& backdrop) {
  // A little darker than the darkest backdrop, or as light as the lightest.
  const bool dark = backdrop.edge.g < 128;
  return dark ? PageColors{{24, 26, 29}, {214, 216, 218}}
              : PageColors{{255, 255, 255}, {40, 42, 46}};
}

float SheetLayout::text_size() const { return std::clamp(float(tile.width) / 15, 9.0f, 26.0f); }

int SheetLayout::label_height() const { return labels ? int(text_size() * 1.7f) : 0; }

uint64_t SheetLayout::width() const { return columns * uint64_t(tile.width + kGap) + kGap; }

uint64_t SheetLayout::height() const {
  const uint64_t rows = (count + columns - 1) / columns;
  return rows * uint64_t(tile.height + label_height() + kGap) + kGap;
}

bool SheetLayout::fits() const {
  return width() <= kMaxSide && height() <= kMaxSide && width() * height() <= kMaxPixels;
}

Sheet::Sheet(const SheetLayout& layout, const Backdrop& backdrop)
    : layout_(layout), text_(page_colors(backdrop).text),
      image_(int(layout.width()), int(layout.height()), page_colors(backdrop).page) {}

void Sheet::add(const Image& tile, const std::string& label) {
  const int gap = SheetLayout::kGap, label_height = layout_.label_height();
  const int column = int(added_ % layout_.columns), row = int(added_ / layout_.columns);
  ++added_;
  const int x = gap + column * (layout_.tile.width + gap);
  const int y = gap + row * (layout_.tile.height + label_height + gap);
  image_.paste(tile, x, y);
  if (!layout_.labels) return;
  const float width = float(layout_.tile.width), size = layout_.text_size();
  const std::string text = fit_text(label, size, width - 4);
  const float left = float(x) + (width - text_width(text, size)) / 2;
  const float baseline = float(y + layout_.tile.height) + size * 1.18f;
  draw_text(image_, left, baseline, text, size, text_);
}

}  // namespace mien::render
