// SPDX-License-Identifier: MIT
// Ways to break a tiny rig, as a table: what to change, and what has to be found then.
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/support/kept_findings.h"
#include "tests/support/tiny_rig.h"

namespace mien::dna {

using U16 = std::initializer_list<uint16_t>;
using U32 = std::initializer_list<uint32_t>;
using F32 = std::initializer_list<float>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr Status kReference = Status::kDnaReference, kStructure = Status::kDnaStructure,
                 kLimit = Status::kDnaLimit, kValue = Status::kDnaValue, kWarning = Status::kOk;

/// A list of 65536 elements, one more than can be numbered.
template <class T>
List<T> too_many(Arena& arena) {
  return {arena.array<T>(65536).data, 65536};
}

struct Damage {
  const char* name;
  Status status;      // kOk: a warning
  const char* field;  // where it has to be found
  void (*apply)(DnaView& view, Arena& arena);
};
inline void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }
inline std::string damage_name(const testing::TestParamInfo<Damage>& info) {
  return info.param.name;
}

/// An error ends the opening of a file; a warning is heard only by those who ask for all.
inline void expect_found(const Damage& damage) {
  Arena arena(default_allocator());
  DnaView view = tiny_rig(arena);
  damage.apply(view, arena);

  KeptFindings all;
  EXPECT_TRUE(check(view, all, true));
  EXPECT_TRUE(all.has(damage.status, damage.field)) << all.text();

  // Those who have enough of one hear no more.
  KeptFindings one;
  one.enough = 1;
  EXPECT_FALSE(check(view, one, true) && one.errors() == 0);
  EXPECT_EQ(one.findings.size(), 1u);

  KeptFindings first;
  first.enough = 1;
  if (damage.status == Status::kOk) {
    EXPECT_EQ(all.errors(), 0u) << all.text();
    EXPECT_TRUE(check(view, first, false));
    EXPECT_EQ(first.findings.size(), 0u) << first.text();
  } else {
    check(view, first, false);
    EXPECT_TRUE(first.has(damage.status, damage.field)) << first.text();
  }
}

inline void expect_no_findings(const DnaView& view) {
  KeptFindings report;
  EXPECT_TRUE(check(view, report, true));
  EXPECT_EQ(report.findings.size(), 0u) << report.text();
}

}  // namespace mien::dna
