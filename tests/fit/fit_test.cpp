// SPDX-License-Identifier: MIT
// Solves of poses that rigs were given: the controls come back, from joints, vertices and landmarks, with noise,
// outliers and missing data; and what the fit says of wrong arguments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <numeric>

#include "tests/fit/fit_head.h"
#include "tests/support/counting_allocator.h"

namespace mien {
namespace {

/// Largest difference of two rows, over controls that `observed` says can be found.
double worst(const std::vector<float>& a, const std::vector<float>& b,
             const std::vector<float>& observed) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (observed[i] > 0.05f) most = std::fmax(most, std::fabs(double{a[i]} - b[i]));
  }
  return most;
}

std::vector<float> observed_by(const FitHandle& fit, size_t count) {
  std::vector<float> values(count);
  EXPECT_EQ(mien_fit_observability(fit.get(), values.data(), count), MIEN_OK);
  return values;
}

TEST(Fit, FindsTheControlsOfJoints) {
  Head head(MIEN_PRESET_MEDIUM);
  Random random = Random::from_seed(81, 1);
  const FitHandle fit = create_fit(head.rig, sized<MienFitDesc>());
  const std::vector<float> observed = observed_by(fit, head.character.raw.count);
  int met = 0;
  constexpr int kPoses = 100;
  for (int pose = 0; pose < kPoses; ++pose) {
    const std::vector<float> raw = head.pose(random, 8 + random.below(18));
    head.evaluate(raw);
    const std::vector<float> joints(head.character.joints.begin(), head.character.joints.end());
    MienFitFrame frame = mien_fit_frame_default();
    frame.joints = joints.data();
    frame.max_iterations = 100;
    std::vector<float> found(raw.size());
    MienFitResult result = mien_fit_result_default();
    ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
    EXPECT_TRUE(result.status == MIEN_FIT_CONVERGED || result.status == MIEN_FIT_ITERATIONS);
    EXPECT_GE(result.joint_worst, result.joint_residual);
    EXPECT_LE(result.joint_worst,
              result.joint_residual * std::sqrt(static_cast<double>(joints.size())) * 1.001);
    head.evaluate(found);
    double range = 0, error = 0;
    for (size_t i = 0; i < joints.size(); ++i) {
      range = std::fmax(range, std::fabs(joints[i]));
      error = std::fmax(error, std::fabs(double{head.character.joints[i]} - joints[i]));
    }
    const bool good = error <= 1e-3 * range && worst(found, raw, observed) <= 0.01;
    met += good;
    if (!good) {
      printf("pose %d: joints %g of %g, controls %g, %u iterations\n", pose, error, range,
             worst(found, raw, observed), result.iterations);
    }
    if (pose % 10 != 0) continue;  // the same bits again
    std::vector<float> again(raw.size());
    ASSERT_EQ(mien_fit_solve(fit.get(), &frame, again.data(), nullptr), MIEN_OK);
    EXPECT_EQ(found, again);
  }
  EXPECT_GE(met, kPoses * 99 / 100);
}

// Weights of 0 leave few points: the solve is that of these points alone.
TEST(Fit, FindsTheControlsOfTheFewPointsThatCount) {
  Head head;
  Random random = Random::from_seed(81, 7);
  const uint32_t count = mesh_of(head.deformer.get(), 0).position_count;
  constexpr uint32_t kEvery = 250;
  const std::vector<MienSolvePoint> all = every(count, 1), few = every(count, kEvery);
  std::vector<float> weights(count);
  for (uint32_t i = 0; i < count; i += kEvery) weights[i] = 1;
  const FitHandle whole = create_point_fit(head, all), alone = create_point_fit(head, few);
  const std::vector<float> observed = observed_by(alone, head.character.raw.count);
  for (int pose = 0; pose < 10; ++pose) {
    const std::vector<float> raw = head.pose(random, 8);
    const std::vector<float> targets = head.positions(raw);
    std::vector<float> few_targets;
    for (uint32_t i = 0; i < count; i += kEvery) {
      few_targets.insert(few_targets.end(), targets.data() + 3 * i, targets.data() + 3 * i + 3);
    }
    MienFitFrame frame = mien_fit_frame_default();
    frame.prior_weight = 1e-7f;
    frame.max_iterations = 100;
    frame.points = few_targets.data();
    std::vector<float> expected(raw.size()), found(raw.size());
    MienFitResult result = mien_fit_result_default();
    ASSERT_EQ(mien_fit_solve(alone.get(), &frame, expected.data(), nullptr), MIEN_OK);
    frame.points = targets.data();
    frame.point_weights = weights.data();
    ASSERT_EQ(mien_fit_solve(whole.get(), &frame, found.data(), &result), MIEN_OK);
    EXPECT_EQ(result.status, MIEN_FIT_CONVERGED) << pose;
    EXPECT_LE(result.point_residual, 1e-4) << pose;
    EXPECT_LE(worst(found, expected, observed), 0.01) << pose;
  }
}

