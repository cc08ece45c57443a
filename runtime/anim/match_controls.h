// SPDX-License-Identifier: MIT
// Finds the raw controls of a rig that a name of another tool stands for.
//
//     name -> as written -> same letters -> both sides -> expression of several controls -> alias -> both sides
//
// The first of these steps that finds controls counts.
#pragma once

#include "runtime/anim/control_spelling.h"
#include "runtime/base/arena.h"
#include "runtime/rig/rig.h"

namespace mien {

/// How a name was matched. Numbers of MIEN_NAME_MATCH_... in mien/names.h.
enum class Match : uint32_t { kNone, kAsWritten, kSpelling, kAlias, kBothSides, kExpression };

struct ControlShare {
  uint32_t control = 0;  // raw
  float weight = 0;
};

constexpr uint32_t kMostShares = 16;  // of a name

struct ControlMatch {
  Match how = Match::kNone;
  uint32_t count = 0;
  ControlShare shares[kMostShares];
};

/// A raw control by its spelling, or by the row of aliases that it is in.
struct ControlKey {
  uint64_t hash;
  uint32_t control, rank;  // of its alias
};

/// Finds raw controls. Without lists each search looks at all controls.
class ControlFinder {
 public:
  explicit ControlFinder(const NameList& names) : names_(names) {}

  /// Makes the lists, for many searches: `count` entries each.
  void sort(Span<ControlKey> by_spelling, Span<ControlKey> by_alias);

  ControlMatch match(Span<const char> name) const;

 private:
  uint32_t find_folded(Span<const char> name) const;
  uint32_t find_spelled(const ControlSpelling& spelling) const;
  uint32_t find_known(const KnownControl& known) const;
  /// All of these return false, with `out` incomplete, if the rig lacks one of the controls.
  bool add_shares(const ControlSpelling& spelling, const KnownControl& known,
                  ControlMatch& out) const;
  bool add_control(const char* name, float weight, ControlMatch& out) const;
  bool add_arkit(const KnownControl& known, float weight, ControlMatch& out) const;

  const NameList& names_;
  Span<ControlKey> by_spelling_, by_alias_;
};

}  // namespace mien
