// SPDX-License-Identifier: MIT
#include "runtime/deform/vertex_output.h"

#include <algorithm>

namespace mien {
namespace {

/// Vertex i takes `size` bytes at begin + i * stride.
struct Run {
  uintptr_t begin, end;  // the extent of all vertices
  size_t size, stride;
};

Run run_of(const VertexStream& stream, uint32_t vertex_count) {
  const uintptr_t begin = reinterpret_cast<uintptr_t>(stream.data);
  if (!stream.data || vertex_count == 0) return {begin, begin, 0, stream.stride};
  const size_t size = vertex_format_size(stream.format);
  return {begin, begin + (size_t{vertex_count} - 1) * stream.stride + size, size, stream.stride};
}

bool overlap(const Run& a, const Run& b) {
  if (a.begin == a.end || b.begin == b.end || a.end <= b.begin || b.end <= a.begin) return false;
  if (a.stride != b.stride) return true;
  // Interleaved: the distance from a vertex of `a` to the next one of `b`.
  const size_t distance = b.begin >= a.begin ? (b.begin - a.begin) % a.stride
                                             : a.stride - 1 - (a.begin - b.begin - 1) % a.stride;
  return distance < a.size || a.stride - distance < b.size;
}

bool is_valid(const VertexStream& stream, uint32_t vertex_count) {
  const uintptr_t begin = reinterpret_cast<uintptr_t>(stream.data);
  return stream.stride >= vertex_format_size(stream.format) && stream.stride % 4 == 0 &&
         begin % 4 == 0 && (UINTPTR_MAX - begin) / stream.stride >= vertex_count;
}

}  // namespace

size_t vertex_format_size(VertexFormat format) {
  switch (format) {
    case VertexFormat::kFloat32x3: return 12;
    case VertexFormat::kFloat32x4: return 16;
    case VertexFormat::kSnorm16x4: return 8;
    case VertexFormat::kSnorm10_10_10_2: break;
  }
  return 4;
}

bool is_valid(const VertexOutput& output, uint32_t vertex_count) {
  const VertexStream* const streams[] = {&output.positions, &output.normals, &output.tangents};
  bool any = false;
  for (const VertexStream* stream : streams) {
    if (!stream->data) continue;
    any = true;
    if (stream->format > VertexFormat::kSnorm10_10_10_2 || !is_valid(*stream, vertex_count)) {
      return false;
    }
  }
  if (output.positions.data && output.positions.format > VertexFormat::kFloat32x4) return false;
  if (output.tangents.data && output.tangents.format == VertexFormat::kFloat32x3) return false;
  const Run positions = run_of(output.positions, vertex_count);
  const Run normals = run_of(output.normals, vertex_count);
  const Run tangents = run_of(output.tangents, vertex_count);
  return any && !overlap(positions, normals) && !overlap(positions, tangents) &&
         !overlap(normals, tangents);
}

bool overlap(const VertexOutput& a, const VertexOutput& b, uint32_t vertex_count) {
  for (const VertexStream* x : {&a.positions, &a.normals, &a.tangents}) {
    const Run run = run_of(*x, vertex_count);
    for (const VertexStream* y : {&b.positions, &b.normals, &b.tangents}) {
      if (overlap(run, run_of(*y, vertex_count))) return true;
    }
  }
  return false;
}

VertexOutputRange range_of(const VertexOutput& output, uint32_t vertex_count) {
  VertexOutputRange range = {UINTPTR_MAX, 0};
  for (const VertexStream* stream : {&output.positions, &output.normals, &output.tangents}) {
    if (!stream->data) continue;
    const Run run = run_of(*stream, vertex_count);
    range = {std::min(range.begin, run.begin), std::max(range.end, run.end)};
  }
  return range;
}

}  // namespace mien
