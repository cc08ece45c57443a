// SPDX-License-Identifier: MIT
// Solves and products of derivatives take no memory, whatever the targets.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/fit/fit_head.h"
#include "tests/support/counted_news.h"
#include "tests/support/counting_allocator.h"

namespace mien {
namespace {

/// How often memory was asked for: of the allocator, or past it.
struct Requests {
  const CountingAllocator& counting;
  size_t all() const { return g_news + counting.requests; }
};

template <class F>
void expect_none(const Requests& requests, const char* what, F&& call) {
  const size_t before = requests.all();
  const MienStatus status = call();
  const size_t after = requests.all();
  EXPECT_EQ(status, MIEN_OK) << what;
  EXPECT_EQ(after, before) << what;
}

TEST(Steady, SolvesTakeNoMemory) {
  Head head;
  CountingAllocator counting;
  const MienAllocator allocator = counting.get();
  const Requests requests = {counting};
  Random random = Random::from_seed(95, 1);
  const MienMesh mesh = mesh_of(head.deformer.get(), 0);
  const std::vector<MienSolvePoint> points = every(mesh.position_count, 13);
  const size_t raw_count = head.character.raw.count;
  const uint32_t pairs[] = {0, 1, 2, 3};
  MienFitDesc desc = sized<MienFitDesc>();
  desc.allocator = &allocator;
  desc.deformer = head.deformer.get();
  desc.symmetric = pairs;
  desc.symmetric_count = 4;
  const FitHandle of_joints = create_fit(head.rig, desc);
  desc.points = points.data();
  desc.point_count = points.size();
  const FitHandle of_points = create_fit(head.rig, desc);
  EXPECT_GT(counting.requests, 0u);

  constexpr size_t kCount = 20;
  std::vector<float> joints, places, images;
  MienFitCamera camera = {{1500, 1500}, {640, 360}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, -160, 100}};
  const std::vector<float> to = head.pose(random, 9);
  for (size_t i = 0; i < kCount; ++i) {
    std::vector<float> raw = to;
    for (float& v : raw) v *= static_cast<float>(i) / kCount;
    const std::vector<float> own = head.joints(raw), surface = head.positions(raw);
    joints.insert(joints.end(), own.begin(), own.end());
    for (const MienSolvePoint& point : points) {
      const float* p = surface.data() + size_t{point.positions[0]} * 3;
      places.insert(places.end(), p, p + 3);
      for (size_t k = 0; k < 2; ++k) {
        images.push_back(camera.focal[k] * (p[k] + camera.translation[k]) /
                             (p[2] + camera.translation[2]) +
                         camera.center[k]);
      }
    }
  }
  const std::vector<float> posed = head.positions(to);
  std::vector<uint32_t> triangles;
  for (size_t i = 0; i < size_t{mesh.triangle_count} * 3; ++i) {
    triangles.push_back(mesh.vertex_position_indices.data[mesh.triangles.data[i]]);
  }
  MienFitSurfaceDesc surface_desc = mien_fit_surface_desc_default();
  surface_desc.positions = posed.data();
  surface_desc.position_count = posed.size() / 3;
  surface_desc.triangles = triangles.data();
  surface_desc.triangle_count = triangles.size() / 3;
  surface_desc.allocator = &allocator;
  MienFitSurface* surface = nullptr;
  ASSERT_EQ(mien_fit_surface_create(&surface_desc, &surface, nullptr), MIEN_OK);

