// SPDX-License-Identifier: MIT
#include "runtime/probe/probe_gaze.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "tests/support/counting_allocator.h"
#include "tests/support/deform_rig.h"

namespace mien {
namespace {

struct GazingHead {
  DnaHandle dna = generate_dna(MIEN_PRESET_HEAD, 0);
  RigHandle rig = create_rig(dna.get());
  DeformerHandle handle = create_deformer(dna.get(), rig.get());
  const Deformer& deformer = *capi::object(handle.get());
  std::vector<std::string> controls = names_of(rig, MIEN_KIND_RAW_CONTROL);
  RigProbe probe{deformer, default_allocator()};
  uint32_t eyes[2] = {};
  GazeTable table = {};

  GazingHead() {
    Error error;
    EXPECT_TRUE(find_eyes(*deformer.rig, eyes));
    EXPECT_EQ(probe_gaze(deformer, eyes, default_allocator(), table, error), Status::kOk)
        << error.message;
  }

  /// Degrees between where the eye looks, evaluated, and where the target is.
  double miss(uint32_t eye, const std::vector<float>& row, const float (&target)[3]) {
    probe.clear();
    for (uint16_t c = 0; c < row.size(); ++c) probe.set(c, row[c]);
    probe.pose();
    const float* center = table.eyes[eye].center;
    const Vec3 at = {center[0] / 10, center[1] / 10, center[2] / 10};
    const Vec3 looks =
        unit(probe.skinned(eyes[eye], at + Vec3{0, 0, 1}) - probe.skinned(eyes[eye], at));
    const Vec3 wanted = unit(Vec3{target[0] / 10, target[1] / 10, target[2] / 10} - at);
    return std::acos(std::min(1.0, dot(looks, wanted))) * 180 / M_PI;
  }
};

GazingHead& gazing_head() {
  static GazingHead made;
  return made;
}

TEST(Gaze, FindsTheControlsOfEachDirection) {
  const auto name = [](uint32_t eye, GazeDirection way) {
    return gazing_head().controls[gazing_head().table.eyes[eye].curves[way]];
  };
  EXPECT_EQ(name(0, kGazeLeft), "eyeLookOutLeft");
  EXPECT_EQ(name(0, kGazeRight), "eyeLookInLeft");
  EXPECT_EQ(name(1, kGazeLeft), "eyeLookInRight");
  EXPECT_EQ(name(1, kGazeRight), "eyeLookOutRight");
  EXPECT_EQ(name(0, kGazeUp), "eyeLookUpLeft");
  EXPECT_EQ(name(1, kGazeDown), "eyeLookDownRight");
  EXPECT_LT(gazing_head().table.fit_error, 2);
}

TEST(Gaze, ObjectsHaveTheTableOfTheirRig) {
  CountingAllocator counter;
  const MienAllocator given = counter.get();
  const Allocator allocator = {given.user, given.allocate, given.release, 0};
  Gaze* gaze = nullptr;
  Error error;
  ASSERT_EQ(create_gaze(gazing_head().deformer, gazing_head().eyes, allocator, gaze, error),
            Status::kOk)
      << error.message;
  EXPECT_EQ(gaze->tag, Gaze::kTag);
  EXPECT_EQ(gaze->raw_count, gazing_head().deformer.rig->raw_count);
  EXPECT_EQ(memcmp(&gaze->table, &gazing_head().table, sizeof(GazeTable)), 0);
  EXPECT_EQ(counter.live, 1u) << "what measuring took is back";
  release(gaze);
  EXPECT_TRUE(counter.clean()) << counter.first_wrong;

  const uint32_t none[2] = {gazing_head().eyes[0], gazing_head().deformer.skeleton.joint_count};
  EXPECT_EQ(create_gaze(gazing_head().deformer, none, allocator, gaze, error), Status::kIndex);
  EXPECT_EQ(gaze, nullptr);
  counter.restart();
  counter.fail_at = 1;
  counter.keep_failing = true;
  EXPECT_EQ(create_gaze(gazing_head().deformer, gazing_head().eyes, allocator, gaze, error),
            Status::kMemory);
  EXPECT_EQ(gaze, nullptr);
  EXPECT_TRUE(counter.clean()) << counter.first_wrong;
}

TEST(Gaze, BothEyesLookAtTheTarget) {
  for (float x : {-300.0f, -40.0f, 0.0f, 150.0f, 330.0f}) {
    for (float y : {-280.0f, 0.0f, 120.0f, 260.0f}) {
      const float target[3] = {x, y, 900};
      std::vector<float> row(gazing_head().controls.size());
      float beyond[2] = {1, 1};
      look_at(gazing_head().table, target, row.data(), beyond);
      EXPECT_EQ(beyond[0], 0);
      EXPECT_EQ(beyond[1], 0);
      for (uint32_t eye : {0u, 1u})
        EXPECT_LT(gazing_head().miss(eye, row, target), 0.6) << x << " " << y;
    }
  }
}

TEST(Gaze, EyesConvergeOnNearTargets) {
  const float near[3] = {0, 0, 250}, far[3] = {0, 0, 100000};
  std::vector<float> row(gazing_head().controls.size());
  look_at(gazing_head().table, near, row.data(), nullptr);
  EXPECT_GT(row[gazing_head().table.eyes[0].curves[kGazeRight]], 0.1f);
  EXPECT_GT(row[gazing_head().table.eyes[1].curves[kGazeLeft]], 0.1f);
  for (uint32_t eye : {0u, 1u}) EXPECT_LT(gazing_head().miss(eye, row, near), 0.6);
  look_at(gazing_head().table, far, row.data(), nullptr);
  for (float value : row) EXPECT_LT(value, 0.01f);
}

TEST(Gaze, TellsWhatIsBeyondTheReachOfTheEyes) {
  const float target[3] = {2000, -1500, 900};
  std::vector<float> row(gazing_head().controls.size());
  float beyond[2];
  look_at(gazing_head().table, target, row.data(), beyond);
  EXPECT_EQ(row[gazing_head().table.eyes[0].curves[kGazeLeft]], 1);
  EXPECT_EQ(row[gazing_head().table.eyes[0].curves[kGazeRight]], 0);
  EXPECT_EQ(row[gazing_head().table.eyes[1].curves[kGazeDown]], 1);
  EXPECT_GT(beyond[0], 1);
  EXPECT_LT(beyond[1], 0);
  const float behind[3] = {-50, 0, -900};
  look_at(gazing_head().table, behind, row.data(), beyond);
  for (float value : row) EXPECT_TRUE(value >= 0 && value <= 1);
  EXPECT_LT(beyond[0], 0);
}

TEST(Gaze, RefusesJointsThatNothingTurns) {
  GazeTable table;
  Error error;
  const uint32_t roots[2] = {0, 0}, none[2] = {0, 1000};
  EXPECT_EQ(probe_gaze(gazing_head().deformer, roots, default_allocator(), table, error),
            Status::kInvalidArgument);
  EXPECT_EQ(probe_gaze(gazing_head().deformer, none, default_allocator(), table, error),
            Status::kIndex);
  EXPECT_EQ(table.fit_error, 0);
}

}  // namespace
}  // namespace mien