TEST(Fit, FindsTheControlsOfPointsThatWereMovedRigidly) {
  Head head;
  Random random = Random::from_seed(81, 2);
  const uint32_t count = mesh_of(head.deformer.get(), 0).position_count;
  const std::vector<MienSolvePoint> points = every(count, 7);
  const FitHandle fit = create_point_fit(head, points);
  ASSERT_TRUE(fit);
  for (const bool outliers : {false, true}) {
    const std::vector<float> raw = head.pose(random, 5);
    const std::vector<float> surface = head.positions(raw);
    std::vector<float> targets;
    for (size_t i = 0; i < points.size(); ++i) {
      const float* p = surface.data() + size_t{points[i].positions[0]} * 3;
      // A quarter turn about z, and a shift.
      targets.insert(targets.end(), {-p[1] + 3, p[0] - 2, p[2] + 1});
      if (outliers && i % 10 == 3) targets[3 * i] += 8;
      if (outliers && i % 10 == 7) targets[3 * i + 1] = std::numeric_limits<float>::quiet_NaN();
    }
    MienFitFrame frame = mien_fit_frame_default();
    frame.points = targets.data();
    frame.rigid = outliers ? 0 : 1;
    frame.robust_scale = outliers ? 0.5f : 0;
    frame.prior_weight = 1e-4f;
    frame.max_iterations = 200;
    if (outliers) {  // where it is: outliers would pull the rigid motion
      for (size_t i = 0; i < points.size(); ++i) {
        const float x = targets[3 * i], y = targets[3 * i + 1];
        targets[3 * i] = y + 2;
        targets[3 * i + 1] = 3 - x;
        targets[3 * i + 2] -= 1;
      }
    }
    std::vector<float> found(raw.size());
    MienFitResult result = mien_fit_result_default();
    ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
    const std::vector<float> solved = head.positions(found);
    double sum = 0;
    for (size_t i = 0; i < surface.size(); ++i) sum += std::fabs(double{solved[i]} - surface[i]);
    EXPECT_LE(sum / static_cast<double>(surface.size()), 0.01) << result.iterations;
    if (!outliers) {
      EXPECT_NEAR(result.rotation[1], -1, 1e-3);
      EXPECT_NEAR(result.translation[0], 3, 1e-2);
    } else {
      EXPECT_EQ(result.missing_points, (points.size() + 2) / 10);
    }
  }
}

