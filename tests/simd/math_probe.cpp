// SPDX-License-Identifier: MIT
// The functions of simd/math.inl over arrays, compiled for each instruction set as kernels are, for
// math_test.cpp. CMake defines the names that kernels_<isa>.cpp define.
#include "tests/simd/math_probe.h"

#include "simd/math.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

template <class V>
void probe(const MathProbeArgs& args) {
  using M = Make<V>;
  for (size_t i = 0; i < args.count; i += sizeof(V) / sizeof(float)) {
    const V x = M::from(args.x + i);
    V a = M::of(0.0f), b = a;
    switch (args.function) {
      case MathFunction::kSineCosine: sine_cosine(x, a, b); break;
      case MathFunction::kArcTangent: a = arc_tangent(M::from(args.y + i), x); break;
      case MathFunction::kArcCosine: a = arc_cosine(x); break;
      case MathFunction::kReciprocalRoot: a = reciprocal_root(x); break;
      case MathFunction::kQuickRotationAngle: a = quick_rotation_angle(x); break;
      case MathFunction::kBoundedSineCosine:
        a = bounded_sine(x);
        b = bounded_cosine(x);
        break;
      case MathFunction::kExpOfNegative: a = exp_of_negative(x); break;
      case MathFunction::kPowerOfTwo: a = power_of_two(x); break;
      case MathFunction::kPowerOfTwoOrZero: a = power_of_two_or_zero(x); break;
      case MathFunction::kNearest: a = nearest(x); break;
      case MathFunction::kRoundToWhole: a = round_to_whole(x, b); break;
    }
    store(args.a + i, a);
    store(args.b + i, b);
  }
}

}  // namespace

extern const MathProbe kMathProbe;
const MathProbe kMathProbe = {kIsa, probe<Vec>, probe<VecPair>};

}  // namespace mien::MIEN_KERNEL_ISA
