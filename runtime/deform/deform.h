// SPDX-License-Identifier: MIT
// Pose -> positions and normals of a mesh. Nothing here allocates, locks or fails: the deformer was
// checked when it was made, and callers check mesh numbers and rooms.
#pragma once

#include "runtime/base/parallel_for.h"
#include "runtime/deform/deformer_instance.h"

namespace mien {

/// One mesh of poses of one deformer, all different, all with room for it. `normals` is not
/// kDefault.
void deform(const Deformer& deformer, Span<DeformerInstance* const> poses, uint32_t mesh,
            Normals normals, const ParallelFor& parallel);

}  // namespace mien
