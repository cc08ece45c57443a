// SPDX-License-Identifier: MIT
// Text from files, and numbers, made readable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "author/text/utf8.h"

namespace mien::cli {

/// Escapes control characters and bytes that are not UTF-8, so that the text stays on one line.
std::string one_line(std::string_view text);

/// A field of a CSV file, in quotes where it needs them (RFC 4180).
std::string csv_field(const std::string& text);

bool ends_with(std::string_view text, std::string_view end);
bool is_one_of(const std::string& text, const std::vector<std::string>& texts);

/// "a,b" -> "a", "b"; an empty list is one empty word.
std::vector<std::string> split_at_commas(const std::string& list);

/// "1,234,567"
std::string grouped(uint64_t number);

/// "812 bytes", "31.4 KB", "9.0 MB": decimal units.
std::string size_text(uint64_t bytes);

/// "0.4 s", "12 s", "3 min 20 s"
std::string duration_text(double seconds);

}  // namespace mien::cli
