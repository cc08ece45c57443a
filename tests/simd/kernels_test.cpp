// SPDX-License-Identifier: MIT
// Each kernel on each instruction set that this CPU has, bit for bit against plain loops, and the
// choice among them.
#include "simd/kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "runtime/base/bits.h"
#include "simd/cpu_features.h"
#include "tests/simd/present_kernels.h"

namespace mien {
namespace {

bool is_fused(Isa isa) { return isa == Isa::kAvx2 || isa == Isa::kAvx512 || isa == Isa::kNeon; }

/// The product is exact as a double. What the sum loses makes it odd, so that rounding it to a float
/// rounds once. Not every C library has a correct fma().
float fused(float a, float b, float c) {
  const double product = double{a} * double{b};
  double sum = product + double{c};
  const double added = sum - product;
  const double lost = (product - (sum - added)) + (double{c} - added);
  uint64_t bits;
  memcpy(&bits, &sum, sizeof(bits));
  if (lost != 0 && bits % 2 == 0) bits += (lost > 0) == (sum > 0) ? 1 : ~uint64_t{0};
  memcpy(&sum, &bits, sizeof(bits));
  return static_cast<float>(sum);
}

float rounded_twice(float a, float b, float c) {
  const volatile float product = a * b;  // volatile: this file may be built with contraction on
  return product + c;
}

/// A joint matrix with awkward numbers; the same for the same counts. Every column holds some of
/// the block rows, which begin at kFirstBlockRow; of some columns only a part is evaluated.
class JointMatrix {
 public:
  static constexpr uint32_t kFirstBlockRow = 4;
  static constexpr uint32_t kUnknown = 2;  // columns that are not evaluated, between the others

  JointMatrix(uint32_t column_count, uint32_t block_row_count, bool fixed)
      : fixed_(fixed), block_row_count_(block_row_count),
        state_(column_count * 131 + block_row_count + 1) {
    uint32_t block = 0;
    for (uint32_t k = 0; k < column_count * kUnknown; ++k) {
      std::vector<uint16_t> pairs, singles;
      for (uint32_t b = 0; b < block_row_count; b += 2) {
        const uint32_t kind = random() % 4;
        const bool first = kind & 1, second = (kind & 2) && b + 1 < block_row_count;
        const uint32_t number = kFirstBlockRow + b;
        // Whether the number of a pair is even is nobody's concern.
        const uint32_t odd = random() % 2;
        if (first && second) pairs.push_back(static_cast<uint16_t>((number + odd) * kBlockRowUnit));
        if (first && !second) singles.push_back(static_cast<uint16_t>(number * kBlockRowUnit));
        if (!first && second)
          singles.push_back(static_cast<uint16_t>((number + 1) * kBlockRowUnit));
      }
      const auto entry = static_cast<uint32_t>(block_rows_.size());
      block_rows_.insert(block_rows_.end(), pairs.begin(), pairs.end());
      block_rows_.insert(block_rows_.end(), singles.begin(), singles.end());
      const auto pair_count = static_cast<uint32_t>(pairs.size());
      const auto single_count = static_cast<uint32_t>(singles.size());
      if (k % kUnknown == 0) {
        const uint32_t skipped_pairs = pair_count ? random() % 2 : 0;
        const uint32_t skipped_singles = single_count ? random() % 2 : 0;
        runs_.push_back(
            {{block + 2 * skipped_pairs, entry + skipped_pairs,
              block + 2 * pair_count + skipped_singles, entry + pair_count + skipped_singles},
             pair_count - skipped_pairs,
             single_count - skipped_singles,
             awkward_number()});
      }
      block += 2 * pair_count + single_count + single_count % 2;
    }
    const size_t value_count = size_t{block} * kJointBlockRows;
    floats_.resize(value_count + 16);
    integers_.resize(value_count + 32);
    for (size_t i = 0; i < value_count; ++i) {
      integer_values()[i] = static_cast<int16_t>(random() % 65535 - 32767);
      float_values()[i] = fixed ? static_cast<float>(integer_values()[i]) : awkward_number();
    }
    for (size_t i = 0; i < sum_count(); ++i) initial_.push_back(awkward_number());
  }

  template <class T>
  static T* aligned(T* storage) {
    const uintptr_t address = reinterpret_cast<uintptr_t>(storage);
    return storage + (64 - address % 64) % 64 / sizeof(T);
  }

  /// Sums by one instruction set; only those of the block rows are written.
  std::vector<float> run(const KernelTable& kernels) {
    const float untouched = 12345.0f;
    std::vector<float> storage(16 + kGuard + sum_count() + kGuard, untouched);
    float* sums = aligned(storage.data()) + kGuard;
    std::copy(initial_.begin(), initial_.end(), sums);
    JointColumnsArgs args = {};
    args.values = values();
    args.block_rows = block_rows_.data();
    args.runs = runs_.data();
    args.run_count = static_cast<uint32_t>(runs_.size());
    args.sums = sums - size_t{kFirstBlockRow} * kJointBlockRows;
    (fixed_ ? kernels.joint_columns_fixed : kernels.joint_columns)(args);
    for (size_t i = 0; i < kGuard; ++i) {
      EXPECT_EQ(sums[-1 - static_cast<ptrdiff_t>(i)], untouched);
      EXPECT_EQ(sums[sum_count() + i], untouched);
    }
    return {sums, sums + sum_count()};
  }

