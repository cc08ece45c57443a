// SPDX-License-Identifier: MIT
// Images that surfaces are painted with.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "integrations/program/render/image.h"

namespace mien::render {

/// The image and halves of it, down to one pixel.
class Texture {
 public:
  /// `alpha` has one number for each pixel, or none if all are opaque.
  explicit Texture(Image image, std::vector<uint8_t> alpha = {});

  /// The color at a place, red, green and blue from 0 to 1 as stored, not linear: between pixels a blend of four.
  /// (0, 0) is the lower left corner; beyond 0 to 1 the image is repeated. `texels` is how many pixels of the
  /// image one of the picture covers: of the halves, the one where it is about one.
  math::Vec3 at(float u, float v, float texels) const;

  /// The alpha at a place, 0 to 1.
  float alpha_at(float u, float v, float texels) const;
  bool has_alpha() const { return !alpha_levels_.empty(); }

  int width() const { return levels_[0].width; }
  int height() const { return levels_[0].height; }

 private:
  std::vector<Image> levels_;
  std::vector<Image> alpha_levels_;  // gray; empty: opaque
};

/// Pixels of a PNG file, and their alpha, which is empty if all are opaque. Throws std::runtime_error with libpng's words, and for more than
/// 2^26 pixels; std::bad_alloc if memory is short.
Image read_png(const std::string& bytes, std::vector<uint8_t>& alpha);

}  // namespace mien::render
