// SPDX-License-Identifier: MIT
// mien info of a baked rig: what a rig can tell without its DNA file.
#pragma once

#include "integrations/cli/image_file.h"

namespace mien::cli {

void write_image_info(const ImageFile& file, bool json, const Session& session);

}  // namespace mien::cli
