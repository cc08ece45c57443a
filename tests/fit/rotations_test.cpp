// SPDX-License-Identifier: MIT
// Raw controls that are the parts of unit quaternions are solved as rotations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/fit/fit_head.h"
#include "tests/support/golden.h"

namespace mien {
namespace {

constexpr size_t kRotations = 44;  // of the golden rig body, which has no other controls
constexpr size_t kSwings = 3;      // of the first of these, which swings and twists read

double length_of(const std::vector<float>& raw, size_t rotation) {
  const float* const q = raw.data() + 4 * rotation;
  double sum = 0;
  for (size_t k = 0; k < 4; ++k) sum += double{q[k]} * double{q[k]};
  return std::sqrt(sum);
}

struct Body {
  Head head{open_dna(golden::read_rig("body"))};
  std::vector<float> initial{head.character.raw.begin(), head.character.raw.end()};

  /// `count` rotations turned by up to 1 radian.
  std::vector<float> pose(Random& random, size_t count) const {
    std::vector<float> raw = initial;
    for (size_t r = 0; r < count; ++r) {
      double axis[3];
      for (double& v : axis) v = random.between(-1, 1);
      const double length = std::hypot(axis[0], axis[1], axis[2]);
      const double half = random.between(0, 1) / 2;
      float* const q = raw.data() + 4 * r;
      for (size_t k = 0; k < 3; ++k) {
        q[k] = static_cast<float>(std::sin(half) * axis[k] / length);
      }
      q[3] = static_cast<float>(std::cos(half));
    }
    return raw;
  }
};

TEST(Rotations, ComeBackFromJoints) {
  Body body;
  FitHandle fit = create_fit(body.head.rig, sized<MienFitDesc>());
  Random random = Random::from_seed(32, 1);
  for (int i = 0; i < 10; ++i) {
    const std::vector<float> raw = body.pose(random, kSwings), joints = body.head.joints(raw);
    MienFitFrame frame = mien_fit_frame_default();
    frame.joints = joints.data();
    std::vector<float> found(raw.size());
    MienFitResult result = mien_fit_result_default();
    ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
    EXPECT_LT(result.joint_residual, 0.01);
    for (size_t c = 0; c < raw.size(); ++c) EXPECT_NEAR(found[c], raw[c], 0.01) << c;
    for (size_t r = 0; r < kRotations; ++r) EXPECT_NEAR(length_of(found, r), 1, 1e-6) << r;
  }
}

TEST(Rotations, HaveTheLengthOneWhateverTheStartAndTheTerms) {
  Body body;
  FitHandle fit = create_fit(body.head.rig, sized<MienFitDesc>());
  Random random = Random::from_seed(33, 1);
  const std::vector<float> joints = body.head.joints(body.pose(random, kRotations));
  std::vector<float> start = body.pose(random, kRotations), found(start.size());
  for (float& v : start) v *= 1.5f;
  MienFitFrame frame = mien_fit_frame_default();
  frame.joints = joints.data();
  frame.start = start.data();
  frame.prior_weight = 1;
  frame.smooth_weight = 1;
  frame.sparse_weight = 1;
  frame.max_iterations = 5;
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), nullptr), MIEN_OK);
  for (size_t r = 0; r < kRotations; ++r) EXPECT_NEAR(length_of(found, r), 1, 1e-6) << r;
}

TEST(Rotations, OfWhichAPartIsHeldAreNumbersWithinTheirBounds) {
  Body body;
  MienFitDesc desc = sized<MienFitDesc>();
  std::vector<uint32_t> controls(4 * kRotations - 1);
  std::iota(controls.begin(), controls.end(), 0u);  // without the w of the last one
  desc.controls = controls.data();
  desc.control_count = controls.size();
  FitHandle fit = create_fit(body.head.rig, desc);
  Random random = Random::from_seed(34, 1);
  const std::vector<float> joints = body.head.joints(body.pose(random, kRotations));
  MienFitFrame frame = mien_fit_frame_default();
  frame.joints = joints.data();
  std::vector<float> found(4 * kRotations);
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), nullptr), MIEN_OK);
  const float* const last = found.data() + 4 * (kRotations - 1);
  EXPECT_EQ(last[3], 1);
  for (size_t k = 0; k < 3; ++k) EXPECT_TRUE(last[k] >= 0 && last[k] <= 1) << last[k];
  EXPECT_NEAR(length_of(found, 0), 1, 1e-6);
}

TEST(Rotations, AreDeterminedAsTheirLeastDeterminedTurn) {
  Body body;
  MienFitDesc desc = sized<MienFitDesc>();
  desc.deformer = body.head.deformer.get();
  const std::vector<MienSolvePoint> points =
      every(mesh_of(body.head.deformer.get(), 0).position_count, 1);
  desc.points = points.data();
  desc.point_count = points.size();
  FitHandle fit = create_fit(body.head.rig, desc);
  std::vector<float> values(4 * kRotations);
  ASSERT_EQ(mien_fit_observability(fit.get(), values.data(), values.size()), MIEN_OK);
  for (size_t r = 0; r < kRotations; ++r) {
    for (size_t k = 0; k < 3; ++k) EXPECT_EQ(values[4 * r + k], values[4 * r + 3]) << r;
  }
  EXPECT_GT(values[4], 0.5f);       // a swing and a twist
  EXPECT_EQ(values[4 * 33], 0.0f);  // a twist alone
}

}  // namespace
}  // namespace mien
