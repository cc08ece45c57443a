// SPDX-License-Identifier: MIT
// Blend shape targets, linear blend skinning, normals. docs/deformation.md.

#pragma once

#include <utility>  // index_sequence, a type only

#include "simd/deform_kernels.h"
#include "simd/quad.inl"

namespace mien::MIEN_KERNEL_ISA {
namespace {

void add_target(const TargetArgs& given) {
  const TargetArgs args = given;  // a local copy: no store can alias it
  const Quad weight = broadcast4(args.weight);
  const auto add = [&](size_t i) {
    float* at = args.positions + size_t{args.indices[i]} * 4;
    store4(at, mul_add4(weight, load4(args.deltas + i * 3), load4(at)));
  };
  size_t i = 0;
  for (; i + 4 <= args.count; i += 4) {
    add(i);
    add(i + 1);
    add(i + 2);
    add(i + 3);
  }
  for (; i < args.count; ++i) add(i);
}

/// Calls add(four positions, mask, deltas) for each group.
template <size_t kWordsPerDelta, class Add>
inline void for_each_group(const FixedTargetArgs& args, const Add& add) {
  constexpr uint64_t kCounts = 0x4332'3221'3221'2110;  // bits of each mask, 4 bits each
  const int16_t* deltas = args.deltas;
  for (size_t i = 0; i < args.count; ++i) {
    const uint32_t group = args.groups[i], mask = group & 15;
    add(args.positions + size_t{group >> 4} * 16, mask, deltas);
    deltas += kWordsPerDelta * (kCounts >> 4 * mask & 15);
  }
}
void add_target_fixed(const FixedTargetArgs& args) {
  const SparseWeight weight = sparse_weight(args.weight);
  for_each_group<3>(args, [=](float* positions, uint32_t mask, const int16_t* deltas) {
    add_sparse4(positions, mask, deltas, weight);
  });
}
void add_target_packed(const FixedTargetArgs& args) {
  const SparseWeight weight = sparse_weight(args.weight * 0x1p-22f);
  for_each_group<2>(args, [=](float* positions, uint32_t mask, const int16_t* deltas) {
    add_sparse_fields4(positions, mask, deltas, weight);
  });
}

void floats_from_fixed(const int16_t* from, float scale, size_t count, float* to) {
  size_t i = 0;
  for (; i + kWidth <= count; i += kWidth) store(to + i, load_fixed(from + i) * broadcast(scale));
  for (; i < count; ++i) to[i] = static_cast<float>(from[i]) * scale;
}

// Normals -----------------------------------------------------------------------------------------

// Squared lengths of vectors that have a direction.
constexpr float kMinSquared = 1e-36f, kMaxSquared = 3.4e38f;

/// Normals are made in two steps, for a chunk of vertices at a time: vectors in scratch memory, then all of
/// them are normalized. For single vertices, the root and the division would take longer than skinning, and
/// out-of-order execution does not reach far enough to overlap them.
constexpr uint32_t kChunkVertices = 256;

/// Cuts positions into chunks of at most kChunkVertices vertices: calls run(first position, count,
/// first_vertex). A position with more vertices is passed several times, each time with some of them.
template <class F>
inline void for_each_chunk(const uint32_t* first_vertex, uint32_t count, F&& run) {
  for (uint32_t i = 0, positions; i < count; i += positions) {
    positions = count - i < kChunkVertices ? count - i : kChunkVertices;
    while (positions > 1 && first_vertex[i + positions] - first_vertex[i] > kChunkVertices) {
      positions /= 2;
    }
    const uint32_t end = first_vertex[i + positions];
    const uint32_t* of_chunk = first_vertex + i;
    uint32_t part[2] = {of_chunk[0]};
    do {
      if (end - part[0] > kChunkVertices || of_chunk == part) {
        part[1] = end - part[0] > kChunkVertices ? part[0] + kChunkVertices : end;
        of_chunk = part;
      }
      run(i, positions, of_chunk);
      part[0] = of_chunk[positions];
    } while (part[0] != end);
  }
}

/// Normalizes a chunk of vectors, x y z * each, and writes them. A vector without a direction becomes the
/// neutral normal.
[[gnu::noinline]] void put_normals(float* vectors, const uint32_t* vertices, size_t count,
                                   const float* neutral, float* normals) {
  alignas(64) float scales[kChunkVertices];
  static_assert(kWidth <= 16);
  uint16_t lost[kChunkVertices / kWidth];  // lanes
  uint32_t any_lost = 0;
  for (size_t k = count; k % kWidth != 0; ++k) {
    store4(vectors + k * 4, load4(vectors + count * 4 - 4));
  }
  for (size_t k = 0; k < count; k += kWidth) {
    const Vec squared = squared_lengths(vectors + k * 4);
    store(scales + k, divide(broadcast(1.0f), square_root(squared)));
    const Vec limited = at_most(at_least(squared, broadcast(kMinSquared)), broadcast(kMaxSquared));
    const uint32_t lanes = different_lanes(squared, limited);
    any_lost |= lanes;
    lost[k / kWidth] = static_cast<uint16_t>(lanes);
  }
  for (size_t k = 0; k < count; ++k) {
    store3(normals + size_t{vertices[k] & ~kHardEdge} * 3,
           load4(vectors + k * 4) * broadcast4(scales[k]));
  }
  for (size_t k = 0; any_lost != 0 && k < count; ++k) {
    if ((lost[k / kWidth] >> k % kWidth & 1) == 0) continue;
    const size_t at = size_t{vertices[k] & ~kHardEdge} * 3;
    store3(normals + at, load4(neutral + at));
  }
}

// Skinning ----------------------------------------------------------------------------------------

constexpr size_t kFloatsPerVec = sizeof(ColumnVec) / sizeof(float);
constexpr size_t kVecsPerMatrix = 16 / kFloatsPerVec;

template <class Add, size_t... K>
[[gnu::always_inline]] inline void add_each(const Add& add, std::index_sequence<K...>) {
  (add(K + 1), ...);
}

/// The sum of weight * matrix over the influences of a position. Each float of the matrix is a lane
/// that adds the influences in order, so all vector widths give the same bits. Parameter packs
/// instead of loops keep each sum in a register, and unroll up to eight influences (kCount; 0 means
/// any number).
template <size_t kCount, size_t... V>
[[gnu::always_inline]] inline void blend(const float* weights, const uint16_t* joints,
                                         const float* matrices, size_t count, Quad* columns,
                                         std::index_sequence<V...>) {
  const float* matrix = matrices + size_t{joints[0]} * 16;
  const ColumnVec first = broadcast_column_vec(weights[0]);
  ColumnVec sums[] = {first * load_column_vec(matrix + V * kFloatsPerVec)...};
  const auto add = [&](size_t k) __attribute__((always_inline)) {
    const float* next = matrices + size_t{joints[k]} * 16;
    const ColumnVec weight = broadcast_column_vec(weights[k]);
    ((sums[V] = mul_add_column_vec(weight, load_column_vec(next + V * kFloatsPerVec), sums[V])),
     ...);
  };
  if constexpr (kCount == 0) {
    for (size_t k = 1; k < count; ++k) add(k);
  } else {
    add_each(add, std::make_index_sequence<kCount - 1>());
  }
  columns4(sums, columns);
}

/// Transforms without the translation.
[[gnu::always_inline]] inline Quad turned4(const Quad* c, const Quad& v) {
  return mul_add4(c[0], lane4<0>(v), mul_add4(c[1], lane4<1>(v), c[2] * lane4<2>(v)));
}

/// The outputs of skin_chunk() besides positions: normals by the matrix, or whatever the arguments ask for.
/// Checking the arguments for each position takes time, but templates for each mode, with and without
/// tangents, would more than double the code.
enum class Skinned { kNothing, kNormals, kAny };

/// Positions, tangents, and normals that are not normalized yet, x y z * each.
template <Skinned kOut, size_t kInfluences>
void skin_chunk(const SkinArgs& given, float* vectors) {
  const SkinArgs args = given;
  const size_t influences = kInfluences != 0 ? kInfluences : args.influences;
  const uint32_t first_vertex = args.first_vertex[0];
  alignas(16) static constexpr float kUnitW[4] = {0, 0, 0, 1};
  const Quad unit_w = load4(kUnitW);
  size_t vertex = 0;
  Quad c[4] = {unit_w, unit_w, unit_w, unit_w};
  for (size_t i = 0; i < args.count; ++i) {
    const float* weights = args.weights + i * influences;
    const uint16_t* joints = args.joints + i * influences;
    // Rigid parts, such as hair, have many positions with the same matrix.
    if (kInfluences != 1 || i == 0 || joints[0] != joints[-1] || weights[0] != weights[-1]) {
      blend<kInfluences>(weights, joints, args.matrices, influences, c,
                         std::make_index_sequence<kVecsPerMatrix>());
    }
    const size_t index = args.position_indices[i];
    const Quad p = load4(args.positions ? args.positions + i * 4 : args.neutral + index * 3);
    const Quad skinned =
        mul_add4(c[0], lane4<0>(p), mul_add4(c[1], lane4<1>(p), mul_add4(c[2], lane4<2>(p), c[3])));
    store3(args.out_positions + index * 3, skinned);
    if constexpr (kOut == Skinned::kNothing) continue;

    const size_t end = args.first_vertex[i + 1] - first_vertex;
    if (kOut == Skinned::kAny && args.out_tangents) {
      for (size_t k = vertex; k != end; ++k) {
        const size_t at = size_t{args.vertices[k] & ~kHardEdge} * 4;
        const Quad t = load_lanes4(args.tangents + at);
        store4(args.out_tangents + at, mul_add4(unit_w, lane4<3>(t), turned4(c, t)));
      }
    }
    Quad turn[3] = {c[0], c[1], c[2]};
    if (kOut == Skinned::kAny && args.mode == SkinNormals::kCofactors) {
      turn[0] = cross4(c[1], c[2]);
      turn[1] = cross4(c[2], c[0]);
      turn[2] = cross4(c[0], c[1]);
    }
    if (kOut == Skinned::kAny && args.mode == SkinNormals::kNone) {
      vertex = end;
      continue;
    }
    for (; vertex != end; ++vertex) {
      store4(vectors + vertex * 4, turned4(turn, load_lanes4(args.sorted_normals + vertex * 4)));
    }
  }
}

using SkinChunk = void (*)(const SkinArgs& args, float* vectors);

template <Skinned kOut>
SkinChunk skin_chunk_for(const SkinArgs& args) {
  if constexpr (kWidth == 1) return skin_chunk<kOut, 0>;
  switch (args.influences) {
    case 1: return skin_chunk<kOut, 1>;
    case 2: return skin_chunk<kOut, 2>;
    case 3: return skin_chunk<kOut, 3>;
    case 4: return skin_chunk<kOut, 4>;
    case 5: return skin_chunk<kOut, 5>;
    case 6: return skin_chunk<kOut, 6>;
    case 7: return skin_chunk<kOut, 7>;
    case 8: return skin_chunk<kOut, 8>;
    default: return skin_chunk<kOut, 0>;
  }
}

void skin_positions(const SkinArgs& args) {
  if (args.mode == SkinNormals::kNone && !args.out_tangents) {
    return skin_chunk_for<Skinned::kNothing>(args)(args, nullptr);
  }
  const SkinChunk skin = args.mode == SkinNormals::kMatrix && !args.out_tangents
                             ? skin_chunk_for<Skinned::kNormals>(args)
                             : skin_chunk_for<Skinned::kAny>(args);
  alignas(64) float vectors[kChunkVertices * 4];
  for_each_chunk(args.first_vertex, args.count,
                 [&](uint32_t first, uint32_t count, const uint32_t* first_vertex) {
                   SkinArgs chunk = args;
                   if (args.positions) chunk.positions += size_t{first} * 4;
                   chunk.weights += size_t{first} * args.influences;
                   chunk.joints += size_t{first} * args.influences;
                   chunk.position_indices += first;
                   chunk.first_vertex = first_vertex;
                   chunk.vertices += first_vertex[0];
                   chunk.count = count;
                   const size_t vertices = first_vertex[count] - first_vertex[0];
                   if (args.sorted_normals) {
                     chunk.sorted_normals += size_t{first_vertex[0]} * 4;
                   } else if (args.mode != SkinNormals::kNone) {
                     chunk.sorted_normals = vectors;  // each is read before it is written
                     for (size_t k = 0; k < vertices; ++k) {
                       const size_t vertex = chunk.vertices[k] & ~kHardEdge;
                       store4(vectors + k * 4, load4(args.normals + vertex * 3));
                     }
                   }
                   skin(chunk, vectors);
                   if (args.mode == SkinNormals::kNone) return;
                   put_normals(vectors, chunk.vertices, vertices, args.normals, args.out_normals);
                 });
}

// Recomputed normals ------------------------------------------------------------------------------

template <class Index>
inline void find_areas(const AreaArgs& given) {
  const AreaArgs args = given;
  for (size_t i = 0; i < args.count; ++i) {
    const Index* face = static_cast<const Index*>(args.faces) + i * 4;
    const auto position = [&](size_t k) { return load4(args.positions + size_t{face[k]} * 3); };
    store4(args.areas + i * 4, cross4(position(2) - position(0), position(3) - position(1)));
  }
}
void face_areas(const AreaArgs& args) {
  args.narrow ? find_areas<uint16_t>(args) : find_areas<uint32_t>(args);
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

template <class Index>
inline void sum_areas(const NormalArgs& given) {
  const NormalArgs args = given;
  const Index* const adjacent_faces = static_cast<const Index*>(args.adjacent_faces);
  alignas(64) float vectors[kChunkVertices * 4];
  uint32_t hard = 0;
  const auto run = [&](uint32_t first, uint32_t count, const uint32_t* first_vertex) {
    const uint32_t* const vertices = args.vertices + first_vertex[0];
    const auto area = [&](size_t k) { return load4(args.areas + size_t{adjacent_faces[k]} * 4); };
    size_t face = args.first_adjacent_face[first], vertex = 0;
    for (size_t i = 0; i < count; ++i) {
      const size_t faces_end = args.first_adjacent_face[first + i + 1];
      Quad sum = broadcast4(0.0f);
      // Most positions of a mesh of quads have four faces.
      for (; face + 4 <= faces_end; face += 4) {
        sum = sum + area(face) + area(face + 1) + area(face + 2) + area(face + 3);
      }
      for (; face != faces_end; ++face) sum = sum + area(face);
      for (const size_t end = first_vertex[i + 1] - first_vertex[0]; vertex != end; ++vertex) {
        store4(vectors + vertex * 4, sum);
      }
    }
    // A separate loop: in the loop above, the rare case would take registers from the sums.
    // A position may come in several chunks.
    while (hard != args.hard_count && args.hard_positions[hard] < args.first_position + first)
      ++hard;
    for (uint32_t h = hard; h != args.hard_count; ++h) {
      const size_t i = args.hard_positions[h] - args.first_position - first;
      if (i >= count) break;
      const float* direction = args.neutral_directions + size_t{h} * 4;
      for (size_t k = first_vertex[i] - first_vertex[0]; k < first_vertex[i + 1] - first_vertex[0];
           ++k) {
        if ((vertices[k] & kHardEdge) == 0) continue;
        const float* normal = args.normals + size_t{vertices[k] & ~kHardEdge} * 3;
        store4(vectors + k * 4, rotated_normal(load4(vectors + k * 4), direction, normal));
      }
    }
    put_normals(vectors, vertices, vertex, args.normals, args.out_normals);
  };
  for_each_chunk(args.first_vertex, args.count, run);
}
void sum_normals(const NormalArgs& args) {
  args.narrow ? sum_areas<uint16_t>(args) : sum_areas<uint32_t>(args);
}

}  // namespace
}  // namespace mien::MIEN_KERNEL_ISA