  /// Sums of `lane_count` characters with inputs of their own, block row after block row, from 0:
  /// [character][sum]. What stands beside them is not touched.
  std::vector<float> run_batch(const KernelTable& kernels, uint32_t lane_count) {
    const size_t stride = sum_count() + kJointBlockRows;
    std::vector<float> storage(16 + kBatchLanes * stride), inputs(16 + runs_.size() * kBatchLanes);
    float* const sums = aligned(storage.data());
    float* const lanes = aligned(inputs.data());
    for (size_t i = 0; i < runs_.size(); ++i) {
      for (uint32_t k = 0; k < lane_count; ++k) lanes[i * kBatchLanes + k] = input_of(i, k);
    }
    JointBatchArgs args = {};
    args.values = values();
    args.inputs = lanes;
    args.stride = stride;
    args.lane_count = lane_count;
    for (uint32_t b = 0; b < block_row_count_; ++b) {
      std::vector<InputBlock> blocks;
      for_each_block([&](size_t i, size_t block, size_t block_row) {
        if (block_row == b) {
          blocks.push_back({static_cast<uint32_t>(block), static_cast<uint32_t>(i)});
        }
      });
      args.block_count = static_cast<uint32_t>(blocks.size());
      blocks.resize(blocks.size() + kBatchAhead);
      args.blocks = blocks.data();
      args.sums = sums + size_t{b} * kJointBlockRows;
      (fixed_ ? kernels.joint_batch_fixed : kernels.joint_batch)(args);
    }
    std::vector<float> result;
    for (uint32_t k = 0; k < lane_count; ++k) {
      result.insert(result.end(), sums + k * stride, sums + k * stride + sum_count());
      for (size_t i = 0; i < kJointBlockRows; ++i)
        EXPECT_EQ(sums[k * stride + sum_count() + i], 0.0f);
    }
    return result;
  }

  /// The same, finished and in lanes: [sum][32].
  std::vector<float> run_batch_in_lanes(const KernelTable& kernels, uint32_t lane_count,
                                        const float* scales) {
    std::vector<float> storage(16 + sum_count() * kBatchLanes),
        inputs(16 + runs_.size() * kBatchLanes);
    float* const sums = aligned(storage.data());
    float* const lanes = aligned(inputs.data());
    for (size_t i = 0; i < runs_.size(); ++i) {
      for (uint32_t k = 0; k < lane_count; ++k) lanes[i * kBatchLanes + k] = input_of(i, k);
    }
    JointBatchArgs args = {};
    args.values = values();
    args.inputs = lanes;
    args.lane_count = lane_count;
    args.finish = true;
    for (uint32_t b = 0; b < block_row_count_; ++b) {
      std::vector<InputBlock> blocks;
      for_each_block([&](size_t i, size_t block, size_t block_row) {
        if (block_row == b) {
          blocks.push_back({static_cast<uint32_t>(block), static_cast<uint32_t>(i)});
        }
      });
      args.block_count = static_cast<uint32_t>(blocks.size());
      blocks.resize(blocks.size() + kBatchAhead);
      args.blocks = blocks.data();
      args.sums = sums + size_t{b} * kJointBlockRows * kBatchLanes;
      args.scales = scales ? scales + size_t{b} * kJointBlockRows : nullptr;
      (fixed_ ? kernels.joint_batch_fixed : kernels.joint_batch)(args);
    }
    return {sums, sums + sum_count() * kBatchLanes};
  }

  /// The same sums by strips of all sizes, whose inputs are all columns; nothing beside them is touched.
  std::vector<float> run_strips(const KernelTable& kernels) {
    const float untouched = 12345.0f;
    std::vector<float> storage(16 + kGuard + sum_count() + kGuard, untouched),
        controls(3, untouched);
    float* const sums = aligned(storage.data()) + kGuard;
    std::copy(initial_.begin(), initial_.end(), sums);
    for (const JointRun& run : runs_) controls.push_back(run.input);
    const auto column_count = static_cast<uint32_t>(runs_.size());
    std::vector<RowStrip> strips = {{0, 2, 3}};
    std::vector<uint16_t> inputs(3);
    for (uint32_t b = 0; b < block_row_count_; b = strips.back().first_block_row) {
      const uint32_t most = static_cast<uint32_t>(strips.size() - 1) % kMaxStripBlockRows + 1;
      const uint32_t end = std::min(block_row_count_, b + most);
      const uint32_t end_block = strips.back().first_block + (end - b) * column_count;
      for (uint32_t i = 0; i < column_count; ++i) inputs.push_back(static_cast<uint16_t>(3 + i));
      strips.push_back({end, end_block + end_block % 2, static_cast<uint32_t>(inputs.size())});
    }
    const size_t value_count = size_t{strips.back().first_block} * kJointBlockRows;
    std::vector<float> floats(value_count + 16);
    std::vector<int16_t> integers(value_count + 32);
    for (size_t s = 0; s + 1 < strips.size(); ++s) {
      const RowStrip strip = strips[s], next = strips[s + 1];
      for_each_block([&](size_t i, size_t block, size_t block_row) {
        if (block_row < strip.first_block_row || block_row >= next.first_block_row) return;
        const size_t to = strip.first_block + block_row - strip.first_block_row +
                          i * (next.first_block_row - strip.first_block_row);
        for (size_t r = 0; r < kJointBlockRows; ++r) {
          aligned(floats.data())[to * kJointBlockRows + r] =
              float_values()[block * kJointBlockRows + r];
          aligned(integers.data())[to * kJointBlockRows + r] =
              integer_values()[block * kJointBlockRows + r];
        }
      });
    }
    JointStripsArgs args = {};
    args.values = aligned(floats.data());
    if (fixed_) args.values = aligned(integers.data());
    args.inputs = inputs.data();
    args.strips = strips.data();
    args.controls = controls.data();
    args.sums = sums;
    args.strip_count = static_cast<uint32_t>(strips.size() - 1);
    (fixed_ ? kernels.joint_strips_fixed : kernels.joint_strips)(args);
    for (size_t i = 0; i < kGuard; ++i) {
      EXPECT_EQ(sums[-1 - static_cast<ptrdiff_t>(i)], untouched);
      EXPECT_EQ(sums[sum_count() + i], untouched);
    }
    return {sums, sums + sum_count()};
  }

