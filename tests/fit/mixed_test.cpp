// SPDX-License-Identifier: MIT
// Frames with targets of several kinds: joints, points, images and a surface together, with weights between them, data
// that one kind lacks, and what is told of each.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "tests/fit/fit_head.h"

namespace mien {
namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();
constexpr float kFocal = 1500;

/// Root mean square of the differences of controls.
double apart(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Every 60th vertex of the head in the box, joints, and a camera in front of the face.
struct Mixed {
  Head head;
  std::vector<MienSolvePoint> points;
  std::vector<float> joint_weights;
  FitHandle fit;
  size_t raw_count = 0;
  MienFitCamera camera = {
      {kFocal, kFocal}, {640, 360}, {1, 0, 0, 0, -1, 0, 0, 0, -1}, {0, 160, 100}};

  explicit Mixed(uint32_t step = 60)
      : points(every(mesh_of(head.deformer.get(), 0).position_count, step)),
        joint_weights(head.character.joints.count, 1.0f), fit(create()),
        raw_count(head.character.raw.count) {}

  FitHandle create() const {
    MienFitDesc desc = sized<MienFitDesc>();
    desc.deformer = head.deformer.get();
    desc.points = points.data();
    desc.point_count = points.size();
    desc.joint_weights = joint_weights.data();
    return create_fit(head.rig, desc);
  }
  std::vector<float> pose(uint64_t seed) {
    Random random = Random::from_seed(seed, 91);
    return head.pose(random, 8);
  }
  std::vector<float> places(const std::vector<float>& raw) {
    const std::vector<float> all = head.positions(raw);
    std::vector<float> out;
    for (const MienSolvePoint& point : points) {
      const float* const from = all.data() + size_t{point.positions[0]} * 3;
      out.insert(out.end(), from, from + 3);
    }
    return out;
  }
  /// What `camera` sees of them.
  std::vector<float> images(const std::vector<float>& places) const {
    std::vector<float> out;
    for (size_t i = 0; i < places.size(); i += 3) {
      const float z = camera.translation[2] - places[i + 2];
      out.push_back(kFocal * places[i] / z + camera.center[0]);
      out.push_back(kFocal * (camera.translation[1] - places[i + 1]) / z + camera.center[1]);
    }
    return out;
  }
  std::vector<uint32_t> triangles() const {
    const MienMesh mesh = mesh_of(head.deformer.get(), 0);
    std::vector<uint32_t> out(size_t{mesh.triangle_count} * 3);
    EXPECT_EQ(mien_deformer_triangles(head.deformer.get(), 0, out.data(), out.size()), MIEN_OK);
    for (uint32_t& corner : out) corner = mesh.vertex_position_indices.data[corner];
    return out;
  }
  MienFitResult solve(const MienFitFrame& frame, std::vector<float>& found) const {
    found.assign(raw_count, -1.0f);
    MienFitResult result = mien_fit_result_default();
    EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
    return result;
  }
};

TEST(Mixed, WeightsDecideBetweenJointsAndPoints) {
  Mixed mixed;
  const std::vector<float> one = mixed.pose(1), other = mixed.pose(2);
  const std::vector<float> joints = mixed.head.joints(one), points = mixed.places(other);
  MienFitFrame frame = mien_fit_frame_default();
  frame.joints = joints.data();
  frame.points = points.data();
  frame.prior_weight = 1e-4f;
  frame.max_iterations = 200;
  std::vector<float> found;
  double joint_residual = 1e9, point_residual = 0;
  for (const float weight : {1e-5f, 1e-3f, 0.1f, 10.0f, 1e4f}) {
    frame.joint_weight = weight;
    const MienFitResult result = mixed.solve(frame, found);
    EXPECT_LT(result.joint_residual, joint_residual) << weight;
    EXPECT_GT(result.point_residual, point_residual) << weight;
    joint_residual = result.joint_residual;
    point_residual = result.point_residual;
    const double cost =
        weight * joint_residual * joint_residual * static_cast<double>(joints.size()) +
        point_residual * point_residual * static_cast<double>(mixed.points.size());
    EXPECT_NEAR(result.cost, cost, 0.02 * cost + 0.01) << weight;
  }
  // Both of one pose: it comes back.
  const std::vector<float> same = mixed.places(one);
  frame.points = same.data();
  frame.joint_weight = 1;
  const MienFitResult result = mixed.solve(frame, found);
  EXPECT_LT(result.joint_residual, 1e-3);
  EXPECT_LT(result.point_residual, 1e-3);
}

TEST(Mixed, PointsBringASurfaceWithinReach) {
  Mixed mixed(30);
  const std::vector<float> raw = mixed.pose(3);
  std::vector<float> surface = mixed.head.positions(raw), points = mixed.places(raw);
  // Turned by 150 degrees about an axis through the origin, and moved.
  const float c = std::cos(2.618f), s = std::sin(2.618f);
  const auto move = [&](float* p) {
    const float x = p[0], z = p[2];
    p[0] = c * x + s * z + 40;
    p[1] -= 25;
    p[2] = c * z - s * x + 10;
  };
  for (size_t i = 0; i < surface.size(); i += 3) move(surface.data() + i);
  for (size_t i = 0; i < points.size(); i += 3) move(points.data() + i);
  // One of 20 is a landmark, which is not drawn to the surface.
  std::vector<float> drawn(mixed.points.size(), 1.0f);
  for (size_t i = 0; i < drawn.size(); ++i) {
    if (i % 20 == 4) {
      drawn[i] = 0;
    } else {
      points[3 * i + i % 3] = kMissing;
    }
  }
  const SurfaceHandle scan = create_surface(surface, mixed.triangles());
  MienFitFrame frame = mien_fit_frame_default();
  frame.surface = scan.get();
  frame.surface_weights = drawn.data();
  frame.rigid = 1;
  frame.prior_weight = 1e-3f;
  frame.max_iterations = 100;
  std::vector<float> found;
  const MienFitResult lost = mixed.solve(frame, found);
  EXPECT_TRUE(lost.missing_points > mixed.points.size() / 2 || lost.surface_residual > 0.5)
      << lost.missing_points << ", " << lost.surface_residual;
  frame.points = points.data();
  MienFitResult result = mixed.solve(frame, found);
  EXPECT_LT(result.missing_points, mixed.points.size() / 20);
  EXPECT_LT(result.point_residual, 0.01);
  EXPECT_LT(result.surface_residual, 0.01);
  EXPECT_EQ(result.image_residual, 0);
  EXPECT_NEAR(result.rotation[0], double{c}, 1e-3);
  EXPECT_NEAR(result.rotation[2], double{s}, 1e-3);
  EXPECT_NEAR(result.translation[1], -25, 0.1);
  const std::vector<float> truth = mixed.places(raw), back = mixed.places(found);
  EXPECT_LT(apart(truth, back), 0.02);
  // A surface that nothing is drawn to has no say.
  std::vector<float> none(drawn.size()), alone;
  frame.surface_weights = none.data();
  result = mixed.solve(frame, found);
  EXPECT_EQ(result.surface_residual, 0);
  frame.surface = nullptr;
  frame.surface_weights = nullptr;
  mixed.solve(frame, alone);
  EXPECT_LT(apart(found, alone), 2e-3);
}

// The right half of the face was scanned as points, a camera saw the left half: either alone leaves the other half
// open, together they determine the face and the camera.
TEST(Mixed, PointsAndImagesCompleteEachOther) {
  Mixed mixed;
  const std::vector<float> raw = mixed.pose(4), truth = mixed.places(raw);
  std::vector<float> points = truth, images = mixed.images(truth);
  size_t in_both = 0;
  for (size_t i = 0; i < mixed.points.size(); ++i) {
    const float x = truth[3 * i];
    if (x > 0.5f) points[3 * i] = kMissing;
    if (x < -0.5f) images[2 * i + 1] = kMissing;
    in_both += std::fabs(x) <= 0.5f;
  }
  ASSERT_GT(in_both, 5u);
  MienFitFrame frame = mien_fit_frame_default();
  frame.points = points.data();
  frame.prior_weight = 1e-5f;
  frame.max_iterations = 200;
  std::vector<float> found;
  mixed.solve(frame, found);
  const double by_points = apart(truth, mixed.places(found));
  MienFitCamera unknown = mixed.camera;
  for (float& v : unknown.rotation) v = 0;
  frame.images = images.data();
  frame.camera = &unknown;
  frame.rigid = 1;
  frame.image_weight = 0.01f;
  const MienFitResult result = mixed.solve(frame, found);
  EXPECT_LT(apart(truth, mixed.places(found)), 0.2 * by_points);
  EXPECT_LT(result.point_residual, 0.01);
  EXPECT_LT(result.image_residual, 0.1);
  EXPECT_GE(result.image_worst, result.image_residual);
  EXPECT_EQ(result.missing_points, 0u);
  // The camera moved; points stayed where they are.
  for (int k = 0; k < 9; ++k) EXPECT_NEAR(result.rotation[k], mixed.camera.rotation[k], 2e-3) << k;
  EXPECT_NEAR(result.translation[2], mixed.camera.translation[2], 0.5);
}

TEST(Mixed, EveryKindCountsAsItsWeightSays) {
  Mixed mixed;
  const std::vector<float> one = mixed.pose(5), other = mixed.pose(6);
  const std::vector<float> points = mixed.places(one), images = mixed.images(mixed.places(other));
  const SurfaceHandle surface = create_surface(mixed.head.positions(one), mixed.triangles());
  MienFitFrame frame = mien_fit_frame_default();
  frame.points = points.data();
  frame.images = images.data();
  frame.camera = &mixed.camera;
  frame.surface = surface.get();
  frame.prior_weight = 1e-4f;
  frame.max_iterations = 200;
  std::vector<float> found;
  double image_residual = 1e9, point_residual = 0;
  for (const float weight : {1e-8f, 1e-4f, 1.0f}) {
    frame.image_weight = weight;
    const MienFitResult result = mixed.solve(frame, found);
    EXPECT_LT(result.image_residual, image_residual) << weight;
    EXPECT_GT(result.point_residual, point_residual) << weight;
    image_residual = result.image_residual;
    point_residual = result.point_residual;
    // Residuals are those of the result, in their units.
    const std::vector<float> at = mixed.places(found), seen = mixed.images(at);
    EXPECT_NEAR(point_residual, apart(points, at) * std::sqrt(3.0), 1e-3 * point_residual + 1e-5);
    EXPECT_NEAR(image_residual, apart(images, seen) * std::sqrt(2.0), 1e-3 * image_residual + 1e-3);
    EXPECT_LE(result.surface_residual, result.surface_worst);
    EXPECT_LE(result.surface_worst, result.point_worst * 1.001);
  }
  EXPECT_LT(image_residual, 2);
}

TEST(Mixed, EachUnitHasItsRobustScale) {
  Mixed mixed;
  const std::vector<float> raw = mixed.pose(7), truth = mixed.places(raw);
  std::vector<float> points = truth, images = mixed.images(truth);
  for (size_t i = 0; i < mixed.points.size(); ++i) {
    if (i % 9 == 2) points[3 * i] += 5;
    if (i % 9 == 5) images[2 * i] += 150;
  }
  MienFitFrame frame = mien_fit_frame_default();
  frame.points = points.data();
  frame.images = images.data();
  frame.camera = &mixed.camera;
  frame.image_weight = 0.01f;
  frame.prior_weight = 1e-5f;
  frame.max_iterations = 200;
  std::vector<float> found;
  mixed.solve(frame, found);
  const double plain = apart(truth, mixed.places(found));
  frame.robust_scale = 0.2f;  // images count fully
  mixed.solve(frame, found);
  const double half = apart(truth, mixed.places(found));
  frame.image_robust_scale = 5;
  mixed.solve(frame, found);
  const double both = apart(truth, mixed.places(found));
  EXPECT_LT(both, 0.1 * plain);
  EXPECT_LT(both, 0.1 * half);
  EXPECT_LT(both, 0.01);
  // Images alone: one scale, by either name.
  frame.points = nullptr;
  frame.robust_scale = 0;
  std::vector<float> again;
  mixed.solve(frame, found);
  frame.image_robust_scale = 0;
  frame.robust_scale = 5;
  mixed.solve(frame, again);
  EXPECT_EQ(found, again);
}

// Of all 19,900 vertices, drawn to a surface, 60 are landmarks too: the sample of a step has them.
TEST(Mixed, FewLandmarksCountBesideManyVertices) {
  Mixed mixed(1);
  const std::vector<float> raw = mixed.pose(8);
  std::vector<float> points = mixed.places(raw), drawn(mixed.points.size(), 1.0f);
  const SurfaceHandle surface = create_surface(points, mixed.triangles());
  for (size_t i = 0; i < mixed.points.size(); ++i) {
    if (i % 331 == 17) {
      drawn[i] = 0;
    } else {
      points[3 * i] = kMissing;
    }
  }
  MienFitFrame frame = mien_fit_frame_default();
  frame.points = points.data();
  frame.surface = surface.get();
  frame.surface_weights = drawn.data();
  frame.prior_weight = 1e-3f;
  frame.max_iterations = 100;
  std::vector<float> found;
  const MienFitResult result = mixed.solve(frame, found);
  EXPECT_EQ(result.status, MIEN_FIT_CONVERGED);
  EXPECT_LT(result.point_residual, 0.01);
  EXPECT_LT(result.surface_residual, 0.01);
}

TEST(Mixed, HasTheSameBitsOnEachThreadAndInEachRun) {
  Mixed mixed;
  constexpr size_t kTake = 4, kThreads = 3;
  std::vector<float> joints, points, images, drawn;
  for (uint64_t i = 0; i < kTake; ++i) {
    const std::vector<float> raw = mixed.pose(10 + i);
    std::vector<float> at = mixed.places(raw), seen = mixed.images(at);
    at[3 * i] = seen[10 * i] = kMissing;
    if (i == 2) std::fill(seen.begin(), seen.end(), kMissing);
    const std::vector<float> values = mixed.head.joints(raw);
    joints.insert(joints.end(), values.begin(), values.end());
    points.insert(points.end(), at.begin(), at.end());
    images.insert(images.end(), seen.begin(), seen.end());
    for (size_t p = 0; p < mixed.points.size(); ++p) drawn.push_back(p % 5 == 0 ? 0.0f : 1.0f);
  }
  const SurfaceHandle surface =
      create_surface(mixed.head.positions(mixed.pose(10)), mixed.triangles());
  MienFitFrame frame = mien_fit_frame_default();
  frame.joints = joints.data();
  frame.points = points.data();
  frame.images = images.data();
  frame.camera = &mixed.camera;
  frame.surface = surface.get();
  frame.surface_weights = drawn.data();
  frame.surface_reach = 1;
  frame.rigid = 1;
  frame.image_weight = 1e-3f;
  frame.robust_scale = 1;
  frame.image_robust_scale = 50;
  frame.prior_weight = 1e-3f;
  frame.max_iterations = 10;
  std::vector<float> found[kThreads];
  std::vector<FitHandle> fits;
  std::vector<std::thread> threads;
  for (auto& rows : found) {
    rows.resize(mixed.raw_count * kTake);
    fits.push_back(mixed.create());
  }
  for (size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      EXPECT_EQ(mien_fit_solve_frames(fits[t].get(), &frame, kTake, found[t].data(), nullptr),
                MIEN_OK);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
  // A fit that has solved others before: nothing of them is left.
  std::vector<float> alone;
  MienFitFrame plain = mien_fit_frame_default();
  plain.points = points.data();
  mixed.solve(plain, alone);
  std::vector<float> after(mixed.raw_count);
  ASSERT_EQ(mien_fit_solve(fits[0].get(), &plain, after.data(), nullptr), MIEN_OK);
  EXPECT_EQ(alone, after);
}

TEST(Mixed, RefusesWrongWeights) {
  Mixed mixed(600);
  const std::vector<float> points(mixed.points.size() * 3), images(mixed.points.size() * 2);
  std::vector<float> drawn(mixed.points.size(), 1.0f), found(mixed.raw_count);
  MienFitFrame good = mien_fit_frame_default();
  good.points = points.data();
  good.images = images.data();
  const auto status = [&](const MienFitFrame& frame) {
    return mien_fit_solve(mixed.fit.get(), &frame, found.data(), nullptr);
  };
  EXPECT_EQ(status(good), MIEN_ERROR_NULL_ARGUMENT);  // no camera
  good.camera = &mixed.camera;
  good.surface_weights = drawn.data();  // without a surface: they are checked, and not read
  EXPECT_EQ(status(good), MIEN_OK);
  for (const float wrong : {-1.0f, kMissing, std::numeric_limits<float>::infinity()}) {
    MienFitFrame frame = good;
    frame.image_weight = wrong;
    EXPECT_EQ(status(frame), MIEN_ERROR_INVALID_ARGUMENT);
    frame = good;
    frame.image_robust_scale = wrong;
    EXPECT_EQ(status(frame), MIEN_ERROR_INVALID_ARGUMENT);
    drawn[2] = wrong;
    EXPECT_EQ(status(good), MIEN_ERROR_INVALID_ARGUMENT);
    drawn[2] = 1;
  }
  MienFitFrame frame = good;
  frame.surface = reinterpret_cast<const MienFitSurface*>(mixed.head.rig.get());
  EXPECT_EQ(status(frame), MIEN_ERROR_HANDLE);
  frame = good;
  frame.struct_size = sizeof(MienFitFrame) - 1;
  EXPECT_EQ(status(frame), MIEN_ERROR_STRUCT_SIZE);
  // A fit of joints alone has no points for any of them.
  const FitHandle of_joints = create_fit(mixed.head.rig, sized<MienFitDesc>());
  EXPECT_EQ(mien_fit_solve(of_joints.get(), &good, found.data(), nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
}

}  // namespace
}  // namespace mien
