// SPDX-License-Identifier: MIT
// Deformed vertices -> vertex buffers.
#pragma once

#include <stdint.h>

namespace mien {

/// The values of MIEN_VERTEX_FORMAT_... in mien.h.
enum class VertexFormat : uint32_t {
  kFloat32x3 = 0,
  kFloat32x4 = 1,
  kSnorm16x4 = 2,
  kSnorm10_10_10_2 = 3
};

/// Memory for one attribute of each vertex, `stride` bytes apart. If data is null, the attribute is not
/// written. Data and stride are multiples of 4.
struct VertexStream {
  uint8_t* data;
  uint32_t stride;
  VertexFormat format;
};

/// Deformed vertices -> the caller's memory, in the order of the vertices; each byte is written once and
/// never read. Tangents are made perpendicular to the normal and normalized; one that loses its direction
/// becomes an arbitrary perpendicular. A fourth component is 1 for positions, 0 for normals, w for tangents.
///
/// Snorm: round(clamp(v, -1, 1) * (2^(bits - 1) - 1)), ties to even, in two's complement; x in the
/// lowest bits. Nothing is fused: the same floats give the same bytes on every instruction set.
/// Reads one float past each position and normal.
struct VertexArgs {
  const float* positions;            // [position] x y z
  const uint32_t* position_indices;  // [vertex]
  const float* normals;              // [vertex] x y z, unit
  const float* tangents;             // [vertex] x y z w
  VertexStream position_stream;      // kFloat32x3 or kFloat32x4
  VertexStream normal_stream;
  VertexStream tangent_stream;  // not kFloat32x3
  uint32_t count;
};
using WriteVerticesKernel = void(const VertexArgs& args);

}  // namespace mien
