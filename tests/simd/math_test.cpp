// SPDX-License-Identifier: MIT
// The functions of simd/math.inl against double precision, over their whole range: single vectors and
// pairs, on every instruction set present, all with the same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "author/base/random.h"
#include "runtime/base/bits.h"
#include "tests/simd/math_probe.h"

namespace mien {

#define MIEN_DECLARE_PROBE(isa)      \
  namespace isa {                    \
  extern const MathProbe kMathProbe; \
  }
MIEN_DECLARE_PROBE(scalar)
MIEN_DECLARE_PROBE(sse2)
MIEN_DECLARE_PROBE(avx2)
MIEN_DECLARE_PROBE(avx512)
MIEN_DECLARE_PROBE(neon)

namespace {

constexpr size_t kStep = 32;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::vector<const MathProbe*> present() {
  std::vector<const MathProbe*> probes;
  const auto add = [&](const MathProbe& probe) {
    if (kernels_for(probe.isa)) probes.push_back(&probe);
  };
  add(scalar::kMathProbe);
#if defined(MIEN_PROBE_SSE2)
  add(sse2::kMathProbe);
#endif
#if defined(MIEN_PROBE_AVX2)
  add(avx2::kMathProbe);
#endif
#if defined(MIEN_PROBE_AVX512)
  add(avx512::kMathProbe);
#endif
#if defined(MIEN_PROBE_NEON)
  add(neon::kMathProbe);
#endif
  return probes;
}

float float_of(uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}
/// Floats at a multiple of 64 bytes, in whole steps.
struct Floats {
  explicit Floats(size_t count) : storage(count + kStep + 16) {
    const size_t past = reinterpret_cast<uintptr_t>(storage.data()) / sizeof(float) % 16;
    data = storage.data() + (past ? 16 - past : 0);
  }
  std::vector<float> storage;
  float* data;
};

struct Results {
  std::vector<float> a, b;
};

/// On the scalar table; the others must give the same bits.
Results evaluate(MathFunction function, const std::vector<float>& x, const std::vector<float>& y) {
  const size_t count = (x.size() + kStep - 1) / kStep * kStep;
  Floats in_x(count), in_y(count), out_a(count), out_b(count);
  std::copy(x.begin(), x.end(), in_x.data);
  std::copy(y.begin(), y.end(), in_y.data);
  Results first;
  for (const MathProbe* probe : present()) {
    for (const auto run : {probe->vectors, probe->pairs}) {
      std::fill(out_a.storage.begin(), out_a.storage.end(), -1.0f);
      run({function, in_x.data, in_y.data, out_a.data, out_b.data, count});
      Results now = {{out_a.data, out_a.data + x.size()}, {out_b.data, out_b.data + x.size()}};
      if (first.a.empty()) first = now;
      for (size_t i = 0; i < x.size(); ++i) {
        const bool same = (bits_of(now.a[i]) == bits_of(first.a[i]) &&
                           bits_of(now.b[i]) == bits_of(first.b[i])) ||
                          (std::isnan(now.a[i]) && std::isnan(first.a[i]));
        if (!same) {
          ADD_FAILURE() << isa_name(probe->isa) << " differs at x = " << x[i] << ": " << now.a[i]
                        << ", " << now.b[i] << ", not " << first.a[i] << ", " << first.b[i];
          return first;
        }
      }
    }
  }
  return first;
}

/// In units of the last place of the float nearest to `expected`.
double ulps(float value, double expected) {
  int exponent = 0;
  std::frexp(expected, &exponent);
  return std::fabs(value - expected) / std::ldexp(1.0, std::max(exponent - 24, -149));
}

/// The largest error of a, and of b if there is one.
template <class A, class B>
void expect_within(double limit, const std::vector<float>& x, const std::vector<float>& y,
                   const Results& results, A&& a, B&& b) {
  double worst = 0;
  size_t at = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    const float other = y.empty() ? 0.0f : y[i];
    const double error = std::max(ulps(results.a[i], a(double{x[i]}, double{other})), b(i));
    if (error > worst || std::isnan(error)) {
      worst = error;
      at = i;
      if (std::isnan(error)) break;
    }
  }
  EXPECT_LE(worst, limit) << "at x = " << x[at] << ", y = " << (y.empty() ? 0.0f : y[at]) << ": "
                          << results.a[at] << ", " << results.b[at];
}

double no_b(size_t) { return 0; }

/// Every `step`-th finite float of either sign.
std::vector<float> finite_floats(uint32_t step) {
  std::vector<float> values;
  for (uint64_t bits = 0; bits < 0x7F800000; bits += step) {
    values.push_back(float_of(static_cast<uint32_t>(bits)));
    values.push_back(-values.back());
  }
  return values;
}

/// Floats from `low` to `high`, evenly.
std::vector<float> range(double low, double high, size_t count) {
  std::vector<float> values;
  for (size_t i = 0; i <= count; ++i) {
    values.push_back(static_cast<float>(low + (high - low) * static_cast<double>(i) /
                                                  static_cast<double>(count)));
  }
  return values;
}

void expect_sine_cosine(const std::vector<float>& x) {
  const Results r = evaluate(MathFunction::kSineCosine, x, {});
  expect_within(
      2, x, {}, r, [](double v, double) { return std::sin(v); },
      [&](size_t i) { return ulps(r.b[i], std::cos(double{x[i]})); });
}

TEST(MathFunctions, SineAndCosineOfAllFiniteFloats) {
  std::vector<float> floats = finite_floats(9973);
#if defined(_WIN32)
  printf("NOT TESTED: sines beyond 1e5 on Windows; its C library is not exact there\n");
  const auto is_large = [](float v) { return std::fabs(v) > 1e5f; };
  floats.erase(std::remove_if(floats.begin(), floats.end(), is_large), floats.end());
#endif
  expect_sine_cosine(floats);
  expect_sine_cosine(range(-20, 20, 200000));
}

// Where most of an angle cancels: the floats about multiples of pi/2, up to numbers that are reduced in
// another way.
TEST(MathFunctions, SineAndCosineNearTheirZeros) {
  std::vector<float> x;
  for (int k = 1; k < 1000; ++k) {
    const uint32_t bits = bits_of(static_cast<float>(k * 1.5707963267948966));
    for (uint32_t i = 0; i < 5; ++i) x.push_back(float_of(bits + i - 2) * (k % 2 ? 1.0f : -1.0f));
  }
  expect_sine_cosine(x);
}

TEST(MathFunctions, SineAndCosineOfSpecialValues) {
  const Results r = evaluate(MathFunction::kSineCosine,
                             {0.0f, -0.0f, kInfinity, -kInfinity, std::nanf(""), 0x1p-149f}, {});
  EXPECT_EQ(r.a[0], 0);
  EXPECT_EQ(r.a[1], 0);
  EXPECT_EQ(r.b[0], 1);
  EXPECT_EQ(r.b[1], 1);
  for (size_t i = 2; i < 5; ++i) EXPECT_TRUE(std::isnan(r.a[i]) && std::isnan(r.b[i])) << i;
  EXPECT_EQ(r.a[5], 0x1p-149f);
  EXPECT_EQ(r.b[5], 1);
}

TEST(MathFunctions, ArcTangentInEveryDirection) {
  Random random = Random::from_seed(71, 1);
  std::vector<float> x, y;
  for (int i = 0; i < 300000; ++i) {
    x.push_back(static_cast<float>(random.between(-1, 1)));
    y.push_back(static_cast<float>(random.between(-1, 1)));
  }
  const std::vector<float> all = finite_floats(100003);
  for (size_t i = 0; i < all.size(); ++i) {
    x.push_back(all[i]);
    y.push_back(all[random.below(static_cast<uint32_t>(all.size()))]);
    x.push_back(1);
    y.push_back(all[i]);
  }
  expect_within(
      2, x, y, evaluate(MathFunction::kArcTangent, x, y),
      [](double v, double w) { return std::atan2(w, v); }, no_b);
}

TEST(MathFunctions, ArcTangentOfSpecialValues) {
  std::vector<float> x, y;
  for (float v : {0.0f, -0.0f, 1.0f, -1.0f, kInfinity, -kInfinity}) {
    for (float w : {0.0f, -0.0f, 1.0f, -1.0f, kInfinity, -kInfinity}) {
      x.push_back(v);
      y.push_back(w);
    }
  }
  const Results r = evaluate(MathFunction::kArcTangent, x, y);
  for (size_t i = 0; i < x.size(); ++i) {
    SCOPED_TRACE("x = " + std::to_string(x[i]) + ", y = " + std::to_string(y[i]));
    if (std::isinf(x[i]) && std::isinf(y[i])) {
      EXPECT_TRUE(std::isnan(r.a[i]));
      continue;
    }
    const double expected = std::atan2(double{y[i]}, double{x[i]});
    EXPECT_LE(ulps(r.a[i], expected), 1);
    EXPECT_EQ(std::signbit(r.a[i]), std::signbit(expected));
  }
  const Results nan = evaluate(MathFunction::kArcTangent, {std::nanf(""), 1, std::nanf("")},
                               {1, std::nanf(""), std::nanf("")});
  for (float angle : nan.a) EXPECT_TRUE(std::isnan(angle));
}

TEST(MathFunctions, ArcCosines) {
  std::vector<float> x = range(-1, 1, 300000);
  for (uint32_t i = 0; i < 1000; ++i) {
    x.push_back(float_of(0x3F800000 - i));
    x.push_back(-x.back());
    x.push_back(float_of(i));
  }
  expect_within(
      2, x, {}, evaluate(MathFunction::kArcCosine, x, {}),
      [](double v, double) { return std::acos(v); }, no_b);
  // What rounding leaves beyond.
  const Results beyond =
      evaluate(MathFunction::kArcCosine, {1.0f, 1.0000001f, 2.0f, -1.0000001f}, {});
  EXPECT_EQ(beyond.a[0], 0);
  EXPECT_EQ(beyond.a[1], 0);
  EXPECT_EQ(beyond.a[2], 0);
  EXPECT_FLOAT_EQ(beyond.a[3], 3.14159274f);
}

TEST(MathFunctions, QuickRotationAngle) {
  std::vector<float> x = range(-1, 1, 400000);
  for (float v = 1; v > 0.999f; v = std::nextafter(v, 0.0f)) x.push_back(v);
  const Results angles = evaluate(MathFunction::kQuickRotationAngle, x, {});
  for (size_t i = 0; i < x.size(); ++i) {
    ASSERT_NEAR(angles.a[i], 2 * std::acos(std::fabs(double{x[i]})), 7e-7) << x[i];
  }
  const Results special = evaluate(
      MathFunction::kQuickRotationAngle,
      {1.0f, -1.0f, 1.0000001f, -2.0f, kInfinity, std::numeric_limits<float>::quiet_NaN()}, {});
  for (size_t i = 0; i < 5; ++i) EXPECT_EQ(special.a[i], 0) << i;
  EXPECT_TRUE(std::isnan(special.a[5]));
}

TEST(MathFunctions, ReciprocalRootOfAllPositiveFloats) {
  std::vector<float> x;
  for (float v : finite_floats(9973)) {
    if (v > 0) x.push_back(v);
  }
  expect_within(
      1.5, x, {}, evaluate(MathFunction::kReciprocalRoot, x, {}),
      [](double v, double) { return 1 / std::sqrt(v); }, no_b);
  const Results special = evaluate(MathFunction::kReciprocalRoot, {0.0f, kInfinity, -1.0f}, {});
  EXPECT_EQ(special.a[0], kInfinity);
  EXPECT_EQ(special.a[1], 0);
  EXPECT_TRUE(std::isnan(special.a[2]));
}

TEST(MathFunctions, BoundedSineAndCosine) {
  const std::vector<float> x = range(-1.57079633, 1.57079633, 200000);
  const Results r = evaluate(MathFunction::kBoundedSineCosine, x, {});
  for (size_t i = 0; i < x.size(); ++i) {
    ASSERT_NEAR(r.a[i], std::sin(double{x[i]}), 1.2e-7) << x[i];
    ASSERT_NEAR(r.b[i], std::cos(double{x[i]}), 1.2e-7) << x[i];
  }
}

TEST(MathFunctions, Exponentials) {
  const std::vector<float> powers = range(-125.99, 126, 300000);
  Results r = evaluate(MathFunction::kPowerOfTwoOrZero, powers, {});
  for (size_t i = 0; i < powers.size(); ++i) {
    ASSERT_NEAR(r.a[i] / std::exp2(double{powers[i]}), 1, 2.5e-7) << powers[i];
  }
  const std::vector<float> negative = range(-86.99, 0, 300000);
  r = evaluate(MathFunction::kExpOfNegative, negative, {});
  for (size_t i = 0; i < negative.size(); ++i) {
    ASSERT_NEAR(r.a[i] / std::exp(double{negative[i]}), 1, 2e-7) << negative[i];
  }
  r = evaluate(MathFunction::kPowerOfTwoOrZero, {-126, -1e30f, -kInfinity, std::nanf(""), 0}, {});
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(r.a[i], 0) << i;
  EXPECT_EQ(r.a[4], 1);
  r = evaluate(MathFunction::kExpOfNegative, {-87.5f, -1e30f, -kInfinity, 0}, {});
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(r.a[i], 0) << i;
  EXPECT_EQ(r.a[3], 1);
}

TEST(MathFunctions, RoundingIsExact) {
  std::vector<float> whole, x = range(-126, 126, 100000);
  for (int n = -126; n <= 127; ++n) whole.push_back(static_cast<float>(n));
  Results r = evaluate(MathFunction::kPowerOfTwo, whole, {});
  for (size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(r.a[i], std::ldexp(1.0f, static_cast<int>(whole[i])));
  }
  r = evaluate(MathFunction::kRoundToWhole, x, {});
  for (size_t i = 0; i < x.size(); ++i) {
    ASSERT_LE(std::fabs(r.a[i] - x[i]), 0.5f) << x[i];
    ASSERT_EQ(r.a[i], std::nearbyint(r.a[i]));
    ASSERT_EQ(r.b[i], std::ldexp(1.0f, static_cast<int>(r.a[i])));
  }
  x = range(-4194304, 4194304, 100000);
  for (float tie : {0.5f, 1.5f, 2.5f, -0.5f, -1.5f}) x.push_back(tie);
  r = evaluate(MathFunction::kNearest, x, {});
  for (size_t i = 0; i < x.size(); ++i) ASSERT_EQ(r.a[i], std::nearbyint(x[i])) << x[i];
}

// The host may have told the processor to round in another direction. Reductions go to the nearest
// whole number all the same, so polynomials stay in their range and what is lost is a few units.
TEST(MathFunctions, ReduceToTheNearestWhateverTheHostRoundsTo) {
  const struct {
    MathFunction function;
    float low, high, within;
    double (*exact)(double);
    double (*second)(double);
  } cases[] = {
      {MathFunction::kSineCosine, -250, 250, 1e-6f, [](double v) { return std::sin(v); },
       [](double v) { return std::cos(v); }},
      {MathFunction::kExpOfNegative, -80, 0, 1e-6f, [](double v) { return std::exp(v); }, nullptr},
      {MathFunction::kPowerOfTwoOrZero, -120, 0, 1e-6f, [](double v) { return std::exp2(v); },
       nullptr},
      {MathFunction::kRoundToWhole, -125, 125, 0.5f, [](double v) { return v; }, nullptr},
      {MathFunction::kNearest, -4e6f, 4e6f, 0.5f, [](double v) { return v; }, nullptr},
  };
  const int directions[] = {
#if defined(FE_UPWARD) && defined(FE_DOWNWARD) && defined(FE_TOWARDZERO)
    FE_UPWARD,
    FE_DOWNWARD,
    FE_TOWARDZERO,
#endif
    FE_TONEAREST
  };
  for (const auto& one : cases) {
    std::vector<float> x = range(one.low, one.high, 30000);
    for (float tie : {0.5f, 1.5f, 2.5f}) x.push_back(-tie);
    const size_t count = (x.size() + kStep - 1) / kStep * kStep;
    Floats in(count), a(count), b(count);
    std::copy(x.begin(), x.end(), in.data);
    for (const MathProbe* probe : present()) {
      for (const int direction : directions) {
        const int before = std::fegetround();
        if (std::fesetround(direction) != 0) continue;
        probe->vectors({one.function, in.data, in.data, a.data, b.data, count});
        std::fesetround(before);
        for (size_t i = 0; i < x.size(); ++i) {
          const double exact = one.exact(double{x[i]});
          ASSERT_NEAR(a.data[i], exact, one.within)
              << isa_name(probe->isa) << ", direction " << direction << ", x = " << x[i];
          if (one.within == 0.5f) {
            ASSERT_EQ(a.data[i], std::nearbyint(a.data[i])) << x[i];
          }
          if (one.second) {
            ASSERT_NEAR(b.data[i], one.second(double{x[i]}), one.within) << x[i];
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace mien
