// SPDX-License-Identifier: MIT
// Constraints of a fit: joints at places and with directions, points that touch, alone and with other targets;
// and controls that are unlocked in stages.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/fit/fit_head.h"

namespace mien {
namespace {

/// A head whose points are some vertices, and a fit of it.
struct Constrained {
  Head head;
  std::vector<MienSolvePoint> points;
  FitHandle fit;
  std::vector<float> found;
  MienFitResult result = mien_fit_result_default();

  Constrained() : points(every(mesh_of(head.deformer.get(), 0).position_count, 40)) {
    MienFitDesc desc = sized<MienFitDesc>();
    desc.deformer = head.deformer.get();
    desc.points = points.data();
    desc.point_count = points.size();
    fit = create_fit(head.rig, desc);
    found.resize(head.character.raw.count);
  }
  MienStatus solve(const MienFitFrame& frame) {
    return mien_fit_solve(fit.get(), &frame, found.data(), &result);
  }
  std::vector<float> models(const std::vector<float>& raw) {
    head.positions(raw);
    MienFloatView view = {};
    EXPECT_EQ(mien_deformer_instance_joint_matrices(head.deformed.get(), &view), MIEN_OK);
    return {view.data, view.data + view.count};
  }
  /// The joint whose matrix a pose changes most.
  uint32_t moved_joint(const std::vector<float>& raw) {
    const std::vector<float> rest = models(std::vector<float>(raw.size())), posed = models(raw);
    size_t best = 0;
    double most = -1;
    for (size_t j = 0; j < rest.size() / 16; ++j) {
      double sum = 0;
      for (size_t k = 0; k < 3; ++k) sum += std::fabs(double{posed[16 * j + k]} - rest[16 * j + k]);
      if (sum > most) most = sum, best = j;
    }
    EXPECT_GT(most, 1e-3);
    return static_cast<uint32_t>(best);
  }
  double distance(size_t a, size_t b) {
    const std::vector<float> all = head.positions(found);
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
      sum += std::pow(
          double{all[points[a].positions[0] * 3 + k]} - all[points[b].positions[0] * 3 + k], 2);
    }
    return std::sqrt(sum);
  }
};

TEST(Constraint, JointsTakePlacesAndDirections) {
  Constrained it;
  Random random = Random::from_seed(82, 1);
  std::vector<float> raw = it.head.pose(random, 10);
  uint32_t look = 0;  // it turns a joint, whatever the others do
  ASSERT_EQ(mien_rig_find(it.head.rig.get(), MIEN_KIND_RAW_CONTROL, "eyeLookOutLeft", &look),
            MIEN_OK);
  raw[look] = 0.8f;
  const uint32_t joint = it.moved_joint(raw);
  const std::vector<float> posed = it.models(raw), rest = it.models(std::vector<float>(raw.size()));
  const float* m = posed.data() + size_t{joint} * 16;
  MienFitConstraint c[3] = {};
  for (MienFitConstraint& each : c) {
    each.joint = joint;
    each.weight = 1;
    each.axis[0] = 2;  // of any length
  }
  c[0].kind = MIEN_CONSTRAINT_JOINT_POSITION;
  c[1].kind = MIEN_CONSTRAINT_JOINT_DIRECTION;
  c[2].kind = MIEN_CONSTRAINT_JOINT_AIM;
  for (size_t k = 0; k < 3; ++k) {
    c[0].target[k] = m[12 + k];
    c[1].target[k] = 5 * m[k];
    c[2].target[k] = m[12 + k] + 30 * m[k];
  }
  for (const MienFitConstraint& one : c) {
    MienFitFrame frame = mien_fit_frame_default();
    frame.constraints = &one;
    frame.constraint_count = 1;
    frame.prior_weight = 1e-6f;
    frame.max_iterations = 200;
    ASSERT_EQ(it.solve(frame), MIEN_OK);
    EXPECT_LT(it.result.constraint_worst, 2e-3) << one.kind << ", " << it.result.iterations;
    const std::vector<float> solved = it.models(it.found);
    double before = 0, after = 0;
    for (size_t k = 0; k < 3; ++k) {
      const size_t at =
          size_t{joint} * 16 + (one.kind == MIEN_CONSTRAINT_JOINT_POSITION ? 12 : 0) + k;
      before += std::fabs(double{rest[at]} - posed[at]);
      after += std::fabs(double{solved[at]} - posed[at]);
    }
    if (one.kind == MIEN_CONSTRAINT_JOINT_AIM) continue;
    EXPECT_LE(after, 0.2 * before + 1e-3) << one.kind;
  }
  // All of them together with vertices, as matrix of the pose at hand.
  std::vector<float> targets;
  const std::vector<float> all = it.head.positions(raw);
  for (const MienSolvePoint& p : it.points) {
    const float* at = all.data() + size_t{p.positions[0]} * 3;
    targets.insert(targets.end(), at, at + 3);
  }
  for (const uint32_t rigid : {0u, 1u}) {
    MienFitFrame frame = mien_fit_frame_default();
    frame.points = targets.data();
    frame.constraints = c;
    frame.constraint_count = 3;
    frame.prior_weight = 1e-6f;
    frame.max_iterations = 200;
    frame.rigid = rigid;
    ASSERT_EQ(it.solve(frame), MIEN_OK);
    EXPECT_LT(it.result.point_residual, 0.02) << it.result.iterations;
    EXPECT_LT(it.result.constraint_residual, 0.02) << it.result.iterations;
  }
}

TEST(Constraint, PointsTouchOrKeepTheirDistance) {
  Constrained it;
  // Two points whose distance a pose changes much, and the distances there and at rest.
  std::vector<float> raw(it.found.size());
  for (size_t i = 0; i < raw.size(); i += 5) raw[i] = 0.7f;
  size_t a = 0, b = 1;
  double most = 0;
  for (size_t i = 0; i + 1 < it.points.size(); i += 3) {
    it.found = std::vector<float>(raw.size());
    const double near_before = it.distance(i, i + 1);
    it.found = raw;
    const double change = std::fabs(it.distance(i, i + 1) - near_before);
    if (change > most) most = change, a = i, b = i + 1;
  }
  it.found = std::vector<float>(raw.size());
  const double rest = it.distance(a, b);
  it.found = raw;
  const double posed = it.distance(a, b);
  ASSERT_GT(std::fabs(rest - posed), 1e-3);
  MienFitConstraint c = {};
  c.kind = MIEN_CONSTRAINT_POINT_DISTANCE;
  c.points[0] = static_cast<uint32_t>(a);
  c.points[1] = static_cast<uint32_t>(b);
  c.weight = 100;
  MienFitFrame frame = mien_fit_frame_default();
  frame.constraints = &c;
  frame.constraint_count = 1;
  frame.prior_weight = 1e-6f;
  // Within the range at the start: nothing to do.
  c.distances[0] = static_cast<float>(0.9 * rest);
  c.distances[1] = static_cast<float>(1.1 * rest);
  ASSERT_EQ(it.solve(frame), MIEN_OK);
  EXPECT_EQ(it.result.constraint_residual, 0);
  for (const float v : it.found) EXPECT_EQ(v, 0);
  // Exactly that of the pose.
  c.distances[0] = c.distances[1] = static_cast<float>(posed);
  frame.max_iterations = 200;
  ASSERT_EQ(it.solve(frame), MIEN_OK);
  EXPECT_NEAR(it.distance(a, b), posed, 0.05 * std::fabs(rest - posed) + 1e-3);
  // Drawn together: 0 is out of reach, but they come nearer.
  c.distances[0] = c.distances[1] = 0;
  ASSERT_EQ(it.solve(frame), MIEN_OK);
  EXPECT_LT(it.distance(a, b), rest - 1e-4);
  EXPECT_NEAR(it.result.constraint_worst, it.distance(a, b), 1e-3);
  // A point at a place, together with landmarks in images.
  const std::vector<float> all = it.head.positions(raw);
  MienFitCamera camera = {{1500, 1500}, {640, 360}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, -160, 100}};
  std::vector<float> images;
  for (const MienSolvePoint& p : it.points) {
    const float* at = all.data() + size_t{p.positions[0]} * 3;
    const float z = at[2] + camera.translation[2];
    images.push_back(1500 * at[0] / z + 640);
    images.push_back(1500 * (at[1] + camera.translation[1]) / z + 360);
  }
  c.kind = MIEN_CONSTRAINT_POINT_POSITION;
  std::copy(all.data() + it.points[a].positions[0] * size_t{3},
            all.data() + it.points[a].positions[0] * size_t{3} + 3, c.target);
  frame.images = images.data();
  frame.camera = &camera;
  ASSERT_EQ(it.solve(frame), MIEN_OK);
  EXPECT_LT(it.result.constraint_worst, 0.05);
  EXPECT_LT(it.result.point_residual, 1) << "pixels";
}

