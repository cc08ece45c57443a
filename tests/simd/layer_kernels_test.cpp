// SPDX-License-Identifier: MIT
// Dense layers, turns of quaternion joints and RBF weights: every instruction set present against a
// plain model in double, and against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "author/base/random.h"
#include "runtime/base/half.h"
#include "tests/simd/present_kernels.h"

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
        const uint32_t rows = (row_count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
        Aligned values(size_t{rows} * columns), biases(rows), outputs(rows);
        std::vector<float> inputs(columns);
        for (size_t i = 0; i < size_t{rows} * columns; ++i) {
          values.data[i] = static_cast<float>(random.between(-1, 1));
        }
        for (float& x : inputs) x = static_cast<float>(random.between(-2, 2));
        for (uint32_t r = 0; r < rows; ++r) {
          biases.data[r] = static_cast<float>(random.between(-20, 20));
        }
        for (const KernelTable* table : present_kernels()) {
          table->dense_layer({values.data, biases.data, inputs.data(), outputs.data, 0.1f, columns,
                              row_count, function, false, false, false});
          for (uint32_t r = 0; r < row_count; ++r) {
            double sum = biases.data[r], size = std::fabs(sum);
            for (uint32_t c = 0; c < columns; ++c) {
              const size_t at =
                  (size_t{r / kBlockLanes} * columns + c) * kBlockLanes + r % kBlockLanes;
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
  Aligned values(kBlockLanes), biases(kBlockLanes), outputs(kBlockLanes);
  for (uint32_t r = 0; r < kBlockLanes; ++r) values.data[r] = r % 2 ? 3e38f : -3e38f;
  const float input = 3e38f;
  for (const KernelTable* table : present_kernels()) {
    for (uint8_t function = 0; function <= 4; ++function) {
      table->dense_layer({values.data, biases.data, &input, outputs.data, 0.5f, 1, kBlockLanes,
                          function, false, false, false});
      for (uint32_t r = 0; r < kBlockLanes; ++r) EXPECT_TRUE(std::isfinite(outputs.data[r]));
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

/// A layer that is evaluated for many lanes at once and for each of them.
struct RandomLayer {
  uint32_t columns, row_count;
  double zeros;  // share of the inputs
};

void expect_same_bits(const KernelTable* table, const RandomLayer& layer, uint32_t round,
                      Random& random) {
  const uint32_t columns = layer.columns, row_count = layer.row_count;
  const uint32_t lanes = 1 + random.below(kBatchLanes);
  const uint32_t rows = (row_count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
  const auto function = static_cast<uint8_t>(round % 5);
  const bool is_half = round / 5 % 2, portable = round / 10 % 2;
  Aligned values(size_t{rows} * columns), biases(rows), inputs(size_t{columns} * kBatchLanes),
      outputs(size_t{rows} * kBatchLanes), single(rows),
      of_lane((columns + kBlockLanes - 1) / kBlockLanes * kBlockLanes);
  for (size_t i = 0; i < size_t{rows} * columns; ++i) {
    values.data[i] = static_cast<float>(random.between(-1, 1));
  }
  for (uint32_t r = 0; r < rows; ++r) biases.data[r] = static_cast<float>(random.between(-2, 2));
  for (size_t i = 0; i < size_t{columns} * kBatchLanes; ++i) {
    const bool zero = random.between(0, 1) < layer.zeros;
    inputs.data[i] = zero ? (i % 3 ? 0.0f : -0.0f) : static_cast<float>(random.between(-2, 2));
  }
  if (round % 7 == 0 && columns > 0) {  // sums that saturate
    values.data[0] = 3e38f;
    for (uint32_t k = 0; k < kBatchLanes; ++k) inputs.data[k] *= 10;
  }
  const AlignedHalves halves(values.data, size_t{rows} * columns);
  if (is_half) table->floats_from_halves(halves.data, size_t{rows} * columns, values.data);
  const void* weights = is_half ? static_cast<const void*>(halves.data) : values.data;
  table->dense_batch({values.data, biases.data, inputs.data, outputs.data, 0.1f, columns, row_count,
                      lanes, function, portable});
  for (uint32_t k = 0; k < lanes; ++k) {
    std::fill_n(of_lane.data, of_lane.storage.size() - 16, 7.0f);  // behind the last: not looked at
    for (uint32_t c = 0; c < columns; ++c) of_lane.data[c] = inputs.data[c * kBatchLanes + k];
    for (const bool sparse : {false, true}) {
      table->dense_layer({weights, biases.data, of_lane.data, single.data, 0.1f, columns, row_count,
                          function, is_half, portable, sparse});
      for (uint32_t r = 0; r < row_count; ++r) {
        ASSERT_EQ(std::memcmp(&outputs.data[r * kBatchLanes + k], &single.data[r], sizeof(float)),
                  0)
            << table->name << ", round " << round << ", lane " << k << ", row " << r << ": "
            << outputs.data[r * kBatchLanes + k] << ", not " << single.data[r]
            << (sparse ? ", sparse" : "");
      }
    }
  }
}

// Every function, floats and halves, fast and portable, any number of lanes.
TEST(DenseBatch, HasTheBitsOfOneByOne) {
  Random random = Random::from_seed(11, 9);
  for (const KernelTable* table : present_kernels()) {
    for (uint32_t round = 0; round < 120; ++round) {
      expect_same_bits(table, {random.below(70), 1 + random.below(50), 0.0}, round, random);
    }
  }
}

// Few zeros, most, nothing else; more columns than fit a word, and more than zeros are looked for in.
TEST(DenseLayer, SkipsZerosWithTheSameBits) {
  Random random = Random::from_seed(11, 10);
  for (const KernelTable* table : present_kernels()) {
    for (uint32_t round = 0; round < 120; ++round) {
      const uint32_t most = round % 8 == 0 ? 600 : round % 4 == 0 ? 200 : 70;
      const double zeros[] = {0.1, 0.75, 1.0};
      expect_same_bits(table, {random.below(most), 1 + random.below(120), zeros[round % 3]}, round,
                       random);
    }
  }
}

// What is skipped is not read: zeros times weights that are not finite would be NaN.
TEST(DenseLayer, LeavesOutTheColumnsOfZeros) {
  constexpr uint32_t kColumns = 70;
  Aligned values(kColumns * kBlockLanes), biases(kBlockLanes), inputs(80), outputs(kBlockLanes);
  for (uint32_t c = 0; c < kColumns; ++c) {
    inputs.data[c] = c % 5 == 0 ? 1.0f : 0.0f;
    for (uint32_t r = 0; r < kBlockLanes; ++r) {
      values.data[c * kBlockLanes + r] =
          c % 5 == 0 ? 1.0f : std::numeric_limits<float>::quiet_NaN();
    }
  }
  for (const KernelTable* table : present_kernels()) {
    table->dense_layer({values.data, biases.data, inputs.data, outputs.data, 0, kColumns,
                        kBlockLanes, 0, false, false, true});
    for (uint32_t r = 0; r < kBlockLanes; ++r) EXPECT_EQ(outputs.data[r], 14.0f) << table->name;
  }
}

// Counts around every vector, from a list that ends with the last number; nothing behind the next 16 is
// written.
TEST(GatherInputs, TakesEachFromItsPlace) {
  constexpr uint32_t kFrom = 70;
  float from[kFrom];
  for (uint32_t i = 0; i < kFrom; ++i) from[i] = static_cast<float>(i) + 0.5f;
  for (const KernelTable* table : present_kernels()) {
    for (uint32_t count = 0; count <= 65; ++count) {
      std::vector<uint16_t> at(count);
      for (uint32_t i = 0; i < count; ++i) at[i] = static_cast<uint16_t>((i * 37 + 69) % kFrom);
      const uint32_t padded = (count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
      Aligned to(padded + 1);
      std::fill_n(to.data, padded + 1, -1.0f);
      table->gather_inputs(from, at.data(), count, to.data);
      for (uint32_t i = 0; i < count; ++i) {
        ASSERT_EQ(to.data[i], from[at[i]]) << table->name << ", " << count;
      }
      ASSERT_EQ(to.data[padded], -1.0f) << table->name << ", " << count;
    }
  }
}

// A layer of one column: each half comes out as it is.
TEST(DenseLayer, EveryFiniteHalfIsReadExactly) {
  std::vector<uint16_t> all;
  for (uint32_t half = 0; half < 65536; ++half) {
    if ((half & 0x7C00) != 0x7C00) all.push_back(static_cast<uint16_t>(half));
  }
  const auto count = static_cast<uint32_t>(all.size());
  ASSERT_EQ(count % kBlockLanes, 0u);
  Aligned biases(count), outputs(count), floats(count);
  AlignedHalves halves(biases.data, count);
  std::copy(all.begin(), all.end(), halves.data);
  const float one = 1;
  for (const KernelTable* table : present_kernels()) {
    table->dense_layer(
        {halves.data, biases.data, &one, outputs.data, 0, 1, count, 0, true, false, false});
    table->floats_from_halves(halves.data, count, floats.data);
    for (uint32_t i = 0; i < count; ++i) {
      ASSERT_EQ(floats.data[i], outputs.data[i]) << table->name << ", " << all[i];
      ASSERT_EQ(outputs.data[i], float_from_half(all[i])) << table->name << ", " << all[i];
    }
  }
}

TEST(DenseLayer, HalvesGiveWhatTheirFloatsGive) {
  Random random = Random::from_seed(14, 1);
  for (uint32_t columns : {1u, 2u, 57u}) {
    for (uint32_t row_count : {3u, 16u, 100u}) {
      const uint32_t rows = (row_count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
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
      for (const KernelTable* table : present_kernels()) {
        DenseLayerArgs args = {values.data, biases.data, inputs.data(), expected.data,
                               0,           columns,     row_count,     3,
                               false,       false,       false};
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

// Blocks whose lanes have different columns and numbers of steps, controls of 0 among them; a step
// more is stored than used, as at a coarse LOD.
TEST(QuaternionJointsKernel, ProductOfTheBlendsOfEachLane) {
  Random random = Random::from_seed(12, 1);
  constexpr uint32_t kFloats = 4 * kBlockLanes, kControls = 19;
  for (uint32_t most : {0u, 1u, 2u, 17u, 70u}) {
    for (uint32_t blocks : {1u, 3u}) {
      const size_t steps = size_t{blocks} * (most + 1);
      Aligned values(steps * kFloats), rotations(blocks * kFloats),
          lane_steps(blocks * kBlockLanes);
      std::vector<uint16_t> columns(steps * kBlockLanes);
      std::vector<uint32_t> first_steps, step_counts(blocks, most);
      std::vector<float> controls(kControls);
      for (uint32_t b = 0; b < blocks; ++b) first_steps.push_back(b * (most + 1));
      for (uint16_t& column : columns) column = static_cast<uint16_t>(random.below(kControls));
      for (float& x : controls) x = static_cast<float>(random.between(-0.5, 1.5));
      controls[1] = controls[2] = 0;
      for (uint32_t i = 0; i < blocks * kBlockLanes; ++i) {
        lane_steps.data[i] = static_cast<float>(i == 3 ? most : random.below(most + 1));
      }
      for (size_t s = 0; s < steps; ++s) {
        for (uint32_t j = 0; j < kBlockLanes; ++j) {
          double q[4], length = 0;
          for (double& part : q) part = random.between(-1, 1);
          q[3] = std::fabs(q[3]) + 0.2;
          for (double part : q) length += part * part;
          for (uint32_t k = 0; k < 4; ++k) {
            values.data[s * kFloats + k * kBlockLanes + j] =
                float_from_half(half_from_float(static_cast<float>(q[k] / std::sqrt(length))));
          }
        }
      }
      const AlignedHalves halves(values.data, steps * kFloats);
      std::vector<float> reference;  // the bits of every instruction set
      for (const KernelTable* table : present_kernels()) {
        QuaternionJointArgs args = {halves.data,        columns.data(),  first_steps.data(),
                                    step_counts.data(), lane_steps.data, controls.data(),
                                    rotations.data,     blocks,          true};
        table->quaternion_joints(args);
        const std::vector<float> from_halves(rotations.data, rotations.data + blocks * kFloats);
        args.values = values.data;
        args.halves = false;
        table->quaternion_joints(args);
        EXPECT_TRUE(std::equal(from_halves.begin(), from_halves.end(), rotations.data));
        if (reference.empty()) reference = from_halves;
        EXPECT_EQ(std::memcmp(reference.data(), rotations.data, reference.size() * sizeof(float)),
                  0)
            << table->name;
      }
      for (uint32_t i = 0; i < blocks * kBlockLanes; ++i) {
        double a[4] = {0, 0, 0, 1};
        const uint32_t lane = i % kBlockLanes;
        for (uint32_t s = 0; s < static_cast<uint32_t>(lane_steps.data[i]); ++s) {
          const size_t step = first_steps[i / kBlockLanes] + s;
          const float* q = values.data + step * kFloats + lane;
          const double w = controls[columns[step * kBlockLanes + lane]];
          double l[4], length = 0;
          for (uint32_t k = 0; k < 4; ++k) l[k] = w * q[k * kBlockLanes];
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
          ASSERT_NEAR(rotations.data[i / kBlockLanes * kFloats + k * kBlockLanes + lane], a[k],
                      4e-6)
              << most << " steps, lane " << i;
        }
      }
    }
  }
}

// Random solver data for the kernel: one solver of `inputs` inputs and `poses` poses.
struct KernelSolver {
  uint32_t lanes;
  RbfSolverPlan plan = {};
  Aligned targets, inverses, scales, factors, weights, results;
  std::vector<float> inputs;

  KernelSolver(Random& random, bool angular, uint32_t input_count, uint32_t poses)
      : lanes((poses + kBlockLanes - 1) / kBlockLanes * kBlockLanes),
        targets(size_t{lanes} * std::max(input_count, 1u)), inverses(size_t{lanes} * poses),
        scales(lanes), factors(lanes), weights(lanes), results(lanes), inputs(input_count) {
    plan.input_count = input_count;
    plan.pose_count = poses;
    plan.angle_inputs = angular ? 4 : 0;
    plan.threshold = -1;
    plan.first_control = kNoFirstControl;
    const auto fill = [&](const auto& at) {
      for (uint32_t i = 0; i < input_count; i += angular ? 4 : 1) {
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
    for (uint32_t p = 0; p < lanes; ++p) {
      for (uint32_t i = 0; i < std::max(input_count, 1u); ++i)
        target(i, p) = p < poses ? 0.0f : NAN;
      if (p < poses) fill([&](uint32_t i) -> float& { return target(i, p); });
      scales.data[p] = static_cast<float>(random.between(0.5, 2));
      factors.data[p] = static_cast<float>(random.between(-2, 2));
    }
    fill([&](uint32_t i) -> float& { return inputs[i]; });
    // Near the unit matrix, or a sum of weights might all but vanish.
    for (uint32_t r = 0; r < poses; ++r) {
      for (uint32_t c = 0; c < poses; ++c) {
        inverse(r, c) = static_cast<float>((r == c) + random.between(-0.05, 0.05));
      }
    }
  }

  void set_function(uint8_t function) {
    plan.function = function;
    plan.scale = function < 2 ? -0.4f : 0.4f;
  }
  float& target(uint32_t input, uint32_t pose) const {
    return targets.data[size_t{input} * lanes + pose];
  }

  float& inverse(uint32_t row, uint32_t column) const {
    const size_t block = size_t{row / kBlockLanes} * plan.pose_count;
    return inverses.data[(block + column) * kBlockLanes + row % kBlockLanes];
  }

  void run(const KernelTable& table) const {
    const uint16_t list[] = {0};
    table.rbf_solvers({&plan, list, 1, inputs.data(), nullptr, nullptr, 0, 0, targets.data,
                       inverses.data, scales.data, factors.data, weights.data, results.data,
                       nullptr});
  }

  double model_weight(uint32_t p) const {
    double squared = 0;
    for (uint32_t i = 0; i < plan.input_count; i += (plan.angle_inputs != 0) ? 4 : 1) {
      if (!(plan.angle_inputs != 0)) {
        const double d = double{target(i, p)} - inputs[i];
        squared += d * d;
        continue;
      }
      double dot = 0;
      for (uint32_t k = i; k < i + 4; ++k) dot += double{target(k, p)} * inputs[k];
      const double angle = dot * dot > 1 ? 0 : std::acos(2 * dot * dot - 1);
      squared += angle * angle;
    }
    const double x = std::sqrt(squared) * plan.scale;
    if (plan.function < 2) return std::exp2(x);
    return std::fmax(0.0, 1 - std::pow(x, 2 * plan.function - 3));
  }
};

TEST(RbfSolvers, EveryDistanceFunctionAndCountToTheBit) {
  Random random = Random::from_seed(13, 1);
  for (bool angular : {false, true}) {
    for (uint32_t input_count : {4u, 8u}) {
      for (uint8_t function = 0; function <= 4; ++function) {
        for (uint32_t poses : {1u, 5u, 8u, 13u, 16u, 17u, 40u}) {
          for (int options = 0; options < 4; ++options) {
            KernelSolver solver(random, angular, input_count, poses);
            solver.set_function(function);
            solver.plan.interpolative = options & 1;
            solver.plan.always_normalize = options & 2;
            solver.target(0, 0) = NAN;

            std::vector<double> expected(poses);
            for (uint32_t p = 1; p < poses; ++p) expected[p] = solver.model_weight(p);
            if (solver.plan.interpolative) {
              std::vector<double> mixed(poses);
              for (uint32_t p = 0; p < poses; ++p) {
                for (uint32_t t = 0; t < poses; ++t) {
                  mixed[p] += expected[t] * solver.inverse(p, t);
                }
                mixed[p] = std::fmin(std::fmax(mixed[p], 0.0), 1.0);
              }
              expected = mixed;
            }
            double sum = 0;
            for (double w : expected) sum += w;
            const bool divides = sum > 1 || (solver.plan.always_normalize && sum > 0);

            std::vector<float> first;
            for (const KernelTable* table : present_kernels()) {
              SCOPED_TRACE(table->name);
              solver.run(*table);
              EXPECT_EQ(solver.weights.data[0], 0.0f) << "what is not a number weighs nothing";
              for (uint32_t p = 0; p < poses; ++p) {
                const double all = double{solver.scales.data[p]} * solver.factors.data[p];
                ASSERT_NEAR(solver.results.data[p], all * expected[p] / (divides ? sum : 1), 1e-4)
                    << "function " << int{function} << ", angular " << angular << ", pose " << p;
              }
              const std::vector<float> mine(solver.results.data, solver.results.data + poses);
              if (first.empty()) first = mine;
              EXPECT_EQ(std::memcmp(mine.data(), first.data(), poses * sizeof(float)), 0);
            }
          }
        }
      }
    }
  }
}

// A batch of solvers of all kinds, whole rotations, swings, twists and plain inputs: each lane has the
// bits of one character alone, on every instruction set.
TEST(RbfSolvers, BatchHasTheBitsOfOneByOne) {
  Random random = Random::from_seed(13, 2);
  constexpr uint32_t kControls = 40, kPoses = 40, kSolvers = 24, kRows = kSolvers * 48;
  for (uint32_t lane_count : {2u, 7u, 16u, 29u, 32u}) {
    std::vector<RbfSolverPlan> plans(kSolvers);
    std::vector<uint16_t> list, inputs;
    Aligned targets(size_t{kSolvers} * 48 * 8), inverses(size_t{kSolvers} * 48 * kPoses);
    Aligned scales(kRows), factors(kRows), swings(kBlockLanes);
    std::vector<uint16_t> rotation_inputs(4 * kBlockLanes);
    for (uint16_t& control : rotation_inputs)
      control = static_cast<uint16_t>(random.below(kControls));
    for (uint32_t i = 0; i < kBlockLanes; ++i) swings.data[i] = i < 8 ? 1.0f : 0.0f;
    size_t target = 0, inverse = 0;
    uint32_t lane = 0, control = kControls;
    for (uint32_t i = 0; i < kSolvers; ++i) {
      RbfSolverPlan& plan = plans[i];
      constexpr uint8_t kKinds[] = {0, 4, 3, 2};
      plan.angle_inputs = kKinds[i % 4];
      const uint32_t rotations = random.below(3);  // none, too
      plan.input_count = plan.angle_inputs ? plan.angle_inputs * rotations : 3 * rotations;
      plan.first_input = static_cast<uint32_t>(inputs.size());
      if (i % 4 >= 2) plan.first_input = (i % 4 == 2 ? 0 : 8) + random.below(6);
      for (uint32_t k = 0; i % 4 < 2 && k < plan.input_count; ++k) {
        inputs.push_back(static_cast<uint16_t>(random.below(kControls)));
      }
      plan.pose_count = random.below(kPoses + 1);
      plan.first_target = target;
      plan.first_inverse = inverse;
      plan.first_lane = lane;
      const uint32_t stride = (plan.pose_count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
      target += size_t{stride} * std::max(plan.input_count, 1u);
      inverse += size_t{stride} * plan.pose_count;
      lane += stride;
      plan.first_control = kNoFirstControl;
      if (random.chance(0.5)) plan.first_control = control, control += plan.pose_count;
      plan.function = static_cast<uint8_t>(random.below(5));
      plan.scale = plan.function < 2 ? -0.4f : 0.4f;
      if (random.chance(0.1)) plan.scale = -plan.scale;
      plan.threshold = random.chance(0.5) ? -1.0f : 0.01f;
      plan.interpolative = random.chance(0.5);
      plan.always_normalize = random.chance(0.5);
      list.push_back(static_cast<uint16_t>(i));
    }
    const auto fill = [&](const Aligned& values, size_t count, double low) {
      for (size_t i = 0; i < count; ++i)
        values.data[i] = static_cast<float>(random.between(low, 1));
    };
    fill(targets, target, -1);
    fill(inverses, inverse, -0.2);
    fill(scales, lane, 0.5);
    fill(factors, lane, -1);

    for (const RbfSolverPlan& plan : plans) {  // what fills the last block
      const uint32_t stride = (plan.pose_count + kBlockLanes - 1) / kBlockLanes * kBlockLanes;
      for (uint32_t p = plan.pose_count; p < stride; ++p) {
        for (uint32_t i = 0; i < std::max(plan.input_count, 1u); ++i) {
          targets.data[plan.first_target + size_t{i} * stride + p] = NAN;
        }
        float* inverse_lane = inverses.data + plan.first_inverse +
                              size_t{p / kBlockLanes} * plan.pose_count * kBlockLanes +
                              p % kBlockLanes;
        for (uint32_t c = 0; c < plan.pose_count; ++c) inverse_lane[c * kBlockLanes] = 0;
      }
      for (uint32_t p = 0; p < plan.pose_count && plan.input_count == 0; ++p) {
        targets.data[plan.first_target + p] = 0;
      }
    }

    std::vector<std::vector<float>> controls(lane_count), expected_controls;
    for (auto& row : controls) {
      row.resize(control);
      for (uint32_t c = 0; c < kControls; ++c) row[c] = static_cast<float>(random.between(-1, 1));
      if (random.chance(0.3)) std::fill(row.begin(), row.begin() + kControls, 0.0f);
    }
    for (const KernelTable* table : present_kernels()) {
      SCOPED_TRACE(table->name);
      std::vector<std::vector<float>> alone = controls, results_alone;
      for (auto& row : alone) {
        Aligned fetched(inputs.size() + 1), rotations(4 * kBlockLanes), weights(kRows), out(kRows);
        for (size_t i = 0; i < inputs.size(); ++i) fetched.data[i] = row[inputs[i]];
        for (size_t i = 0; i < 4 * kBlockLanes; ++i) rotations.data[i] = row[rotation_inputs[i]];
        table->rbf_solvers({plans.data(), list.data(), kSolvers, fetched.data, rotations.data,
                            swings.data, 0, 1, targets.data, inverses.data, scales.data,
                            factors.data, weights.data, out.data, row.data()});
        results_alone.emplace_back(out.data, out.data + lane);
      }
      std::vector<std::vector<float>> together = controls;
      std::vector<std::vector<float>> results(lane_count, std::vector<float>(lane));
      std::vector<float*> rows, out;
      for (auto& row : together) rows.push_back(row.data());
      for (auto& row : results) out.push_back(row.data());
      Aligned lanes(size_t{control} * kBatchLanes), parts(4 * kBlockLanes * kBatchLanes),
          weights(kPoses * kBatchLanes), mixed(kPoses * kBatchLanes);
      table->gather_lanes(rows.data(), lane_count, kControls, lanes.data);
      for (uint32_t c = 0; c < kControls; ++c) {
        for (uint32_t k = 0; k < kBatchLanes; ++k) {
          ASSERT_EQ(lanes.data[c * kBatchLanes + k], k < lane_count ? together[k][c] : 0.0f);
        }
      }
      // And back, behind one number that stays and before another.
      std::vector<std::vector<float>> back(lane_count, std::vector<float>(kControls + 2, 7.0f));
      std::vector<float*> back_rows;
      for (auto& row : back) back_rows.push_back(row.data());
      table->scatter_lanes(lanes.data, kControls, lane_count, back_rows.data(), 1);
      for (uint32_t k = 0; k < lane_count; ++k) {
        EXPECT_EQ(back[k].front(), 7.0f);
        EXPECT_EQ(back[k].back(), 7.0f);
        EXPECT_TRUE(
            std::equal(together[k].begin(), together[k].begin() + kControls, back[k].begin() + 1));
      }
      table->rbf_batch({plans.data(),
                        list.data(),
                        kSolvers,
                        inputs.data(),
                        rotation_inputs.data(),
                        swings.data,
                        targets.data,
                        inverses.data,
                        scales.data,
                        factors.data,
                        lanes.data,
                        parts.data,
                        {weights.data, mixed.data},
                        rows.data(),
                        out.data(),
                        1,
                        lane_count});
      if (expected_controls.empty()) expected_controls = alone;
      for (uint32_t k = 0; k < lane_count; ++k) {
        EXPECT_EQ(std::memcmp(alone[k].data(), expected_controls[k].data(), control * 4), 0) << k;
        ASSERT_EQ(std::memcmp(alone[k].data(), together[k].data(), control * 4), 0) << k;
        for (const RbfSolverPlan& plan : plans) {
          if (plan.first_control != kNoFirstControl) {
            for (uint32_t c = plan.first_control; c < plan.first_control + plan.pose_count; ++c) {
              ASSERT_EQ(std::memcmp(&lanes.data[c * kBatchLanes + k], &together[k][c], 4), 0);
            }
            continue;
          }
          ASSERT_EQ(std::memcmp(&results_alone[k][plan.first_lane], &results[k][plan.first_lane],
                                plan.pose_count * sizeof(float)),
                    0)
              << "lane " << k;
        }
      }
    }
  }
}

// What fills the last block must count for nothing, with inputs or without.
TEST(RbfSolvers, LanesWithoutAPoseWeighNothing) {
  Random random = Random::from_seed(15, 1);
  for (uint32_t input_count : {0u, 3u, 4u}) {
    for (bool angular : {false, true}) {
      KernelSolver solver(random, angular && input_count != 3, input_count, 3);
      solver.set_function(0);
      solver.plan.always_normalize = true;
      for (uint32_t p = 0; p < 3; ++p) solver.scales.data[p] = solver.factors.data[p] = 1;
      for (const KernelTable* table : present_kernels()) {
        solver.run(*table);
        float sum = 0;
        for (uint32_t p = 0; p < 3; ++p) sum += solver.results.data[p];
        EXPECT_NEAR(sum, 1, 1e-6) << table->name << ", " << input_count << " inputs";
        for (uint32_t p = 3; p < solver.lanes; ++p) {
          EXPECT_EQ(solver.weights.data[p], 0) << table->name << ", " << input_count << " inputs";
        }
      }
    }
  }
}

// The function itself, before sums and threshold.
TEST(RbfSolvers, WeightsWithinTheirBound) {
  Random random = Random::from_seed(16, 1);
  for (int round = 0; round < 200; ++round) {
    KernelSolver solver(random, round % 2, 4, 40);
    solver.set_function(static_cast<uint8_t>(round / 2 % 5));
    for (const KernelTable* table : present_kernels()) {
      solver.run(*table);
      for (uint32_t p = 0; p < 40; ++p) {
        ASSERT_NEAR(solver.weights.data[p], solver.model_weight(p), 3e-6) << table->name;
      }
    }
  }
}

}  // namespace
}  // namespace mien
