// SPDX-License-Identifier: MIT
// Text from files, made fit to be shown.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mien::cli {

/// Bytes of the UTF-8 sequence that `text` (not empty) begins with; 0 if it begins with none.
size_t utf8_length(std::string_view text);

/// Control characters, and bytes that are not UTF-8, made visible: a line stays one line.
std::string one_line(std::string_view text);

}  // namespace mien::cli