// What a fit solved before leaves nothing in the rows of its constraints.
TEST(Constraint, ContactsHaveTheSameBitsWhateverWasSolvedBefore) {
  Constrained it;
  Random random = Random::from_seed(5, 5);
  const std::vector<float> all = it.head.positions(it.head.pose(random, 8));
  std::vector<float> targets, few;
  for (const MienSolvePoint& point : it.points) {
    for (size_t k = 0; k < 3; ++k) targets.push_back(all[point.positions[0] * size_t{3} + k]);
    few.push_back(few.size() % 5 == 0 ? 1.0f : 0.0f);  // effects are measured at the pose
  }
  MienFitConstraint contact = {};
  contact.kind = MIEN_CONSTRAINT_POINT_DISTANCE;
  contact.points[1] = 5;
  contact.weight = 3;
  MienFitFrame frame = mien_fit_frame_default();
  frame.points = targets.data();
  frame.rigid = 1;
  frame.constraints = &contact;
  frame.constraint_count = 1;
  frame.prior_weight = 1e-2f;
  MienFitFrame before = mien_fit_frame_default();
  before.points = targets.data();
  before.point_weights = few.data();
  ASSERT_EQ(it.solve(frame), MIEN_OK);
  const std::vector<float> first = it.found;
  ASSERT_EQ(it.solve(before), MIEN_OK);
  EXPECT_NE(it.found, first);
  ASSERT_EQ(it.solve(frame), MIEN_OK);
  EXPECT_EQ(it.found, first);
}