  /// Starts from 0, with the inputs of one of the characters above.
  void become(uint32_t character) {
    std::fill(initial_.begin(), initial_.end(), 0.0f);
    for (size_t i = 0; i < runs_.size(); ++i) runs_[i].input = input_of(i, character);
  }

  /// The same sums by a plain loop with the given multiply-add.
  template <class Number, class MulAdd>
  std::vector<Number> expected(MulAdd mul_add) {
    std::vector<Number> sums(initial_.begin(), initial_.end());
    for_each_block([&](size_t i, size_t block, size_t block_row) {
      for (size_t r = 0; r < kJointBlockRows; ++r) {
        Number& sum = sums[block_row * kJointBlockRows + r];
        sum = mul_add(Number{float_values()[block * kJointBlockRows + r]}, Number{runs_[i].input},
                      sum);
      }
    });
    return sums;
  }

  size_t sum_count() const { return size_t{block_row_count_} * kJointBlockRows; }

 private:
  static constexpr size_t kGuard = 16;

  /// Calls f(run, block, block row counted from the first).
  template <class F>
  void for_each_block(F f) {
    for (size_t i = 0; i < runs_.size(); ++i) {
      const JointRun& run = runs_[i];
      for (uint32_t p = 0; p < run.pair_count; ++p) {
        const size_t number = block_rows_[run.start.pair_entry + p] & kPairBlockRows;
        const size_t block_row = number / kBlockRowUnit - kFirstBlockRow;
        f(i, run.start.first_pair + 2 * p, block_row);
        f(i, run.start.first_pair + 2 * p + 1, block_row + 1);
      }
      for (uint32_t p = 0; p < run.single_count; ++p) {
        f(i, run.start.first_single + p,
          block_rows_[run.start.single_entry + p] / kBlockRowUnit - kFirstBlockRow);
      }
    }
  }

  static float input_of(size_t run, uint32_t character) {
    return static_cast<float>((run * 37 + character * 11) % 23) * 0.0437f;
  }

