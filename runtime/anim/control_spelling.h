// SPDX-License-Identifier: MIT
// Names of facial controls in the spellings and vocabularies that tools use.
//
// A name is read as letters and a side: "mouthSmileLeft", "mouthSmile_L", "mouth_smile_l", "Left mouth smile" and
// "CTRL_expressions.mouthSmileL" are "mouthsmile", left. The table of aliases then says which of these mean the
// same: "AU12_L", "mouthCornerPullL" and "MouthCornerPullLeft" are "mouthSmileLeft".
#pragma once

#include <cstdint>

#include "runtime/base/span.h"

namespace mien {

enum class Side : uint8_t { kNone, kLeft, kRight };

/// A name reduced to its letters and digits, in lower case. Empty if the name has none, or is longer than
/// any name of the vocabularies; an empty spelling matches nothing.
struct ControlSpelling {
  static constexpr size_t kMost = 62;
  char text[kMost];
  uint8_t count = 0;
  Side side = Side::kNone;

  bool empty() const { return count == 0; }
  Span<const char> letters() const { return {text, count}; }
};

ControlSpelling spell_control(Span<const char> name);

bool operator==(const ControlSpelling& a, const ControlSpelling& b);

/// A name that the table knows.
struct KnownControl {
  static constexpr uint32_t kUnknown = ~uint32_t{0};
  uint32_t row = kUnknown;  // of the table
  Side side = Side::kNone;  // of the name of the row; none if it names its side itself
  uint32_t rank = 0;        // 0: the row's own name, then its aliases in order

  bool known() const { return row != kUnknown; }
};

/// Finds a spelling in the table of aliases. If several rows match, the first counts.
KnownControl know_control(const ControlSpelling& spelling);

/// "mouthSmileLeft": the name of ARKit; where ARKit has none, of MetaHuman's raw controls. Returns its length, at most
/// kMostKnownName; 0 if `known` is not.
constexpr size_t kMostKnownName = 48;
size_t write_known_name(const KnownControl& known, char* out);

/// Whether left and right are directions of the motion, as in jawLeft, and not sides of the face.
bool is_direction(const ControlSpelling& spelling);

}  // namespace mien
