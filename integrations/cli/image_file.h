// SPDX-License-Identifier: MIT
// RIG on the command line where it is a baked rig instead of a DNA file.
#pragma once

#include <string>

#include "integrations/cli/options.h"

namespace mien::cli {

/// By its signature. Looks at regular files, and at the first byte of standard input ("-").
bool is_image(const std::string& path);

bool is_image_bytes(const std::string& bytes);

/// The bytes of standard input stand first: the rig points into them.
struct ImageFile {
  std::string shown;  // path, or "standard input"
  std::string bytes;
  Rig rig;
};

/// Refuses options that were settled when the rig was baked, unless they say what it is.
ImageFile open_image(const std::string& path, const LoadOptions& load, const RigOptions& evaluation,
                     uint32_t reuse = MIEN_REUSE_UNCHANGED);

}  // namespace mien::cli
