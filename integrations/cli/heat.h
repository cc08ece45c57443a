// SPDX-License-Identifier: MIT
// A picture of what a control moves.
#pragma once

#include "integrations/cli/influence.h"
#include "integrations/cli/pictures.h"

namespace mien::cli {

/// Side by side: the shape at rest, colored by how far each place moves, and the shape with the
/// control on; below them the scale of the colors. The subject is in the pose of the control.
picture::Image draw_heat(Subject& subject, const Influence& influence,
                         const PictureOptions& options);

}  // namespace mien::cli
