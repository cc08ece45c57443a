// SPDX-License-Identifier: MIT
// RIG on the command line: opening it, and making a rig of it.
#pragma once

#include <string>
#include <vector>

#include "integrations/cli/cli.h"

namespace mien::cli {

/// The bytes of standard input stand first: the DNA points into them, so it has to go before them.
struct RigFile {
  std::string shown;  // path, or "standard input"
  std::string bytes;
  Dna dna;
  MienDnaInfo info;
};

std::string shown_name(const std::string& path);

/// `path` may be "-". Notes LODs that were named but are not there.
RigFile open_rig_file(const std::string& path, const MienDnaDesc& desc, const Session& session);

Rig create_rig(const RigFile& file, const MienRigDesc& desc);
MienRigInfo rig_info(const MienRig* rig);
uint32_t rig_count(const MienRig* rig, uint32_t kind);

}  // namespace mien::cli
