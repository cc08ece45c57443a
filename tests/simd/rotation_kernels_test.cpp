// SPDX-License-Identifier: MIT
// Euler angles, twists and swings in lanes: every instruction set present against double precision, and
// against each other to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "author/base/random.h"
#include "tests/simd/present_kernels.h"

namespace mien {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr uint8_t kAxes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

using Quad = std::array<double, 4>;

Quad product(const Quad& a, const Quad& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}
double length(const Quad& q) {
  return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}
Quad scaled(const Quad& q, double s) { return {q[0] * s, q[1] * s, q[2] * s, q[3] * s}; }
Quad conjugate(const Quad& q) { return {-q[0], -q[1], -q[2], q[3]}; }

/// Radians between two rotations, of any length but 0.
double angle_between(const Quad& a, const Quad& b) {
  const Quad turn = product(scaled(a, 1 / length(a)), conjugate(scaled(b, 1 / length(b))));
  return 2 * std::atan2(std::hypot(turn[0], turn[1], turn[2]), std::fabs(turn[3]));
}

EulerForm random_form(Random& random, int sequence) {
  EulerForm form = {};
  std::copy(kAxes[sequence], kAxes[sequence] + 3, form.axes);
  form.parity = sequence == 0 || sequence == 3 || sequence == 4 ? 1.0f : -1.0f;
  const float unit = random.chance(0.5) ? 0.017453292f : 1.0f;
  for (int i = 0; i < 3; ++i) {
    const float sign = random.chance(0.5) ? 1.0f : -1.0f;
    form.to_radians[i] = sign * unit;
    form.from_radians[i] = sign / unit;
  }
  return form;
}

Quad quaternion_of(const EulerForm& form, const std::array<double, 3>& angles) {
  Quad q = {0, 0, 0, 1};
  for (const uint8_t axis : form.axes) {
    const double half = angles[axis] * double{form.to_radians[axis]} / 2;
    Quad turn = {0, 0, 0, std::cos(half)};
    turn[axis] = std::sin(half);
    q = product(turn, q);
  }
  return q;
}

/// Rows of lanes in blocks.
struct Block {
  Block(uint32_t row_count, size_t lanes)
      : rows(row_count), storage(rows * (lanes + 2 * kBlockLanes) + 16, 0.0f) {
    const size_t past = reinterpret_cast<uintptr_t>(storage.data()) / sizeof(float) % 16;
    data = storage.data() + (past ? 16 - past : 0);
  }
  Block(const Block&) = delete;
  float& at(size_t lane, size_t row) {
    return data[(lane / kBlockLanes * rows + row) * kBlockLanes + lane % kBlockLanes];
  }
  uint32_t rows;
  std::vector<float> storage;
  float* data;
};

/// Runs a kernel on every instruction set, expects the same bits in the first lanes, and leaves them.
template <class Run>
void run_everywhere(Block& out, size_t lanes, uint32_t rows, Run&& run) {
  std::vector<float> first;
  for (const KernelTable* table : present_kernels()) {
    for (size_t i = 0; i < lanes; ++i) {  // what the one before it wrote
      for (uint32_t r = 0; r < rows; ++r) out.at(i, r) = 12345.0f;
    }
    run(*table);
    std::vector<float> now;
    for (size_t i = 0; i < lanes; ++i) {
      for (uint32_t r = 0; r < rows; ++r) now.push_back(out.at(i, r));
    }
    if (first.empty()) first = now;
    ASSERT_EQ(std::memcmp(first.data(), now.data(), now.size() * sizeof(float)), 0) << table->name;
  }
}

TEST(EulerKernels, DescribeTheRotationInEveryFormAndCount) {
  Random random = Random::from_seed(72, 1);
  for (int sequence = 0; sequence < 6; ++sequence) {
    for (uint32_t count : {1u, 3u, 4u, 5u, 8u, 9u, 15u, 16u, 17u, 31u, 100u}) {
      const EulerForm form = random_form(random, sequence);
      Block quaternions(4, count), angles(4, count);
      for (size_t i = 0; i < count; ++i) {
        const double size = std::exp(random.between(-20, 20));
        for (int k = 0; k < 4; ++k) {
          quaternions.at(i, k) = static_cast<float>(random.between(-1, 1) * size);
        }
      }
      run_everywhere(angles, count, 3, [&](const KernelTable& table) {
        table.angles_from_quaternions({form, quaternions.data, angles.data, count});
      });
      for (size_t i = 0; i < count; ++i) {
        const Quad expected = {quaternions.at(i, 0), quaternions.at(i, 1), quaternions.at(i, 2),
                               quaternions.at(i, 3)};
        const Quad mine = quaternion_of(form, {angles.at(i, 0), angles.at(i, 1), angles.at(i, 2)});
        ASSERT_LT(angle_between(mine, expected), 1e-6) << "sequence " << sequence;
        const uint8_t second = form.axes[1];
        ASSERT_LE(std::fabs(angles.at(i, second) * double{form.to_radians[second]}),
                  kPi / 2 + 1e-6);
      }
    }
  }
}

TEST(EulerKernels, MayWriteWhereTheyRead) {
  Random random = Random::from_seed(72, 2);
  const EulerForm form = random_form(random, 1);
  for (const KernelTable* table : present_kernels()) {
    Block from(4, 20), to(4, 20);
    for (size_t i = 0; i < 20; ++i) {
      for (int k = 0; k < 4; ++k) from.at(i, k) = static_cast<float>(random.between(-1, 1));
    }
    table->quaternions_from_angles({form, from.data, to.data, 20});
    table->quaternions_from_angles({form, from.data, from.data, 20});
    for (size_t i = 0; i < 20; ++i) {
      for (int k = 0; k < 4; ++k) ASSERT_EQ(from.at(i, k), to.at(i, k)) << table->name;
    }
    table->angles_from_quaternions({form, from.data, to.data, 20});
    table->angles_from_quaternions({form, from.data, from.data, 20});
    for (size_t i = 0; i < 20; ++i) {
      for (int k = 0; k < 3; ++k) ASSERT_EQ(from.at(i, k), to.at(i, k)) << table->name;
    }
  }
}

TEST(EulerKernels, AnglesNearAndAtThePolesDescribeTheRotation) {
  Random random = Random::from_seed(72, 3);
  for (int sequence = 0; sequence < 6; ++sequence) {
    const EulerForm form = random_form(random, sequence);
    const uint8_t second = form.axes[1];
    constexpr double kOffsets[] = {0, 1e-9, 1e-8, 1e-7, 3e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.1};
    constexpr uint32_t kCount = 20 * 10;
    Block quaternions(4, kCount), angles(4, kCount);
    for (uint32_t i = 0; i < kCount; ++i) {
      const double radians[3] = {random.between(-kPi, kPi), random.between(-kPi, kPi),
                                 random.between(-kPi, kPi)};
      std::array<double, 3> a;
      for (int k = 0; k < 3; ++k) a[k] = radians[k] / double{form.to_radians[k]};
      a[second] = ((i % 2 ? kPi / 2 : -kPi / 2) + (i % 4 < 2 ? 1 : -1) * kOffsets[i / 20]) /
                  double{form.to_radians[second]};
      if (i / 20 == 0 && i % 20 < 2) a[form.axes[0]] = a[form.axes[2]] = 0;
      const Quad q = quaternion_of(form, a);
      for (int k = 0; k < 4; ++k) quaternions.at(i, k) = static_cast<float>(q[k]);
    }
    run_everywhere(angles, kCount, 3, [&](const KernelTable& table) {
      table.angles_from_quaternions({form, quaternions.data, angles.data, kCount});
    });
    for (size_t i = 0; i < kCount; ++i) {
      const Quad expected = {quaternions.at(i, 0), quaternions.at(i, 1), quaternions.at(i, 2),
                             quaternions.at(i, 3)};
      const Quad mine = quaternion_of(form, {angles.at(i, 0), angles.at(i, 1), angles.at(i, 2)});
      ASSERT_LT(angle_between(mine, expected), 1.5e-6) << "sequence " << sequence << ", lane " << i;
    }
  }
}

TEST(EulerKernels, TurnsAboutOneAxisAndNoTurnLeaveTheOtherAnglesZero) {
  Random random = Random::from_seed(72, 4);
  for (int sequence = 0; sequence < 6; ++sequence) {
    const EulerForm form = random_form(random, sequence);
    Block quaternions(4, 5), angles(4, 5);  // lane 3: the identity; lane 4: no length
    for (size_t i = 0; i < 3; ++i) {
      quaternions.at(i, i) = static_cast<float>(std::sin(0.3));
      quaternions.at(i, 3) = static_cast<float>(std::cos(0.3));
    }
    quaternions.at(3, 3) = 1;
    run_everywhere(angles, 5, 3, [&](const KernelTable& table) {
      table.angles_from_quaternions({form, quaternions.data, angles.data, 5});
    });
    for (size_t i = 0; i < 5; ++i) {
      for (size_t k = 0; k < 3; ++k) {
        if (i == k) {
          EXPECT_NEAR(angles.at(i, k) * form.to_radians[k], 0.6, 2e-7);
        } else {
          EXPECT_EQ(angles.at(i, k), 0) << "lane " << i << ", axis " << k;
        }
      }
    }
  }
}

TEST(EulerKernels, QuaternionsOfAnyAngles) {
  Random random = Random::from_seed(72, 5);
  for (int sequence = 0; sequence < 6; ++sequence) {
    for (uint32_t count : {1u, 7u, 16u, 40u}) {
      const EulerForm form = random_form(random, sequence);
      Block angles(4, count), quaternions(4, count);
      for (size_t i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) {
          const double turns = random.chance(0.2) ? 100 : 1;
          angles.at(i, k) =
              static_cast<float>(random.between(-7, 7) * turns * form.from_radians[k]);
        }
      }
      run_everywhere(quaternions, count, 4, [&](const KernelTable& table) {
        table.quaternions_from_angles({form, angles.data, quaternions.data, count});
      });
      for (size_t i = 0; i < count; ++i) {
        std::array<double, 3> a;
        for (size_t k = 0; k < 3; ++k) {
          // As it is rounded to half angles in radians.
          a[k] = double{angles.at(i, k) * (0.5f * form.to_radians[k])} * 2 /
                 double{form.to_radians[k]};
        }
        const Quad expected = quaternion_of(form, a);
        for (size_t k = 0; k < 4; ++k) ASSERT_NEAR(quaternions.at(i, k), expected[k], 4e-7);
      }
    }
  }
}

