// SPDX-License-Identifier: MIT
// docs/numbers.md, 1 "Arithmetic": a host may have turned on flush-to-zero or another direction of
// rounding. Results stay finite, near, and the same for an instance and in a batch.
#include <gtest/gtest.h>

#if defined(__SSE2__)

#include <xmmintrin.h>

#include <cmath>

#include "tests/support/many_rigs.h"

namespace mien {
namespace {

/// The environment of the host, for as long as it lives.
struct Host {
  unsigned before = _mm_getcsr();
  explicit Host(unsigned bits) { _mm_setcsr(before | bits); }
  ~Host() { _mm_setcsr(before); }
};

constexpr unsigned kFlush = 0x8040;  // results and inputs that are subnormal count as 0
constexpr unsigned kHosts[] = {kFlush, 0x2000, 0x4000, 0x6000, kFlush | 0x6000};

std::vector<float> results_of(const RigHandle& rig, unsigned host, uint64_t seed, bool with_nan) {
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
      const std::vector<float> expected = results_of(rig, 0, 1, false);
      for (const unsigned host : kHosts) {
        const std::vector<float> found = results_of(rig, host, 1, false);
        ASSERT_EQ(found.size(), expected.size());
        double largest = 1;
        for (const float value : expected) largest = std::max(largest, std::fabs(double(value)));
        for (size_t i = 0; i < found.size(); ++i) {
          ASSERT_TRUE(std::isfinite(found[i])) << host << ", result " << i;
          ASSERT_NEAR(found[i], expected[i], 1e-4 * largest) << host << ", result " << i;
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
      const std::vector<float> expected = results_of(rig, 0, 2, true);
      const std::vector<float> found = results_of(rig, kFlush, 2, true);
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
      for (const unsigned host : kHosts) {
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
        ASSERT_TRUE(same_results(one, alone)) << mien_isa_name(isa) << ", host " << host;
      }
    }
  });
}

}  // namespace
}  // namespace mien

#else

TEST(HostEnvironment, ChangesResultsWithinATenThousandth) {
  GTEST_SKIP() << "NOT TESTED: flush-to-zero of the host; only SSE2 can be told";
}

#endif
