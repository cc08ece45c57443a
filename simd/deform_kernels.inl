// SPDX-License-Identifier: MIT
// Blend shape targets, linear blend skinning, normals. docs/deformation.md.

#pragma once

#include <utility>  // index_sequence, a mere type

#include "simd/quad.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

void add_target(const TargetArgs& given) {
  const TargetArgs args = given;  // a local copy: no store can alias it
  const Quad weight = broadcast4(args.weight);
  for (size_t i = 0; i < args.count; ++i) {
    float* at = args.positions + size_t{args.indices[i]} * 4;
    store4(at, mul_add4(weight, load4(args.deltas + i * 3), load4(at)));
  }
}

// Normals -----------------------------------------------------------------------------------------

// Squared lengths of what has a direction.
constexpr float kMinSquared = 1e-36f, kMaxSquared = 3.4e38f;

/// Writes the normal of a vertex: the vector normalized, or the neutral normal if it has no direction.
inline void put_normal(const Quad& vector, uint32_t vertex, const float* neutral, float* normals) {
  const size_t place = size_t{vertex & ~kHardEdge} * 3;
  float squared;
  const Quad unit = normalized4(vector, squared);
  const bool has_direction = squared > kMinSquared && squared < kMaxSquared;
  store3(normals + place, has_direction ? unit : load4(neutral + place));
}

// Skinning ----------------------------------------------------------------------------------------

constexpr size_t kVecsPerMatrix = 16 / kWidth;

template <class Add, size_t... K>
inline void add_each(const Add& add, std::index_sequence<K...>) {
  (add(K + 1), ...);
}

/// The sum of weight * matrix over the influences of a position. Each float of the matrix is a lane
/// that adds the influences in order, so all vector widths give the same bits. Parameter packs
/// instead of loops keep each sum in a register, and unroll up to eight influences (kCount; 0 means
/// any number).
template <size_t kCount, size_t... V>
inline void blend(const float* weights, const uint16_t* joints, const float* matrices, size_t count,
                  Quad* columns, std::index_sequence<V...>) {
  const float* matrix = matrices + size_t{joints[0]} * 16;
  const Vec first = broadcast(weights[0]);
  Vec sums[] = {first * load(matrix + V * kWidth)...};
  const auto add = [&](size_t k) {
    const float* next = matrices + size_t{joints[k]} * 16;
    const Vec weight = broadcast(weights[k]);
    ((sums[V] = mul_add(weight, load(next + V * kWidth), sums[V])), ...);
  };
  // Compilers vectorize the loop of the scalar kernels, but not the unrolled form.
  if constexpr (kCount == 0 || kWidth == 1) {
    for (size_t k = 1; k < count; ++k) add(k);
  } else {
    add_each(add, std::make_index_sequence<kCount - 1>());
  }
  columns4(sums, columns);
}

template <SkinNormals kMode, size_t kInfluences, bool kTangents>
void skin_rows(const SkinArgs& given) {
  const SkinArgs args = given;
  const size_t influences = kInfluences != 0 ? kInfluences : args.influences;
  const uint32_t* vertex = args.vertices + args.first_vertex[0];
  alignas(16) static constexpr float kUnitW[4] = {0, 0, 0, 1};
  const Quad unit_w = load4(kUnitW);
  for (size_t i = 0; i < args.count; ++i) {
    Quad c[4];
    blend<kInfluences>(args.weights + i * influences, args.joints + i * influences, args.matrices,
                       influences, c, std::make_index_sequence<kVecsPerMatrix>());
    const float* p = args.positions + i * 4;
    const Quad skinned =
        mul_add4(c[0], broadcast4(p[0]),
                 mul_add4(c[1], broadcast4(p[1]), mul_add4(c[2], broadcast4(p[2]), c[3])));
    store3(args.out_positions + size_t{args.position_indices[i]} * 3, skinned);
    if constexpr (kTangents) {
      for (size_t k = args.first_vertex[i]; k < args.first_vertex[i + 1]; ++k) {
        const size_t place = size_t{args.vertices[k] & ~kHardEdge} * 4;
        const float* t = args.tangents + place;
        const Quad linear = mul_add4(c[0], broadcast4(t[0]),
                                     mul_add4(c[1], broadcast4(t[1]), c[2] * broadcast4(t[2])));
        store4(args.out_tangents + place, mul_add4(unit_w, broadcast4(t[3]), linear));
      }
    }
    if constexpr (kMode != SkinNormals::kNone) {
      if constexpr (kMode == SkinNormals::kCofactors) {
        const Quad x = c[0], y = c[1], z = c[2];
        c[0] = cross4(y, z);
        c[1] = cross4(z, x);
        c[2] = cross4(x, y);
      }
      for (const uint32_t* end = args.vertices + args.first_vertex[i + 1]; vertex != end;
           ++vertex) {
        const float* n = args.normals + size_t{*vertex & ~kHardEdge} * 3;
        put_normal(mul_add4(c[0], broadcast4(n[0]),
                            mul_add4(c[1], broadcast4(n[1]), c[2] * broadcast4(n[2]))),
                   *vertex, args.normals, args.out_normals);
      }
    }
  }
}

