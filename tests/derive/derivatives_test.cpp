// SPDX-License-Identifier: MIT
// Derivatives against central differences of the models in double precision (tests/support), each product in
// reverse against the one forward, and the documented choices where there is no derivative.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "integrations/program/model/ml_model.h"
#include "integrations/program/model/rbf_model.h"
#include "integrations/program/model/rotation_model.h"
#include "tests/derive/derivatives_handle.h"
#include "tests/support/deform_rig.h"
#include "tests/support/random_layer_rig.h"

namespace mien {
namespace {

std::vector<float> reverse(const DerivativesHandle& d, uint32_t from, uint32_t to,
                           const std::vector<float>& rows, uint32_t count = 1, uint32_t mesh = 0) {
  std::vector<float> out(size_of(d, from, mesh) * count);
  EXPECT_EQ(mien_derivatives_reverse(d.get(), from, to, mesh, count, rows.data(), out.data()),
            MIEN_OK);
  return out;
}

std::vector<float> random_row(Random& random, size_t count) {
  std::vector<float> row(count);
  for (float& v : row) v = static_cast<float>(random.between(-1, 1));
  return row;
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += double{a[i]} * double{b[i]};
  return sum;
}
double length(const std::vector<float>& a) { return std::sqrt(dot(a, a)); }

// For random u and v: (J u) v = u (J^T v), of which float sums lose a little of |J u| |v| + |u| |J^T v|.
void expect_transposed(const DerivativesHandle& d, Random& random, uint32_t from, uint32_t to,
                       uint32_t mesh = 0) {
  const std::vector<float> u = random_row(random, size_of(d, from, mesh));
  const std::vector<float> v = random_row(random, size_of(d, to, mesh));
  const std::vector<float> ju = forward(d, from, to, u, 1, mesh);
  const std::vector<float> jv = reverse(d, from, to, v, 1, mesh);
  const double norm = length(ju) * length(v) + length(u) * length(jv);
  EXPECT_LE(std::fabs(dot(ju, v) - dot(u, jv)), 1e-4 * norm + 1e-30)
      << "from " << from << " to " << to << ": " << dot(ju, v) << " and " << dot(u, jv);
}

// Many directions have the bits of single ones: where all of them move all controls, where each moves few, and
// where only one number counts. Rows beyond 32 are too few to be multiplied together, or enough.
void expect_same_bits(const DerivativesHandle& d, Random& random, uint32_t from, uint32_t to,
                      uint32_t mesh = 0) {
  const double shares[] = {1, 0.1, 0};
  for (uint32_t n = 0; n < 6; ++n) {
    const bool back = n % 2 != 0;
    const uint32_t count = n < 2 ? 37 : 34;
    const auto run = back ? reverse : forward;
    const size_t in = size_of(d, back ? to : from, mesh), out = size_of(d, back ? from : to, mesh);
    std::vector<float> rows = random_row(random, in * count);
    for (size_t i = 0; i < rows.size(); ++i) {
      if (i % in != 0 && !random.chance(shares[n / 2])) rows[i] = 0;
    }
    const std::vector<float> all = run(d, from, to, rows, count, mesh);
    for (const uint32_t k : {0u, 17u, 33u, count - 1}) {
      const std::vector<float> row(rows.begin() + static_cast<long>(k * in),
                                   rows.begin() + static_cast<long>((k + 1) * in));
      const std::vector<float> one = run(d, from, to, row, 1, mesh);
      for (size_t i = 0; i < out; ++i) {
        ASSERT_EQ(one[i], all[k * out + i])
            << (back ? "reverse" : "forward") << " from " << from << " to " << to << ", " << i;
      }
    }
  }
}

const uint32_t kChain[] = {MIEN_POINT_GUI,    MIEN_POINT_RAW,      MIEN_POINT_CONTROLS,
                           MIEN_POINT_JOINTS, MIEN_POINT_LOCALS,   MIEN_POINT_MODELS,
                           MIEN_POINT_SKINS,  MIEN_POINT_POSITIONS};

void expect_consistent(const DerivativesHandle& d, Random& random, bool geometry) {
  for (size_t i = 0; i < (geometry ? 8u : 4u); ++i) {
    for (size_t k = i + 1; k < (geometry ? 8u : 4u); ++k) {
      expect_transposed(d, random, kChain[i], kChain[k]);
    }
    if (kChain[i] > MIEN_POINT_CONTROLS) continue;
    expect_transposed(d, random, kChain[i], MIEN_POINT_CHANNELS);
    expect_transposed(d, random, kChain[i], MIEN_POINT_MAPS);
  }
  expect_same_bits(d, random, MIEN_POINT_GUI, MIEN_POINT_JOINTS);
  expect_same_bits(d, random, MIEN_POINT_RAW, MIEN_POINT_MAPS);
  if (!geometry) return;
  expect_transposed(d, random, MIEN_POINT_CHANNELS, MIEN_POINT_POSITIONS);
  expect_same_bits(d, random, MIEN_POINT_RAW, MIEN_POINT_POSITIONS);
  expect_same_bits(d, random, MIEN_POINT_JOINTS, MIEN_POINT_SKINS);
}

// The model of a whole rig ------------------------------------------------------------------------

double clamped(double v) { return v > 0 ? std::fmin(v, 1.0) : 0; }

std::vector<double> model_controls(const LayerRig& rig, const std::vector<double>& raw,
                                   uint32_t lod, Span<const float> computed) {
  std::vector<double> x = initial_controls(rig);
  std::copy(raw.begin(), raw.end(), x.begin());
  std::vector<double> masks(8, 1.0);
  model_ml(rig, lod, masks, false, x);
  model_rbf(rig, lod, x);
  const PlainRig& base = rig.base;
  for (uint16_t p = 0; p < base.psd_count; ++p) {
    double weight = 1, product = 1;
    bool any = false;
    for (const PlainPsd& triple : base.psds) {
      if (triple.row != base.raw_count + p) continue;
      any = true;
      weight *= triple.value;
      product *= clamped(x[triple.column]);
    }
    const double value = any ? std::fmin(1.0, weight * product) : 0;
    // Those that no LOD needs stay 0.
    x[base.raw_count + p] = computed[base.raw_count + p] == 0 ? 0 : value;
  }
  return x;
}

/// One number of the model, by a step along a direction of the raw controls.
using Model = std::function<std::vector<double>(double step)>;

/// The central difference, and whether both sides agree on it.
std::vector<double> difference(const Model& model, double step, std::vector<bool>& smooth) {
  const std::vector<double> before = model(-step), here = model(0), after = model(step);
  std::vector<double> slopes(here.size());
  smooth.assign(here.size(), true);
  for (size_t i = 0; i < here.size(); ++i) {
    slopes[i] = (after[i] - before[i]) / (2 * step);
    const double left = (here[i] - before[i]) / step, right = (after[i] - here[i]) / step;
    smooth[i] = std::fabs(left - right) <= 1e-3 * (1 + std::fabs(slopes[i]));
  }
  return slopes;
}

/// Derivatives of the quaternions that joint values mean, and of translations and scales: 10 numbers each.
std::vector<double> flat(const std::vector<ModelJoint>& joints,
                         const std::vector<ModelJoint>& signs) {
  std::vector<double> all;
  for (size_t j = 0; j < joints.size(); ++j) {
    const ModelQuaternion q = unit(joints[j].rotation), s = unit(signs[j].rotation);
    const double sign = q.x * s.x + q.y * s.y + q.z * s.z + q.w * s.w < 0 ? -1 : 1;
    all.insert(all.end(), joints[j].translation.begin(), joints[j].translation.end());
    for (const double part : {q.x, q.y, q.z, q.w}) all.push_back(sign * part);
    all.insert(all.end(), joints[j].scale.begin(), joints[j].scale.end());
  }
  return all;
}

struct Compared {
  size_t numbers = 0, kinks = 0;
};

void expect_slopes(const std::vector<double>& mine, const std::vector<double>& expected,
                   const std::vector<bool>& smooth, double tolerance, Compared& compared,
                   const char* what) {
  ASSERT_EQ(mine.size(), expected.size());
  double norm = 0;
  for (const double v : expected) norm = std::fmax(norm, std::fabs(v));
  for (size_t i = 0; i < mine.size(); ++i) {
    ++compared.numbers;
    if (!smooth[i]) {
      ++compared.kinks;
      continue;
    }
    ASSERT_NEAR(mine[i], expected[i], tolerance * (1 + norm)) << what << " " << i;
  }
}

void compare_layer_rig(const LayerRig& rig, uint32_t rotation, Random& random, Compared& compared) {
  const LayerFile file(rig);
  const RigHandle handle = create_rig(file.dna.get(), MIEN_ISA_ENVIRONMENT, MIEN_OK, rotation);
  const bool quaternions = rotation == MIEN_ROTATION_OUTPUT_QUATERNION;
  for (uint32_t lod = 0; lod < rig.base.lod_count; ++lod) {
    Character character(handle);
    std::vector<float> raw = random_raw(rig, {4, 8}, random);
    for (size_t i = 0; i < 4; ++i) raw[i] = static_cast<float>(random.between(0.1, 0.9));
    std::copy(raw.begin(), raw.end(), character.raw.begin());
    character.evaluate(lod);
    const DerivativesHandle d = create_derivatives(handle.get());
    linearize(d, character);
    const std::vector<float> direction = random_row(random, raw.size());
    const auto controls_at = [&](double step) {
      std::vector<double> moved(raw.begin(), raw.end());
      for (size_t i = 0; i < moved.size(); ++i) moved[i] += step * direction[i];
      return model_controls(rig, moved, lod, character.controls);
    };
    std::vector<bool> smooth;
    // The model's dot products of quaternions are 32-bit floats: smaller steps would show their rounding.
    const std::vector<double> expected = difference(controls_at, 2e-4, smooth);
    std::vector<float> made = forward(d, MIEN_POINT_RAW, MIEN_POINT_CONTROLS, direction);
    // The inverse of an interpolative solver may magnify how it was rounded; then slopes tell nothing either.
    const std::vector<double> modeled_controls = controls_at(0);
    bool exact = true;
    for (size_t i = 0; i < smooth.size(); ++i) {
      exact &= smooth[i];
      // A pose control of 0 may lie on either side of its clamp.
      const bool at_clamp = i >= rig.first_rbf() && std::fabs(character.controls[i]) < 1e-6 &&
                            std::fabs(made[i] - expected[i]) > 1e-3;
      if (std::fabs(character.controls[i] - modeled_controls[i]) <= 1e-5 && !at_clamp) continue;
      exact = smooth[i] = false;
    }
    // Pose controls of solvers have that rounding, magnified by inverses: ten times the tolerance.
    const auto rbf = static_cast<std::ptrdiff_t>(rig.first_rbf());
    const std::vector<double> slopes(made.begin(), made.end());
    expect_slopes({slopes.begin(), slopes.begin() + rbf},
                  {expected.begin(), expected.begin() + rbf},
                  {smooth.begin(), smooth.begin() + rbf}, 1e-3, compared, "control");
    expect_slopes({slopes.begin() + rbf, slopes.end()}, {expected.begin() + rbf, expected.end()},
                  {smooth.begin() + rbf, smooth.end()}, 1e-2, compared, "pose control");

    if (!exact) continue;
    const std::vector<ModelJoint> here = model_joints(rig, controls_at(0), lod, quaternions);
    const std::vector<double> joints = difference(
        [&](double step) {
          std::vector<double> moved = modeled_controls;
          for (size_t i = 0; i < moved.size(); ++i) moved[i] += step * expected[i];
          return flat(model_joints(rig, moved, lod, quaternions), here);
        },
        1e-5, smooth);
    // At coarser LODs the model orders the columns of some quaternion joints otherwise than files need.
    const std::vector<double> evaluated =
        flat(joints_of(rig, character.joints.data, character.joints.count, quaternions), here);
    const std::vector<double> modeled = flat(here, here);
    for (size_t i = 0; i < smooth.size(); ++i) {
      if (std::fabs(evaluated[i] - modeled[i]) > 1e-3) smooth[i] = false;
    }
    // What the product says of the same numbers: joint values moved along it.
    made = forward(d, MIEN_POINT_RAW, MIEN_POINT_JOINTS, direction);
    std::vector<bool> all;
    const std::vector<double> mine = difference(
        [&](double step) {
          std::vector<ModelJoint> moved(here.size());
          const size_t width = quaternions ? 10 : 9;
          for (size_t j = 0; j < moved.size(); ++j) {
            const auto value = [&](size_t k) {
              return character.joints[j * width + k] + step * made[j * width + k];
            };
            for (size_t k = 0; k < 3; ++k) {
              moved[j].translation[k] = value(k);
              moved[j].scale[k] = value(width - 3 + k);
            }
            if (quaternions) {
              moved[j].rotation = {value(3), value(4), value(5), value(6)};
            } else {
              moved[j].rotation =
                  model_quaternion(convention_of(rig), {value(3), value(4), value(5)});
            }
          }
          return flat(moved, here);
        },
        1e-5, all);
    expect_slopes(mine, joints, smooth, 2e-3, compared, "joint number");
  }
}

TEST(Derivatives, FollowTheModelThroughAllLayers) {
  Random random = Random::from_seed(71, 1);
  Compared compared;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    LayerRig rig = random_layer_rig(random, false);
    // Below a threshold the derivative is not that of the value, which is 0 there.
    for (PlainRbfSolver& solver : rig.solvers) solver.threshold = 0;
    // Correctives are computed after poses read them: they would be those of the frame before.
    for (PlainRbfPose& pose : rig.poses) {
      for (uint16_t& input : pose.inputs) input = static_cast<uint16_t>(input % rig.base.raw_count);
    }
    compare_layer_rig(rig, MIEN_ROTATION_OUTPUT_EULER, random, compared);
    compare_layer_rig(rig, MIEN_ROTATION_OUTPUT_QUATERNION, random, compared);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(compared.numbers, 5000u);
  printf("%zu numbers compared, %zu left out\n", compared.numbers - compared.kinks, compared.kinks);
  EXPECT_LT(compared.kinks, compared.numbers / 10);
}

TEST(Derivatives, InReverseAreTheTransposedOnes) {
  Random random = Random::from_seed(71, 2);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const LayerRig rig = random_layer_rig(random, round % 4 == 3, round % 5 == 4);
    const LayerFile file(rig);
    MienRigDesc desc = sized<MienRigDesc>();
    desc.isa = present_isas()[static_cast<size_t>(round) % present_isas().size()];
    desc.rotation_output = round % 2 ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER;
    desc.storage = round % 3 == 1 ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT;
    desc.ml_masks = round % 3 == 2 ? MIEN_ML_MASKS_BLEND : MIEN_ML_MASKS_SWITCH;
    const RigHandle handle = create_rig(file.dna.get(), desc);
    Character character(handle);
    const DerivativesHandle d = create_derivatives(handle.get());
    for (uint32_t lod = 0; lod < rig.base.lod_count; ++lod) {
      const std::vector<float> raw = random_raw(rig, {4, 8}, random);
      std::copy(raw.begin(), raw.end(), character.raw.begin());
      for (float& mask : character.masks) mask = static_cast<float>(random.below(3)) / 2;
      for (float& gui : character.gui) gui = static_cast<float>(random.between(-1, 1));
      character.evaluate(lod);
      linearize(d, character);
      if (round % 4 != 3) expect_consistent(d, random, false);  // wild numbers overflow
    }
  }
}

TEST(Derivatives, OfMatricesAndPositionsFollowTheModel) {
  Random random = Random::from_seed(71, 3);
  for (uint32_t round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    DeformRigOptions options;
    options.rotation_sequence = round % 6;
    for (int i = 0; i < 3; ++i) options.rotation_signs[i] = round >> i & 1 ? -1 : 1;
    options.rotation_unit = round % 2;
    const bool quaternions = round % 3 == 2, adds = round % 6 == 1;
    MienDeformerDesc desc = sized<MienDeformerDesc>();
    desc.compose = adds ? MIEN_COMPOSE_EULER_ADD : MIEN_COMPOSE_PRODUCT;
    desc.storage = round % 4 == 3 ? MIEN_STORAGE_16_BIT : MIEN_STORAGE_32_BIT;
    const Deformed made(random_deform_rig(round, options), desc,
                        quaternions ? MIEN_ROTATION_OUTPUT_QUATERNION : MIEN_ROTATION_OUTPUT_EULER);
    const PlainDeformer plain = {made.dna->view, quaternions, adds, false};
    const DeformValues values = random_values(made.rig.get(), round);
    Character character(made.rig);
    character.evaluate(0);
    Instance& instance = *reinterpret_cast<Instance*>(character.instance.get());
    std::copy(values.joints.begin(), values.joints.end(), instance.joints.begin());
    std::copy(values.channels.begin(), values.channels.end(), instance.channels.begin());
    const DerivativesHandle d = create_derivatives(made.rig.get(), made.deformer.get());
    linearize(d, character);
    expect_consistent(d, random, true);
    expect_transposed(d, random, MIEN_POINT_JOINTS, MIEN_POINT_POSITIONS, 1);

    // Steps of floats: the largest that is exact enough.
    constexpr double kStep = 1.0 / 1024;
    const auto compare = [&](uint32_t from, uint32_t to, auto&& model) {
      std::vector<float> direction = random_row(random, size_of(d, from));
      const std::vector<float> product = forward(d, from, to, direction);
      const auto at = [&](double step) {
        DeformValues moved = values;
        std::vector<float>& row = from == MIEN_POINT_JOINTS ? moved.joints : moved.channels;
        for (size_t i = 0; i < row.size(); ++i) row[i] += static_cast<float>(step * direction[i]);
        return model(moved);
      };
      const std::vector<double> before = at(-kStep), after = at(kStep);
      ASSERT_EQ(before.size(), product.size());
      double norm = 0;
      for (const float v : product) norm = std::fmax(norm, std::fabs(v));
      for (size_t i = 0; i < product.size(); ++i) {
        ASSERT_NEAR(product[i], (after[i] - before[i]) / (2 * kStep), 2e-3 * norm + 1e-4) << i;
      }
    };
    const auto matrices = [](const std::vector<Matrix4d>& all) {
      std::vector<double> numbers;
      for (const Matrix4d& m : all) {
        for (size_t c = 0; c < 4; ++c) {
          for (size_t r = 0; r < 4; ++r) numbers.push_back(m[r][c]);
        }
      }
      return numbers;
    };
    const auto positions = [&](const DeformValues& moved) {
      std::vector<double> numbers;
      for (const Vec3d& p : plain.positions(0, moved))
        numbers.insert(numbers.end(), p.begin(), p.end());
      return numbers;
    };
    compare(MIEN_POINT_JOINTS, MIEN_POINT_MODELS,
            [&](const DeformValues& moved) { return matrices(plain.models(moved.joints)); });
    compare(MIEN_POINT_JOINTS, MIEN_POINT_SKINS,
            [&](const DeformValues& moved) { return matrices(plain.skins(moved.joints)); });
    compare(MIEN_POINT_JOINTS, MIEN_POINT_POSITIONS, positions);
    compare(MIEN_POINT_CHANNELS, MIEN_POINT_POSITIONS, positions);
    if (testing::Test::HasFatalFailure()) return;
  }
}

// Controls of 0 and 1, and GUI controls at the ends of their intervals, move inward.
TEST(Derivatives, AtTheEndsOfAnIntervalLeadIntoIt) {
  PlainRig plain;
  plain.gui_count = 2;
  plain.raw_count = 3;
  plain.psd_count = 2;
  plain.map_count = 1;
  plain.gui_to_raw = {{0, 0, -1, 0, 0, 0}, {0, 0, 0, 1, 1, 0}, {1, 1, 0, 1, 1, 0}};
  plain.psds = {{3, 0, 2}, {3, 1, 1}, {4, 2, 3}};
  plain.maps = {{0, 0, 0, 1, 1, 0}};
  plain.map_lods = {1};
  plain.joint_count = 1;
  plain.groups = {{{2}, {3, 4}, {0, 1}, {1, 0, 0, 1}}};
  Character character(make_rig(plain));
  const DerivativesHandle d = create_derivatives(character.rig);
  const auto at = [&](std::vector<float> raw, std::vector<float> direction) {
    std::copy(raw.begin(), raw.end(), character.raw.begin());
    character.evaluate(0);
    linearize(d, character);
    return forward(d, MIEN_POINT_RAW, MIEN_POINT_JOINTS, direction);
  };
  EXPECT_EQ(at({0, 0.25f, 0}, {1, 0, 0})[0], 0.5f);
  EXPECT_EQ(at({0, 0.25f, 0}, {0, 0, 1})[1], 3.0f);
  EXPECT_EQ(at({0.25f, 1, 0}, {0, 1, 0})[0], 0.5f);
  EXPECT_EQ(at({0.25f, 1.5f, 0}, {0, 1, 0})[0], 0.0f) << "beyond its clamp";
  EXPECT_EQ(at({0, 0, 0.5f}, {0, 0, 1})[1], 0.0f) << "the corrective is at its limit, beyond 1";
  // The first row is flat and counts at 0; its neighbor has the slope.
  character.gui[0] = 0;
  linearize(d, character);
  EXPECT_EQ(forward(d, MIEN_POINT_GUI, MIEN_POINT_RAW, {1, 0})[0], 1.0f);
  EXPECT_EQ(forward(d, MIEN_POINT_RAW, MIEN_POINT_MAPS, {1, 0, 0})[0], 1.0f);
}

TEST(Derivatives, OfSomeStagesTakeTheOthersAsConstant) {
  PlainRig plain;
  plain.raw_count = 2;
  plain.psd_count = 1;
  plain.psds = {{2, 0, 1}, {2, 1, 1}};
  plain.joint_count = 1;
  plain.groups = {{{2}, {0, 2}, {0, 1}, {1, 0, 0, 1}}};
  Character character(make_rig(plain));
  character.raw[0] = character.raw[1] = 0.5f;
  character.evaluate(0);
  const DerivativesHandle d = create_derivatives(character.rig);
  linearize(d, character, MIEN_STAGE_JOINTS);
  std::vector<float> moved = forward(d, MIEN_POINT_RAW, MIEN_POINT_JOINTS, {1, 1});
  EXPECT_EQ(moved[0], 1.0f);
  EXPECT_EQ(moved[1], 0.0f);
  linearize(d, character);
  moved = forward(d, MIEN_POINT_RAW, MIEN_POINT_JOINTS, {1, 1});
  EXPECT_EQ(moved[1], 1.0f);
}

TEST(Derivatives, OfAGeneratedHeadAreConsistent) {
  Random random = Random::from_seed(71, 4);
  for (const uint32_t preset : {MIEN_PRESET_LARGE, MIEN_PRESET_BODY}) {
    const DnaHandle dna = generate_dna(preset, 3);
    for (const uint32_t isa : present_isas()) {
      const RigHandle rig = create_rig(dna.get(), isa);
      Character character(rig);
      for (float& v : character.raw) {
        v = random.chance(0.5) ? 0.0f : static_cast<float>(random.between(0, 1));
      }
      character.evaluate(0);
      const DerivativesHandle d = create_derivatives(rig.get());
      linearize(d, character);
      expect_consistent(d, random, false);
    }
  }
}

TEST(Derivatives, RefuseWrongArguments) {
  PlainRig plain;
  plain.raw_count = 1;
  plain.joint_count = 1;
  const RigHandle rig = make_rig(plain);
  Character character(rig);
  const Character other(make_rig(plain));
  const DerivativesHandle d = create_derivatives(rig.get());
  float in[9] = {}, out[16] = {};
  const auto run = [&](uint32_t from, uint32_t to, const float* row = nullptr) {
    return mien_derivatives_forward(d.get(), from, to, 0, 1, row ? row : in, out);
  };
  EXPECT_EQ(run(MIEN_POINT_RAW, MIEN_POINT_JOINTS), MIEN_ERROR_INVALID_ARGUMENT)
      << "not linearized";
  linearize(d, character);
  EXPECT_EQ(run(MIEN_POINT_RAW, MIEN_POINT_JOINTS), MIEN_OK);
  EXPECT_EQ(run(MIEN_POINT_JOINTS, MIEN_POINT_RAW), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(run(MIEN_POINT_JOINTS, MIEN_POINT_CHANNELS), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(run(MIEN_POINT_RAW, MIEN_POINT_SKINS), MIEN_ERROR_INDEX) << "no deformer";
  EXPECT_EQ(run(MIEN_POINT_RAW, 10), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(
      mien_derivatives_forward(d.get(), MIEN_POINT_RAW, MIEN_POINT_JOINTS, 0, 1, nullptr, out),
      MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(
      mien_derivatives_forward(d.get(), MIEN_POINT_RAW, MIEN_POINT_JOINTS, 0, 0, nullptr, nullptr),
      MIEN_OK);
  EXPECT_EQ(mien_derivatives_linearize(d.get(), other.instance.get(), MIEN_STAGE_ALL),
            MIEN_ERROR_MISMATCH);
  EXPECT_EQ(mien_derivatives_linearize(d.get(), character.instance.get(), 64),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_derivatives_linearize(nullptr, character.instance.get(), 0),
            MIEN_ERROR_NULL_ARGUMENT);
  MienDerivatives* made = nullptr;
  EXPECT_EQ(mien_derivatives_create(nullptr, nullptr, &made, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

}  // namespace
}  // namespace mien
