// SPDX-License-Identifier: MIT
#include "runtime/base/half.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace mien {
namespace {

/// The value of a finite half, by the definition of the format.
double value_of(uint32_t half) {
  const int exponent = static_cast<int>(half >> 10 & 31), fraction = static_cast<int>(half & 1023);
  const double magnitude =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return half & 0x8000 ? -magnitude : magnitude;
}

TEST(Half, EveryFiniteOneThereAndBack) {
  for (uint32_t half = 0; half < 65536; ++half) {
    if ((half & 0x7C00) == 0x7C00) continue;  // infinities and NaN are never stored
    const float value = float_from_half(static_cast<uint16_t>(half));
    ASSERT_EQ(value, value_of(half));
    ASSERT_EQ(std::signbit(value), half >> 15 != 0);
    ASSERT_EQ(half_from_float(value), half);
  }
}

TEST(Half, RoundsToTheNearestAndTiesToEven) {
  for (uint32_t low = 0; low < 0x7BFF; ++low) {
    const double a = value_of(low), b = value_of(low + 1);
    const auto middle = static_cast<float>((a + b) / 2);  // exact
    const uint16_t even = static_cast<uint16_t>(low % 2 == 0 ? low : low + 1);
    ASSERT_EQ(half_from_float(middle), even);
    ASSERT_EQ(half_from_float(-middle), even | 0x8000);
    ASSERT_EQ(half_from_float(std::nextafter(middle, 0.0f)), low);
    ASSERT_EQ(half_from_float(std::nextafter(middle, 1e9f)), low + 1);
  }
}

TEST(Half, WhatHasNoHalfBecomesFinite) {
  const float huge = std::numeric_limits<float>::infinity();
  for (float value : {65519.99f, 65520.0f, 1e9f, 3.4e38f, huge}) {
    EXPECT_EQ(half_from_float(value), 0x7BFF) << value;
    EXPECT_EQ(half_from_float(-value), 0xFBFF) << value;
  }
  EXPECT_EQ(half_from_float(NAN), 0);
  EXPECT_EQ(half_from_float(1e-45f), 0);
  EXPECT_EQ(half_from_float(-0.0f), 0x8000);
}

}  // namespace
}  // namespace mien
