// SPDX-License-Identifier: MIT
// The expressions of ARKit as raw controls of heads that use other names for them. Controls that have the
// names of ARKit need no table: bindings find them (binding.h).
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
