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

/// A joint matrix with awkward numbers; the same for the same counts. Every column holds some of
/// the blocks; the kernel works on those in the middle, as if the others were other chunks.
class JointMatrix {
 public:
  static constexpr uint32_t kFirstBlock = 3;
  static constexpr uint32_t kUnknown = 2;  // columns that are not evaluated, between the others

  JointMatrix(uint32_t column_count, uint32_t block_count, bool fixed)
      : fixed_(fixed), block_count_(block_count), state_(column_count * 131 + block_count + 1) {
    for (uint32_t k = 0; k < column_count * kUnknown + 1; ++k) {
      first_pieces_.push_back(static_cast<uint32_t>(blocks_.size()));
      uint16_t counts[3] = {};  // pieces before, within and behind the chunk
      for (uint32_t b = 0; b < kFirstBlock + block_count + 2; ++b) {
        if (random() % 3 == 0) continue;
        blocks_.push_back(static_cast<uint16_t>(b * kBlockUnit));
        ++counts[b < kFirstBlock ? 0 : (b < kFirstBlock + block_count ? 1 : 2)];
      }
      ends_.push_back(counts[0]);
      ends_.push_back(static_cast<uint16_t>(counts[0] + counts[1]));
    }
    for (uint32_t i = 0; i < column_count; ++i) {
      columns_.push_back(static_cast<uint16_t>(i * kUnknown));
      inputs_.push_back(awkward_number());
    }
    const size_t value_count = blocks_.size() * kPieceRows;
    floats_.resize(value_count + 16);
    integers_.resize(value_count + 32);
    for (size_t i = 0; i < value_count; ++i) {
      integer_values()[i] = static_cast<int16_t>(random() % 65535 - 32767);
      float_values()[i] = fixed ? static_cast<float>(integer_values()[i]) : awkward_number();
    }
    for (size_t i = 0; i < sum_count(); ++i) initial_.push_back(awkward_number());
  }

  /// Sums by one instruction set; only those of the chunk are written.
  std::vector<float> run(const KernelTable& kernels) {
    const float untouched = 12345.0f;
    std::vector<float> storage(16 + kGuard + sum_count() + kGuard, untouched);
    float* sums = aligned(storage.data()) + kGuard;
    std::copy(initial_.begin(), initial_.end(), sums);
    JointColumnsArgs args = {};
    args.values = fixed_ ? static_cast<const void*>(integer_values()) : float_values();
    args.blocks = blocks_.data();
    args.first_pieces = first_pieces_.data();
    args.begins = ends_.data();
    args.ends = ends_.data() + 1;
    args.stride = 2;
    args.columns = columns_.data();
    args.inputs = inputs_.data();
    args.sums = sums;
    args.column_count = static_cast<uint32_t>(columns_.size());
    args.first_block = kFirstBlock;
    (fixed_ ? kernels.joint_columns_fixed : kernels.joint_columns)(args);
    for (size_t i = 0; i < kGuard; ++i) {
      EXPECT_EQ(sums[-1 - static_cast<ptrdiff_t>(i)], untouched);
      EXPECT_EQ(sums[sum_count() + i], untouched);
    }
    return {sums, sums + sum_count()};
  }

  /// The same sums by a plain loop with the given multiply-add.
  template <class Number, class MulAdd>
  std::vector<Number> expected(MulAdd mul_add) {
    std::vector<Number> sums(initial_.begin(), initial_.end());
    for (size_t i = 0; i < columns_.size(); ++i) {
      const size_t k = columns_[i];
      for (size_t p = ends_[2 * k]; p < ends_[2 * k + 1]; ++p) {
        const size_t piece = first_pieces_[k] + p;
        for (size_t r = 0; r < kPieceRows; ++r) {
          Number& sum = sums[(blocks_[piece] / kBlockUnit - kFirstBlock) * kPieceRows + r];
          sum = mul_add(Number{float_values()[piece * kPieceRows + r]}, Number{inputs_[i]}, sum);
        }
      }
    }
    return sums;
  }

  size_t sum_count() const { return size_t{block_count_} * kPieceRows; }

 private:
  static constexpr size_t kGuard = 16;