/// docs/rig-evaluation.md, 7 "Twist and swing".
Quad slerp_to_identity(const Quad& q, double t) {
  const double sign = q[3] < 0 ? -1 : 1, cosine = q[3] * sign;
  double from = 1 - t, to = t;
  if (cosine <= 1 - std::ldexp(1.0, -23)) {
    const double angle = std::acos(cosine);
    from = std::sin((1 - t) * angle) / std::sin(angle);
    to = std::sin(t * angle) / std::sin(angle);
  }
  Quad result = scaled(q, from);
  result[3] += to * sign;
  return result;
}
Quad twist_or_swing(const Quad& q, int axis, bool inverted, bool swing, double blend) {
  Quad twist = {0, 0, 0, q[3]};
  twist[axis] = inverted ? -q[axis] : q[axis];
  twist = length(twist) > 0 ? scaled(twist, 1 / length(twist)) : Quad{0, 0, 0, 1};
  if (!swing) return slerp_to_identity(twist, blend);
  Quad rest = product(q, twist);
  rest = scaled(conjugate(rest), 1 / (length(rest) * length(rest)));
  return product(twist, slerp_to_identity(rest, blend));
}

/// Lanes that read controls in an order of their own.
struct TwistsAndSwings {
  explicit TwistsAndSwings(uint32_t lanes)
      : count((lanes + kBlockLanes - 1) / kBlockLanes * kBlockLanes), rows(kTwistSwingRows, lanes),
        rotations(4, lanes), inputs(4 * count), controls(4 * count) {
    for (size_t i = 0; i < inputs.size(); ++i) {
      inputs[i] = static_cast<uint16_t>(inputs.size() - 1 - i);
    }
  }
  float& input(size_t lane, size_t k) {
    return controls[inputs[(lane / kBlockLanes * 4 + k) * kBlockLanes + lane % kBlockLanes]];
  }
  void set(size_t lane, size_t axis, bool inverted, double blend, bool swing) {
    rows.at(lane, axis) = inverted ? -1.0f : 1.0f;
    rows.at(lane, 3) = static_cast<float>(blend);
    rows.at(lane, 4) = swing ? 1.0f : 0.0f;
  }
  void run_everywhere() {
    mien::run_everywhere(rotations, count, 4, [&](const KernelTable& table) {
      table.twist_swing({inputs.data(), rows.data, controls.data(), rotations.data,
                         static_cast<uint32_t>(count / kBlockLanes)});
    });
  }
  size_t count;
  Block rows, rotations;
  std::vector<uint16_t> inputs;
  std::vector<float> controls;
};

