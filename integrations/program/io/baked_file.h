// SPDX-License-Identifier: MIT
// RIG on the command line as a baked file.
#pragma once

#include <string>

#include "integrations/program/io/handles.h"

namespace mien::cli {

/// Tells by the signature. Reads regular files, and peeks at standard input ("-").
bool is_baked_file(const std::string& path);

bool is_baked_bytes(const std::string& bytes);

struct BakedFile {
  std::string shown;  // path, or "standard input"
  Baked baked;
  Rig rig;
  Deformer deformer;  // null if the file has none
};

/// `path` may be "-".
BakedFile open_baked_file(const std::string& path, const MienBakedRigDesc& desc);

}  // namespace mien::cli