  template <class T>
  static T* aligned(T* storage) {
    const uintptr_t address = reinterpret_cast<uintptr_t>(storage);
    return storage + (64 - address % 64) % 64 / sizeof(T);
  }
  float* float_values() { return aligned(floats_.data()); }
  int16_t* integer_values() { return aligned(integers_.data()); }

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

  bool fixed_;
  uint32_t block_count_, state_;
  std::vector<uint32_t> first_pieces_;
  std::vector<uint16_t> blocks_, ends_, columns_;
  std::vector<float> inputs_, floats_, initial_;
  std::vector<int16_t> integers_;
};

/// Calls check(matrix, kernels) for odd sizes on each instruction set present.
template <class Check>
void for_each_matrix(Check check) {
  for (const KernelTable* kernels : present_kernels()) {
    for (uint32_t column_count : {0u, 1u, 2u, 17u, 300u}) {
      for (uint32_t block_count : {0u, 1u, 2u, 3u, 7u, 40u}) {
        for (bool fixed : {false, true}) {
          SCOPED_TRACE(std::string(kernels->name) + ", columns " + std::to_string(column_count) +
                       ", blocks " + std::to_string(block_count) + (fixed ? ", fixed" : ""));
          JointMatrix matrix(column_count, block_count, fixed);
          check(matrix, *kernels);
        }
      }
    }
  }
}

TEST(JointColumnsKernel, BitEqualToPlainLoopOfItsFamily) {
  for_each_matrix([](JointMatrix& matrix, const KernelTable& kernels) {
    const std::vector<float> sums = matrix.run(kernels);
    const std::vector<float> expected = is_fused(kernels.isa)
                                            ? matrix.expected<float>(fused)
                                            : matrix.expected<float>(rounded_twice);
    for (size_t i = 0; i < sums.size(); ++i) {
      ASSERT_EQ(bits_of(sums[i]), bits_of(expected[i])) << "sum " << i;
    }
  });
}

TEST(JointColumnsKernel, CloseToDoublePrecision) {
  for_each_matrix([](JointMatrix& matrix, const KernelTable& kernels) {
    const std::vector<float> sums = matrix.run(kernels);
    const auto multiply_add = [](double a, double b, double c) { return a * b + c; };
    const auto add_sizes = [](double a, double b, double c) {
      return std::abs(a * b) + std::abs(c);
    };
    const std::vector<double> exact = matrix.expected<double>(multiply_add);
    const std::vector<double> sizes = matrix.expected<double>(add_sizes);
    for (size_t i = 0; i < sums.size(); ++i) {
      ASSERT_NEAR(sums[i], exact[i], 302 * 1.2e-7 * std::abs(sizes[i]) + 302 * 1.5e-45)
          << "sum " << i;
    }
  });
}

TEST(JointColumnsKernel, TestDataTellsTheFamiliesApart) {
  JointMatrix matrix(300, 5, false);
  EXPECT_NE(matrix.expected<float>(fused), matrix.expected<float>(rounded_twice));
}

TEST(FinishSumsKernel, ScalesAndSaturates) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  const float infinity = std::numeric_limits<float>::infinity();
  alignas(64) const float scales[8] = {2, 0.5f, 1, 1, 1, 4, 0, -1};
  for (const KernelTable* kernels : present_kernels()) {
    SCOPED_TRACE(kernels->name);
    alignas(64) float sums[16] = {1, 2, -3, infinity, -infinity, kLargest, 5, 6};
    std::copy(sums, sums + 8, sums + 8);
    sums[8 + 3] = std::numeric_limits<float>::quiet_NaN();
    kernels->finish_sums(sums, scales, 8);
    kernels->finish_sums(sums + 8, nullptr, 8);
    const float scaled[] = {2, 1, -3, kLargest, -kLargest, kLargest, 0, -6};
    const float plain[] = {1, 2, -3, -kLargest, -kLargest, kLargest, 5, 6};
    for (size_t i = 0; i < 8; ++i) {
      EXPECT_EQ(sums[i], scaled[i]) << i;
      EXPECT_EQ(sums[8 + i], plain[i]) << i;
    }
  }
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
