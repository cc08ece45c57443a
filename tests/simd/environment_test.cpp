// SPDX-License-Identifier: MIT
// docs/numbers.md, 1 "Arithmetic": a host may have turned on flush-to-zero or another direction of
// rounding. Results stay finite, near, and the same for an instance and in a batch.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/host_environment.h"
#include "tests/support/many_rigs.h"

namespace mien {
namespace {

TEST(HostEnvironment, FlushesAndRoundsAsItIsTold) {
  volatile float small = 1e-38f, one = 1, three = 3;
  EXPECT_GT(small * 0.1f, 0);
  EXPECT_GT(one / three * 3.0, 1);
  {
    const Host turned({false, FE_DOWNWARD});
    EXPECT_LT(one / three * 3.0, 1);
  }
  EXPECT_GT(one / three * 3.0, 1);
  if (kFlushBits == 0) GTEST_SKIP() << "NOT TESTED: flush-to-zero; this processor has none";
  const Host turned(kFlushing);
  EXPECT_EQ(small * 0.1f, 0);
}

std::vector<float> results_of(const RigHandle& rig, const Environment& host, uint64_t seed,
                              bool with_nan) {
  Character character(rig);
  Random random = Random::from_seed(9, seed);
  draw_controls(random, 60, character.raw);
  for (size_t i = 0; i < character.raw.count; i += 3) character.raw[i] *= 1e-38f;
  if (with_nan) character.raw[0] = std::nanf("");
  const Host turned(host);
  character.evaluate(0);
  return character.results();
}

TEST(HostEnvironment, ChangesResultsWithinATenThousandth) {
  for_each_dna(20, [](const DnaHandle& dna) {
    for (const uint32_t isa : present_isas()) {
      SCOPED_TRACE(mien_isa_name(isa));
      const RigHandle rig = create_rig(dna.get(), isa);
      const std::vector<float> expected = results_of(rig, kUsual, 1, false);
      for (const Environment& host : kHosts) {
        const std::vector<float> found = results_of(rig, host, 1, false);
        ASSERT_EQ(found.size(), expected.size());
        double largest = 1;
        for (const float value : expected) largest = std::max(largest, std::fabs(double(value)));
        for (size_t i = 0; i < found.size(); ++i) {
          ASSERT_TRUE(std::isfinite(found[i])) << told(host) << ", result " << i;
          ASSERT_NEAR(found[i], expected[i], 1e-4 * largest) << told(host) << ", result " << i;
        }
      }
    }
  });
}

TEST(HostEnvironment, LeavesTheRulesForNaN) {
  for_each_dna(5, [](const DnaHandle& dna) {
    for (const uint32_t isa : present_isas()) {
      SCOPED_TRACE(mien_isa_name(isa));
      const RigHandle rig = create_rig(dna.get(), isa);
      const std::vector<float> expected = results_of(rig, kUsual, 2, true);
      const std::vector<float> found = results_of(rig, kFlushing, 2, true);
      ASSERT_EQ(found.size(), expected.size());
      for (size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(std::isnan(found[i]), std::isnan(expected[i])) << "result " << i;
      }
    }
  });
}

TEST(HostEnvironment, IsTheSameForABatch) {
  for_each_dna(10, [](const DnaHandle& dna) {
    for (const uint32_t isa : present_isas()) {
      const RigHandle rig = create_rig(dna.get(), isa);
      for (const Environment& host : kHosts) {
        Character one(rig), other(rig), alone(rig);
        Random random = Random::from_seed(3, 5);
        draw_controls(random, 60, one.raw);
        for (size_t i = 0; i < one.raw.count; ++i) {
          if (i % 4 == 0) one.raw[i] *= 1e-38f;
          alone.raw[i] = one.raw[i];
          other.raw[i] = one.raw[i] * 0.5f;
        }
        const Host turned(host);
        MienInstance* const both[] = {one.instance.get(), other.instance.get()};
        MienBatch* made = nullptr;
        ASSERT_EQ(mien_batch_create(rig.get(), nullptr, &made, nullptr), MIEN_OK);
        const BatchHandle batch(made);
        const uint32_t lods[] = {0, 0};
        ASSERT_EQ(mien_rig_evaluate_batch(rig.get(), made, both, lods, 2, MIEN_STAGE_ALL, nullptr),
                  MIEN_OK);
        alone.evaluate(0);
        ASSERT_TRUE(same_results(one, alone)) << mien_isa_name(isa) << ", " << told(host);
      }
    }
  });
}

}  // namespace
}  // namespace mien
