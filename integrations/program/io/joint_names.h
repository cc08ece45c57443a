// SPDX-License-Identifier: MIT
// Meanings of joint names.
#pragma once

#include <string>
#include <vector>

namespace mien::cli {

/// Whether the name of a joint is one of `words`, with or without a side, a prefix and a number:
/// "C_Head", "neck_01", "FACIAL_L_Eye".
bool is_body_part(const std::string& name, const std::vector<std::string>& words);

}  // namespace mien::cli
