// SPDX-License-Identifier: MIT
// Solves of motions: several frames in one call, on several threads, and with noise, outliers and missing data.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "tests/fit/fit_head.h"
#include "tests/support/golden.h"

namespace mien {
namespace {

constexpr size_t kFrames = 40;  // more than are multiplied together

/// One of `stride` controls swings, at different rates.
std::vector<float> swing(size_t raw_count, double time, size_t stride = 9) {
  std::vector<float> raw(raw_count);
  for (size_t i = 0; i < raw_count; i += stride) {
    const double rate = 1 + 0.2 * static_cast<double>(i % 7);
    raw[i] = static_cast<float>(0.4 - 0.4 * std::cos(time * rate + static_cast<double>(i)));
  }
  return raw;
}

std::vector<MienFitResult> results_of(size_t count) {
  return std::vector<MienFitResult>(count, mien_fit_result_default());
}

TEST(Frames, OfJointsAreThoseOfSingleSolves) {
  Head head(MIEN_PRESET_MEDIUM);
  const FitHandle fit = create_fit(head.rig, sized<MienFitDesc>());
  const size_t raw_count = head.character.raw.count, joint_count = head.character.joints.count;
  std::vector<float> targets;
  double range = 0;
  for (size_t i = 0; i < kFrames; ++i) {
    const std::vector<float> joints = head.joints(swing(raw_count, static_cast<double>(i) / 60));
    targets.insert(targets.end(), joints.begin(), joints.end());
    for (const float v : joints) range = std::fmax(range, std::fabs(v));
  }
  targets[20 * joint_count + 3] = std::numeric_limits<float>::quiet_NaN();
  for (const size_t first : {size_t{0}, size_t{21}}) {  // with a missing value, and without
    const size_t count = kFrames - first;
    MienFitFrame frame = mien_fit_frame_default();
    frame.joints = targets.data() + first * joint_count;
    std::vector<float> found(count * raw_count), again(count * raw_count), one(raw_count), before;
    std::vector<MienFitResult> results = results_of(count);
    ASSERT_EQ(mien_fit_solve_frames(fit.get(), &frame, count, found.data(), results.data()),
              MIEN_OK);
    ASSERT_EQ(mien_fit_solve_frames(fit.get(), &frame, count, again.data(), nullptr), MIEN_OK);
    EXPECT_EQ(found, again);
    for (size_t i = 0; i < count; ++i) {
      MienFitFrame single = frame;
      single.joints += i * joint_count;
      single.start = i == 0 ? nullptr : before.data();
      ASSERT_EQ(mien_fit_solve(fit.get(), &single, one.data(), nullptr), MIEN_OK);
      EXPECT_EQ(results[i].status, MIEN_FIT_CONVERGED) << i;
      EXPECT_LE(results[i].joint_worst, 1e-3 * range) << i;
      EXPECT_FALSE(results[i].jumped) << i;
      for (size_t c = 0; c < raw_count; ++c) {
        ASSERT_NEAR(one[c], found[i * raw_count + c], 5e-3) << i << ' ' << c;
      }
      before = one;
    }
  }
}

/// A motion of joints in two ranges: on one thread with one fit, and on two threads with one each.
void expect_same_ranges(Head&& head) {
  constexpr size_t kRange = 24;
  const size_t raw_count = head.character.raw.count, joint_count = head.character.joints.count;
  std::vector<float> targets;
  double range = 0;
  for (size_t i = 0; i < 2 * kRange; ++i) {
    const std::vector<float> joints = head.joints(swing(raw_count, static_cast<double>(i) / 60));
    targets.insert(targets.end(), joints.begin(), joints.end());
    for (const float v : joints) range = std::fmax(range, std::fabs(v));
  }
  const FitHandle fits[2] = {create_fit(head.rig, sized<MienFitDesc>()),
                             create_fit(head.rig, sized<MienFitDesc>())};
  std::vector<float> alone(2 * kRange * raw_count), together(alone.size());
  std::vector<MienFitResult> results = results_of(2 * kRange);
  const auto solve = [&](const FitHandle& fit, size_t part, std::vector<float>& found,
                         MienFitResult* told) {
    MienFitFrame frame = mien_fit_frame_default();
    frame.joints = targets.data() + part * kRange * joint_count;
    EXPECT_EQ(mien_fit_solve_frames(fit.get(), &frame, kRange,
                                    found.data() + part * kRange * raw_count, told),
              MIEN_OK);
  };
  for (const size_t part : {size_t{0}, size_t{1}}) {
    solve(fits[0], part, alone, results.data() + part * kRange);
  }
  std::thread other([&] { solve(fits[1], 1, together, nullptr); });
  solve(fits[0], 0, together, nullptr);
  other.join();
  EXPECT_EQ(alone, together);
  for (const MienFitResult& result : results) {
    EXPECT_EQ(result.status, MIEN_FIT_CONVERGED);
    EXPECT_LE(result.joint_worst, 1e-3 * range);
  }
}

TEST(Frames, OfJointsHaveTheSameBitsInRangesOnAnyThread) {
  expect_same_ranges(Head(MIEN_PRESET_MEDIUM));
  expect_same_ranges(Head(open_dna(golden::read_rig("ml"))));  // networks between controls
}

/// Solves a motion for all vertices, each frame from the one before, and returns the iterations after the first frame.
uint32_t solve_vertices(Head& head, size_t frame_count, size_t stride, float apart) {
  const size_t raw_count = head.character.raw.count;
  const std::vector<MienSolvePoint> points =
      every(mesh_of(head.deformer.get(), 0).position_count, 1);
  const FitHandle fit = create_point_fit(head, points);
  std::vector<float> observed(raw_count), found(raw_count), before;
  EXPECT_EQ(mien_fit_observability(fit.get(), observed.data(), raw_count), MIEN_OK);
  uint32_t iterations = 0;
  for (size_t i = 0; i < frame_count; ++i) {
    const std::vector<float> raw = swing(raw_count, static_cast<double>(i) / 60, stride);
    const std::vector<float> targets = head.positions(raw);
    MienFitFrame frame = mien_fit_frame_default();
    frame.points = targets.data();
    frame.prior_weight = 1e-6f;
    frame.start = i == 0 ? nullptr : before.data();
    MienFitResult result = mien_fit_result_default();
    EXPECT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
    EXPECT_EQ(result.status, MIEN_FIT_CONVERGED) << i;
    if (i != 0) iterations += result.iterations;
    for (size_t c = 0; c < raw_count; ++c) {
      if (observed[c] <= 0.05f) continue;
      EXPECT_NEAR(found[c], raw[c], apart) << i << ", control " << c;
    }
    before = found;
  }
  return iterations;
}

// A step looks at all vertices where it takes the effects of controls at rest.
TEST(Frames, OfAllVerticesTakeFewSteps) {
  Head head;
  constexpr size_t kVertexFrames = 10;
  EXPECT_LE(solve_vertices(head, kVertexFrames, 9, 1e-3f), 2 * (kVertexFrames - 1));
}

// Where effects at rest are far from those of the pose, steps learn from those before.
TEST(Frames, OfAllVerticesOfALargeHeadTakeFewSteps) {
  Head head(MIEN_PRESET_LARGE);
  constexpr size_t kVertexFrames = 4;
  EXPECT_LE(solve_vertices(head, kVertexFrames, 4, 2e-3f), 5 * (kVertexFrames - 1));
}

TEST(Frames, RefuseWrongArguments) {
  Head head(MIEN_PRESET_SMALL);
  const FitHandle fit = create_fit(head.rig, sized<MienFitDesc>());
  MienFitFrame frame = mien_fit_frame_default();
  std::vector<float> found(head.character.raw.count);
  EXPECT_EQ(mien_fit_solve_frames(fit.get(), &frame, 0, nullptr, nullptr), MIEN_OK);
  EXPECT_EQ(mien_fit_solve_frames(fit.get(), &frame, 1, nullptr, nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_fit_solve_frames(fit.get(), nullptr, 1, found.data(), nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_fit_solve_frames(nullptr, &frame, 1, found.data(), nullptr),
            MIEN_ERROR_NULL_ARGUMENT);
  std::vector<MienFitResult> results = results_of(2);
  results[1].struct_size = 8;
  EXPECT_NE(mien_fit_solve_frames(fit.get(), &frame, 2, std::vector<float>(2 * found.size()).data(),
                                  results.data()),
            MIEN_OK);
  frame.sparse_weight = -1;
  EXPECT_EQ(mien_fit_solve_frames(fit.get(), &frame, 1, found.data(), nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
}

/// What both ways to solve frames refuse, before they write anything. `good` has two frames.
void expect_refusals(MienFit* fit, const MienFitFrame& good, size_t raw_count) {
  std::vector<float> found(2 * raw_count, 7.0f);
  const std::vector<float> untouched = found;
  std::vector<float> row(raw_count);
  row.back() = std::numeric_limits<float>::quiet_NaN();
  std::vector<uint32_t> stages(raw_count);
  stages.back() = 16;
  const float image[4] = {};
  const MienFitCamera camera = {};
  const std::vector<uint64_t> no_surface(64);
  MienFitConstraint constraint = {};
  constraint.kind = 99;
  const auto refuse = [&](MienStatus expected, const char* what, auto change) {
    MienFitFrame wrong = good;
    change(wrong);
    std::vector<MienFitResult> results = results_of(2);
    EXPECT_EQ(mien_fit_solve_frames(fit, &wrong, 2, found.data(), results.data()), expected)
        << what;
    EXPECT_EQ(found, untouched) << what;
    EXPECT_EQ(mien_fit_solve(fit, &wrong, found.data(), nullptr), expected) << what << ", alone";
  };
  using Frame = MienFitFrame;
  refuse(MIEN_ERROR_STRUCT_SIZE, "size", [](Frame& f) { f.struct_size = 1; });
  const MienStatus wrong = MIEN_ERROR_INVALID_ARGUMENT;
  refuse(wrong, "start", [&](Frame& f) { f.start = row.data(); });
  refuse(wrong, "prior", [&](Frame& f) { f.prior = row.data(); });
  refuse(wrong, "stage", [&](Frame& f) { f.stages = stages.data(); });
  refuse(wrong, "prior_weight", [](Frame& f) { f.prior_weight = -1; });
  refuse(wrong, "smooth_weight", [](Frame& f) { f.smooth_weight = -1; });
  refuse(wrong, "symmetric_weight", [](Frame& f) { f.symmetric_weight = INFINITY; });
  refuse(wrong, "robust_scale", [](Frame& f) { f.robust_scale = -1; });
  refuse(wrong, "joint_weight", [](Frame& f) { f.joint_weight = -1; });
  refuse(wrong, "constraint", [&](Frame& f) {
    f.constraints = &constraint;
    f.constraint_count = 1;
  });
  refuse(MIEN_ERROR_NULL_ARGUMENT, "no camera", [&](Frame& f) {
    f.points = nullptr;
    f.images = image;
  });
  if (!good.points) {
    refuse(MIEN_ERROR_NULL_ARGUMENT, "a fit without points", [&](Frame& f) { f.points = image; });
    return;
  }
  refuse(wrong, "two kinds of points", [&](Frame& f) {
    f.images = image;
    f.camera = &camera;
  });
  refuse(MIEN_ERROR_HANDLE, "surface", [&](Frame& f) {
    f.points = nullptr;
    f.surface = reinterpret_cast<const MienFitSurface*>(no_surface.data());
  });
}

TEST(Frames, OfJointsAndOfPointsRefuseTheSame) {
  Head head(MIEN_PRESET_MEDIUM);
  const size_t raw_count = head.character.raw.count;
  const FitHandle of_joints = create_fit(head.rig, sized<MienFitDesc>());
  const std::vector<float> joints(2 * head.character.joints.count);
  MienFitFrame frame = mien_fit_frame_default();
  frame.joints = joints.data();
  expect_refusals(of_joints.get(), frame, raw_count);

  const std::vector<MienSolvePoint> points =
      every(mesh_of(head.deformer.get(), 0).position_count, 50);
  const FitHandle of_points = create_point_fit(head, points);
  std::vector<float> targets(6 * points.size());
  frame = mien_fit_frame_default();
  frame.points = targets.data();
  expect_refusals(of_points.get(), frame, raw_count);

  // A weight of the last frame is found before the first one is solved.
  std::vector<float> weights(2 * points.size(), 1.0f), found(2 * raw_count, 7.0f);
  weights.back() = -1;
  frame.point_weights = weights.data();
  EXPECT_EQ(mien_fit_solve_frames(of_points.get(), &frame, 2, found.data(), nullptr),
            MIEN_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(found, std::vector<float>(2 * raw_count, 7.0f));
}

/// Frames with stages, and single solves of which only the first one has them.
void expect_stages_of_the_first_frame(MienFit* fit, MienFitFrame frame, const float* row,
                                      size_t width, size_t raw_count) {
  std::vector<uint32_t> stages(raw_count, 1);
  for (size_t i = 0; i < raw_count; i += 18) stages[i] = 0;
  frame.max_iterations = 3;
  std::vector<float> found(2 * raw_count), plain(2 * raw_count), one(raw_count), before;
  ASSERT_EQ(mien_fit_solve_frames(fit, &frame, 2, plain.data(), nullptr), MIEN_OK);
  frame.stages = stages.data();
  std::vector<MienFitResult> results = results_of(2);
  ASSERT_EQ(mien_fit_solve_frames(fit, &frame, 2, found.data(), results.data()), MIEN_OK);
  EXPECT_NE(std::vector<float>(found.begin(), found.begin() + static_cast<int>(raw_count)),
            std::vector<float>(plain.begin(), plain.begin() + static_cast<int>(raw_count)))
      << "stages take other steps";
  MienFitResult result = mien_fit_result_default();
  for (size_t i = 0; i < 2; ++i) {
    (frame.joints ? frame.joints : frame.points) = row + i * width;
    ASSERT_EQ(mien_fit_solve(fit, &frame, one.data(), &result), MIEN_OK);
    for (size_t c = 0; c < raw_count; ++c) ASSERT_NEAR(one[c], found[i * raw_count + c], 5e-3) << c;
    before = one;
    frame.start = before.data();
    frame.stages = nullptr;
  }
}

TEST(Frames, StagesAreOfTheFirstFrame) {
  Head head(MIEN_PRESET_MEDIUM);
  const size_t raw_count = head.character.raw.count, joint_count = head.character.joints.count;
  const std::vector<MienSolvePoint> points =
      every(mesh_of(head.deformer.get(), 0).position_count, 10);
  std::vector<float> joints, places;
  for (const double time : {1.0, 1.1}) {
    const std::vector<float> raw = swing(raw_count, time), own = head.joints(raw);
    joints.insert(joints.end(), own.begin(), own.end());
    const std::vector<float> skin = head.positions(raw);
    for (const MienSolvePoint& p : points) {
      for (size_t k = 0; k < 3; ++k) places.push_back(skin[p.positions[0] * size_t{3} + k]);
    }
  }
  MienFitFrame frame = mien_fit_frame_default();
  frame.joints = joints.data();
  expect_stages_of_the_first_frame(create_fit(head.rig, sized<MienFitDesc>()).get(), frame,
                                   joints.data(), joint_count, raw_count);
  MienFitDesc desc = sized<MienFitDesc>();
  desc.deformer = head.deformer.get();
  desc.points = points.data();
  desc.point_count = points.size();
  frame = mien_fit_frame_default();
  frame.points = places.data();
  expect_stages_of_the_first_frame(create_fit(head.rig, desc).get(), frame, places.data(),
                                   3 * points.size(), raw_count);
}

/// Landmarks of a motion with noise, every tenth an outlier in some frames, and some frames without any.
struct Landmarks {
  Head head;
  std::vector<MienSolvePoint> points;
  std::vector<float> targets;

  Landmarks() : points(every(mesh_of(head.deformer.get(), 0).position_count, 25)) {
    Random random = Random::from_seed(83, 1);
    for (size_t i = 0; i < kFrames; ++i) {
      const std::vector<float> all =
          head.positions(swing(head.character.raw.count, static_cast<double>(i) / 30));
      for (size_t p = 0; p < points.size(); ++p) {
        for (size_t k = 0; k < 3; ++k) {
          float v = all[points[p].positions[0] * size_t{3} + k];
          v += static_cast<float>(random.between(-0.05, 0.05));
          if (i % 4 == 1 && p % 10 == 3) v += 6;
          if (p % 7 == 2 || i == 17) v = std::numeric_limits<float>::quiet_NaN();
          targets.push_back(v);
        }
      }
    }
  }
  FitHandle fit() {
    MienFitDesc desc = sized<MienFitDesc>();
    desc.deformer = head.deformer.get();
    desc.points = points.data();
    desc.point_count = points.size();
    return create_fit(head.rig, desc);
  }
  MienFitFrame frame() const {
    MienFitFrame frame = mien_fit_frame_default();
    frame.points = targets.data();
    frame.robust_scale = 0.5f;
    frame.prior_weight = 1e-3f;
    frame.smooth_weight = 1e-2f;
    return frame;
  }
};

TEST(Frames, HaveTheSameBitsOnEachThread) {
  Landmarks marks;
  const size_t size = marks.head.character.raw.count * kFrames;
  std::vector<float> found[3];
  std::vector<FitHandle> fits;
  std::vector<std::thread> threads;
  for (auto& rows : found) {
    rows.resize(size);
    fits.push_back(marks.fit());
  }
  const MienFitFrame frame = marks.frame();
  for (size_t t = 0; t < 3; ++t) {
    threads.emplace_back([&, t] {
      EXPECT_EQ(mien_fit_solve_frames(fits[t].get(), &frame, kFrames, found[t].data(), nullptr),
                MIEN_OK);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
}

TEST(Frames, NeverJumpFartherThanTheTargetsUnlessTheySaySo) {
  Landmarks marks;
  const FitHandle fit = marks.fit();
  const size_t raw_count = marks.head.character.raw.count;
  const MienFitFrame frame = marks.frame();
  std::vector<float> found(kFrames * raw_count);
  std::vector<MienFitResult> results = results_of(kFrames);
  ASSERT_EQ(mien_fit_solve_frames(fit.get(), &frame, kFrames, found.data(), results.data()),
            MIEN_OK);
  const auto surface = [&](size_t i) {
    return marks.head.positions({found.data() + i * raw_count, found.data() + (i + 1) * raw_count});
  };
  size_t told = 0;
  for (size_t i = 1; i < kFrames; ++i) {
    EXPECT_EQ(results[i].status, i == 17 ? uint32_t{MIEN_FIT_NO_DATA} : results[i].status);
    if (i == 17) {
      EXPECT_EQ(
          std::vector<float>(found.data() + i * raw_count, found.data() + (i + 1) * raw_count),
          std::vector<float>(found.data() + (i - 1) * raw_count, found.data() + i * raw_count));
    }
    told += results[i].jumped;
    if (results[i].jumped) continue;
    const std::vector<float> before = surface(i - 1), after = surface(i);
    double moved = 0, asked = 0;
    for (size_t p = 0; p < marks.points.size(); ++p) {
      const float* target = marks.targets.data() + (i * marks.points.size() + p) * 3;
      const size_t at = marks.points[p].positions[0] * size_t{3};
      const bool outlier = i % 4 == 1 && p % 10 == 3;
      for (size_t k = 0; k < 3; ++k) {
        moved += outlier ? 0 : std::pow(double{after[at + k]} - before[at + k], 2);
        if (!outlier && std::isfinite(target[k])) {
          asked += std::pow(double{target[k]} - before[at + k], 2);
        }
      }
    }
    EXPECT_LE(moved, 1.1 * asked + 1e-6) << i;
  }
  EXPECT_LT(told, kFrames / 4);
}

TEST(Frames, TellOfAJump) {
  Head head(MIEN_PRESET_MEDIUM);
  const FitHandle fit = create_fit(head.rig, sized<MienFitDesc>());
  const std::vector<float> start = swing(head.character.raw.count, 1);
  const std::vector<float> joints = head.joints(start);
  // The targets ask for nothing, but the prior does.
  MienFitFrame frame = mien_fit_frame_default();
  frame.joints = joints.data();
  frame.start = start.data();
  frame.prior_weight = 1e4f;
  std::vector<float> found(start.size());
  MienFitResult result = mien_fit_result_default();
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_TRUE(result.jumped);
  frame.prior_weight = 0;
  ASSERT_EQ(mien_fit_solve(fit.get(), &frame, found.data(), &result), MIEN_OK);
  EXPECT_FALSE(result.jumped);
}

}  // namespace
}  // namespace mien