  std::vector<float> found(kCount * raw_count);
  std::vector<MienFitResult> results(kCount, mien_fit_result_default());
  std::vector<uint32_t> stages(raw_count, 1);
  stages[0] = 0;
  std::vector<float> weights(kCount * points.size());
  for (size_t i = 0; i < weights.size(); i += 9) weights[i] = 1;
  MienFitConstraint constraint = {};
  constraint.kind = MIEN_CONSTRAINT_POINT_DISTANCE;
  constraint.points[1] = 5;
  constraint.weight = 1;
  const auto solve = [&](const char* what, const FitHandle& fit, auto change) {
    MienFitFrame frame = mien_fit_frame_default();
    frame.prior_weight = frame.sparse_weight = frame.smooth_weight = frame.symmetric_weight = 1e-4f;
    change(frame);
    frame.max_iterations = 5;
    expect_none(requests, what,
                [&] { return mien_fit_solve(fit.get(), &frame, found.data(), results.data()); });
    expect_none(requests, what, [&] {
      return mien_fit_solve_frames(fit.get(), &frame, kCount, found.data(), results.data());
    });
    uint32_t iterations = 0;
    for (const MienFitResult& result : results) iterations += result.iterations;
    EXPECT_GT(iterations, 5u) << what;
  };
  using Frame = MienFitFrame;
  solve("joints", of_joints, [&](Frame& f) { f.joints = joints.data(); });
  solve("points", of_points, [&](Frame& f) { f.points = places.data(); });
  solve("points that turn", of_points, [&](Frame& f) {
    f.points = places.data();
    f.rigid = 1;
    f.robust_scale = 0.5f;
  });
  solve("few points", of_points, [&](Frame& f) {
    f.points = places.data();
    f.point_weights = weights.data();
  });
  solve("images", of_points, [&](Frame& f) {
    f.images = images.data();
    f.camera = &camera;
    f.rigid = f.focal = 1;
  });
  solve("constraints and stages", of_points, [&](Frame& f) {
    f.points = places.data();
    f.constraints = &constraint;
    f.constraint_count = 1;
    f.stages = stages.data();
  });
  solve("a surface", of_points, [&](Frame& f) { f.surface = surface; });
  std::vector<uint32_t> keys(kCount);
  size_t key_count = 0;
  expect_none(requests, "keys",
              [&] { return mien_fit_keys(found.data(), kCount, 0.01f, keys.data(), &key_count); });
  mien_fit_surface_destroy(surface);
}

TEST(Steady, ProductsOfDerivativesTakeNoMemory) {
  Head head;
  CountingAllocator counting;
  const MienAllocator allocator = counting.get();
  const Requests requests = {counting};
  MienDerivativesDesc desc = mien_derivatives_desc_default();
  desc.deformer = head.deformer.get();
  desc.allocator = &allocator;
  MienDerivatives* derivatives = nullptr;
  ASSERT_EQ(mien_derivatives_create(head.rig.get(), &desc, &derivatives, nullptr), MIEN_OK);
  MienJacobianDesc columns = mien_jacobian_desc_default();
  columns.from_point = MIEN_POINT_RAW;
  columns.to_point = MIEN_POINT_JOINTS;
  columns.allocator = &allocator;
  MienJacobian* jacobian = nullptr;
  ASSERT_EQ(mien_jacobian_create(derivatives, &columns, &jacobian, nullptr), MIEN_OK);
  MienJacobianPattern pattern = mien_jacobian_pattern_default();
  ASSERT_EQ(mien_jacobian_pattern(jacobian, &pattern), MIEN_OK);
  EXPECT_GT(counting.requests, 0u);

  Random random = Random::from_seed(95, 2);
  head.evaluate(head.pose(random, 9));
  expect_none(requests, "linearize", [&] {
    return mien_derivatives_linearize(derivatives, head.character.instance.get(), MIEN_STAGE_ALL);
  });
  constexpr uint32_t kMost = 64;
  for (const uint32_t to : {MIEN_POINT_CONTROLS, MIEN_POINT_JOINTS, MIEN_POINT_MODELS,
                            MIEN_POINT_SKINS, MIEN_POINT_CHANNELS, MIEN_POINT_POSITIONS}) {
    size_t size = 0;
    ASSERT_EQ(mien_derivatives_size(derivatives, to, 0, &size), MIEN_OK);
    std::vector<float> rows(kMost * head.character.raw.count, 0.5f), out(kMost * size, 0.5f);
    for (const uint32_t count : {1u, kMost}) {
      expect_none(requests, "forward", [&] {
        return mien_derivatives_forward(derivatives, MIEN_POINT_RAW, to, 0, count, rows.data(),
                                        out.data());
      });
      expect_none(requests, "reverse", [&] {
        return mien_derivatives_reverse(derivatives, MIEN_POINT_RAW, to, 0, count, out.data(),
                                        rows.data());
      });
    }
  }
  std::vector<float> values(pattern.rows.count);
  expect_none(requests, "jacobian", [&] {
    return mien_derivatives_jacobian(derivatives, jacobian, nullptr, 0, values.data(),
                                     values.size());
  });
  mien_jacobian_destroy(jacobian);
  mien_derivatives_destroy(derivatives);
}

}  // namespace
}  // namespace mien
