// SPDX-License-Identifier: MIT
#include "integrations/program/io/frame_rate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

namespace mien::cli {

namespace {

constexpr double kMaxHertz = 1e6;
constexpr uint32_t kMaxDenominator = 1000000;
constexpr double kAllowedPartOfFrame = 0.05;

// Of cameras, screens and motion capture.
constexpr uint32_t kCommon[] = {24, 25, 30, 48, 50, 60, 72, 90, 100, 120, 144, 200, 240};
// Of NTSC video: n * 1000 / 1001.
constexpr uint32_t kVideo[] = {24, 30, 48, 60, 120, 240};

bool parse_whole(const char* begin, const char* end, uint32_t& number) {
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stop == end;
}

bool in_range(double hertz) { return hertz >= 1.0 / 6 && hertz <= kMaxHertz; }

double relative_distance(double a, double b) { return std::abs(a - b) / b; }

/// The fraction with the smallest denominator within an error of a number (Stern-Brocot).
Rate simplest_fraction(double hertz, double error) {
  uint64_t low_n = 0, low_d = 1, high_n = 1, high_d = 0;
  const double whole = std::floor(hertz);
  low_n = static_cast<uint64_t>(whole);
  high_n = low_n + 1;
  high_d = 1;
  if (hertz - whole <= error && low_n > 0) return {static_cast<uint32_t>(low_n), 1};
  if (whole + 1 - hertz <= error) return {static_cast<uint32_t>(high_n), 1};
  for (;;) {
    const uint64_t n = low_n + high_n, d = low_d + high_d;
    if (d > kMaxDenominator || n > std::numeric_limits<uint32_t>::max()) {
      return {static_cast<uint32_t>(low_n ? low_n : high_n),
              static_cast<uint32_t>(low_n ? low_d : high_d)};
    }
    const double middle = static_cast<double>(n) / static_cast<double>(d);
    if (std::abs(middle - hertz) <= error) {
      return {static_cast<uint32_t>(n), static_cast<uint32_t>(d)};
    }
    (middle < hertz ? low_n : high_n) = n;
    (middle < hertz ? low_d : high_d) = d;
  }
}

double median_interval(const std::vector<double>& seconds) {
  std::vector<double> intervals;
  for (size_t i = 1; i < seconds.size(); ++i) intervals.push_back(seconds[i] - seconds[i - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

/// Of a span between two times, with the rounding of doubles.
double error_of_span(const Times& times) {
  const double largest = std::max(std::abs(times.seconds.front()), std::abs(times.seconds.back()));
  return 2 * times.precision + 4 * largest * std::numeric_limits<double>::epsilon();
}

}  // namespace

Rate parse_rate(const std::string& word) {
  Rate rate;
  const char *begin = word.data(), *end = begin + word.size();
  const size_t slash = word.find('/');
  if (slash != std::string::npos) {
    if (!parse_whole(begin, begin + slash, rate.numerator) ||
        !parse_whole(begin + slash + 1, end, rate.denominator) || rate.denominator == 0) {
      return {};
    }
  } else if (!parse_whole(begin, end, rate.numerator)) {
    double hertz = 0;
    const auto [stop, error] = std::from_chars(begin, end, hertz, std::chars_format::fixed);
    const size_t point = word.find('.');
    if (error != std::errc() || stop != end || !in_range(hertz)) return {};
    const size_t decimals = word.size() - point - 1;
    // 29.97, 23.976, 23.98
    const double half_unit = 0.5 * std::pow(10.0, -static_cast<double>(decimals));
    for (uint32_t n : kVideo) {
      if (decimals >= 2 && std::abs(n * 1000 / 1001.0 - hertz) <= half_unit)
        return {n * 1000, 1001};
    }
    rate = simplest_fraction(hertz, half_unit * 1e-3);
  }
  if (!rate.known() || !in_range(rate.hertz())) return {};
  const uint32_t common = std::gcd(rate.numerator, rate.denominator);
  return {rate.numerator / common, rate.denominator / common};
}

std::string rate_text(const Rate& rate) {
  const std::string text = std::to_string(rate.numerator);
  return rate.denominator == 1 ? text : text + "/" + std::to_string(rate.denominator);
}

Rate nearest_rate(double hertz, double relative_error) {
  Rate best;
  double distance = relative_error;
  const auto offer = [&](const Rate& rate) {
    const double d = relative_distance(hertz, rate.hertz());
    if (d > distance || (best.known() && d == distance)) return;
    best = rate;
    distance = d;
  };
  for (uint32_t n : kCommon) offer({n, 1});
  // Whole rates are more common.
  if (best.known()) return best;
  for (uint32_t n : kVideo) offer({n * 1000, 1001});
  if (best.known()) return best;
  return simplest_fraction(hertz, hertz * relative_error);
}

size_t first_row_off(const Times& times, const Rate& rate) {
  const double frame = 1 / rate.hertz();
  const double allowed =
      std::max(kAllowedPartOfFrame * frame, std::min(2 * times.precision, 0.45 * frame));
  for (size_t i = 1; i < times.seconds.size(); ++i) {
    const double expected = times.seconds[0] + static_cast<double>(i) * frame;
    if (std::abs(times.seconds[i] - expected) > allowed + 1e-9) return i;
  }
  return times.seconds.size();
}

Rate find_rate(const Times& times) {
  const size_t rows = times.seconds.size();
  if (rows < 2) return {60, 1};
  const double span = times.seconds.back() - times.seconds.front();
  const double mean = static_cast<double>(rows - 1) / span;
  if (in_range(mean)) {
    const Rate rate = nearest_rate(mean, std::min(error_of_span(times) / span, 0.01));
    if (first_row_off(times, rate) == rows) return rate;
  }
  const double interval = median_interval(times.seconds);
  const double hertz = 1 / interval;
  if (!in_range(hertz)) return {};
  return nearest_rate(hertz, std::max(error_of_span(times) / interval, 0.005));
}

Rate find_drifting_rate(const Times& times) {
  const size_t rows = times.seconds.size();
  if (rows < 2) return {60, 1};
  const double mean =
      static_cast<double>(rows - 1) / (times.seconds.back() - times.seconds.front());
  if (!in_range(mean)) return {};
  Rate best;
  double distance = 0.05;
  for (uint32_t n : kCommon) {
    if (relative_distance(mean, n) > distance) continue;
    distance = relative_distance(mean, n);
    best = {n, 1};
  }
  return best.known() ? best : nearest_rate(mean, 0.01);
}

}  // namespace mien::cli