TEST(TwistSwingKernel, EveryKindAxisBlendAndCount) {
  Random random = Random::from_seed(72, 6);
  for (uint32_t count : {1u, 4u, 7u, 8u, 13u, 16u, 33u, 400u}) {
    TwistsAndSwings lanes(count);
    std::vector<Quad> expected;
    for (size_t i = 0; i < count; ++i) {
      Quad q;
      for (double& part : q) part = random.between(-1, 1);
      if (random.chance(0.2)) q = {q[0] * 1e-4, q[1] * 1e-4, q[2] * 1e-4, q[3]};  // nearly none
      q = scaled(q, 1 / length(q));
      for (int k = 0; k < 4; ++k) lanes.input(i, k) = static_cast<float>(q[k]);
      const int axis = static_cast<int>(random.below(3));
      const bool swing = random.chance(0.5), inverted = swing || random.chance(0.5);
      constexpr double kBlends[] = {0, 0.25, 0.5, 0.8125, 1, 1.5, -0.5};
      const double blend = kBlends[random.below(7)];
      lanes.set(i, axis, inverted, blend, swing);
      for (int k = 0; k < 4; ++k) q[k] = lanes.input(i, k);
      expected.push_back(twist_or_swing(q, axis, inverted, swing, blend));
    }
    lanes.run_everywhere();
    for (size_t i = 0; i < count; ++i) {
      for (int k = 0; k < 4; ++k) {
        ASSERT_NEAR(lanes.rotations.at(i, k), expected[i][k], 2e-6)
            << "lane " << i << ", part " << k;
      }
    }
  }
}

