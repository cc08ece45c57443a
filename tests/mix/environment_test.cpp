// SPDX-License-Identifier: MIT
// docs/numbers.md, 1 "Arithmetic", for mixing: whatever the host has done to the environment of floats,
// rows stay finite, within the limits of the mix, and near those of the usual one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/host_environment.h"
#include "tests/support/mix_scene.h"

namespace mien {
namespace {

TEST(HostEnvironment, LeavesMixingNearAndWithinItsLimits) {
  for (uint32_t isa = 1; isa < kIsaCount; ++isa) {
    const KernelTable* const kernels = kernels_for(static_cast<Isa>(isa));
    if (!kernels) continue;
    SCOPED_TRACE(kernels->name);
    const MixScene scene(24, kernels);
    const uint32_t curves = scene.mix->used_curves();
    for (const Environment& host : kHosts) {
      SceneActor usual(scene, 5), other(scene, 5);
      usual.begin();
      other.begin();
      Random random = Random::from_seed(5, 0), same = random;
      double largest = 0, moved = 0;
      for (int step = 0; step < 600; ++step) {
        usual.disturb(random);
        other.disturb(same);
        const float* const expected = usual.step(kSceneStep);
        const float* const found = [&] {
          const Host turned(host);
          return other.step(kSceneStep);
        }();
        for (uint32_t l = 0; l < curves; ++l) {
          ASSERT_TRUE(std::isfinite(found[l])) << told(host) << ", curve " << l;
          ASSERT_GE(found[l], scene.mix->lower[l]) << told(host) << ", curve " << l;
          ASSERT_LE(found[l], scene.mix->upper[l]) << told(host) << ", curve " << l;
          largest = std::max(largest, std::fabs(double{found[l]} - double{expected[l]}));
          moved = std::max(moved, std::fabs(double{expected[l]}));
        }
      }
      EXPECT_GT(moved, 0.5);
      EXPECT_LT(largest, 1e-4) << told(host);
    }
  }
}

}  // namespace
}  // namespace mien
