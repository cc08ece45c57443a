// SPDX-License-Identifier: MIT
#include "integrations/program/io/joint_names.h"

#include <algorithm>
#include <cctype>

namespace mien::cli {

bool is_body_part(const std::string& name, const std::vector<std::string>& words) {
  static const std::vector<std::string> kBeside = {"l",     "r",      "c",    "m",    "left",
                                                   "right", "facial", "face", "joint"};
  const auto is_in = [](const std::string& word, const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  size_t found = 0;
  std::string word;
  for (size_t i = 0; i <= name.size(); ++i) {
    const auto letter = static_cast<unsigned char>(i < name.size() ? name[i] : '_');
    if (std::isalpha(letter)) {
      word += static_cast<char>(std::tolower(letter));
      continue;
    }
    if (is_in(word, words)) {
      ++found;
    } else if (!word.empty() && !is_in(word, kBeside)) {
      return false;
    }
    word.clear();
  }
  return found == 1;
}

}  // namespace mien::cli
