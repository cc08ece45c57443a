// SPDX-License-Identifier: MIT
// Real heads with expressions, where they are at hand: $MIEN_SHARED/data/meshes, as its README describes.
#pragma once

#include <string>

#include "tests/support/author_setup.h"

namespace mien::author {

/// The folder; empty if it is not there.
std::string real_mesh_folder();

/// The skin of ICT FaceKit with 56 expressions that move it. False if there is no such file.
bool load_ict(AuthorSetup& out);
/// The head of MakeHuman with 34 expressions.
bool load_makehuman(AuthorSetup& out);

/// `count` bones at means of the moving vertices, which count by their motion; weights over the
/// `influences` nearest along the surface.
void add_bones_and_weights(uint32_t count, uint32_t influences, AuthorSetup& out);

}  // namespace mien::author
