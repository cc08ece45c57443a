// SPDX-License-Identifier: MIT
#include "integrations/program/io/nearest_name.h"

#include <algorithm>
#include <cctype>

namespace mien::cli {

namespace {

constexpr size_t kLongestName = 1000;  // that anyone mistypes

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

/// Insertions, deletions, replacements and exchanges of neighbors that turn `a` into `b`, or `limit` if
/// there are as many or more. Only places that differ by less than `limit` are looked at, so the time
/// is that of the length of `a`, times `limit`. Adds to `steps` for each pair of letters.
size_t edit_distance(std::string_view a, std::string_view b, size_t limit, uint64_t& steps) {
  std::vector<size_t> before_last(b.size() + 1, limit), last = before_last, row = before_last;
  for (size_t j = 0; j < std::min(limit, b.size() + 1); ++j) last[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    const size_t first = i < limit ? 1 : i - limit + 1, end = std::min(i + limit, b.size() + 1);
    row[first - 1] = i < limit ? i : limit;
    for (size_t j = first; j < end; ++j, ++steps) {
      const size_t replaced = last[j - 1] + (a[i - 1] != b[j - 1]);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
      const bool exchanged = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (exchanged) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    if (end <= b.size()) row[end] = limit;  // what the next row reads beyond
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return std::min(last[b.size()], limit);
}

}  // namespace

NearestName::NearestName(std::string_view name)
    : name_(lower_case(name)), best_distance_(std::min<size_t>(name.size() / 4, 5) + 2) {}

size_t NearestName::distance_to(std::string_view text) {
  const size_t longer = std::max(name_.size(), text.size());
  const size_t shorter = std::min(name_.size(), text.size());
  // The difference of lengths has to be inserted.
  if (longer - shorter >= best_distance_ || longer > kLongestName) return best_distance_;
  return edit_distance(name_, text, best_distance_, steps_);
}

void NearestName::offer(std::string_view candidate) {
  const size_t dot = candidate.find('.');
  const std::string lower = lower_case(candidate.substr(0, 2 * kLongestName));
  size_t distance = distance_to(lower);
  if (dot < lower.size() && name_.find('.') == std::string::npos) {
    distance = std::min(distance, distance_to(std::string_view(lower).substr(dot + 1)));
  }
  if (distance >= best_distance_) return;
  best_distance_ = distance;
  best_ = candidate;
}

std::string NearestName::question(const std::string& otherwise) const {
  return best_.empty() ? otherwise : "did you mean \"" + best_ + "\"?";
}

std::string nearest_question(std::string_view name, const std::vector<std::string>& candidates,
                             const std::string& otherwise) {
  NearestName nearest(name);
  for (const std::string& candidate : candidates) nearest.offer(candidate);
  return nearest.question(otherwise);
}

std::string list_of(const std::vector<std::string>& names, const std::string& last_word) {
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i != 0) list += i + 1 == names.size() ? " " + last_word + " " : ", ";
    list += names[i];
  }
  return list;
}

}  // namespace mien::cli
