// SPDX-License-Identifier: MIT
// Names of bones as MetaHuman heads have them, so that animation made for those plays on other heads.
#pragma once

#include "author/base/dna_making.h"
#include "author/mesh/author_mesh.h"

namespace mien::author {

/// Renames bones that have a counterpart: spine_05, neck_01, ..., FACIAL_C_FacialRoot, FACIAL_C_Jaw, FACIAL_L_Eye.
/// Facial bones are named by side and region already. False if memory ran out.
bool name_as_metahuman(Placement& placement, Arena& arena);

}  // namespace mien::author
