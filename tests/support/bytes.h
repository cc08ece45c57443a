// SPDX-License-Identifier: MIT
// The bytes of a file, as tests hold them.
#pragma once

#include <cstdint>
#include <vector>

namespace mien {

using Bytes = std::vector<uint8_t>;

}  // namespace mien