// Each point of the face in the targets is elsewhere than that of the rig.
TEST(Fit, OffsetsMakeTheFaceThatOfAnotherPerson) {
  Head head;
  Random random = Random::from_seed(81, 9);
  const uint32_t count = mesh_of(head.deformer.get(), 0).position_count;
  const std::vector<MienSolvePoint> points = every(count, 7);
  const FitHandle fit = create_point_fit(head, points);
  const std::vector<float> raw = head.pose(random, 5), surface = head.positions(raw);
  MienFitCamera camera = {{1500, 1500}, {640, 360}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, -160, 100}};
  std::vector<float> offsets, targets, images;
  for (const MienSolvePoint& point : points) {
    float p[3];
    for (size_t k = 0; k < 3; ++k) {
      offsets.push_back(static_cast<float>(random.between(-0.5, 0.5)));
      p[k] = surface[size_t{point.positions[0]} * 3 + k] + offsets.back();
    }
    targets.insert(targets.end(), {-p[1] + 3, p[0] - 2, p[2] + 1});
    const float z = p[2] + camera.translation[2];
    for (size_t k = 0; k < 2; ++k) {
      images.push_back(camera.focal[k] * (p[k] + camera.translation[k]) / z + camera.center[k]);
    }
  }
  const auto off = [&](const MienFitFrame& frame) {
    std::vector<float> found(raw.size());
    EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), nullptr), MIEN_OK);
    const std::vector<float> solved = head.positions(found);
    double sum = 0;
    for (size_t i = 0; i < surface.size(); ++i) sum += std::fabs(double{solved[i]} - surface[i]);
    return sum / static_cast<double>(surface.size());
  };
  for (const bool seen : {false, true}) {
    MienFitFrame frame = mien_fit_frame_default();
    frame.points = seen ? nullptr : targets.data();
    frame.images = seen ? images.data() : nullptr;
    frame.camera = &camera;
    frame.rigid = 1;
    frame.prior_weight = 1e-4f;
    frame.max_iterations = 200;
    const double without = off(frame);
    frame.point_offsets = offsets.data();
    const double with = off(frame);
    EXPECT_LE(with, 0.01) << seen;
    EXPECT_GE(without, 3 * with) << seen;
  }
  // A constraint is about the point of the rig.
  std::vector<float> nothing(points.size() * 3, std::numeric_limits<float>::quiet_NaN());
  MienFitConstraint place = {};
  place.kind = MIEN_CONSTRAINT_POINT_POSITION;
  place.weight = 1;
  const std::vector<float> rest = head.positions(std::vector<float>(raw.size()));
  std::copy_n(rest.data() + size_t{points[0].positions[0]} * 3, 3, place.target);
  MienFitFrame frame = mien_fit_frame_default();
  frame.points = nothing.data();
  frame.constraints = &place;
  frame.constraint_count = 1;
  frame.point_offsets = offsets.data();
  std::vector<float> found(raw.size());
  MienFitResult result = mien_fit_result_default();
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_LT(result.constraint_worst, 1e-4);
  offsets[4] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), nullptr), MIEN_ERROR_INVALID_ARGUMENT);
}

TEST(Fit, FindsControlsOfImages) {
  Head head;
  Random random = Random::from_seed(81, 3);
  const uint32_t count = mesh_of(head.deformer.get(), 0).position_count;
  const std::vector<MienSolvePoint> points = every(count, count / 68 + 1);
  const FitHandle fit = create_point_fit(head, points);
  const std::vector<float> raw = head.pose(random, 5);
  const std::vector<float> surface = head.positions(raw);
  MienFitCamera camera = {{1500, 1500}, {640, 360}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, -160, 100}};
  std::vector<float> images;
  for (const MienSolvePoint& point : points) {
    const float* p = surface.data() + size_t{point.positions[0]} * 3;
    const float z = p[2] + camera.translation[2];
    images.push_back(1500 * p[0] / z + 640);
    images.push_back(1500 * (p[1] + camera.translation[1]) / z + 360);
  }
  MienFitFrame frame = mien_fit_frame_default();
  frame.images = images.data();
  frame.camera = &camera;
  frame.prior_weight = 0.1f;
  frame.max_iterations = 200;
  std::vector<float> found(raw.size());
  MienFitResult result = mien_fit_result_default();
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_LE(result.point_residual, 0.5) << "pixels, after " << result.iterations;
  // A camera that was moved, turned and has another focal length.
  const MienFitCamera known = camera;
  camera.focal[0] = camera.focal[1] = 1400;
  camera.translation[0] = 3;
  camera.translation[2] = 110;
  const float c = std::cos(0.1f), s = std::sin(0.1f);
  const float turned[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
  std::copy(turned, turned + 9, camera.rotation);
  frame.rigid = 1;
  frame.focal = 1;
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_LE(result.point_residual, 0.5) << "pixels, after " << result.iterations;
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(result.rotation[k], known.rotation[k], 0.01) << k;
  EXPECT_NEAR(result.translation[2] / result.focal[0], known.translation[2] / known.focal[0], 1e-3);
  // One whose rotation is unknown is found only if it may move.
  for (float& v : camera.rotation) v = 0;
  frame.rigid = 0;
  EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_ERROR_INVALID_ARGUMENT);
  camera.rotation[4] = std::numeric_limits<float>::infinity();
  frame.rigid = 1;
  EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_ERROR_INVALID_ARGUMENT);
}

