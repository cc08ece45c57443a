// SPDX-License-Identifier: MIT
// Dense layers, turns of quaternion joints and RBF weights: every instruction set present against a
// plain model in double, and against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "runtime/author/random.h"
#include "runtime/base/half.h"
#include "simd/kernels.h"

namespace mien {
namespace {

/// Floats at a multiple of 64 bytes.
struct Aligned {
  explicit Aligned(size_t count) : storage(count + 16) {
    const size_t past = reinterpret_cast<uintptr_t>(storage.data()) / sizeof(float) % 16;
    data = storage.data() + (past ? 16 - past : 0);
  }
  std::vector<float> storage;
  float* data;
};

std::vector<const KernelTable*> present() {
  std::vector<const KernelTable*> tables;
  for (uint32_t isa = 1; isa < kIsaCount; ++isa) {
    if (const KernelTable* table = kernels_for(static_cast<Isa>(isa))) tables.push_back(table);
  }
  return tables;
}

double activation(uint8_t function, double v, double alpha) {
  switch (function) {
    case 1: return v < 0 ? 0 : v;
    case 2: return v < 0 ? alpha * v : v;
    case 3: return std::tanh(v);
    case 4: return 1 / (1 + std::exp(-v));
    default: return v;
  }
}

TEST(DenseLayer, EveryActivationAndSize) {
  Random random = Random::from_seed(11, 1);
  for (uint8_t function = 0; function <= 4; ++function) {
    for (uint32_t columns : {0u, 1u, 3u, 64u, 129u}) {
      for (uint32_t row_count : {1u, 16u, 29u, 49u, 80u, 141u, 400u}) {
        const uint32_t rows = (row_count + kBlockRows - 1) / kBlockRows * kBlockRows;
        Aligned values(size_t{rows} * columns), biases(rows), outputs(rows);
        std::vector<float> inputs(columns);
        for (size_t i = 0; i < size_t{rows} * columns; ++i) {
          values.data[i] = static_cast<float>(random.between(-1, 1));
        }
        for (float& x : inputs) x = static_cast<float>(random.between(-2, 2));
        for (uint32_t r = 0; r < rows; ++r) {
          biases.data[r] = static_cast<float>(random.between(-20, 20));
        }
        for (const KernelTable* table : present()) {
          table->dense_layer({values.data, biases.data, inputs.data(), outputs.data, 0.1f, columns,
                              row_count, function, false});
          for (uint32_t r = 0; r < row_count; ++r) {
            double sum = biases.data[r], size = std::fabs(sum);
            for (uint32_t c = 0; c < columns; ++c) {
              const size_t at =
                  (size_t{r / kBlockRows} * columns + c) * kBlockRows + r % kBlockRows;
              const double product = double{values.data[at]} * inputs[c];
              sum += product;
              size += std::fabs(product);
            }
            const double expected = activation(function, sum, double{0.1f});
            const double limit = (columns + 2) * size * 1.2e-7 + 3e-7;
            ASSERT_NEAR(outputs.data[r], expected, limit)
                << table->name << ", function " << int{function} << ", " << columns << " columns";
          }
        }
      }
    }
  }
}

TEST(DenseLayer, WhatOverflowsSaturates) {
  Aligned values(kBlockRows), biases(kBlockRows), outputs(kBlockRows);
  for (uint32_t r = 0; r < kBlockRows; ++r) values.data[r] = r % 2 ? 3e38f : -3e38f;
  const float input = 3e38f;
  for (const KernelTable* table : present()) {
    for (uint8_t function = 0; function <= 4; ++function) {
      table->dense_layer(
          {values.data, biases.data, &input, outputs.data, 0.5f, 1, kBlockRows, function, false});
      for (uint32_t r = 0; r < kBlockRows; ++r) EXPECT_TRUE(std::isfinite(outputs.data[r]));
    }
  }
}

/// The same floats as halves.
struct AlignedHalves {
  AlignedHalves(const float* values, size_t count) : storage(count + 32) {
    const size_t past = reinterpret_cast<uintptr_t>(storage.data()) / sizeof(uint16_t) % 32;
    data = storage.data() + (past ? 32 - past : 0);
    for (size_t i = 0; i < count; ++i) data[i] = half_from_float(values[i]);
  }
  std::vector<uint16_t> storage;
  uint16_t* data;
};

// A layer of one column: each half comes out as it is.
TEST(DenseLayer, EveryFiniteHalfIsReadExactly) {
  std::vector<uint16_t> all;
  for (uint32_t half = 0; half < 65536; ++half) {
    if ((half & 0x7C00) != 0x7C00) all.push_back(static_cast<uint16_t>(half));
  }
  const auto count = static_cast<uint32_t>(all.size());
  ASSERT_EQ(count % kBlockRows, 0u);
  Aligned biases(count), outputs(count);
  AlignedHalves halves(biases.data, count);
  std::copy(all.begin(), all.end(), halves.data);
  const float one = 1;
  for (const KernelTable* table : present()) {
    table->dense_layer({halves.data, biases.data, &one, outputs.data, 0, 1, count, 0, true});
    for (uint32_t i = 0; i < count; ++i) {
      ASSERT_EQ(outputs.data[i], float_from_half(all[i])) << table->name << ", " << all[i];
    }
  }
}

TEST(DenseLayer, HalvesGiveWhatTheirFloatsGive) {
  Random random = Random::from_seed(14, 1);
  for (uint32_t columns : {1u, 2u, 57u}) {
    for (uint32_t row_count : {3u, 16u, 100u}) {
      const uint32_t rows = (row_count + kBlockRows - 1) / kBlockRows * kBlockRows;
      Aligned values(size_t{rows} * columns), biases(rows), outputs(rows), expected(rows);
      std::vector<float> inputs(columns);
      for (float& x : inputs) x = static_cast<float>(random.between(-2, 2));
      for (size_t i = 0; i < size_t{rows} * columns; ++i) {
        values.data[i] = static_cast<float>(random.between(-1, 1));
      }
      const AlignedHalves halves(values.data, size_t{rows} * columns);
      for (size_t i = 0; i < size_t{rows} * columns; ++i) {
        values.data[i] = float_from_half(halves.data[i]);
      }
      for (const KernelTable* table : present()) {
        DenseLayerArgs args = {values.data, biases.data, inputs.data(), expected.data, 0, columns,
                               row_count,   3,           false};
        table->dense_layer(args);
        args.values = halves.data;
        args.outputs = outputs.data;
        args.halves = true;
        table->dense_layer(args);
        EXPECT_EQ(std::memcmp(outputs.data, expected.data, row_count * sizeof(float)), 0)
            << table->name;
      }
    }
  }
}

TEST(JointTurns, ProductOfBlends) {
  Random random = Random::from_seed(12, 1);
  for (uint32_t columns : {0u, 1u, 2u, 17u}) {
    for (uint32_t blocks : {1u, 3u}) {
      constexpr uint32_t kFloats = 4 * kBlockRows;
      Aligned values(size_t{blocks} * (columns + 1) * kFloats), rotations(blocks * kFloats);
      std::vector<uint16_t> controls_of(columns);
      std::vector<float> controls(columns + 3);
      for (uint32_t c = 0; c < columns; ++c) controls_of[c] = static_cast<uint16_t>(columns - c);
      for (float& x : controls) x = static_cast<float>(random.between(-0.5, 1.5));
      if (columns > 1) controls[1] = 0;
      // One column more is stored than evaluated, as at a coarse LOD.
      for (uint32_t b = 0; b < blocks; ++b) {
        for (uint32_t c = 0; c <= columns; ++c) {
          for (uint32_t j = 0; j < kBlockRows; ++j) {
            double q[4], length = 0;
            for (double& part : q) part = random.between(-1, 1);
            q[3] = std::fabs(q[3]) + 0.2;
            for (double part : q) length += part * part;
            for (uint32_t k = 0; k < 4; ++k) {
              values.data[(size_t{b} * (columns + 1) + c) * kFloats + k * kBlockRows + j] =
                  float_from_half(half_from_float(static_cast<float>(q[k] / std::sqrt(length))));
            }
          }
        }
      }
      const AlignedHalves halves(values.data, size_t{blocks} * (columns + 1) * kFloats);
      for (const KernelTable* table : present()) {
        JointTurnArgs args = {halves.data, controls_of.data(), controls.data(), rotations.data,
                              columns,     columns + 1,        blocks,          true};
        table->joint_turns(args);
        const std::vector<float> from_halves(rotations.data, rotations.data + blocks * kFloats);
        args.values = values.data;
        args.halves = false;
        table->joint_turns(args);
        EXPECT_TRUE(std::equal(from_halves.begin(), from_halves.end(), rotations.data));
        for (uint32_t b = 0; b < blocks; ++b) {
          for (uint32_t j = 0; j < kBlockRows; ++j) {
            double a[4] = {0, 0, 0, 1};
            for (uint32_t c = 0; c < columns; ++c) {
              const float* q = values.data + (size_t{b} * (columns + 1) + c) * kFloats + j;
              const double w = controls[controls_of[c]];
              double l[4], length = 0;
              for (uint32_t k = 0; k < 4; ++k) l[k] = w * q[k * kBlockRows];
              l[3] += 1 - w;
              for (double part : l) length += part * part;
              for (double& part : l) part /= std::sqrt(length);
              const double p[4] = {l[3] * a[0] + l[0] * a[3] + l[1] * a[2] - l[2] * a[1],
                                   l[3] * a[1] - l[0] * a[2] + l[1] * a[3] + l[2] * a[0],
                                   l[3] * a[2] + l[0] * a[1] - l[1] * a[0] + l[2] * a[3],
                                   l[3] * a[3] - l[0] * a[0] - l[1] * a[1] - l[2] * a[2]};
              std::memcpy(a, p, sizeof(a));
            }
            for (uint32_t k = 0; k < 4; ++k) {
              ASSERT_NEAR(rotations.data[b * kFloats + k * kBlockRows + j], a[k], 4e-6)
                  << table->name << ", " << columns << " columns, joint " << j;
            }
          }
        }
      }
    }
  }
}

TEST(RbfWeights, EveryDistanceAndFunctionToTheBit) {
  Random random = Random::from_seed(13, 1);
  for (bool angular : {false, true}) {
    for (uint8_t function = 0; function <= 4; ++function) {
      const uint32_t inputs_count = angular ? 8 : 3, poses = 3 * kBlockRows;
      Aligned targets(size_t{inputs_count} * poses);
      std::vector<float> inputs(inputs_count);
      const auto fill = [&](const auto& at) {
        for (uint32_t i = 0; i < inputs_count; i += angular ? 4 : 1) {
          double q[4], length = 0;
          for (double& part : q) {
            part = random.between(-1, 1);
            length += part * part;
          }
          for (uint32_t k = 0; k < (angular ? 4u : 1u); ++k) {
            at(i + k) = static_cast<float>(angular ? q[k] / std::sqrt(length) : q[k]);
          }
        }
      };
      for (uint32_t p = 0; p < poses; ++p) {
        fill([&](uint32_t i) -> float& { return targets.data[i * poses + p]; });
      }
      fill([&](uint32_t i) -> float& { return inputs[i]; });
      targets.data[0] = NAN;

      std::vector<float> first;
      for (const KernelTable* table : present()) {
        Aligned weights(poses);
        table->rbf_weights({targets.data, inputs.data(), weights.data, inputs_count, poses, 0.4f,
                            function, angular});
        EXPECT_EQ(weights.data[0], 0.0f) << "what is not a number weighs nothing";
        for (uint32_t p = 1; p < poses; ++p) {
          double squared = 0;
          for (uint32_t i = 0; i < inputs_count; i += angular ? 4 : 1) {
            if (!angular) {
              const double d = double{targets.data[i * poses + p]} - inputs[i];
              squared += d * d;
              continue;
            }
            double dot = 0;
            for (uint32_t k = i; k < i + 4; ++k)
              dot += double{targets.data[k * poses + p]} * inputs[k];
            const double angle = dot * dot > 1 ? 0 : std::acos(2 * dot * dot - 1);
            squared += angle * angle;
          }
          const double x = std::sqrt(squared) * double{0.4f};
          double expected = std::exp(-x);
          if (function >= 2) expected = std::fmax(0.0, 1 - std::pow(x, 2 * function - 3));
          if (function == 2) expected = std::fmax(0.0, 1 - x);
          ASSERT_NEAR(weights.data[p], expected, 1e-5)
              << table->name << ", function " << int{function} << ", angular " << angular;
        }
        const std::vector<float> mine(weights.data, weights.data + poses);
        if (first.empty()) first = mine;
        EXPECT_EQ(std::memcmp(mine.data(), first.data(), poses * sizeof(float)), 0) << table->name;
      }
    }
  }
}

}  // namespace
}  // namespace mien
