// SPDX-License-Identifier: MIT
// Textures of the generated head: images in a folder, and the materials file beside the DNA file that names them.
#pragma once

#include <string>

#include "integrations/program/io/handles.h"
#include "integrations/program/io/terminal.h"

namespace mien::cli {

/// Writes skin_basecolor.png, skin_normal.png, skin_roughness.png, eyes_basecolor.png, eyes_normal.png, tongue_normal.png
/// and hair.png into `folder`, which is made if it is missing, and OUT.materials.json beside `path`, the DNA file of `dna`: a head of this seed.
void write_head_textures(Dna dna, uint64_t seed, const std::string& path, const std::string& folder,
                         const Session& session);

}  // namespace mien::cli
