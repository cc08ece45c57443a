// SPDX-License-Identifier: MIT
// The functions of simd/math.inl, reached by instruction set.
#pragma once

#include <stddef.h>

#include "simd/isa.h"

namespace mien {

enum class MathFunction {
  kSineCosine,  // of x: a, b
  kArcTangent,  // of y, x
  kArcCosine,
  kQuickRotationAngle,
  kBoundedSineCosine,  // of x: a, b
  kReciprocalRoot,
  kExpOfNegative,
  kPowerOfTwo,
  kPowerOfTwoOrZero,
  kNearest,
  kRoundToWhole,  // b is the power of two
};

/// `count` is a multiple of 32; all arrays are 64-byte aligned.
struct MathProbeArgs {
  MathFunction function;
  const float* x;
  const float* y;
  float* a;
  float* b;
  size_t count;
};

struct MathProbe {
  Isa isa;
  void (*vectors)(const MathProbeArgs& args);
  void (*pairs)(const MathProbeArgs& args);
};

}  // namespace mien