// That controls come back from a surface is tested with a real head, in solve_test.py of the program: this mesh is
// too rough for nearest places to be the right ones.
TEST(Fit, SurfacesOfAnotherTopologyDrawPointsToThem) {
  Head head;
  const MienMesh mesh = mesh_of(head.deformer.get(), 0);
  const std::vector<MienSolvePoint> points = every(mesh.position_count, 31);
  const FitHandle fit = create_point_fit(head, points);
  std::vector<float> raw(head.character.raw.count);
  for (size_t i = 0; i < raw.size(); i += 9) raw[i] = 0.5f;
  for (const bool last : {false, true}) {
    // Triangles split at their centers, without the lowest or the highest tenth of them.
    std::vector<float> surface = head.positions(raw);
    std::vector<uint32_t> triangles, order(mesh.triangle_count);
    std::iota(order.begin(), order.end(), 0u);
    const auto height_of = [&](uint32_t t) {
      float sum = 0;
      for (size_t n = 0; n < 3; ++n) {
        sum +=
            surface[mesh.vertex_position_indices.data[mesh.triangles.data[3 * t + n]] * size_t{3} +
                    1];
      }
      return sum;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return height_of(a) < height_of(b); });
    const size_t left = order.size() / 10;
    order.erase(last ? order.end() - left : order.begin(),
                last ? order.end() : order.begin() + left);
    for (const size_t t : order) {
      uint32_t corner[3];
      float center[3] = {};
      for (size_t n = 0; n < 3; ++n) {
        corner[n] = mesh.vertex_position_indices.data[mesh.triangles.data[3 * t + n]];
        for (size_t k = 0; k < 3; ++k) center[k] += surface[corner[n] * size_t{3} + k] / 3;
      }
      const auto middle = static_cast<uint32_t>(surface.size() / 3);
      surface.insert(surface.end(), center, center + 3);
      for (size_t n = 0; n < 3; ++n) {
        triangles.insert(triangles.end(), {corner[n], corner[(n + 1) % 3], middle});
      }
    }
    const SurfaceHandle target = create_surface(surface, triangles);
    MienFitFrame frame = mien_fit_frame_default();
    frame.surface = target.get();
    frame.surface_reach = 2;
    frame.prior_weight = 1e-4f;
    std::vector<float> found(raw.size());
    MienFitResult start = mien_fit_result_default(), result = mien_fit_result_default();
    frame.max_iterations = 1;
    ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &start), MIEN_OK);
    frame.max_iterations = 0;
    ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
    std::vector<float> again(raw.size());
    ASSERT_EQ(mien_fit_solve(fit.get(), &frame, again.data(), nullptr), MIEN_OK);
    EXPECT_EQ(found, again);
    EXPECT_LT(result.cost, start.cost);
    EXPECT_GT(result.missing_points, points.size() / 20) << "where the surface ends";
    EXPECT_LT(result.missing_points, points.size() / 3);
    EXPECT_LT(result.point_residual, 0.15) << "points that lose their target stop no step";
  }
}

