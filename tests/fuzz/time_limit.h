// SPDX-License-Identifier: MIT
// Time as a finding: SECURITY.md promises about 100 ms for each MiB, and for smaller files as much.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>

namespace mien {

// A fuzzer counts edges, which makes a program a few times slower; sanitizers do so much more. Other CPUs
// are mostly emulated.
#if !defined(__x86_64__) && !defined(_M_X64)
constexpr double kSlowdown = 200;
#elif defined(__SANITIZE_ADDRESS__)
constexpr double kSlowdown = 40;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer)
constexpr double kSlowdown = 40;
#else
constexpr double kSlowdown = 4;
#endif
#else
constexpr double kSlowdown = 4;
#endif

inline void check_time(double seconds, size_t file_size, std::string& broken) {
  const double megabytes = std::max(1.0, static_cast<double>(file_size) / (1 << 20));
  if (!broken.empty() || seconds <= 0.1 * kSlowdown * megabytes) return;
  char text[80];
  snprintf(text, sizeof(text), "%.2f s for %zu bytes", seconds, file_size);
  broken = text;
}

}  // namespace mien
