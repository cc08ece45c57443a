// SPDX-License-Identifier: MIT
// RBF solvers against a plain model (integrations/program/model/rbf_model.h), on every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "integrations/program/model/rbf_model.h"
#include "tests/support/layer_rig.h"

namespace mien {
namespace {

// Raw controls: four plain ones, then two quaternions.
constexpr uint16_t kRbfRaw = 12, kFirstQuaternion = 4;

std::vector<float> random_quaternion(Random& random) {
  std::vector<float> q(4);
  double length = 0;
  for (float& part : q) {
    part = static_cast<float>(random.between(-1, 1));
    length += double{part} * part;
  }
  for (float& part : q) part = static_cast<float>(part / std::sqrt(length));
  return q;
}

struct RbfRig {
  LayerRig rig;
  Random& random;

  explicit RbfRig(Random& from) : random(from) {
    rig.base.raw_count = kRbfRaw;
    rig.base.joint_count = 1;
  }

  /// A solver with poses of its own, which drive a control each.
  PlainRbfSolver& add(PlainRbfSolver solver, uint16_t pose_count) {
    const bool angular = solver.distance != 0;
    const auto quaternions = static_cast<uint16_t>(1 + random.below(2));
    const uint16_t first = angular ? kFirstQuaternion : 0;
    const auto count = static_cast<uint16_t>(angular ? 4 * quaternions : 3);
    for (uint16_t i = 0; i < count; ++i) solver.inputs.push_back(static_cast<uint16_t>(first + i));
    for (uint16_t p = 0; p < pose_count; ++p) {
      for (uint16_t i = 0; i < count; i = static_cast<uint16_t>(i + (angular ? 4 : 1))) {
        if (angular) {
          std::vector<float> q = random_quaternion(random);
          if (solver.distance == 3) {  // twists are on a circle: keep them apart
            const double half = (p + random.between(0.1, 0.5)) * 3.14159265 / pose_count;
            q[solver.axis] = static_cast<float>(std::sin(half));
            q[3] = static_cast<float>(std::cos(half));
          }
          solver.targets.insert(solver.targets.end(), q.begin(), q.end());
        } else {
          solver.targets.push_back(static_cast<float>(random.between(-1, 1)));
        }
      }
      solver.poses.push_back(static_cast<uint16_t>(rig.poses.size()));
      rig.poses.push_back({static_cast<float>(random.between(0.5, 1.5)),
                           {},
                           {static_cast<uint16_t>(kRbfRaw + rig.rbf_count++)},
                           {static_cast<float>(random.between(0.5, 2))}});
    }
    rig.solvers.push_back(solver);
    return rig.solvers.back();
  }
};

void expect_rbf_model(const LayerRig& rig, Random& random, double tolerance, int frames) {
  const LayerFile file(rig);
  for (uint32_t isa : present_isas()) {
    const RigHandle handle = create_rig(file.dna.get(), isa);
    ASSERT_TRUE(handle);
    for (int frame = 0; frame < frames; ++frame) {
      // A new one: poses may multiply with what a later solver gave in the frame before.
      Character character(handle);
      const std::vector<float> raw = random_raw(rig, {4, 8}, random);
      std::copy(raw.begin(), raw.end(), character.raw.begin());
      for (uint32_t lod = 0; lod < rig.base.lod_count; ++lod) {
        std::vector<double> expected = initial_controls(rig);
        std::copy(raw.begin(), raw.end(), expected.begin());
        model_rbf(rig, lod, expected);
        character.evaluate(lod);
        for (size_t i = 0; i < expected.size(); ++i) {
          ASSERT_NEAR(character.controls[i], expected[i], tolerance)
              << mien_isa_name(isa) << ", LOD " << lod << ", control " << i;
        }
      }
    }
  }
}

TEST(RbfSolvers, EveryCombination) {
  Random random = Random::from_seed(31, 1);
  for (uint16_t unit = 0; unit < 2; ++unit) {
    RbfRig made(random);
    made.rig.rotation_unit = unit;
    for (uint16_t type = 0; type < 2; ++type) {
      for (uint16_t distance = 0; distance < 4; ++distance) {
        for (uint16_t function = 0; function < 5; ++function) {
          for (uint16_t normalize = 0; normalize < 2; ++normalize) {
            for (uint16_t automatic = 0; automatic < 2; ++automatic) {
              for (uint16_t axis = 0; axis < (distance < 2 ? 1 : 3); ++axis) {
                PlainRbfSolver solver;
                solver.type = type;
                solver.distance = distance;
                solver.function = function;
                solver.normalize = normalize;
                solver.automatic_radius = automatic;
                solver.axis = axis;
                solver.radius = unit == 0 ? 70.0f : 1.2f;
                const uint32_t most = type == 1 ? 5 : 20;
                made.add(solver, static_cast<uint16_t>(2 + random.below(most)));
              }
            }
          }
        }
      }
    }
    // The angle between nearly equal rotations is rounding up to 1e-3, and inverses magnify.
    expect_rbf_model(made.rig, random, 4e-3, 4);
  }
}

// As many poses as fill one block of the kernels, one less, one more, many, and none at all.
TEST(RbfSolvers, EveryCountOfPoses) {
  Random random = Random::from_seed(31, 2);
  RbfRig made(random);
  for (uint16_t count : {1, 2, 7, 8, 9, 15, 16, 17, 31, 32, 33, 48, 100, 0}) {
    for (uint16_t distance : {0, 1, 2, 3}) {
      PlainRbfSolver solver;
      solver.distance = distance;
      solver.function = 1;
      solver.threshold = 0;
      made.add(solver, static_cast<uint16_t>(count));
    }
  }
  expect_rbf_model(made.rig, random, 1e-3, 10);
}

// Nothing to weigh, and nothing behind it in memory: for the address sanitizer.
TEST(RbfSolvers, WithoutPosesDriveNothing) {
  for (uint16_t type : {0, 1}) {
    Random random = Random::from_seed(31, 7);
    RbfRig made(random);
    PlainRbfSolver solver;
    solver.type = type;
    made.add(solver, 0);
    made.rig.rbf_count = 1;
    expect_rbf_model(made.rig, random, 0, 2);
  }
}

// Poses that share a control, drive several, none, in any order, or multiply with controls, those
// of earlier poses among them.
TEST(RbfSolvers, PosesDriveWhatTheyLike) {
  Random random = Random::from_seed(31, 3);
  for (int round = 0; round < 40; ++round) {
    RbfRig made(random);
    PlainRbfSolver solver;
    solver.distance = static_cast<uint16_t>(random.below(2));
    solver.normalize = static_cast<uint16_t>(random.below(2));
    for (int s = 0; s < 3; ++s) made.add(solver, 6);
    LayerRig& rig = made.rig;
    for (PlainRbfPose& pose : rig.poses) {
      if (random.chance(0.3)) continue;
      pose.outputs.clear();
      pose.weights.clear();
      for (uint32_t o = random.below(4); o > 0; --o) {
        pose.outputs.push_back(static_cast<uint16_t>(kRbfRaw + random.below(rig.rbf_count)));
        pose.weights.push_back(static_cast<float>(random.between(-1, 1)));
      }
      for (uint32_t i = random.below(3); i > 0; --i) {
        pose.inputs.push_back(static_cast<uint16_t>(random.below(rig.control_count())));
      }
    }
    if (round % 2) rig.solvers[1].poses[2] = rig.solvers[0].poses[1];  // of two solvers
    if (round % 3 == 0) rig.solvers[1].inputs[0] = kRbfRaw;  // reads what the first one drives
    SCOPED_TRACE(round);
    expect_rbf_model(rig, random, 1e-5, 5);
  }
}

TEST(RbfSolvers, OnlyThoseOfTheLod) {
  Random random = Random::from_seed(31, 4);
  RbfRig made(random);
  for (int s = 0; s < 4; ++s) made.add({}, 5);
  made.rig.base.lod_count = 3;
  made.rig.lod_solvers = {{3, 0, 1, 2}, {2}, {}};
  expect_rbf_model(made.rig, random, 1e-5, 5);
}

TEST(RbfSolvers, OneSolverAlone) {
  Random random = Random::from_seed(31, 5);
  RbfRig made(random);
  for (uint16_t distance : {0, 1, 2, 3, 2, 3}) {
    PlainRbfSolver solver;
    solver.distance = distance;
    made.add(solver, 5);
  }
  made.rig.lod_solvers = {{0}};
  const LayerFile file(made.rig);
  for (uint32_t isa : present_isas()) {
    const RigHandle handle = create_rig(file.dna.get(), isa);
    for (uint32_t s = 0; s < made.rig.solvers.size(); ++s) {
      Character character(handle);
      const std::vector<float> raw = random_raw(made.rig, {4, 8}, random);
      std::copy(raw.begin(), raw.end(), character.raw.begin());
      std::vector<double> expected(raw.begin(), raw.end());
      expected.resize(made.rig.control_count());
      model_rbf_solver(made.rig, made.rig.solvers[s], expected);
      ASSERT_EQ(mien_rig_evaluate_rbf_solver(handle.get(), character.instance.get(), 0, s),
                MIEN_OK);
      for (size_t i = 0; i < expected.size(); ++i) {
        ASSERT_NEAR(character.controls[i], expected[i], 1e-5) << mien_isa_name(isa);
      }
    }
  }
}

// docs/rig-evaluation.md, 12.9 "Finite inputs give finite outputs"
TEST(RbfSolvers, AlwaysNormalizeOfVanishingWeightsGivesZeros) {
  Random random = Random::from_seed(31, 6);
  for (uint16_t function = 0; function < 5; ++function) {
    RbfRig made(random);
    PlainRbfSolver solver;
    solver.function = function;
    solver.normalize = 1;
    solver.radius = 1e-3f;
    made.add(solver, 5);
    const LayerFile file(made.rig);
    for (uint32_t isa : present_isas()) {
      Character character(create_rig(file.dna.get(), isa));
      for (float distance : {10.0f, 1e4f, 1e30f, 3e38f}) {
        std::fill(character.raw.begin(), character.raw.end(), distance);
        character.evaluate(0);
        for (float value : character.rbf) EXPECT_EQ(value, 0) << mien_isa_name(isa);
      }
    }
  }
}

}  // namespace
}  // namespace mien
