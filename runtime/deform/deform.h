// SPDX-License-Identifier: MIT
// Joint matrices and channel weights -> positions and normals of a mesh, also as vertices in the
// memory of the caller. Nothing here allocates, locks or fails: the compiler has checked the
// deformer, and the caller checks its arguments.
#pragma once

#include "runtime/base/parallel_for.h"
#include "runtime/deform/deformer_instance.h"

namespace mien {

/// Deforms one mesh of several instances, all of them different, of this deformer, and with memory
/// for the mesh. `normals` is not kDefault.
void deform(const Deformer& deformer, Span<DeformerInstance* const> instances, uint32_t mesh,
            Normals normals, const ParallelFor& parallel);

/// The same, and then writes the vertices of each instance to its `output`, which is valid, and has
/// a stream of tangents only if the deformer has tangents. docs/deformation.md, 5 "Vertex output".
void write_vertices(const Deformer& deformer, Span<DeformerInstance* const> instances,
                    uint32_t mesh, Normals normals, const ParallelFor& parallel);

}  // namespace mien