template <SkinNormals kMode>
void skin_mode(const SkinArgs& args) {
  // Not unrolled: that would double the code for an optional output.
  if (args.out_tangents) return skin_rows<kMode, 0, true>(args);
  switch (args.influences) {
    case 1: return skin_rows<kMode, 1, false>(args);
    case 2: return skin_rows<kMode, 2, false>(args);
    case 3: return skin_rows<kMode, 3, false>(args);
    case 4: return skin_rows<kMode, 4, false>(args);
    case 5: return skin_rows<kMode, 5, false>(args);
    case 6: return skin_rows<kMode, 6, false>(args);
    case 7: return skin_rows<kMode, 7, false>(args);
    case 8: return skin_rows<kMode, 8, false>(args);
    default: return skin_rows<kMode, 0, false>(args);
  }
}

void skin_positions(const SkinArgs& args) {
  switch (args.mode) {
    case SkinNormals::kNone: return skin_mode<SkinNormals::kNone>(args);
    case SkinNormals::kMatrix: return skin_mode<SkinNormals::kMatrix>(args);
    case SkinNormals::kCofactors: return skin_mode<SkinNormals::kCofactors>(args);
  }
}

// Recomputed normals ------------------------------------------------------------------------------

void face_areas(const AreaArgs& given) {
  const AreaArgs args = given;
  for (size_t i = 0; i < args.count; ++i) {
    const uint32_t* face = args.faces + i * 4;
    const auto position = [&](size_t k) { return load4(args.positions + size_t{face[k]} * 3); };
    store4(args.areas + i * 4, cross4(position(2) - position(0), position(3) - position(1)));
  }
}

inline float dot3(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Rotates a normal by the shortest rotation from the neutral direction to that of `sum`. Zero if
/// the sum has no direction.
inline Quad rotated_normal(const Quad& sum, const float* neutral_direction, const float* normal) {
  float now[4];
  store4(now, sum);
  const float squared = dot3(now, now);
  if (!(squared > kMinSquared && squared < kMaxSquared)) return broadcast4(0.0f);
  const Quad unit = sum * broadcast4(1.0f / __builtin_sqrtf(squared));
  const Quad axis = cross4(load4(neutral_direction), unit), n = load4(normal);
  float unit_parts[4], axis_parts[4];
  store4(unit_parts, unit);
  store4(axis_parts, axis);
  const float cosine = dot3(neutral_direction, unit_parts);
  const float rest = 1 + cosine < 1e-6f ? 1e-6f : 1 + cosine;
  return mul_add4(axis, broadcast4(dot3(axis_parts, normal) / rest),
                  mul_add4(n, broadcast4(cosine), cross4(axis, n)));
}

void sum_normals(const NormalArgs& given) {
  const NormalArgs args = given;
  const uint32_t* vertex = args.vertices + args.first_vertex[0];
  for (size_t i = 0; i < args.count; ++i) {
    Quad sum = broadcast4(0.0f);
    for (size_t k = args.first_adjacent_face[i]; k < args.first_adjacent_face[i + 1]; ++k) {
      sum = sum + load4(args.areas + size_t{args.adjacent_faces[k]} * 4);
    }
    for (const uint32_t* end = args.vertices + args.first_vertex[i + 1]; vertex != end; ++vertex) {
      Quad normal = sum;
      if ((*vertex & kHardEdge) != 0) {
        const float* n = args.normals + size_t{*vertex & ~kHardEdge} * 3;
        normal = rotated_normal(sum, args.neutral_directions + i * 4, n);
      }
      put_normal(normal, *vertex, args.normals, args.out_normals);
    }
  }
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
