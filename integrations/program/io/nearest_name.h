// SPDX-License-Identifier: MIT
// "Did you mean ...?": the candidate nearest to a name.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace mien::cli {

/// Finds the candidate nearest to a name by edit distance. Case does not matter, and the prefix of a
/// candidate may be left out: "jawOpen" matches "CTRL_expressions.jawOpen".
class NearestName {
 public:
  explicit NearestName(std::string_view name);

  void offer(std::string_view candidate);

  /// `did you mean "..."?`, or `otherwise` if none was near.
  std::string question(const std::string& otherwise) const;

  /// Pairs of letters that were compared so far.
  uint64_t steps() const { return steps_; }

 private:
  /// At most best_distance_: what is farther away does not matter.
  size_t distance_to(std::string_view text);

  std::string name_;
  std::string best_;
  size_t best_distance_;
  uint64_t steps_ = 0;
};

std::string nearest_question(std::string_view name, const std::vector<std::string>& candidates,
                             const std::string& otherwise);

/// "a, b or c"
std::string list_of(const std::vector<std::string>& names, const std::string& last_word);

}  // namespace mien::cli
