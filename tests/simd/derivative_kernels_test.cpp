// SPDX-License-Identifier: MIT
// The transposed products on each instruction set, against sums in double precision, with the bits of their
// families.
#include "simd/derivative_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <vector>

#include "author/base/random.h"
#include "tests/simd/present_kernels.h"

namespace mien {
namespace {

template <class T>
const T* aligned(const std::vector<T>& storage) {
  const auto address = reinterpret_cast<uintptr_t>(storage.data());
  return storage.data() + (64 - address % 64) % 64 / sizeof(T);
}

template <class T>
T* aligned(std::vector<T>& storage) {
  return const_cast<T*>(aligned(static_cast<const std::vector<T>&>(storage)));
}

bool is_fused(Isa isa) { return isa == Isa::kAvx2 || isa == Isa::kAvx512 || isa == Isa::kNeon; }

/// Columns of random blocks, pairs first.
struct Matrix {
  std::vector<float> floats;
  std::vector<int16_t> integers;
  std::vector<uint16_t> numbers;
  std::vector<JointRun> runs;
  std::vector<std::vector<InputBlock>> blocks[2];  // [even or odd block row][column]
  uint32_t block_rows;

  Matrix(Random& random, uint32_t columns, uint32_t rows) : block_rows(rows) {
    uint32_t block = 0;
    for (uint32_t c = 0; c < columns; ++c) {
      std::vector<uint32_t> pairs, singles;
      for (uint32_t b = 0; b < rows; b += 2) {
        const uint32_t kind = random.below(4);
        if (kind == 3 && b + 1 < rows) pairs.push_back(b);
        if (kind == 1) singles.push_back(b);
        if (kind == 2 && b + 1 < rows) singles.push_back(b + 1);
      }
      JointRun run = {};
      run.start = {block, static_cast<uint32_t>(numbers.size()), 0, 0};
      run.pair_count = static_cast<uint32_t>(pairs.size());
      run.single_count = static_cast<uint32_t>(singles.size());
      for (auto& half : blocks) half.emplace_back();
      for (const uint32_t b : pairs) {
        numbers.push_back(static_cast<uint16_t>(b * kBlockRowUnit + random.below(2)));
        for (uint32_t half = 0; half < 2; ++half) {
          blocks[half][c].push_back({block++, b + half});
        }
      }
      run.start.first_single = block;
      run.start.single_entry = static_cast<uint32_t>(numbers.size());
      for (const uint32_t b : singles) {
        numbers.push_back(static_cast<uint16_t>(b * kBlockRowUnit));
        blocks[b % 2][c].push_back({block++, b});
      }
      block += block % 2;
      runs.push_back(run);
    }
    floats.resize(size_t{block} * kJointBlockRows + 32);
    integers.resize(size_t{block} * kJointBlockRows + 64);
    for (size_t i = 0; i < size_t{block} * kJointBlockRows; ++i) {
      const int number = static_cast<int>(random.below(65535)) - 32767;
      aligned(integers)[i] = static_cast<int16_t>(number);
      aligned(floats)[i] = static_cast<float>(number) / 1024;
    }
  }
};

struct TransposedCase {
  const Matrix& matrix;
  const float* lanes;  // [row][kBatchLanes]
  bool fixed, portable;
};

/// The products of all columns with lanes `first` ... `first` + lane_count - 1: [column][lane].
std::vector<float> transposed_products(const KernelTable& kernels, const TransposedCase& of,
                                       uint32_t first, uint32_t lane_count) {
  const Matrix& m = of.matrix;
  const uint32_t pairs = (m.block_rows + 1) / 2;
  std::vector<float> storage(size_t{pairs} * 2 * kJointBlockRows * lane_count + 16);
  for (size_t row = 0; row < size_t{m.block_rows} * kJointBlockRows; ++row) {
    for (size_t k = 0; k < lane_count; ++k) {
      const size_t pair = row / (2 * kJointBlockRows), in_pair = row % (2 * kJointBlockRows);
      aligned(storage)[(pair * lane_count + k) * 2 * kJointBlockRows + in_pair] =
          of.lanes[row * kBatchLanes + first + k];
    }
  }
  std::vector<float> sums(m.runs.size() * lane_count);
  JointTransposedArgs args = {};
  args.values = of.fixed ? static_cast<const void*>(aligned(m.integers)) : aligned(m.floats);
  args.block_rows = m.numbers.data();
  args.runs = m.runs.data();
  args.run_count = static_cast<uint32_t>(m.runs.size());
  args.rows = aligned(storage);
  args.outputs = sums.data();
  args.lane_count = lane_count;
  args.portable = of.portable;
  (of.fixed ? kernels.joint_transposed_fixed : kernels.joint_transposed)(args);
  return sums;
}

void expect_near_exact(const TransposedCase& of, size_t column, uint32_t lane, float sum) {
  double exact = 0, size = 0;
  for (const auto& half : of.matrix.blocks) {
    for (const InputBlock& b : half[column]) {
      for (size_t r = 0; r < kJointBlockRows; ++r) {
        const size_t at = size_t{b.block} * kJointBlockRows + r;
        const double value = of.fixed ? static_cast<double>(aligned(of.matrix.integers)[at])
                                      : double{aligned(of.matrix.floats)[at]};
        const double product =
            value * of.lanes[(b.input * kJointBlockRows + r) * kBatchLanes + lane];
        exact += product;
        size += std::fabs(product);
      }
    }
  }
  EXPECT_NEAR(sum, exact, 1e-5 * size);
}

// Columns of different lengths, more and fewer than are multiplied at a time; lanes as single gradients.
TEST(JointTransposedKernels, HaveTheBitsOfTheirFamilyInLanesAndAlone) {
  Random random = Random::from_seed(72, 1);
  for (const uint32_t rows : {1u, 2u, 7u, 40u}) {
    Matrix m(random, 11, rows);
    std::vector<float> storage(size_t{rows + 1} * kJointBlockRows * kBatchLanes + 64);
    float* const lanes = aligned(storage);
    for (size_t i = 0; i < size_t{rows} * kJointBlockRows * kBatchLanes; ++i) {
      lanes[i] = static_cast<float>(random.between(-1, 1));
    }
    for (const bool fixed : {false, true}) {
      for (const bool portable : {false, true}) {
        const TransposedCase of = {m, lanes, fixed, portable};
        std::map<bool, std::vector<float>> of_family;
        for (const KernelTable* kernels : present_kernels()) {
          SCOPED_TRACE(kernels->name);
          const std::vector<float> together =
              transposed_products(*kernels, of, 13, kTransposedLanes);
          for (uint32_t k = 0; k < kTransposedLanes; ++k) {
            const std::vector<float> alone = transposed_products(*kernels, of, 13 + k, 1);
            for (size_t c = 0; c < m.runs.size(); ++c) {
              EXPECT_EQ(together[c * kTransposedLanes + k], alone[c]) << c << ", " << k;
              expect_near_exact(of, c, 13 + k, alone[c]);
            }
          }
          const auto [first, is_new] =
              of_family.emplace(is_fused(kernels->isa) && !portable, together);
          if (!is_new) {
            EXPECT_EQ(first->second, together);
          }
        }
      }
    }
  }
}

TEST(SkinTransposedKernel, IsTheTransposedSkin) {
  Random random = Random::from_seed(72, 2);
  constexpr uint32_t kMatrices = 5, kCount = 6;
  for (const uint32_t influences : {1u, 3u, 9u}) {
    std::vector<float> positions(kCount * 4 + 16), weights(kCount * influences),
        gradients(kCount * 3 + 4);
    std::vector<float> skins(kMatrices * 16 + 16);
    std::vector<uint16_t> joints(kCount * influences);
    std::vector<uint16_t> indices = {3, 0, 5, 1, 4, 2};
    for (std::vector<float>* row : {&positions, &weights, &gradients, &skins}) {
      for (float& v : *row) v = static_cast<float>(random.between(-1, 1));
    }
    for (uint16_t& j : joints) j = static_cast<uint16_t>(random.below(kMatrices));
    for (const KernelTable* kernels : present_kernels()) {
      SCOPED_TRACE(kernels->name);
      std::vector<float> matrices(kMatrices * 12), out(kCount * 4);
      SkinTransposedArgs args = {};
      args.positions = positions.data();
      args.weights = weights.data();
      args.joints = joints.data();
      args.position_indices = indices.data();
      args.gradients = gradients.data();
      args.skins = aligned(skins);
      args.matrices = matrices.data();
      args.out_positions = out.data();
      args.count = kCount;
      args.influences = influences;
      kernels->skin_transposed(args);
      std::vector<double> expected(kMatrices * 12), moved(kCount * 3);
      for (size_t i = 0; i < kCount; ++i) {
        for (size_t k = 0; k < influences; ++k) {
          const size_t at = i * influences + k, joint = joints[at];
          for (size_t r = 0; r < 3; ++r) {
            const double g = double{weights[at]} * gradients[indices[i] * 3 + r];
            for (size_t c = 0; c < 4; ++c) {
              expected[joint * 12 + 4 * r + c] += g * (c < 3 ? positions[i * 4 + c] : 1.0);
            }
            for (size_t c = 0; c < 3; ++c) {
              moved[i * 3 + c] += g * aligned(skins)[joint * 16 + 4 * c + r];
            }
          }
        }
      }
      for (size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(matrices[i], expected[i], 1e-5);
      for (size_t i = 0; i < moved.size(); ++i) {
        EXPECT_NEAR(out[i / 3 * 4 + i % 3], moved[i], 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace mien
