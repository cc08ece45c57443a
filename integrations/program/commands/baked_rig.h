// SPDX-License-Identifier: MIT
// A baked file under the options of commands that take DNA files as well.
#pragma once

#include "integrations/program/commands/options.h"
#include "integrations/program/io/baked_file.h"

namespace mien::cli {

/// Refuses options that baking has already decided, unless they agree with the file.
BakedFile open_baked_rig(const std::string& path, const LoadOptions& load,
                         const RigOptions& evaluation, uint32_t reuse = MIEN_REUSE_UNCHANGED);

}  // namespace mien::cli
