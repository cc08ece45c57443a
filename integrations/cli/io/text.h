// SPDX-License-Identifier: MIT
// Text from files, made printable.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mien::cli {

/// Length in bytes of the UTF-8 sequence at the start of `text` (not empty); 0 if it is invalid.
size_t utf8_length(std::string_view text);

/// Escapes control characters and bytes that are not UTF-8, so that the text stays on one line.
std::string one_line(std::string_view text);

}  // namespace mien::cli
