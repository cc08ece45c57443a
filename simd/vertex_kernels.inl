// SPDX-License-Identifier: MIT
// Deformed vertices -> vertex buffers. docs/deformation.md, 5 "Vertex output".

#pragma once

#include "simd/math.inl"
#include "simd/quad.inl"
#include "simd/vertex_kernels.h"

namespace mien::MIEN_KERNEL_ISA {
namespace {

/// The same component of four vertices, or four components of one.
struct Quads {
  Quad x, y, z, w;
};

/// Four vectors, `stride` floats apart, as their components. Past `count` the last one is repeated.
inline Quads load_components(const float* from, size_t stride, size_t count) {
  const auto at = [&](size_t k) { return load4(from + (k < count ? k : count - 1) * stride); };
  Quads q = {at(0), at(1), at(2), at(3)};
  transpose4(q.x, q.y, q.z, q.w);
  return q;
}

// Formats -----------------------------------------------------------------------------------------

/// The memory of four vertices of a stream, of which `count` exist.
struct Target {
  uint8_t* data;
  size_t stride;
  size_t count;

  float* floats(size_t k) const {
    return static_cast<float*>(static_cast<void*>(data + k * stride));
  }
};
inline Target target_of(const VertexStream& stream, size_t first, size_t count) {
  return {stream.data + first * stream.stride, stream.stride, count};
}

/// v in -1 ... 1 times `scale`, rounded to the nearest whole number, in the low bits.
inline Quad to_snorm(const Quad& v, float scale) {
  const Quad clamped = lower4(higher4(v, broadcast4(-1.0f)), broadcast4(1.0f));
  return clamped * broadcast4(scale) + broadcast4(kRounder);
}

inline void write_snorm16(const Target& to, const Quads& v) {
  constexpr float kScale = 32767;
  float low[4], high[4];
  store4(low, join_bits4(to_snorm(v.x, kScale), to_snorm(v.y, kScale), 16));
  store4(high, join_bits4(to_snorm(v.z, kScale), to_snorm(v.w, kScale), 16));
  for (size_t k = 0; k < to.count; ++k) {
    __builtin_memcpy(to.data + k * to.stride, &low[k], 4);
    __builtin_memcpy(to.data + k * to.stride + 4, &high[k], 4);
  }
}

inline void write_snorm10(const Target& to, const Quads& v) {
  constexpr float kScale = 511;
  const Quad xy = join_bits4(to_snorm(v.x, kScale), to_snorm(v.y, kScale), 10);
  const Quad zw = join_bits4(to_snorm(v.z, kScale), to_snorm(v.w, 1), 10);
  float words[4];
  store4(words, join_bits4(xy, zw, 20));
  for (size_t k = 0; k < to.count; ++k) __builtin_memcpy(to.data + k * to.stride, &words[k], 4);
}

/// Vectors of three, and the fourth component if the format has one.
inline void write_floats(const Target& to, const float* from, const uint32_t* indices,
                         VertexFormat format, float w) {
  for (size_t k = 0; k < to.count; ++k) {
    store3(to.floats(k), load4(from + (indices ? size_t{indices[k]} : k) * 3));
    if (format == VertexFormat::kFloat32x4) to.floats(k)[3] = w;
  }
}

// Tangents ----------------------------------------------------------------------------------------

/// A unit vector perpendicular to the unit vector n; x if n is zero. compile/pack_tangents.cpp uses
/// the same formula.
inline void set_perpendicular(const float* n, float* out) {
  const float sign = __builtin_copysignf(1.0f, n[2]);
  const float a = -1 / (sign + n[2]);
  out[0] = 1 + sign * n[0] * n[0] * a;
  out[1] = sign * n[0] * n[1] * a;
  out[2] = -sign * n[0];
}

/// Tangents without their part along the normals, normalized.
inline void make_perpendicular(const Quads& n, Quads& t) {
  // A tangent along the normal leaves only rounding errors, below 1e-5 of its length.
  constexpr float kMinSquaredPart = 1e-10f;
  const Quad before = t.x * t.x + t.y * t.y + t.z * t.z;
  const Quad along = n.x * t.x + n.y * t.y + n.z * t.z;
  t.x = t.x - n.x * along;
  t.y = t.y - n.y * along;
  t.z = t.z - n.z * along;
  const Quad squared = t.x * t.x + t.y * t.y + t.z * t.z;
  const Quad scale = divide4(broadcast4(1.0f), square_root4(squared));
  t.x = t.x * scale;
  t.y = t.y * scale;
  t.z = t.z * scale;

  const Quad least = higher4(before * broadcast4(kMinSquaredPart), broadcast4(kMinSquared));
  const uint32_t lost =
      different_lanes4(squared, lower4(higher4(squared, least), broadcast4(kMaxSquared)));
  if (lost == 0) return;
  float normals[3][4], tangents[3][4];
  store4(normals[0], n.x);
  store4(normals[1], n.y);
  store4(normals[2], n.z);
  store4(tangents[0], t.x);
  store4(tangents[1], t.y);
  store4(tangents[2], t.z);
  for (uint32_t k = 0; k < 4; ++k) {
    if ((lost >> k & 1) == 0) continue;
    const float normal[3] = {normals[0][k], normals[1][k], normals[2][k]};
    float tangent[3];
    set_perpendicular(normal, tangent);
    for (uint32_t i = 0; i < 3; ++i) tangents[i][k] = tangent[i];
  }
  t.x = load4(tangents[0]);
  t.y = load4(tangents[1]);
  t.z = load4(tangents[2]);
}

// Vertices ----------------------------------------------------------------------------------------

inline void write_normals(const VertexStream& stream, const Target& to, const float* normals,
                          const Quads& components) {
  const Quads n = {components.x, components.y, components.z, broadcast4(0.0f)};
  switch (stream.format) {
    case VertexFormat::kSnorm16x4: return write_snorm16(to, n);
    case VertexFormat::kSnorm10_10_10_2: return write_snorm10(to, n);
    default: return write_floats(to, normals, nullptr, stream.format, 0);
  }
}

inline void write_tangents(const VertexStream& stream, const Target& to, Quads t) {
  switch (stream.format) {
    case VertexFormat::kSnorm16x4: return write_snorm16(to, t);
    case VertexFormat::kSnorm10_10_10_2: return write_snorm10(to, t);
    default: break;
  }
  transpose4(t.x, t.y, t.z, t.w);
  const Quad vectors[4] = {t.x, t.y, t.z, t.w};
  for (size_t k = 0; k < to.count; ++k) store4(to.floats(k), vectors[k]);
}

/// Four vertices at a time, with all their attributes: interleaved streams then fill whole cache lines, which
/// write-combining memory needs.
void write_vertices(const VertexArgs& given) {
  const VertexArgs args = given;
  for (size_t i = 0; i < args.count; i += 4) {
    const size_t count = args.count - i < 4 ? args.count - i : 4;
    if (args.position_stream.data) {
      write_floats(target_of(args.position_stream, i, count), args.positions,
                   args.position_indices + i, args.position_stream.format, 1);
    }
    if (!args.normal_stream.data && !args.tangent_stream.data) continue;
    const float* normals = args.normals + i * 3;
    const Quads n = load_components(normals, 3, count);
    if (args.normal_stream.data) {
      write_normals(args.normal_stream, target_of(args.normal_stream, i, count), normals, n);
    }
    if (args.tangent_stream.data) {
      Quads t = load_components(args.tangents + i * 4, 4, count);
      make_perpendicular(n, t);
      write_tangents(args.tangent_stream, target_of(args.tangent_stream, i, count), t);
    }
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
