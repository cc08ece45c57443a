// SPDX-License-Identifier: MIT
// Joint matrices and channel weights -> positions and normals of a mesh; optionally also vertices in the
// caller's memory. Nothing here allocates, locks or fails: the compiler has checked the deformer, and the
// caller of these functions checks their arguments.
#pragma once

#include "runtime/base/parallel_for.h"
#include "runtime/deform/deformer_instance.h"

namespace mien {

/// Channels of less weight move no vertex.
constexpr float kMinChannelWeight = 1e-5f;

/// Deforms one mesh of several instances. They must be distinct instances of this deformer, with memory for
/// the mesh. `normals` must not be kDefault.
void deform(const Deformer& deformer, Span<DeformerInstance* const> instances, uint32_t mesh,
            Normals normals, const ParallelFor& parallel);

/// True if the output of an instance shares a byte with that of another one. All are valid.
bool outputs_overlap(Span<DeformerInstance* const> instances, uint32_t vertex_count);

/// Like deform(), and then writes the vertices of each instance to its `output`, which must be valid. It may
/// have a stream of tangents only if the deformer has tangents. docs/deformation.md, 5 "Vertex output".
void write_vertices(const Deformer& deformer, Span<DeformerInstance* const> instances,
                    uint32_t mesh, Normals normals, const ParallelFor& parallel);

}  // namespace mien
