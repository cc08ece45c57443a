// SPDX-License-Identifier: MIT
// RIG on the command line as a baked file.
#pragma once

#include <string>

#include "integrations/cli/io/handles.h"

namespace mien::cli {

/// Tells by the signature. Reads regular files, and peeks at standard input ("-").
bool is_baked_file(const std::string& path);

bool is_baked_bytes(const std::string& bytes);

/// The rig points into the bytes of standard input, so they stand before it and outlive it.
struct BakedFile {
  std::string shown;  // path, or "standard input"
  std::string bytes;
  Rig rig;
};

/// `path` may be "-".
BakedFile open_baked_file(const std::string& path, const MienBakedDesc& desc);

}  // namespace mien::cli
