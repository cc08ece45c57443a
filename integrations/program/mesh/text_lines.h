// SPDX-License-Identifier: MIT
// Lines and words of OBJ, MTL and .target files.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

#include "integrations/program/io/text.h"
#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

/// Goes through a file line by line, words separated by blanks. A backslash at the end continues a line.
class TextLines {
 public:
  TextLines(const std::string& bytes, const std::string& path) : bytes_(bytes), path_(path) {}

  bool next() {
    if (at_ >= bytes_.size()) return false;
    ++number_;
    line_.clear();
    for (;;) {
      size_t end = bytes_.find('\n', at_);
      const bool last = end == std::string::npos;
      if (last) end = bytes_.size();
      std::string_view part(bytes_.data() + at_, end - at_);
      at_ = last ? bytes_.size() : end + 1;
      if (!part.empty() && part.back() == '\r') part.remove_suffix(1);
      const bool goes_on = !part.empty() && part.back() == '\\' && !last;
      if (goes_on) part.remove_suffix(1);
      if (line_.size() + part.size() > kLongest) fail("the line is longer than a megabyte");
      line_.append(part);
      if (!goes_on) break;
      line_ += ' ';
      ++number_;
    }
    const size_t comment = line_.find('#');
    if (comment != std::string::npos) line_.resize(comment);
    rest_ = line_;
    return true;
  }

  /// Empty at the end of the line.
  std::string_view word() {
    const size_t from = rest_.find_first_not_of(" \t");
    if (from == std::string_view::npos) return rest_ = {};
    const size_t to = rest_.find_first_of(" \t", from);
    const std::string_view found = rest_.substr(from, to - from);
    rest_ = to == std::string_view::npos ? std::string_view() : rest_.substr(to);
    return found;
  }

  /// The rest of the line without blanks around it.
  std::string name() const {
    const size_t from = rest_.find_first_not_of(" \t");
    if (from == std::string_view::npos) return "";
    return std::string(rest_.substr(from, rest_.find_last_not_of(" \t") + 1 - from));
  }

  double number(const char* what) {
    const std::string_view text = word();
    if (text.empty()) fail(std::string(what) + " lacks a number");
    double value = 0;
    const char* from = text.data() + (text[0] == '+' ? 1 : 0);
    const auto read = std::from_chars(from, text.data() + text.size(), value);
    if (read.ec == std::errc::result_out_of_range && read.ptr == text.data() + text.size()) {
      value = std::strtod(std::string(text).c_str(), nullptr);  // underflow is 0, overflow infinite
    } else if (read.ec != std::errc() || read.ptr != text.data() + text.size()) {
      fail("\"" + one_line(text.substr(0, 40)) + "\" is not a number");
    }
    if (!std::isfinite(value)) fail("\"" + one_line(text.substr(0, 40)) + "\" is not finite");
    return value;
  }

  [[noreturn]] void fail(const std::string& why) const {
    fail_mesh(path_, "line " + std::to_string(number_), why, "export the mesh again");
  }

 private:
  static constexpr size_t kLongest = size_t{1} << 20;

  const std::string& bytes_;
  const std::string& path_;
  size_t at_ = 0, number_ = 0;
  std::string line_;
  std::string_view rest_;
};

}  // namespace mien::cli
