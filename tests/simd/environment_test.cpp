// SPDX-License-Identifier: MIT
// docs/numbers.md, 1 "Arithmetic": a host may have turned on flush-to-zero or another direction of
// rounding. Results stay finite, near, and the same for an instance and in a batch.
#include <gtest/gtest.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <cfenv>
#include <cmath>

#include "tests/support/many_rigs.h"

namespace mien {
namespace {

// The word that governs floats, and its bits for subnormal results, and inputs, that count as 0.
#if defined(__SSE2__)
constexpr unsigned kFlushBits = 0x8040;
unsigned control_word() { return _mm_getcsr(); }
void set_control_word(unsigned word) { _mm_setcsr(word); }
#elif defined(__aarch64__)
constexpr unsigned kFlushBits = 1u << 24;
unsigned control_word() {
  uint64_t word;
  asm volatile("mrs %0, fpcr" : "=r"(word));
  return static_cast<unsigned>(word);
}
void set_control_word(unsigned word) { asm volatile("msr fpcr, %0" ::"r"(uint64_t{word})); }
#elif defined(__arm__)
constexpr unsigned kFlushBits = 1u << 24;
unsigned control_word() {
  unsigned word;
  asm volatile("vmrs %0, fpscr" : "=r"(word));
  return word;
}
void set_control_word(unsigned word) { asm volatile("vmsr fpscr, %0" ::"r"(word)); }
#else
constexpr unsigned kFlushBits = 0;  // RISC-V and s390x keep what is subnormal
unsigned control_word() { return 0; }
void set_control_word(unsigned) {}
#endif

struct Environment {
  bool flushes;
  int direction;
};
constexpr Environment kUsual = {false, FE_TONEAREST}, kFlushing = {true, FE_TONEAREST};
constexpr Environment kHosts[] = {kFlushing,
                                  {false, FE_DOWNWARD},
                                  {false, FE_UPWARD},
                                  {false, FE_TOWARDZERO},
                                  {true, FE_TOWARDZERO}};

/// The environment of the host, for as long as it lives.
struct Host {
  int direction = std::fegetround();
  unsigned word = control_word();
  explicit Host(const Environment& wanted) {
    EXPECT_EQ(std::fesetround(wanted.direction), 0);
    if (wanted.flushes) set_control_word(control_word() | kFlushBits);
  }
  ~Host() {
    std::fesetround(direction);
    set_control_word(word);
  }
};

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

std::string told(const Environment& host) {
  return "direction " + std::to_string(host.direction) + (host.flushes ? ", flushing" : "");
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