// Of a surface a hundred times too small, all places are about as far from any point: the search still leaves out most of
// them, and a solve ends with its named status, at a limit of time soon after it.
TEST(Fit, SurfacesOfAnotherSizeEndSoon) {
  Head head;
  const MienMesh mesh = mesh_of(head.deformer.get(), 0);
  const std::vector<MienSolvePoint> points = every(mesh.position_count, 9);
  const FitHandle fit = create_point_fit(head, points);
  const std::vector<float> rest = head.positions(std::vector<float>(head.character.raw.count));
  // Each triangle as 64.
  std::vector<float> surface;
  std::vector<uint32_t> triangles;
  constexpr uint32_t kParts = 8;
  constexpr double kMostTimes =
      200;  // as long: it takes 30; a search of all places more than 10,000
  for (size_t t = 0; t < mesh.triangle_count; ++t) {
    const float* corner[3];
    for (size_t n = 0; n < 3; ++n) {
      corner[n] = rest.data() +
                  mesh.vertex_position_indices.data[mesh.triangles.data[3 * t + n]] * size_t{3};
    }
    const auto place = [&](uint32_t a, uint32_t b) {
      for (size_t k = 0; k < 3; ++k) {
        const float u = static_cast<float>(a) / kParts, v = static_cast<float>(b) / kParts;
        surface.push_back(corner[0][k] + u * (corner[1][k] - corner[0][k]) +
                          v * (corner[2][k] - corner[0][k]));
      }
      triangles.push_back(static_cast<uint32_t>(surface.size() / 3 - 1));
    };
    for (uint32_t a = 0; a < kParts; ++a) {
      for (uint32_t b = 0; a + b < kParts; ++b) {
        place(a, b), place(a + 1, b), place(a, b + 1);
        if (a + b + 1 < kParts) place(a + 1, b), place(a + 1, b + 1), place(a, b + 1);
      }
    }
  }
  std::vector<float> small = surface;
  for (float& v : small) v *= 0.01f;
  std::vector<float> found(head.character.raw.count);
  struct Solved {
    MienFitResult result;
    double seconds;  // of the processor
  };
  const auto solve = [&](const SurfaceHandle& target, uint32_t rigid, double limit) {
    MienFitFrame frame = mien_fit_frame_default();
    frame.surface = target.get();
    frame.rigid = rigid;
    frame.max_iterations = 2;
    frame.max_seconds = limit;
    Solved solved = {mien_fit_result_default(), 0};
    const std::clock_t begin = std::clock();
    EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &solved.result), MIEN_OK);
    solved.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    for (const float v : found) EXPECT_TRUE(v >= 0 && v <= 1) << v;
    return solved;
  };
  const SurfaceHandle right = create_surface(surface, triangles),
                      wrong = create_surface(small, triangles);
  for (const uint32_t rigid : {0u, 1u}) {
    const Solved near = solve(right, rigid, 0), far = solve(wrong, rigid, 0);
    EXPECT_LT(near.result.point_residual, 0.01);
    EXPECT_GT(far.result.point_residual, 1);
    EXPECT_EQ(far.result.status, MIEN_FIT_ITERATIONS);
    EXPECT_LT(far.seconds, kMostTimes * near.seconds) << rigid;
  }
  const Solved limited = solve(wrong, 1, 1e-9);
  EXPECT_EQ(limited.result.status, MIEN_FIT_TIME);
}

TEST(Fit, RefusesWrongSurfaces) {
  const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  create_surface(corners, {0, 1, 3}, MIEN_ERROR_INDEX);
  create_surface(corners, {}, MIEN_ERROR_INVALID_ARGUMENT);
  create_surface({0, 0, 0, 1, 0, NAN, 0, 1, 0}, {0, 1, 2}, MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_fit_surface_create(nullptr, nullptr, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  mien_fit_surface_destroy(nullptr);
  CountingAllocator memory;
  const MienAllocator allocator = memory.get();
  memory.restart();
  memory.fail_at = 1;
  create_surface(corners, {0, 1, 2}, MIEN_ERROR_MEMORY, &allocator);
  memory.restart();
  const SurfaceHandle one = create_surface(corners, {0, 1, 2}, MIEN_OK, nullptr);
  Head head(MIEN_PRESET_TINY);
  const FitHandle fit = create_fit(head.rig, sized<MienFitDesc>());
  std::vector<float> found(head.character.raw.count);
  MienFitFrame frame = mien_fit_frame_default();
  frame.surface = one.get();
  EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), nullptr), MIEN_ERROR_NULL_ARGUMENT);
  const std::vector<MienSolvePoint> points = {{0, {0, 0, 0}, {1, 0, 0}}};
  MienFitDesc desc = sized<MienFitDesc>();
  desc.deformer = head.deformer.get();
  desc.points = points.data();
  desc.point_count = 1;
  const FitHandle with_points = create_fit(head.rig, desc);
  frame.points = corners.data();  // beside a surface
  EXPECT_EQ(mien_fit_solve(with_points.get(), &frame, found.data(), nullptr), MIEN_OK);
  frame.points = nullptr;
  frame.surface = reinterpret_cast<const MienFitSurface*>(fit.get());
  EXPECT_EQ(mien_fit_solve(with_points.get(), &frame, found.data(), nullptr), MIEN_ERROR_HANDLE);
}

