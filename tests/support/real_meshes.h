// SPDX-License-Identifier: MIT
// Real heads with expressions, where they are at hand: $MIEN_SHARED/data/meshes, as its README describes.
#pragma once

#include <string>

#include "tests/support/author_setup.h"

namespace mien::author {

/// The folder; empty if it is not there.
std::string real_mesh_folder();

/// Positions, faces and shapes of the skin of ICT FaceKit, with 56 expressions that move it. False if
/// there is no such file.
bool load_ict(AuthorSetup& out);
/// The head of MakeHuman with 34 expressions.
bool load_makehuman(AuthorSetup& out);
/// The front of a face of MediaPipe, without expressions.
bool load_mediapipe(AuthorSetup& out);

}  // namespace mien::author
