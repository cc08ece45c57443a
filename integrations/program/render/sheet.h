// SPDX-License-Identifier: MIT
// Several images side by side, with labels.
#pragma once

#include <cstdint>
#include <string>

#include "integrations/program/render/image.h"
#include "integrations/program/render/render.h"

namespace mien::render {

/// Colors of a page that goes with a backdrop.
struct PageColors {
  Color page, text;
};
PageColors page_colors(const Backdrop& backdrop);

struct SheetLayout {
  size_t count, columns;
  Size tile;
  bool labels;

  static constexpr int kGap = 6;  // pixels around each tile

  float text_size() const;
  int label_height() const;
  uint64_t width() const;
  uint64_t height() const;
  /// Of a sheet that fits in memory and in other programs.
  static constexpr uint64_t kMaxSide = 65535, kMaxPixels = uint64_t{1} << 27;
  bool fits() const;
};

/// Tiles row by row, with a label under each.
class Sheet {
 public:
  /// `layout` has to fit.
  Sheet(const SheetLayout& layout, const Backdrop& backdrop);

  void add(const Image& tile, const std::string& label);
  const Image& image() const { return image_; }

 private:
  SheetLayout layout_;
  Color text_;
  size_t added_ = 0;
  Image image_;
};

}  // namespace mien::render
