// SPDX-License-Identifier: MIT
// Fits with points on several meshes: eyes, teeth and skin together.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/fit/fit_head.h"

namespace mien {
namespace {

// Of LOD 0 of the head in the box.
constexpr uint32_t kSkin = 0, kTeeth = 1, kEyes[] = {3, 4};

struct Meshes {
  Head head;
  size_t raw_count = head.character.raw.count;

  uint32_t control(const char* name) const {
    uint32_t found = 0;
    EXPECT_EQ(mien_rig_find(head.rig.get(), MIEN_KIND_RAW_CONTROL, name, &found), MIEN_OK) << name;
    return found;
  }
  std::vector<MienSolvePoint> every(uint32_t mesh, uint32_t step) const {
    std::vector<MienSolvePoint> points;
    for (uint32_t i = 0; i < mesh_of(head.deformer.get(), mesh).position_count; i += step) {
      points.push_back({mesh, {i, i, i}, {1, 0, 0}});
    }
    return points;
  }
  FitHandle fit(const std::vector<MienSolvePoint>& points) const {
    return create_point_fit(head, points);
  }
  /// Where points are in a pose.
  std::vector<float> places(const std::vector<float>& raw,
                            const std::vector<MienSolvePoint>& points) {
    head.evaluate(raw);
    EXPECT_EQ(mien_deformer_instance_update(head.deformed.get(), head.character.instance.get()),
              MIEN_OK);
    std::vector<float> out;
    std::vector<bool> done(64);
    for (const MienSolvePoint& point : points) {
      if (!done[point.mesh]) {
        EXPECT_EQ(mien_deformer_instance_deform(head.deformed.get(), point.mesh, MIEN_NORMALS_NONE,
                                                nullptr),
                  MIEN_OK);
      }
      done[point.mesh] = true;
      const Span<const float> all = Deformed::positions(head.deformed.get(), point.mesh);
      for (size_t k = 0; k < 3; ++k) {
        float sum = 0;
        for (size_t n = 0; n < 3; ++n) {
          sum += point.weights[n] * all[point.positions[n] * size_t{3} + k];
        }
        out.push_back(sum);
      }
    }
    return out;
  }
  MienFitResult solve(const FitHandle& fit, const MienFitFrame& frame,
                      std::vector<float>& found) const {
    found.assign(raw_count, -1.0f);
    MienFitResult result = mien_fit_result_default();
    EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
    return result;
  }
};

std::vector<MienSolvePoint> join(std::vector<MienSolvePoint> a,
                                 const std::vector<MienSolvePoint>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

MienFitFrame frame_of(const std::vector<float>& targets) {
  MienFitFrame frame = mien_fit_frame_default();
  frame.points = targets.data();
  frame.prior_weight = 1e-6f;
  frame.max_iterations = 100;
  return frame;
}

TEST(FitMeshes, EyesAndTeethSayWhatTheSkinDoesNot) {
  Meshes meshes;
  std::vector<float> raw(meshes.raw_count), found;
  const uint32_t look = meshes.control("eyeLookOutLeft"), jaw = meshes.control("jawOpen");
  raw[look] = 0.7f;
  raw[jaw] = 0.4f;
  // A patch of the forehead, and few points of an eye and of the teeth.
  const std::vector<MienSolvePoint> skin = meshes.every(kSkin, 1500);
  const std::vector<MienSolvePoint> all =
      join(join(meshes.every(kTeeth, 300), meshes.every(kEyes[0], 60)), skin);
  const FitHandle fit = meshes.fit(all);
  const std::vector<float> targets = meshes.places(raw, all);
  const MienFitResult result = meshes.solve(fit, frame_of(targets), found);
  EXPECT_EQ(result.status, MIEN_FIT_CONVERGED);
  EXPECT_LT(result.point_worst, 1e-3);
  EXPECT_NEAR(found[look], 0.7f, 0.01f);
  EXPECT_NEAR(found[jaw], 0.4f, 0.05f);
  // Only the eye sees its gaze, to which two controls lead: outward, and back.
  std::vector<float> by_all(meshes.raw_count), by_teeth(meshes.raw_count);
  const FitHandle teeth = meshes.fit(meshes.every(kTeeth, 300));
  ASSERT_EQ(mien_fit_observability(fit.get(), by_all.data(), by_all.size()), MIEN_OK);
  ASSERT_EQ(mien_fit_observability(teeth.get(), by_teeth.data(), by_teeth.size()), MIEN_OK);
  const uint32_t back = meshes.control("eyeLookInLeft");
  EXPECT_GT(std::max(by_all[look], by_all[back]), 0.01f);
  EXPECT_EQ(by_teeth[look], 0);
  EXPECT_EQ(by_teeth[back], 0);
  EXPECT_GT(*std::max_element(by_teeth.begin(), by_teeth.end()), 0.9f);
}

// The points of two meshes in any order, with missing ones, with few or nearly all positions, with more points than a
// sample has: the same controls.
TEST(FitMeshes, OrderAndNumberOfPointsDoNotMatter) {
  Meshes meshes;
  Random random = Random::from_seed(93, 1);
  const std::vector<float> raw = meshes.head.pose(random, 8);
  const std::vector<MienSolvePoint> skin = meshes.every(kSkin, 97), eye = meshes.every(kEyes[1], 5);
  std::vector<MienSolvePoint> mixed = join(skin, eye);
  std::vector<float> expected, found;
  const std::vector<float> targets = meshes.places(raw, mixed);
  const FitHandle plain = meshes.fit(mixed);
  EXPECT_LT(meshes.solve(plain, frame_of(targets), expected).point_worst, 2e-3);

  for (size_t i = mixed.size(); i > 1; --i) {
    std::swap(mixed[i - 1], mixed[random.below(static_cast<uint32_t>(i))]);
  }
  std::vector<float> shuffled = meshes.places(raw, mixed);
  for (size_t i = 0; i < mixed.size(); i += 9) {
    shuffled[3 * i + 1] = std::numeric_limits<float>::quiet_NaN();
  }
  const FitHandle again = meshes.fit(mixed);
  const MienFitResult result = meshes.solve(again, frame_of(shuffled), found);
  EXPECT_LT(result.point_worst, 2e-3);
  EXPECT_EQ(result.missing_points, (mixed.size() + 8) / 9);
  std::vector<float> observed(meshes.raw_count);
  ASSERT_EQ(mien_fit_observability(again.get(), observed.data(), observed.size()), MIEN_OK);
  for (size_t c = 0; c < raw.size(); ++c) {
    if (observed[c] > 0.05f) {
      EXPECT_NEAR(found[c], expected[c], 0.01f) << c;
    }
  }

  const std::vector<MienSolvePoint> of_eyes = meshes.every(kEyes[1], 1);
  static_cast<void>(meshes.places(raw, {of_eyes[0]}));
  const Span<const float> eyes = Deformed::positions(meshes.head.deformed.get(), kEyes[1]);
  std::vector<float> all_targets(eyes.begin(), eyes.begin() + 3 * of_eyes.size());
  const std::vector<MienSolvePoint> many = join(of_eyes, meshes.every(kSkin, 1));
  const std::vector<float> skin_places = meshes.head.positions(raw);
  all_targets.insert(all_targets.end(), skin_places.begin(), skin_places.end());
  const FitHandle large = meshes.fit(many);
  EXPECT_LT(meshes.solve(large, frame_of(all_targets), found).point_worst, 2e-3);
  // Only the eye has targets, few of the points.
  std::vector<float> weights(many.size());
  std::fill_n(weights.begin(), of_eyes.size(), 1.0f);
  MienFitFrame of_eye = frame_of(all_targets);
  of_eye.point_weights = weights.data();
  EXPECT_LT(meshes.solve(large, of_eye, found).point_residual, 1e-3);
}

TEST(FitMeshes, SurfacesDrawThePointsOfEach) {
  Meshes meshes;
  std::vector<float> raw(meshes.raw_count), found;
  const uint32_t look = meshes.control("eyeLookUpLeft");
  raw[look] = 0.5f;
  raw[meshes.control("jawOpen")] = 0.15f;
  const std::vector<MienSolvePoint> points =
      join(meshes.every(kSkin, 40), meshes.every(kTeeth, 10));
  // One surface of both, with the teeth first.
  std::vector<float> positions;
  std::vector<uint32_t> triangles;
  for (const uint32_t m : {kTeeth, kSkin}) {
    const MienMesh mesh = mesh_of(meshes.head.deformer.get(), m);
    const auto first = static_cast<uint32_t>(positions.size() / 3);
    static_cast<void>(meshes.places(raw, {{m, {0, 0, 0}, {1, 0, 0}}}));
    const Span<const float> all = Deformed::positions(meshes.head.deformed.get(), m);
    positions.insert(positions.end(), all.begin(), all.begin() + mesh.position_count * size_t{3});
    for (size_t i = 0; i < mesh.triangle_count * size_t{3}; ++i) {
      triangles.push_back(first + mesh.vertex_position_indices.data[mesh.triangles.data[i]]);
    }
  }
  const SurfaceHandle surface = create_surface(positions, triangles);
  const FitHandle fit = meshes.fit(points);
  MienFitFrame frame = mien_fit_frame_default();
  frame.surface = surface.get();
  frame.surface_reach = 1;
  frame.prior_weight = 1e-4f;
  frame.max_iterations = 100;
  const MienFitResult result = meshes.solve(fit, frame, found);
  EXPECT_LT(result.surface_residual, 0.01);
  const std::vector<float> truth = meshes.places(raw, points), back = meshes.places(found, points);
  double apart = 0, asked = 0;
  const std::vector<float> rest = meshes.places(std::vector<float>(meshes.raw_count), points);
  for (size_t i = 0; i < truth.size(); ++i) {
    apart += (double{back[i]} - truth[i]) * (double{back[i]} - truth[i]);
    asked += (double{rest[i]} - truth[i]) * (double{rest[i]} - truth[i]);
  }
  EXPECT_LT(apart, 0.01 * asked);
}

// Lower teeth meet a place; they keep their distance from a place of the skin.
TEST(FitMeshes, ConstraintsAreBetweenThem) {
  Meshes meshes;
  const std::vector<MienSolvePoint> points =
      join(meshes.every(kTeeth, 300), meshes.every(kSkin, 700));
  const size_t skin = meshes.every(kTeeth, 300).size();
  const std::vector<float> rest = meshes.places(std::vector<float>(meshes.raw_count), points);
  const FitHandle fit = meshes.fit(points);
  size_t tooth = 0, scalp = skin;
  for (size_t i = 0; i < points.size(); ++i) {
    size_t& found = i < skin ? tooth : scalp;
    const float higher = rest[3 * i + 1] - rest[3 * found + 1];
    if (i < skin ? higher < 0 : higher > 0) found = i;
  }
  MienFitConstraint lower = {};
  lower.kind = MIEN_CONSTRAINT_POINT_POSITION;
  lower.points[0] = static_cast<uint32_t>(tooth);
  for (size_t k = 0; k < 3; ++k) lower.target[k] = rest[3 * lower.points[0] + k];
  lower.target[1] -= 1;
  lower.weight = 1;
  MienFitConstraint apart = lower;
  apart.kind = MIEN_CONSTRAINT_POINT_DISTANCE;
  apart.points[1] = static_cast<uint32_t>(scalp);
  double squared = 0;
  for (size_t k = 0; k < 3; ++k) {
    const double d = double{rest[3 * apart.points[0] + k]} - rest[3 * scalp + k];
    squared += d * d;
  }
  apart.distances[0] = static_cast<float>(std::sqrt(squared)) + 0.5f;
  apart.distances[1] = apart.distances[0] + 0.2f;
  for (const MienFitConstraint& one : {lower, apart}) {
    MienFitFrame frame = mien_fit_frame_default();
    frame.constraints = &one;
    frame.constraint_count = 1;
    frame.prior_weight = 1e-6f;
    frame.max_iterations = 100;
    std::vector<float> found;
    const MienFitResult result = meshes.solve(fit, frame, found);
    EXPECT_LT(result.constraint_worst, 0.05) << one.kind;
    EXPECT_GT(*std::max_element(found.begin(), found.end()), 0.05f);
    // Beside points.
    MienFitFrame both = frame;
    both.points = rest.data();
    both.rigid = 1;
    const MienFitResult beside = meshes.solve(fit, both, found);
    EXPECT_EQ(beside.status, MIEN_FIT_CONVERGED);
  }
}

TEST(FitMeshes, RefuseWrongMeshes) {
  Meshes meshes;
  std::vector<MienSolvePoint> points = join(meshes.every(kSkin, 5000), meshes.every(kTeeth, 500));
  MienFitDesc desc = sized<MienFitDesc>();
  desc.deformer = meshes.head.deformer.get();
  desc.points = points.data();
  desc.point_count = points.size();
  points.back().mesh = 64;
  create_fit(meshes.head.rig, desc, MIEN_ERROR_INDEX);
  points.back().mesh = ~0u;
  create_fit(meshes.head.rig, desc, MIEN_ERROR_INDEX);
  points.back() = {kTeeth, {19000, 0, 0}, {1, 0, 0}};  // a position of the skin
  create_fit(meshes.head.rig, desc, MIEN_ERROR_INDEX);
  points.back() = {kSkin, {19000, 0, 0}, {1, 0, 0}};
  EXPECT_TRUE(create_fit(meshes.head.rig, desc));
}

}  // namespace
}  // namespace mien