  float* float_values() { return aligned(floats_.data()); }
  int16_t* integer_values() { return aligned(integers_.data()); }
  const void* values() {
    return fixed_ ? static_cast<const void*>(integer_values()) : float_values();
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

  bool fixed_;
  uint32_t block_row_count_, state_;
  std::vector<JointRun> runs_;
  std::vector<uint16_t> block_rows_;
  std::vector<float> floats_, initial_;
  std::vector<int16_t> integers_;
};

/// Calls check(matrix, kernels) for odd sizes on each instruction set present.
template <class Check>
void for_each_matrix(Check check) {
  for (const KernelTable* kernels : present_kernels()) {
    for (uint32_t column_count : {0u, 1u, 2u, 17u, 300u}) {
      for (uint32_t block_row_count : {0u, 1u, 2u, 3u, 7u, 40u}) {
        for (bool fixed : {false, true}) {
          SCOPED_TRACE(std::string(kernels->name) + ", columns " + std::to_string(column_count) +
                       ", block_rows " + std::to_string(block_row_count) +
                       (fixed ? ", fixed" : ""));
          JointMatrix matrix(column_count, block_row_count, fixed);
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

TEST(JointStripsKernel, BitEqualToColumns) {
  for_each_matrix([](JointMatrix& matrix, const KernelTable& kernels) {
    const auto compare = [&] {
      const std::vector<float> columns = matrix.run(kernels), strips = matrix.run_strips(kernels);
      for (size_t i = 0; i < columns.size(); ++i) {
        ASSERT_EQ(bits_of(strips[i] + 0.0f), bits_of(columns[i] + 0.0f)) << "sum " << i;
      }
    };
    compare();
    for (uint32_t k : {0u, 3u}) {
      matrix.become(k);
      compare();
    }
  });
}

TEST(JointBatchKernel, BitEqualToColumns) {
  for_each_matrix([](JointMatrix& matrix, const KernelTable& kernels) {
    for (uint32_t lane_count : {1u, 5u, kBatchLanes}) {
      const std::vector<float> together = matrix.run_batch(kernels, lane_count);
      for (uint32_t k = 0; k < lane_count; ++k) {
        matrix.become(k);
        const std::vector<float> alone = matrix.run(kernels);
        for (size_t i = 0; i < alone.size(); ++i) {
          // Inputs of 0 take part: what is -0 alone may be 0 here, until the sums are finished.
          ASSERT_EQ(bits_of(together[k * alone.size() + i] + 0.0f), bits_of(alone[i] + 0.0f))
              << "character " << k << ", sum " << i;
        }
      }
    }
  });
}

TEST(JointBatchKernel, FinishesInLanesAsFinishSumsDoes) {
  for_each_matrix([](JointMatrix& matrix, const KernelTable& kernels) {
    for (uint32_t lane_count : {1u, 5u, kBatchLanes}) {
      const std::vector<float> together = matrix.run_batch(kernels, lane_count);
      const size_t count = together.size() / lane_count, padded = (count + 15) / 16 * 16;
      std::vector<float> scales(16 + padded), expected(16 + padded);
      float* const scale = JointMatrix::aligned(scales.data());
      float* const alone = JointMatrix::aligned(expected.data());
      for (size_t i = 0; i < count; ++i) scale[i] = static_cast<float>(i % 7) * 0.75f - 1.5f;
      for (const float* used :
           {static_cast<const float*>(nullptr), static_cast<const float*>(scale)}) {
        const std::vector<float> lanes = matrix.run_batch_in_lanes(kernels, lane_count, used);
        for (uint32_t k = 0; k < lane_count; ++k) {
          std::copy_n(together.begin() + static_cast<ptrdiff_t>(k * count), count, alone);
          kernels.finish_sums(alone, used, padded);
          for (size_t i = 0; i < count; ++i) {
            ASSERT_EQ(bits_of(lanes[i * kBatchLanes + k]), bits_of(alone[i]))
                << "character " << k << ", sum " << i;
          }
        }
      }
    }
  });
}

TEST(ScatterTargetsKernel, WritesTheRowsOfTargetsOnly) {
  constexpr size_t kRows = 40, kOutputs = 64;
  const JointTarget targets[] = {{7, 50, 0}, {0, 3, 0}, {30, 20, 0}, {9, 22, 0}};
  alignas(64) float sums[kRows * kBatchLanes];
  for (size_t i = 0; i < kRows * kBatchLanes; ++i) sums[i] = static_cast<float>(i + 1);
  for (const KernelTable* kernels : present_kernels()) {
    SCOPED_TRACE(kernels->name);
    for (uint32_t rows : {6u, 3u, 1u}) {
      for (uint32_t lane_count : {1u, 3u, 4u, 7u, kBatchLanes}) {
        std::vector<float> outputs(kBatchLanes * kOutputs), expected = outputs;
        float* to[kBatchLanes];
        for (uint32_t k = 0; k < kBatchLanes; ++k) to[k] = outputs.data() + k * kOutputs;
        kernels->scatter_targets({sums, targets, to, 4, rows, lane_count});
        for (const JointTarget& target : targets) {
          for (uint32_t r = 0; r < rows; ++r) {
            for (uint32_t k = 0; k < lane_count; ++k) {
              expected[k * kOutputs + target.output + r] =
                  sums[(target.packed_row + r) * kBatchLanes + k];
            }
          }
        }
        EXPECT_EQ(outputs, expected) << rows << " rows, " << lane_count << " characters";
      }
    }
  }
}

/// Correctives with awkward inputs; some read what others give.
struct Correctives {
  std::vector<uint16_t> outputs, inputs, run_lengths;
  std::vector<float> weights;
  std::vector<uint32_t> first_inputs = {0};
  std::vector<uint64_t> marks;
  uint32_t control_count = 40;

  Correctives() {
    // Runs of 6, 6, 6 and 2 entries, with 1, 2, 3 and 4 inputs that come before the run.
    for (uint32_t e = 0, run = 0; e < 20; ++e) {
      outputs.push_back(static_cast<uint16_t>(20 + e));
      run_lengths.push_back(static_cast<uint16_t>(e < 18 ? 6 - e % 6 : 20 - e));
      if (run_lengths.back() == 6 || e == 18) run = e;
      for (uint32_t i = 0; i < run / 6 + 1; ++i) {
        inputs.push_back(static_cast<uint16_t>((e * 7 + i * 5) % (20 + run)));
      }
      first_inputs.push_back(static_cast<uint32_t>(inputs.size()));
      weights.push_back(e % 5 == 0 ? -3.0f : 0.5f + static_cast<float>(e) * 0.1f);
    }
    for (uint32_t c = 0; c < control_count; ++c) marks.push_back(uint64_t{1} << c);
  }

  static float input_of(uint32_t control, uint32_t character) {
    if (control == 3) return std::numeric_limits<float>::quiet_NaN();
    if (control == 4) return -std::numeric_limits<float>::infinity();
    return static_cast<float>((control * 13 + character * 7) % 19) * 0.1f - 0.3f;
  }

  /// Controls of a character: inputs, and what its correctives were before.
  std::vector<float> controls(uint32_t character) const {
    std::vector<float> values(control_count, 0.25f);
    for (uint32_t c = 0; c < 20; ++c) values[c] = input_of(c, character);
    return values;
  }

  /// By plain loops; tells which outputs changed.
  std::vector<float> expected(std::vector<float> values, uint64_t& changed) const {
    changed = 0;
    for (size_t e = 0; e < outputs.size(); ++e) {
      float product = 1.0f;
      for (uint32_t i = first_inputs[e]; i < first_inputs[e + 1]; ++i) {
        const float input = values[inputs[i]];
        product *= input > 0.0f ? (input < 1.0f ? input : 1.0f) : 0.0f;
      }
      product *= weights[e];
      const float value = product < 1.0f ? product : 1.0f;
      if (bits_of(value) != bits_of(values[outputs[e]])) changed |= uint64_t{1} << outputs[e];
      values[outputs[e]] = value;
    }
    return values;
  }
};

TEST(PsdKernels, BitEqualToPlainLoopsAndTellChanges) {
  const Correctives c;
  for (const KernelTable* kernels : present_kernels()) {
    SCOPED_TRACE(kernels->name);
    alignas(64) float lanes[40 * kBatchLanes];
    for (uint32_t k = 0; k < kBatchLanes; ++k) {
      const std::vector<float> values = c.controls(k);
      for (uint32_t i = 0; i < c.control_count; ++i) lanes[i * kBatchLanes + k] = values[i];
    }
    uint32_t changed_lanes[20] = {};
    kernels->psd_batch({c.outputs.data(), c.weights.data(), c.first_inputs.data(), c.inputs.data(),
                        lanes, changed_lanes, 20});
    for (uint32_t k = 0; k < kBatchLanes; ++k) {
      std::vector<float> values = c.controls(k);
      uint64_t changed = 0;
      const std::vector<float> expected = c.expected(values, changed);
      const PsdArgs args = {
          c.outputs.data(),     c.weights.data(), c.first_inputs.data(), c.inputs.data(),
          c.run_lengths.data(), c.marks.data(),   values.data(),         20};
      EXPECT_NE(changed, 0u);
      EXPECT_EQ(kernels->psds(args), changed);
      for (uint32_t i = 0; i < c.control_count; ++i) {
        EXPECT_EQ(bits_of(values[i]), bits_of(expected[i])) << "control " << i;
        EXPECT_EQ(bits_of(lanes[i * kBatchLanes + k]), bits_of(expected[i])) << "control " << i;
      }
      for (uint32_t e = 0; e < 20; ++e) {
        EXPECT_EQ(changed_lanes[e] >> k & 1, changed >> c.outputs[e] & 1) << "corrective " << e;
      }
      // Once more: nothing changes.
      EXPECT_EQ(kernels->psds(args), 0u);
      // As lists of those that do not read each other, the last ones first.
      values = c.controls(k);
      uint64_t told = 0;
      for (uint32_t e = 0, count; e < 20; e += count) {
        count = c.run_lengths[e];
        uint16_t entries[20] = {};
        for (uint32_t i = 0; i < count; ++i) entries[i] = static_cast<uint16_t>(e + count - 1 - i);
        const PsdListArgs list = {c.outputs.data(),
                                  c.weights.data(),
                                  c.first_inputs.data(),
                                  c.inputs.data(),
                                  values.data(),
                                  entries,
                                  entries,
                                  count};
        const uint32_t listed = kernels->psd_list(list);
        for (uint32_t i = 0; i < listed; ++i) told |= uint64_t{1} << c.outputs[entries[i]];
      }
      EXPECT_EQ(told, changed);
      for (uint32_t i = 0; i < c.control_count; ++i) {
        EXPECT_EQ(bits_of(values[i]), bits_of(expected[i])) << "control " << i;
      }
    }
  }
}

TEST(NonzeroKernel, FindsWhatIsNotZero) {
  for (const KernelTable* kernels : present_kernels()) {
    for (uint32_t count : {0u, 1u, 15u, 64u, 65u, 200u}) {
      SCOPED_TRACE(std::string(kernels->name) + ", " + std::to_string(count));
      alignas(64) float values[200];
      for (uint32_t i = 0; i < 200; ++i) {
        const float awkward[] = {0.0f, -0.0f, 1e-45f, -2.0f, std::nanf(""), 0.0f};
        values[i] = awkward[i * i % 6];
      }
      uint64_t words[4] = {};
      kernels->nonzero({values, words, count});
      for (uint32_t i = 0; i < (count + 63) / 64 * 64; ++i) {
        const bool expected = i < count && values[i] != 0.0f;
        EXPECT_EQ(words[i / 64] >> i % 64 & 1, expected) << i;
      }
    }
  }
}

TEST(DifferentKernel, ComparesBits) {
  for (const KernelTable* kernels : present_kernels()) {
    for (uint32_t count : {0u, 1u, 15u, 64u, 65u, 197u}) {
      for (uint32_t shift : {0u, 1u, 3u}) {
        SCOPED_TRACE(std::string(kernels->name) + ", " + std::to_string(count));
        alignas(64) float values[200], others[200];
        for (uint32_t i = 0; i < 200; ++i) {
          const float awkward[] = {0.0f, -0.0f, 1e-45f, -2.0f, std::nanf(""), 0.0f};
          values[i] = awkward[i * i % 6];
          others[i] = awkward[i * 7 % 11 % 6];
        }
        uint64_t words[4] = {};
        kernels->different({values + shift, others + shift / 2, words, count});
        for (uint32_t i = 0; i < (count + 63) / 64 * 64; ++i) {
          const bool expected =
              i < count && bits_of(values[i + shift]) != bits_of(others[i + shift / 2]);
          EXPECT_EQ(words[i / 64] >> i % 64 & 1, expected) << i;
        }
      }
    }
  }
}

TEST(FinishSumsKernel, ScalesAndSaturates) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  const float infinity = std::numeric_limits<float>::infinity();
  alignas(64) const float scales[16] = {2, 0.5f, 1, 1, 1, 4, 0, -1, 1, 1, 1, 1, 1, 1, 1, 1};
  for (const KernelTable* kernels : present_kernels()) {
    SCOPED_TRACE(kernels->name);
    alignas(64) float scaled[16] = {1, 2, -3, infinity, -infinity, kLargest, 5, 6, -0.0f};
    alignas(64) float plain[16];
    std::copy(scaled, scaled + 16, plain);
    plain[3] = std::numeric_limits<float>::quiet_NaN();
    kernels->finish_sums(scaled, scales, 16);
    kernels->finish_sums(plain, nullptr, 16);
    const float expected_scaled[] = {2, 1, -3, kLargest, -kLargest, kLargest, 0, -6};
    const float expected_plain[] = {1, 2, -3, -kLargest, -kLargest, kLargest, 5, 6};
    for (size_t i = 0; i < 8; ++i) {
      EXPECT_EQ(scaled[i], expected_scaled[i]) << i;
      EXPECT_EQ(plain[i], expected_plain[i]) << i;
      EXPECT_EQ(bits_of(plain[8 + i]), 0u) << "-0 becomes 0";
    }
  }
}

TEST(FinishRunsKernel, WritesTheRunsOfTheSet) {
  // Two words of runs of each length, the shortest first, with other rows between them.
  constexpr uint32_t kRuns = 2 * kMaxRunRows * 64, kRows = kRuns * (kMaxRunRows + 1);
  static_assert(kRows % 16 == 0, "whole vectors");
  constexpr float kUntouched = 12345.0f;
  alignas(64) float sums[kRows], scales[kRows];
  std::fill(scales, scales + kRows, 0.25f);
  std::vector<uint32_t> rows(kRuns);
  std::vector<uint16_t> outputs(kRuns);
  std::vector<uint64_t> words(kRuns / 64);
  uint32_t first_words[kMaxRunRows + 1];
  for (uint32_t n = 0; n <= kMaxRunRows; ++n) first_words[n] = 2 * n;
  const auto length = [](uint32_t run) { return run / 128 + 1; };
  for (uint32_t i = 0; i < kRows; ++i) sums[i] = i % 5 ? static_cast<float>(i) - 200 : -0.0f;
  for (uint32_t i = 0; i < kRuns; ++i) {
    const uint32_t last = kRows - kMaxRunRows + i % 2;
    rows[i] = i == 127 ? kRows - 1 : i * 37 * (kMaxRunRows + 1) % last;
    outputs[i] = static_cast<uint16_t>(i * 613 % kRuns * (kMaxRunRows + 1));
    // One of each three, and all of every third word.
    if (i % 3 == 0 || i / 64 % 3 == 1) words[i / 64] |= uint64_t{1} << i % 64;
  }
  const auto in_set = [&](uint32_t run) { return words[run / 64] >> run % 64 & 1; };
  FinishRunsArgs args = {};
  args.sums = sums;
  args.runs = words.data();
  args.rows = rows.data();
  args.outputs = outputs.data();
  args.first_words = first_words;
  for (const KernelTable* kernels : present_kernels()) {
    SCOPED_TRACE(kernels->name);
    for (const float* scale :
         {static_cast<const float*>(nullptr), static_cast<const float*>(scales)}) {
      std::vector<float> written(kRuns * (kMaxRunRows + 1), kUntouched), expected = written;
      for (uint32_t i = 0; i < kRuns; ++i) {
        if (!in_set(i)) continue;
        for (uint32_t r = 0; r < length(i); ++r) {
          const size_t row = rows[i] + r;
          expected[outputs[i] + r] = sums[row] * (scale ? scale[row] : 1) + 0.0f;
        }
      }
      args.scales = scale;
      args.to = written.data();
      kernels->finish_runs(args);
      for (size_t i = 0; i < written.size(); ++i) {
        ASSERT_EQ(bits_of(written[i]), bits_of(expected[i])) << i;
      }
    }
  }
}

TEST(ReadBlockRowsKernel, ReadsRowsOfFilesAtAnyAddress) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kLargest = std::numeric_limits<float>::max();
  const float special[] = {0.0f,      -0.0f,     1e-45f,     -1e-45f,       kLargest,
                           -kLargest, kInfinity, -kInfinity, std::nanf(""), -std::nanf("")};
  for (const KernelTable* kernels : present_kernels()) {
    for (uint32_t count = 0; count <= 21; ++count) {
      // Rows of this length only, so that a checker of memory sees what is read behind them.
      std::vector<std::vector<uint8_t>> rows(kJointBlockRows);
      std::vector<float> expected(size_t{count} * kJointBlockRows);
      BlockRowsArgs args;
      for (uint32_t r = 0; r < kJointBlockRows; ++r) {
        const uint32_t shift = r % 4;  // bytes before the row
        rows[r].resize(shift + count * 4);
        for (uint32_t c = 0; c < count; ++c) {
          const uint32_t i = c * kJointBlockRows + r;
          const float value = i % 3 == 0 ? special[i / 3 % 10] : 0.37f * static_cast<float>(i) - 9;
          const uint32_t bits = bits_of(value);
          for (uint32_t k = 0; k < 4; ++k) {
            rows[r][shift + c * 4 + k] = static_cast<uint8_t>(bits >> (24 - 8 * k));
          }
          expected[i] = value > -kLargest ? (value < kLargest ? value : kLargest) : -kLargest;
        }
        args.rows[r] = rows[r].data() + shift;
      }
      alignas(64) float blocks[22 * kJointBlockRows];
      std::fill(std::begin(blocks), std::end(blocks), 7.0f);
      // In another order; where two columns share a block, the last one stays.
      float* places[21];
      for (uint32_t c = 0; c < count; ++c) {
        places[c] = blocks + size_t{count - 1 - c} * kJointBlockRows;
      }
      if (count % 5 == 0 && count > 0) {
        for (uint32_t c = 0; c < count; ++c) places[c] = blocks + size_t{c} * kJointBlockRows;
        places[0] = places[count - 1];
      }
      args.blocks = places;
      args.count = count;
      kernels->read_block_rows(args);
      for (uint32_t c = 0; c < count; ++c) {
        if (c == 0 && places[0] == places[count - 1] && count > 1) continue;
        for (uint32_t r = 0; r < kJointBlockRows; ++r) {
          ASSERT_EQ(bits_of(places[c][r]), bits_of(expected[c * kJointBlockRows + r]))
              << kernels->name << ' ' << count << ' ' << c << ' ' << r;
        }
      }
      if (count % 5 == 0 && count > 1) {
        for (uint32_t r = 0; r < kJointBlockRows; ++r) ASSERT_EQ(blocks[r], 7.0f);
      }
      for (size_t i = expected.size(); i < std::size(blocks); ++i) ASSERT_EQ(blocks[i], 7.0f);
    }
  }
}

/// Big-endian, at an address that is not aligned; a checker of memory sees what is read behind them.
struct FileNumbers {
  std::vector<uint8_t> bytes;
  explicit FileNumbers(const std::vector<float>& values) : bytes(1 + values.size() * 4) {
    for (size_t i = 0; i < values.size(); ++i) {
      for (uint32_t k = 0; k < 4; ++k) {
        bytes[1 + i * 4 + k] = static_cast<uint8_t>(bits_of(values[i]) >> (24 - 8 * k));
      }
    }
  }
  const uint8_t* data() const { return bytes.data() + 1; }
};

TEST(MarkNonzerosKernel, MarksWhatIsNeitherZeroNorMinusZero) {
  const float special[] = {0.0f,  -0.0f, 1e-45f, -1e-45f,       0.0f,
                           -0.0f, 1.0f,  0.0f,   std::nanf(""), -2e38f};
  for (const KernelTable* kernels : present_kernels()) {
    for (const uint32_t columns :
         {0u, 1u, 7u, 31u, 32u, 33u, 63u, 64u, 65u, 96u, 100u, 128u, 150u}) {
      const uint32_t rows = 5, words_per_row = (columns + 63) / 64;
      std::vector<float> values(size_t{rows} * columns);
      std::vector<uint64_t> expected(size_t{rows} * words_per_row),
          words(expected.size() + 1, ~0ull);
      for (uint32_t i = 0; i < values.size(); ++i) {
        values[i] = special[(i * 7 + i / 11) % 10];
        const uint64_t bit = uint64_t{(bits_of(values[i]) & 0x7FFFFFFF) != 0} << i % columns % 64;
        expected[i / columns * words_per_row + i % columns / 64] |= bit;
      }
      const FileNumbers file(values);
      kernels->mark_nonzeros(file.data(), rows, columns, words.data());
      for (size_t w = 0; w < expected.size(); ++w) {
        ASSERT_EQ(words[w], expected[w]) << kernels->name << ' ' << columns << ' ' << w;
      }
      EXPECT_EQ(words.back(), ~0ull);
    }
  }
}

TEST(LargestMagnitudeKernel, TakesWhatIsUpToTheLimit) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float above = std::nextafter(3.4e38f, kInfinity);
  for (const KernelTable* kernels : present_kernels()) {
    EXPECT_EQ(kernels->largest_magnitude(nullptr, 0), 0.0f);
    for (uint32_t count = 1; count <= 40; ++count) {
      for (uint32_t at = 0; at < count; ++at) {
        std::vector<float> values(count);
        for (uint32_t i = 0; i < count; ++i) {
          const float too_large[] = {above, -kInfinity, std::nanf(""), -0.0f};
          values[i] = i % 3 == 0 ? too_large[i / 3 % 4] : 0.25f / static_cast<float>(i + 1);
        }
        for (const float largest : {-2.5f, 3.4e38f}) {
          values[at] = largest;
          const FileNumbers file(values);
          ASSERT_EQ(kernels->largest_magnitude(file.data(), count), std::fabs(largest))
              << kernels->name << ' ' << count << ' ' << at;
        }
      }
    }
  }
}

TEST(FixBlocksKernel, CountsStepsOfTheScalesOfRows) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  alignas(64) const float scales[kJointBlockRows] = {1, 0.5f, 3, 0, -1, 1e-45f, kLargest, 0.1f};
  const float values[] = {0,      0.5f,     1.5f,      2.5f,   -2.5f, 40000,
                          -40000, kLargest, -kLargest, 1e-45f, -7};
  for (const KernelTable* kernels : present_kernels()) {
    for (size_t count = 2; count <= 6; count += 2) {
      alignas(64) float blocks[6 * kJointBlockRows];
      alignas(64) int16_t fixed[7 * kJointBlockRows];
      std::fill(std::begin(fixed), std::end(fixed), int16_t{123});
      for (size_t i = 0; i < std::size(blocks); ++i) blocks[i] = values[i * 3 % 11];
      kernels->fix_blocks(blocks, scales, count, fixed);
      for (size_t i = 0; i < std::size(fixed); ++i) {
        int16_t expected = 123;
        if (i < count * kJointBlockRows) {
          const float scale = scales[i % kJointBlockRows];
          const float steps = scale > 0 ? std::nearbyint(blocks[i] / scale) : 0.0f;
          expected = static_cast<int16_t>(std::clamp(steps, -32767.0f, 32767.0f));
        }
        ASSERT_EQ(fixed[i], expected) << kernels->name << ' ' << count << ' ' << i;
      }
    }
  }
}

TEST(KernelsFor, TablesKnowTheirNames) {
  std::printf("present:");
  for (uint32_t i = 1; i < kIsaCount; ++i) {
    const KernelTable* kernels = kernels_for(static_cast<Isa>(i));
    if (!kernels) continue;
    std::printf(" %s", kernels->name);
    EXPECT_EQ(kernels->isa, static_cast<Isa>(i));
    EXPECT_STREQ(kernels->name, isa_name(kernels->isa));
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
  GTEST_SKIP() << "NOT TESTED: the choice of kernels; there are scalar ones only";
#endif
}

TEST(CpuFeatures, EachInstructionSetNeedsAllOfItsBits) {
  // A server with AVX-512: CPUID leaf 1 ECX, leaf 7 EBX, XCR0.
  const X86Registers server = {0x16, 0xfffa3203, 0xd19f27eb, 0xe7};
  const auto narrowest = [](X86Registers registers) {
    const CpuFeatures cpu = features_of(registers);
    EXPECT_TRUE(cpu.sse2);
    EXPECT_FALSE(cpu.neon);
    EXPECT_TRUE(cpu.avx2 || !cpu.avx512);
    return cpu.avx512 ? "avx512" : cpu.avx2 ? "avx2" : "sse2";
  };
  EXPECT_STREQ(narrowest(server), "avx512");
  const auto without = [&](uint32_t X86Registers::*where, uint32_t bit) {
    X86Registers less = server;
    less.*where &= ~(uint32_t{1} << bit);
    return narrowest(less);
  };
  // SSE3, SSSE3, FMA, SSE4.1, SSE4.2, POPCNT, XSAVE, OSXSAVE, AVX, F16C
  for (uint32_t bit : {0, 9, 12, 19, 20, 23, 26, 27, 28, 29}) {
    EXPECT_STREQ(without(&X86Registers::leaf1_ecx, bit), "sse2") << bit;
  }
  EXPECT_STREQ(without(&X86Registers::leaf7_ebx, 5), "sse2") << "AVX2";
  for (uint32_t bit : {16, 17, 28, 30, 31}) {  // F, DQ, CD, BW, VL
    EXPECT_STREQ(without(&X86Registers::leaf7_ebx, bit), "avx2") << bit;
  }
  // What the system does not save when it switches threads.
  for (uint32_t bit : {1, 2}) EXPECT_STREQ(without(&X86Registers::xcr0, bit), "sse2") << bit;
  for (uint32_t bit : {5, 6, 7}) EXPECT_STREQ(without(&X86Registers::xcr0, bit), "avx2") << bit;
  // CPUID repeats the last leaf for those that do not exist: its bits mean something else.
  EXPECT_STREQ(narrowest({6, server.leaf1_ecx, server.leaf7_ebx, server.xcr0}), "sse2");
  EXPECT_STREQ(narrowest({}), "sse2");
}

void set_environment(const char* value) {
#if defined(_WIN32)
  _putenv_s("MIEN_ISA", value ? value : "");
#else
  value ? setenv("MIEN_ISA", value, 1) : unsetenv("MIEN_ISA");
#endif
}

/// MIEN_ISA for the time of one test.
class ChooseKernels : public ::testing::Test {
 protected:
  ChooseKernels() {
    if (const char* value = std::getenv("MIEN_ISA")) {
      was_set_ = true;
      before_ = value;
    }
    set_environment(nullptr);
  }
  ~ChooseKernels() override { set_environment(was_set_ ? before_.c_str() : nullptr); }
  static const KernelTable* choose(const char* environment) {
    set_environment(environment);
    return kernels_from_environment();
  }

 private:
  bool was_set_ = false;
  std::string before_;
};

TEST_F(ChooseKernels, BestWithoutEnvironment) {
  EXPECT_EQ(kernels_from_environment(), kernels_for(Isa::kBest));
  EXPECT_EQ(choose(""), kernels_for(Isa::kBest));
  EXPECT_EQ(choose("best"), kernels_for(Isa::kBest));
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

TEST_F(ChooseKernels, EnvironmentDoesNotTouchAnArgument) {
  const KernelTable* best = kernels_for(Isa::kBest);
  EXPECT_EQ(choose("scalar"), kernels_for(Isa::kScalar));
  EXPECT_EQ(kernels_for(Isa::kBest), best);
}

}  // namespace
}  // namespace mien