/// Rows of 32 characters, aligned, with numbers of their own in the first `count`.
struct Characters {
  Characters(Random& random, size_t control_count, size_t count, double low, double high)
      : storage(control_count * kBatchLanes + 16) {
    const size_t past = reinterpret_cast<uintptr_t>(storage.data()) / sizeof(float) % 16;
    controls = storage.data() + (past ? 16 - past : 0);
    for (size_t c = 0; c < control_count; ++c) {
      for (size_t k = 0; k < count; ++k) {
        controls[c * kBatchLanes + k] = static_cast<float>(random.between(low, high));
      }
    }
  }
  std::vector<float> of(size_t character, size_t control_count) const {
    std::vector<float> own(control_count);
    for (size_t c = 0; c < control_count; ++c) own[c] = controls[c * kBatchLanes + character];
    return own;
  }
  std::vector<float> storage;
  float* controls;
};

/// Expects lanes `first` ... of a character in `together` to have the bits of those in `alone`.
void expect_character(const Block& together, size_t characters, size_t character,
                      const Block& alone, size_t first, size_t count) {
  const size_t blocks = (characters + kBlockLanes - 1) / kBlockLanes;
  for (size_t i = 0; i < count; ++i) {
    const size_t lane = i * blocks * kBlockLanes + character;
    for (uint32_t k = 0; k < 4; ++k) {
      const float a = const_cast<Block&>(together).at(lane, k);
      const float b = const_cast<Block&>(alone).at(first + i, k);
      ASSERT_EQ(std::memcmp(&a, &b, sizeof(a)), 0)
          << "lane " << first + i << ", character " << character << ": " << a << " and " << b;
    }
  }
}