TEST(Fit, TellsWhyItStops) {
  Head head(MIEN_PRESET_SMALL);
  const FitHandle fit = create_fit(head.rig, sized<MienFitDesc>());
  std::vector<float> found(head.character.raw.count), nothing(head.character.joints.count);
  MienFitFrame frame = mien_fit_frame_default();
  MienFitResult result = mien_fit_result_default();
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_EQ(result.status, MIEN_FIT_NO_DATA);
  std::fill(nothing.begin(), nothing.end(), std::numeric_limits<float>::quiet_NaN());
  frame.joints = nothing.data();
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_EQ(result.status, MIEN_FIT_NO_DATA);
  head.evaluate(std::vector<float>(found.size(), 0.5f));
  const std::vector<float> joints(head.character.joints.begin(), head.character.joints.end());
  frame.joints = joints.data();
  frame.max_iterations = 1;
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_EQ(result.status, MIEN_FIT_ITERATIONS);
  EXPECT_EQ(result.iterations, 1u);
  frame.canceled = [](void*) -> uint32_t { return 1; };
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_EQ(result.status, MIEN_FIT_CANCELED);
  frame = mien_fit_frame_default();
  frame.joints = joints.data();
  frame.max_seconds = 1e-12;
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_EQ(result.status, MIEN_FIT_TIME);
}

TEST(Fit, TellsWhenNoPointIsThere) {
  Head head(MIEN_PRESET_SMALL);
  const std::vector<MienSolvePoint> points =
      every(mesh_of(head.deformer.get(), 0).position_count, 20);
  const FitHandle fit = create_point_fit(head, points);
  const size_t raw_count = head.character.raw.count;
  const std::vector<float> start(raw_count, 0.25f), prior(raw_count, 0.75f),
      zeros(points.size(), 0.0f);
  std::vector<float> targets(3 * points.size(), 1.0f);
  MienFitCamera camera = {{1500, 1500}, {640, 360}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 100}};
  const SurfaceHandle away = create_surface({0, 900, 0, 1, 900, 0, 0, 901, 0}, {0, 1, 2});
  const auto expect_no_data = [&](const char* what, size_t missing, auto change) {
    MienFitFrame frame = mien_fit_frame_default();
    frame.start = start.data();
    frame.prior = prior.data();
    frame.prior_weight = 1;
    change(frame);
    for (const uint32_t rigid : {0u, 1u}) {
      frame.rigid = rigid;
      std::vector<float> found(raw_count);
      MienFitResult result = mien_fit_result_default();
      ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK) << what;
      EXPECT_EQ(result.status, MIEN_FIT_NO_DATA) << what << ' ' << rigid;
      EXPECT_EQ(result.missing_points, missing) << what << ' ' << rigid;
      EXPECT_EQ(found, start) << what << ' ' << rigid;
    }
  };
  using Frame = MienFitFrame;
  expect_no_data("weights of 0", 0, [&](Frame& f) {
    f.points = targets.data();
    f.point_weights = zeros.data();
  });
  expect_no_data("a surface out of reach", points.size(), [&](Frame& f) {
    f.surface = away.get();
    f.surface_reach = 1;
  });
  for (const float nothing : {std::numeric_limits<float>::quiet_NaN(), INFINITY}) {
    std::fill(targets.begin(), targets.end(), nothing);
    expect_no_data("points", points.size(), [&](Frame& f) { f.points = targets.data(); });
    expect_no_data("images", points.size(), [&](Frame& f) {
      f.images = targets.data();
      f.camera = &camera;
    });
  }
}

