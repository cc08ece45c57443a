// SPDX-License-Identifier: MIT
// Vertex streams in the caller's memory, and their checks. docs/deformation.md, 5 "Vertex output".
#pragma once

#include <cstddef>

#include "simd/vertex_kernels.h"

namespace mien {

/// Where the vertices of a mesh go. A stream without data is not written.
struct VertexOutput {
  VertexStream positions, normals, tangents;
};

/// Bytes of one vertex in a format.
size_t vertex_format_size(VertexFormat format);

/// True if there is a stream, if no two vertices share a byte, and if each stream has a format that its
/// attribute allows, a stride of at least the size of the format, data and stride that are multiples of 4,
/// and an end within the address space.
bool is_valid(const VertexOutput& output, uint32_t vertex_count);

/// True if two outputs share a byte.
bool overlap(const VertexOutput& a, const VertexOutput& b, uint32_t vertex_count);

/// The first byte of an output, and the byte after the last.
struct VertexOutputRange {
  uintptr_t begin, end;
};
VertexOutputRange range_of(const VertexOutput& output, uint32_t vertex_count);

}  // namespace mien