TEST(TwistSwingKernel, CharactersInLanesHaveTheBitsOfOne) {
  Random random = Random::from_seed(72, 8);
  constexpr uint32_t kLanes = 23, kFirst = 3, kCount = 19;
  TwistsAndSwings lanes(kLanes);
  for (size_t i = 0; i < kLanes; ++i) {
    const bool swing = random.chance(0.4);
    lanes.set(i, random.below(3), swing || random.chance(0.5), random.between(-0.2, 1.2), swing);
  }
  for (uint32_t count : {1u, 5u, 16u, 17u, 32u}) {
    for (double size : {0.0, 1e-12, 1.0, 1e12}) {
      const Characters characters(random, lanes.controls.size(), count, -size, size);
      for (const KernelTable* table : present_kernels()) {
        SCOPED_TRACE(table->name);
        Block together(4, size_t{kCount} * 32);
        table->twist_swing_batch({lanes.inputs.data(), lanes.rows.data, characters.controls,
                                  together.data, kFirst, kCount, count});
        for (uint32_t k = 0; k < count; ++k) {
          lanes.controls = characters.of(k, lanes.controls.size());
          table->twist_swing({lanes.inputs.data(), lanes.rows.data, lanes.controls.data(),
                              lanes.rotations.data,
                              static_cast<uint32_t>(lanes.count / kBlockLanes)});
          expect_character(together, count, k, lanes.rotations, kFirst, kCount);
        }
      }
    }
  }
}

TEST(QuaternionBatchKernel, CharactersInLanesHaveTheBitsOfOne) {
  Random random = Random::from_seed(72, 9);
  constexpr uint32_t kJoints = 2 * kBlockLanes, kFirst = 5, kCount = 22, kControls = 30;
  for (uint32_t most : {1u, 6u, 70u}) {
    const size_t steps = size_t{2} * most;
    Block values(4, steps * kBlockLanes), lane_steps(1, kJoints), alone(4, kJoints);
    std::vector<uint16_t> columns(steps * kBlockLanes);
    const std::vector<uint32_t> first_steps = {0, most}, step_counts = {most, most};
    for (uint16_t& column : columns) column = static_cast<uint16_t>(random.below(kControls));
    for (size_t i = 0; i < steps * kBlockLanes; ++i) {
      Quad q = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1),
                random.between(0, 1)};
      q = scaled(q, 1 / length(q));
      for (int k = 0; k < 4; ++k) values.at(i, k) = static_cast<float>(q[k]);
    }
    for (uint32_t i = 0; i < kJoints; ++i) {
      lane_steps.at(i, 0) = static_cast<float>(random.below(most + 1));
    }
    for (uint32_t count : {1u, 7u, 16u, 31u}) {
      for (double high : {0.0, 1.0, 2e7}) {
        const Characters characters(random, kControls, count, high > 1 ? -high : 0, high);
        for (const KernelTable* table : present_kernels()) {
          SCOPED_TRACE(table->name);
          Block together(4, size_t{kCount} * 32);
          QuaternionBatchArgs batch = {values.data,
                                       columns.data(),
                                       first_steps.data(),
                                       step_counts.data(),
                                       lane_steps.data,
                                       characters.controls,
                                       together.data,
                                       kFirst,
                                       kCount,
                                       count,
                                       false};
          table->quaternion_batch(batch);
          for (uint32_t k = 0; k < count; ++k) {
            const std::vector<float> controls = characters.of(k, kControls);
            table->quaternion_joints({values.data, columns.data(), first_steps.data(),
                                      step_counts.data(), lane_steps.data, controls.data(),
                                      alone.data, 2, false});
            expect_character(together, count, k, alone, kFirst, kCount);
          }
        }
      }
    }
  }
}

// Rows lie anywhere, and what is beside a rotation stays.
TEST(ScatterRotationKernel, WritesTheNumbersOfEachCharacterAndNoMore) {
  Random random = Random::from_seed(72, 10);
  for (uint32_t count : {1u, 4u, 15u, 19u, 32u}) {
    for (bool quaternions : {false, true}) {
      Block rotation(4, 32);
      for (size_t i = 0; i < 32; ++i) {
        for (uint32_t k = 0; k < 4; ++k) {
          rotation.at(i, k) = static_cast<float>(random.between(-1, 1));
        }
      }
      for (const KernelTable* table : present_kernels()) {
        std::vector<std::vector<float>> rows(count, std::vector<float>(9, 7.0f));
        std::vector<float*> at;
        for (auto& row : rows) at.push_back(row.data() + 1);
        table->scatter_rotation(rotation.data, count, 2, quaternions, at.data());
        for (uint32_t c = 0; c < count; ++c) {
          for (uint32_t i = 0; i < 9; ++i) {
            const bool written = i >= 3 && i < (quaternions ? 7u : 6u);
            ASSERT_EQ(rows[c][i], written ? rotation.at(c, i - 3) : 7.0f)
                << table->name << ", character " << c << ", number " << i;
          }
        }
      }
    }
  }
}

