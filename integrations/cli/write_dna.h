// SPDX-License-Identifier: MIT
// OUT of the commands that write DNA files.
#pragma once

#include <string>

#include "integrations/cli/cli.h"

namespace mien::cli {

/// Wrong usage if `path` is "-" and a person would get the bytes.
void refuse_terminal(const std::string& path, const Session& session,
                     const char* what = "a DNA file");

/// Writes to a file, a device, or with "-" to standard output.
void write_dna(const MienDna* dna, const MienWriteDesc& desc, const std::string& path);

}  // namespace mien::cli
