// SPDX-License-Identifier: MIT
// OUT of the commands that write DNA files.
#pragma once

#include <mien.h>

#include <string>
#include <vector>

#include "integrations/program/io/terminal.h"

namespace mien::cli {

/// Writes to a file, a device, or with "-" to standard output. Returns the bytes.
std::vector<char> write_dna(const MienDna* dna, const MienWriteDesc& desc, const std::string& path,
                            const Session& session);

}  // namespace mien::cli
