// SPDX-License-Identifier: MIT
#include "integrations/program/io/text.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace mien::cli {

std::string one_line(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const size_t length = utf8_length(text);
    const auto byte = static_cast<unsigned char>(text[0]);
    if (length != 0 && byte >= 0x20 && byte != 0x7f) {
      line.append(text.substr(0, length));
    } else if (byte == '\n' || byte == '\t') {
      line += byte == '\n' ? "\\n" : "\\t";
    } else {
      char escape[8];
      std::snprintf(escape, sizeof(escape), "\\x%02x", unsigned{byte});
      line += escape;
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return line;
}

std::string csv_field(const std::string& text) {
  // Readers trim blanks at the ends.
  const bool plain = text.find_first_of(",\"\r\n") == std::string::npos &&
                     text.find_first_of(" \t") != 0 && text.find_last_of(" \t") != text.size() - 1;
  if (plain) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

bool is_one_of(const std::string& text, const std::vector<std::string>& texts) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

std::vector<std::string> split_at_commas(const std::string& list) {
  std::vector<std::string> words;
  for (size_t begin = 0;;) {
    const size_t comma = list.find(',', begin);
    words.push_back(list.substr(begin, comma - begin));
    if (comma == std::string::npos) return words;
    begin = comma + 1;
  }
}

std::string grouped(uint64_t number) {
  std::string text = std::to_string(number);
  for (size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return text;
}

std::string size_text(uint64_t bytes) {
  if (bytes < 1000) return std::to_string(bytes) + (bytes == 1 ? " byte" : " bytes");
  constexpr const char* kUnits[] = {"KB", "MB", "GB", "TB", "PB", "EB"};
  double size = static_cast<double>(bytes) / 1000;
  size_t unit = 0;
  for (; size >= 999.95 && unit + 1 < std::size(kUnits); ++unit) size /= 1000;
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f %s", size, kUnits[unit]);
  return text;
}

std::string duration_text(double seconds) {
  char text[48];
  if (seconds < 9.95) {
    std::snprintf(text, sizeof(text), "%.1f s", seconds);
    return text;
  }
  const auto whole = static_cast<uint64_t>(seconds + 0.5);
  if (whole < 60) return std::to_string(whole) + " s";
  if (whole < 3600) return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
  return std::to_string(whole / 3600) + " h " + std::to_string(whole / 60 % 60) + " min";
}

}  // namespace mien::cli