TEST(TwistSwingKernel, EndsOfTheBlendAreExact) {
  TwistsAndSwings lanes(2);
  for (size_t i = 0; i < 2; ++i) {
    lanes.input(i, 1) = 0.6f;
    lanes.input(i, 3) = 0.8f;
    lanes.set(i, 1, false, static_cast<double>(i), false);  // the whole twist; the identity
  }
  lanes.run_everywhere();
  EXPECT_FLOAT_EQ(lanes.rotations.at(0, 1), 0.6f);
  EXPECT_FLOAT_EQ(lanes.rotations.at(0, 3), 0.8f);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(lanes.rotations.at(1, k), 0);
  EXPECT_FLOAT_EQ(lanes.rotations.at(1, 3), 1);
}

// Whose squares are hardly floats, or none.
TEST(TwistSwingKernel, MakesInputsUnitThatAreFarFromIt) {
  for (float size : {1e-35f, 1e-30f, 1e-12f, 1e12f, 1e30f, 1e38f}) {
    TwistsAndSwings unit(32), lanes(32);
    for (size_t i = 0; i < 32; ++i) {
      const bool far = i % 3 == 0;  // beside others that are unit
      const float parts[] = {0.1f, -0.7f, 0.1f, 0.7f};
      for (int k = 0; k < 4; ++k) {
        unit.input(i, k) = parts[k];
        lanes.input(i, k) = far ? parts[k] * size : parts[k];
      }
      for (auto* both : {&unit, &lanes}) both->set(i, i % 3, i % 2 != 0, 0.3, i % 2 != 0);
    }
    unit.run_everywhere();
    lanes.run_everywhere();
    for (size_t i = 0; i < 32; ++i) {
      for (int k = 0; k < 4; ++k) {
        ASSERT_NEAR(lanes.rotations.at(i, k), unit.rotations.at(i, k), 2e-6) << size << " " << i;
      }
    }
  }
}

// No part on the axis and w 0; no input at all; lengths far from 1; blends far from 0 ... 1.
TEST(TwistSwingKernel, GivesFiniteResultsForExtremeInputs) {
  Random random = Random::from_seed(72, 7);
  constexpr uint32_t kCount = 1600;
  TwistsAndSwings lanes(kCount);
  Block angles(4, kCount);
  constexpr float kLengths[] = {1e-9f, 1e-5f, 1, 1e5f, 1e9f, 1e-38f, 1e38f};
  constexpr float kBlends[] = {0, 1, -1e9f, 1e9f, 0.5f, 300};
  for (size_t i = 0; i < kCount; ++i) {
    const float size = kLengths[random.below(7)];
    for (int k = 0; k < 4; ++k) {
      lanes.input(i, k) =
          random.chance(0.4) ? 0.0f : static_cast<float>(random.between(-0.5, 0.5)) * size;
    }
    const uint32_t axis = random.below(3);
    lanes.set(i, axis, random.chance(0.5), kBlends[random.below(6)], random.chance(0.5));
  }
  lanes.run_everywhere();
  const EulerForm form = random_form(random, 2);
  run_everywhere(angles, kCount, 3, [&](const KernelTable& table) {
    table.angles_from_quaternions({form, lanes.rotations.data, angles.data, kCount});
  });
  for (size_t i = 0; i < kCount; ++i) {
    for (int k = 0; k < 4; ++k) ASSERT_TRUE(std::isfinite(lanes.rotations.at(i, k))) << i;
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(std::isfinite(angles.at(i, k))) << i;
  }
}

}  // namespace
}  // namespace mien
