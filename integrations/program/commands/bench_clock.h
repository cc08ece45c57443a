// SPDX-License-Identifier: MIT
// How `mien bench` takes times.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

namespace mien::cli {

// Reading the clock takes some hundred nanoseconds: a sample repeats its work until it takes at
// least this long.
constexpr double kSampleNs = 50000.0;

/// Processor time of this thread, so that other programs on the machine count as little as possible;
/// the time of day where the system does not tell.
inline double work_ns() {
#if defined(CLOCK_THREAD_CPUTIME_ID)
  timespec time{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) == 0) {
    return static_cast<double>(time.tv_sec) * 1e9 + static_cast<double>(time.tv_nsec);
  }
#endif
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double, std::nano>(now).count();
}

inline double median(std::vector<double>& samples) {
  if (samples.empty()) return 0.0;
  const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
  std::nth_element(samples.begin(), middle, samples.end());
  return *middle;
}

/// The time of one pass if that is long enough, else the mean over several.
template <class Pass>
double time_per_pass(const Pass& pass) {
  double start = work_ns();
  pass();
  const double one_ns = work_ns() - start;
  if (one_ns >= kSampleNs) return one_ns;
  const size_t repeats = static_cast<size_t>(kSampleNs / std::max(one_ns, 20.0)) + 1;
  start = work_ns();
  for (size_t i = 0; i < repeats; ++i) pass();
  return (work_ns() - start) / static_cast<double>(repeats);
}

}  // namespace mien::cli
