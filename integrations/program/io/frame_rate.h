// SPDX-License-Identifier: MIT
// Frames per second as fractions, and what the times of rows say about them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mien::cli {

struct Rate {
  uint32_t numerator = 0, denominator = 1;  // 0: unknown

  bool known() const { return numerator != 0; }
  double hertz() const { return static_cast<double>(numerator) / denominator; }
};

/// "60", "29.97", "30000/1001". Rates of video that are written with few decimals are the fractions they
/// stand for. Unknown for other words and rates out of range.
Rate parse_rate(const std::string& word);

/// "60", "30000/1001"
std::string rate_text(const Rate& rate);

/// The rate of a common kind nearest to `hertz`, or the simplest fraction, not more than
/// `relative_error` away.
Rate nearest_rate(double hertz, double relative_error);

/// When rows were taken, in seconds, ascending.
struct Times {
  std::vector<double> seconds;
  double precision = 0;  // half a unit in the last place of the numbers as they were written
};

/// The first row that is more than a twentieth of a frame (or the precision of the times) away from a
/// constant rate, or the number of rows.
size_t first_row_off(const Times& times, const Rate& rate);

/// The constant rate that the rows lie on; if there is none, that of most of them. 60 for one row.
Rate find_rate(const Times& times);

/// The rate of a recording whose clock drifts.
Rate find_drifting_rate(const Times& times);

}  // namespace mien::cli
