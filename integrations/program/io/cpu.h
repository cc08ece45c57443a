// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mien::cli {

/// The name of the processor, or "unknown" where the system does not tell.
std::string cpu_name();

}  // namespace mien::cli
