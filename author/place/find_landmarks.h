// SPDX-License-Identifier: MIT
// Landmarks of the face, found or given, with the confidence of each.
#pragma once

#include "author/place/face_mask.h"

namespace mien::author {

/// Takes those of the caller. Fails with kAuthorRefused if one is far outside the mesh, or if they contradict
/// each other.
Status take_landmarks(Placing& placing);

/// Finds nose, throat, lips, corners of the mouth and chin. The mask is known.
Status find_landmarks(Placing& placing);

}  // namespace mien::author
