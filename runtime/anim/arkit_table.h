// SPDX-License-Identifier: MIT
// The expressions of ARKit as raw controls of heads that name them in the other usual way. Those of
// the same names need no table: bindings find them (binding.h).
#pragma once

#include "runtime/base/span.h"

namespace mien {

/// A raw control, and its share in an expression.
struct ArkitEntry {
  const char* expression;
  const char* control;
  float weight;
};

/// By expression.
Span<const ArkitEntry> arkit_table();

}  // namespace mien
