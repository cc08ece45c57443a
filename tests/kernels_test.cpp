// SPDX-License-Identifier: MIT
// Each kernel on each instruction set that this CPU has, bit for bit against plain loops, and the
// choice among them.
#include "simd/kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "simd/cpu_features.h"

namespace mien {
namespace {

std::vector<const KernelTable*> present_kernels() {
  std::vector<const KernelTable*> tables;
  for (uint32_t i = 1; i < kIsaCount; ++i) {
    if (const KernelTable* table = kernels_for(static_cast<Isa>(i))) tables.push_back(table);
  }
  return tables;
}

bool is_fused(Isa isa) { return isa == Isa::kAvx2 || isa == Isa::kAvx512 || isa == Isa::kNeon; }

float fused(float a, float b, float c) { return std::fma(a, b, c); }

float rounded_twice(float a, float b, float c) {
  const volatile float product = a * b;  // volatile: this file may be built with contraction on
  return product + c;
}

uint32_t bits_of(float value) {
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// A joint group with awkward numbers; the same for the same counts.
class JointGroup {
 public:
  JointGroup(uint32_t column_count, uint32_t block_count)
      : column_count_(column_count), block_count_(block_count),
        state_(column_count * 131 + block_count + 1),
        storage_(size_t{column_count} * block_count * kBlockRows + 16), controls_(400) {
    for (float& control : controls_) control = awkward_number();
    for (uint32_t c = 0; c < column_count; ++c) {
      columns_.push_back(static_cast<uint16_t>(random() % controls_.size()));
    }
    for (size_t i = 0; i < value_count(); ++i) values()[i] = awkward_number();
  }

  /// Sums by one instruction set. Scratch and sums are written where they should be and nowhere
  /// else; sums need no alignment.
  std::vector<float> run(const KernelTable& kernels) {
    const float untouched = 12345.0f;
    std::vector<float> inputs(column_count_ + 16, untouched);
    std::vector<float> sums(1 + row_count() + 16, untouched);
    kernels.joint_group({values(), columns_.data(), controls_.data(), inputs.data(),
                         sums.data() + 1, column_count_, block_count_});
    EXPECT_EQ(sums[0], untouched);
    for (size_t i = 0; i < 16; ++i) {
      EXPECT_EQ(inputs[column_count_ + i], untouched);
      EXPECT_EQ(sums[1 + row_count() + i], untouched);
    }
    return {sums.begin() + 1, sums.begin() + 1 + static_cast<ptrdiff_t>(row_count())};
  }

  /// The same sums by a plain loop with the given multiply-add.
  template <class MulAdd>
  std::vector<float> expected(MulAdd mul_add) {
    std::vector<float> sums(row_count(), 0.0f);
    for (size_t row = 0; row < row_count(); ++row) {
      for (uint32_t c = 0; c < column_count_; ++c) {
        sums[row] = mul_add(value(row, c), controls_[columns_[c]], sums[row]);
      }
    }
    return sums;
  }

  double exact(size_t row, double* out_sum_of_sizes) {
    double sum = 0.0;
    *out_sum_of_sizes = 0.0;
    for (uint32_t c = 0; c < column_count_; ++c) {
      const double product = double{value(row, c)} * double{controls_[columns_[c]]};
      sum += product;
      *out_sum_of_sizes += std::abs(product);
    }
    return sum;
  }

  size_t row_count() const { return size_t{block_count_} * kBlockRows; }

 private:
  size_t value_count() const { return row_count() * column_count_; }

  float* values() {
    const uintptr_t address = reinterpret_cast<uintptr_t>(storage_.data());
    return storage_.data() + (64 - address % 64) % 64 / sizeof(float);
  }

  float value(size_t row, uint32_t column) {
    const size_t block = row / kBlockRows;
    return values()[(block * column_count_ + column) * kBlockRows + row % kBlockRows];
  }

  uint32_t random() {
    state_ = state_ * 1664525u + 1013904223u;
    return state_ >> 8;
  }

  float awkward_number() {
    switch (random() % 16) {
      case 0: return 0.0f;
      case 1: return -0.0f;
      case 2: return 1.0f;
      case 3: return std::numeric_limits<float>::denorm_min() * static_cast<float>(random() % 9999);
      case 4: return -std::numeric_limits<float>::min() / 3.0f;
      case 5: return static_cast<float>(random()) * 1e-30f;
      default: return (static_cast<float>(random() % 2000003) - 1e6f) * 1e-6f;
    }
  }

  uint32_t column_count_, block_count_, state_;
  std::vector<float> storage_, controls_;
  std::vector<uint16_t> columns_;
};

/// Calls check(group, kernels) for odd sizes on each instruction set present. Fifteen blocks take
/// every path of the widest one: eight, four, two and one vectors at a time.
template <class Check>
void for_each_group(Check check) {
  for (const KernelTable* kernels : present_kernels()) {
    for (uint32_t column_count : {0u, 1u, 2u, 3u, 17u, 300u}) {
      for (uint32_t block_count : {0u, 1u, 2u, 3u, 5u, 8u, 15u}) {
        SCOPED_TRACE(std::string(kernels->name) + ", columns " + std::to_string(column_count) +
                     ", blocks " + std::to_string(block_count));
        JointGroup group(column_count, block_count);
        check(group, *kernels);
      }
    }
  }
}

TEST(JointGroupKernel, BitEqualToPlainLoopOfItsFamily) {
  for_each_group([](JointGroup& group, const KernelTable& kernels) {
    const std::vector<float> sums = group.run(kernels);
    const std::vector<float> expected =
        is_fused(kernels.isa) ? group.expected(fused) : group.expected(rounded_twice);
    for (size_t row = 0; row < group.row_count(); ++row) {
      ASSERT_EQ(bits_of(sums[row]), bits_of(expected[row])) << "row " << row;
    }
  });
}

TEST(JointGroupKernel, CloseToDoublePrecision) {
  for_each_group([](JointGroup& group, const KernelTable& kernels) {
    const std::vector<float> sums = group.run(kernels);
    for (size_t row = 0; row < group.row_count(); ++row) {
      double sum_of_sizes;
      const double exact = group.exact(row, &sum_of_sizes);
      ASSERT_NEAR(sums[row], exact, 302 * 1.2e-7 * sum_of_sizes + 302 * 1.5e-45) << "row " << row;
    }
  });
}

TEST(JointGroupKernel, TestDataTellsTheFamiliesApart) {
  JointGroup group(300, 5);
  EXPECT_NE(group.expected(fused), group.expected(rounded_twice));
}

TEST(KernelsFor, TablesKnowTheirNames) {
  std::printf("present:");
  for (const KernelTable* kernels : present_kernels()) {
    std::printf(" %s", kernels->name);
    EXPECT_STREQ(kernels->name, isa_name(kernels->isa));
    EXPECT_EQ(kernels_for(kernels->isa), kernels);
  }
  std::printf("\n");
  ASSERT_NE(kernels_for(Isa::kScalar), nullptr);
  EXPECT_STREQ(isa_name(Isa::kBest), "best");
  EXPECT_STREQ(isa_name(static_cast<Isa>(kIsaCount)), "unknown");
  EXPECT_STREQ(isa_name(static_cast<Isa>(0xffffffffu)), "unknown");
}

TEST(KernelsFor, AbsentIsNull) {
  EXPECT_EQ(kernels_for(static_cast<Isa>(kIsaCount)), nullptr);
  EXPECT_EQ(kernels_for(static_cast<Isa>(0xffffffffu)), nullptr);
#if defined(__x86_64__)
  EXPECT_EQ(kernels_for(Isa::kNeon), nullptr);
#elif defined(__aarch64__)
  for (Isa isa : {Isa::kSse2, Isa::kAvx2, Isa::kAvx512}) EXPECT_EQ(kernels_for(isa), nullptr);
#endif
}

// The compiler's own detection is a second opinion (for clang 14 without F16C, of which it does not
// know: every CPU with AVX2 has it).
TEST(KernelsFor, AgreesWithCompilersDetection) {
#if defined(__x86_64__)
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  const Isa best = avx512 ? Isa::kAvx512 : avx2 ? Isa::kAvx2 : Isa::kSse2;
  EXPECT_NE(kernels_for(Isa::kSse2), nullptr);
  EXPECT_EQ(kernels_for(Isa::kAvx2) != nullptr, avx2);
  EXPECT_EQ(kernels_for(Isa::kAvx512) != nullptr, avx512);
  EXPECT_EQ(kernels_for(Isa::kBest)->isa, best);
#elif defined(__aarch64__)
  EXPECT_EQ(kernels_for(Isa::kBest)->isa, Isa::kNeon);
#else
  GTEST_SKIP() << "nothing to compare with";
#endif
}

TEST(CpuFeatures, WiderImpliesNarrower) {
  const CpuFeatures cpu = detect_cpu_features();
  EXPECT_TRUE(cpu.avx2 || !cpu.avx512);
  EXPECT_TRUE(cpu.sse2 || !cpu.avx2);
  EXPECT_FALSE(cpu.sse2 && cpu.neon);
}

/// MIEN_ISA for the time of one test.
class ChooseKernels : public ::testing::Test {
 protected:
  ChooseKernels() {
    if (const char* value = std::getenv("MIEN_ISA")) {
      was_set_ = true;
      before_ = value;
    }
    unsetenv("MIEN_ISA");
  }
  ~ChooseKernels() override {
    was_set_ ? setenv("MIEN_ISA", before_.c_str(), 1) : unsetenv("MIEN_ISA");
  }
  static const KernelTable* choose(const char* environment, Isa isa = Isa::kBest) {
    setenv("MIEN_ISA", environment, 1);
    return choose_kernels(isa);
  }

 private:
  bool was_set_ = false;
  std::string before_;
};

TEST_F(ChooseKernels, BestWithoutEnvironment) {
  EXPECT_EQ(choose_kernels(Isa::kBest), kernels_for(Isa::kBest));
  EXPECT_EQ(choose("", Isa::kBest), kernels_for(Isa::kBest));
  EXPECT_EQ(choose("best", Isa::kBest), kernels_for(Isa::kBest));
}

TEST_F(ChooseKernels, EveryNameRoundTrips) {
  for (uint32_t i = 0; i < kIsaCount; ++i) {
    const Isa isa = static_cast<Isa>(i);
    EXPECT_EQ(choose(isa_name(isa)), kernels_for(isa)) << isa_name(isa);
  }
}

TEST_F(ChooseKernels, UnknownNameIsNull) {
  for (const char* name : {"unknown", "AVX2", "avx", "avx2 ", "2"}) {
    EXPECT_EQ(choose(name), nullptr) << name;
  }
}

TEST_F(ChooseKernels, ArgumentGoesBeforeEnvironment) {
  EXPECT_EQ(choose("unknown", Isa::kScalar), kernels_for(Isa::kScalar));
  for (const KernelTable* kernels : present_kernels()) {
    EXPECT_EQ(choose("scalar", kernels->isa), kernels);
  }
}

}  // namespace
}  // namespace mien
