// SPDX-License-Identifier: MIT
// mien info of a baked rig: what a rig can tell without its DNA file.
#pragma once

#include "integrations/program/io/baked_file.h"
#include "integrations/program/io/terminal.h"

namespace mien::cli {

void write_baked_info(const BakedFile& file, bool json, const Session& session);

}  // namespace mien::cli