TEST(Constraint, MissingOnesDoNothingAndWrongOnesAreRefused) {
  Constrained it;
  MienFitConstraint c = {};
  c.kind = MIEN_CONSTRAINT_JOINT_DIRECTION;
  c.weight = 1;
  c.axis[0] = 1;
  c.target[1] = std::numeric_limits<float>::quiet_NaN();
  MienFitFrame frame = mien_fit_frame_default();
  frame.constraints = &c;
  frame.constraint_count = 1;
  ASSERT_EQ(it.solve(frame), MIEN_OK);
  EXPECT_EQ(it.result.status, MIEN_FIT_NO_DATA);
  const auto refused = [&](MienStatus status) { EXPECT_EQ(it.solve(frame), status); };
  c.target[1] = 0;
  refused(MIEN_ERROR_INVALID_ARGUMENT);  // no direction
  c.target[1] = 1;
  c.axis[0] = 0;
  refused(MIEN_ERROR_INVALID_ARGUMENT);
  c.axis[0] = 1;
  c.weight = -1;
  refused(MIEN_ERROR_INVALID_ARGUMENT);
  c.weight = 1;
  c.kind = 99;
  refused(MIEN_ERROR_INVALID_ARGUMENT);
  c.kind = MIEN_CONSTRAINT_JOINT_AIM;
  c.joint = 100000;
  refused(MIEN_ERROR_INDEX);
  c.kind = MIEN_CONSTRAINT_POINT_DISTANCE;
  c.points[1] = 100000;
  refused(MIEN_ERROR_INDEX);
  c.points[1] = 1;
  c.distances[0] = 2;
  refused(MIEN_ERROR_INVALID_ARGUMENT);
  const std::vector<MienFitConstraint> many(65, MienFitConstraint{});
  frame.constraints = many.data();
  frame.constraint_count = many.size();
  refused(MIEN_ERROR_INVALID_ARGUMENT);
  frame.constraints = nullptr;
  refused(MIEN_ERROR_NULL_ARGUMENT);
  const FitHandle joints_only = create_fit(it.head.rig, sized<MienFitDesc>());
  c = {};
  c.kind = MIEN_CONSTRAINT_JOINT_POSITION;
  frame.constraints = &c;
  frame.constraint_count = 1;
  EXPECT_EQ(mien_fit_solve(joints_only.get(), &frame, it.found.data(), nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
}

TEST(Stages, UnlockControlsOneAfterTheOther) {
  Head head(MIEN_PRESET_MEDIUM);
  const FitHandle fit = create_fit(head.rig, sized<MienFitDesc>());
  Random random = Random::from_seed(82, 2);
  const std::vector<float> joints = head.joints(head.pose(random, 12));
  std::vector<uint32_t> stages(head.character.raw.count, 3);
  for (size_t i = 0; i < stages.size(); i += 4) stages[i] = 1;
  MienFitFrame frame = mien_fit_frame_default();
  frame.joints = joints.data();
  frame.stages = stages.data();
  // Stopped after some steps of the first stage: the others have not moved.
  uint32_t calls = 0;
  frame.user = &calls;
  frame.canceled = [](void* user) -> uint32_t { return ++*static_cast<uint32_t*>(user) > 1; };
  std::vector<float> found(stages.size());
  MienFitResult result = mien_fit_result_default();
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  double first = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    first += stages[i] == 1 ? found[i] : 0;
    EXPECT_TRUE(stages[i] == 1 || found[i] == 0) << i;
  }
  EXPECT_GT(first, 0);
  // To the end: all have, and the joints are met.
  frame.canceled = nullptr;
  frame.max_iterations = 100;
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_EQ(result.status, MIEN_FIT_CONVERGED);
  double range = 0;
  for (const float v : joints) range = std::fmax(range, std::fabs(v));
  EXPECT_LE(result.joint_worst, 1e-3 * range);
  stages[0] = 16;
  EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_ERROR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace mien