TEST(Fit, RefusesWrongArguments) {
  Head head(MIEN_PRESET_SMALL);
  MienFitDesc desc = sized<MienFitDesc>();
  desc.lod = 99;
  create_fit(head.rig, desc, MIEN_ERROR_LOD);
  desc = sized<MienFitDesc>();
  const uint32_t controls[] = {1, 0, 100000};
  desc.controls = controls;
  desc.control_count = 2;
  create_fit(head.rig, desc, MIEN_ERROR_INVALID_ARGUMENT);
  desc.controls = controls + 2;
  desc.control_count = 1;
  create_fit(head.rig, desc, MIEN_ERROR_INDEX);
  desc = sized<MienFitDesc>();
  const std::vector<float> high(head.character.raw.count, -1.0f);
  desc.upper = high.data();
  create_fit(head.rig, desc, MIEN_ERROR_INVALID_ARGUMENT);
  desc = sized<MienFitDesc>();
  MienSolvePoint point = {0, {0, 0, 1000000}, {1, 0, 0}};
  desc.points = &point;
  desc.point_count = 1;
  create_fit(head.rig, desc, MIEN_ERROR_NULL_ARGUMENT);
  desc.deformer = head.deformer.get();
  create_fit(head.rig, desc, MIEN_ERROR_INDEX);
  point.positions[2] = 0;
  const FitHandle fit = create_fit(head.rig, desc);
  std::vector<float> found(head.character.raw.count);
  MienFitFrame frame = mien_fit_frame_default();
  const float image[] = {1, 2, 3};
  frame.images = image;
  EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), nullptr), MIEN_ERROR_NULL_ARGUMENT);
  frame = mien_fit_frame_default();
  frame.prior_weight = -1;
  EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), nullptr), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_fit_solve(nullptr, &frame, found.data(), nullptr), MIEN_ERROR_NULL_ARGUMENT);
  MienFit* made = nullptr;
  EXPECT_EQ(mien_fit_create(nullptr, &desc, &made, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_fit_create(head.rig.get(), nullptr, &made, nullptr), MIEN_ERROR_NULL_ARGUMENT);
}

TEST(Fit, SurvivesEveryFailedAllocation) {
  Head head(MIEN_PRESET_TINY);
  CountingAllocator memory;
  const MienAllocator allocator = memory.get();
  // On two meshes.
  const MienSolvePoint points[] = {{0, {0, 0, 0}, {1, 0, 0}}, {1, {0, 0, 0}, {1, 0, 0}}};
  MienFitDesc desc = sized<MienFitDesc>();
  desc.deformer = head.deformer.get();
  desc.points = points;
  desc.point_count = 2;
  desc.allocator = &allocator;
  for (size_t k = 1;; ++k) {
    memory.restart();
    memory.fail_at = k;
    MienFit* made = nullptr;
    const MienStatus status = mien_fit_create(head.rig.get(), &desc, &made, nullptr);
    mien_fit_destroy(made);
    EXPECT_EQ(memory.live, 0u) << k;
    if (memory.failed == 0) {
      EXPECT_EQ(status, MIEN_OK);
      break;
    }
    EXPECT_EQ(status, MIEN_ERROR_MEMORY) << k;
  }
}

TEST(Fit, ChoosesKeysWithinATolerance) {
  Random random = Random::from_seed(81, 9);
  std::vector<float> curve;
  double at = 0;
  for (int i = 0; i < 300; ++i)
    curve.push_back(static_cast<float>(at += random.between(-0.1, 0.1)));
  size_t before = curve.size();
  for (const float tolerance : {0.01f, 0.1f, 1.0f}) {
    std::vector<uint32_t> keys(curve.size());
    size_t count = 0;
    ASSERT_EQ(mien_fit_keys(curve.data(), curve.size(), tolerance, keys.data(), &count), MIEN_OK);
    ASSERT_GE(count, 2u);
    EXPECT_LT(count, before);
    before = count;
    EXPECT_EQ(keys[0], 0u);
    EXPECT_EQ(keys[count - 1], curve.size() - 1);
    for (size_t k = 0; k + 1 < count; ++k) {
      const uint32_t a = keys[k], b = keys[k + 1];
      ASSERT_LT(a, b);
      for (uint32_t i = a; i <= b; ++i) {
        const double line = curve[a] + (double{curve[b]} - curve[a]) * (i - a) / (b - a);
        EXPECT_NEAR(curve[i], line, tolerance * (1 + 1e-6));
      }
    }
  }
}

TEST(Fit, RefusesKeysOfWrongCurves) {
  float curve[] = {0, NAN};
  uint32_t keys[2];
  size_t count = 7;
  EXPECT_EQ(mien_fit_keys(curve, 2, 0, keys, &count), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(count, 0u);
  EXPECT_EQ(mien_fit_keys(curve, 1, -1, keys, &count), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_fit_keys(curve, 1, INFINITY, keys, &count), MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(mien_fit_keys(curve, 1, 0, nullptr, &count), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_fit_keys(curve, 1, 0, keys, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_fit_keys(nullptr, 0, 0, nullptr, &count), MIEN_OK);
  EXPECT_EQ(mien_fit_keys(curve, 1, 0, keys, &count), MIEN_OK);
  EXPECT_EQ(count, 1u);
}

}  // namespace
}  // namespace mien
