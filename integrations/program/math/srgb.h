// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace mien::math {

/// The curve of sRGB (IEC 61966-2-1): an encoded value in 0..1 to a linear one.
inline double srgb_to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// The inverse.
inline double linear_to_srgb(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace mien::math
