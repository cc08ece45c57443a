// SPDX-License-Identifier: MIT
// Curves of a take -> the keys that an animator edits.
#include <algorithm>
#include <cmath>

#include "capi/arguments/arguments.h"
#include "capi/include/mien_solve.h"

namespace {

/// The farthest frame to which a straight line from `from` stays within the tolerance of all values between:
/// each of them leaves an interval of slopes.
size_t find_next_key(const float* values, size_t count, size_t from, double tolerance) {
  double low = -INFINITY, high = INFINITY;
  size_t next = from + 1;
  for (size_t i = from + 1; i < count; ++i) {
    const double run = static_cast<double>(i - from), rise = double{values[i]} - values[from];
    const double slope = rise / run;
    if (slope >= low && slope <= high) next = i;
    low = std::max(low, (rise - tolerance) / run);
    high = std::min(high, (rise + tolerance) / run);
    if (low > high) break;
  }
  return next;
}

}  // namespace

MienStatus mien_fit_keys(const float* values, size_t count, float tolerance, uint32_t* out_keys,
                         size_t* out_key_count) {
  if (!out_key_count) return MIEN_ERROR_NULL_ARGUMENT;
  *out_key_count = 0;
  if (count == 0) return MIEN_OK;
  if (!values || !out_keys) return MIEN_ERROR_NULL_ARGUMENT;
  if (!(tolerance >= 0) || !std::isfinite(tolerance)) return MIEN_ERROR_INVALID_ARGUMENT;
  for (size_t i = 0; i < count; ++i) {
    if (!std::isfinite(values[i])) return MIEN_ERROR_INVALID_ARGUMENT;
  }
  size_t keys = 0;
  for (size_t at = 0;; at = find_next_key(values, count, at, double{tolerance})) {
    out_keys[keys++] = static_cast<uint32_t>(at);
    if (at + 1 == count) break;
  }
  *out_key_count = keys;
  return MIEN_OK;
}
