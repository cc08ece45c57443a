// SPDX-License-Identifier: MIT
// Vertices: blend shape targets, linear blend skinning, normals.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace mien {

/// positions[4 * indices[i] + k] += weight * deltas[3 * i + k] for k = 0, 1, 2. Reads one number past
/// the last delta; the fourth float of a position becomes meaningless.
struct TargetArgs {
  const float* deltas;
  const uint16_t* indices;
  float* positions;
  float weight;
  uint32_t count;
};
using AddTargetKernel = void(const TargetArgs& args);

/// The same in groups of four positions, of which one or more have deltas: the lowest 4 bits of a group say which, the
/// others are its number, positions / 4. The deltas of all groups follow each other. add_target_fixed takes three 16-bit
/// integers for each, add_target_packed three of 10 bits in 32, at any even address: x in the lowest bits, then y, z, in
/// two's complement. Writes whole groups; reads up to kDeltaPadding integers past the last delta.
struct FixedTargetArgs {
  const uint16_t* groups;
  const int16_t* deltas;
  float* positions;
  float weight;
  uint32_t count;  // groups
};
using AddFixedTargetKernel = void(const FixedTargetArgs& args);
constexpr uint32_t kGroupPositions = 4, kDeltaPadding = 16;

/// to[i] = from[i] * scale.
using FloatsFromFixedKernel = void(const int16_t* from, float scale, size_t count, float* to);

/// How skinning transforms normals: by the blended matrix, or by its cofactor matrix, which is right
/// for any scale.
enum class SkinNormals : uint32_t { kNone, kMatrix, kCofactors };

/// In a vertex index of SkinArgs and NormalArgs: the vertex lies on a hard edge.
constexpr uint32_t kHardEdge = 0x8000'0000;

/// Linear blend skinning of `count` positions with the same number of influences, at least one:
///
///     positions   x y z * of each, or null
///     neutral     without positions: x y z of position i at 3 * position_indices[i]
///     weights     `influences` for each position; joints likewise
///     matrices    skin matrices by joint, 64-byte aligned
///     normals     x y z of each vertex; sorted_normals: x y z * of vertices[k] at 4 * k, or null
///     tangents    x y z w of each vertex
///
/// Writes position i to out_positions[3 * position_indices[i]]. Its vertices are vertices[k] for
/// first_vertex[i] <= k < first_vertex[i + 1]; their normals are transformed, normalized, and
/// written to out_normals[3 * vertex]. Reads one float past each normal. A normal that loses its direction is copied instead. Unless
/// out_tangents is null, their tangents are transformed by the blended matrix and written to
/// out_tangents[4 * vertex], not normalized, with their w.
struct SkinArgs {
  const float* positions;
  const float* neutral;
  const float* weights;
  const uint16_t* joints;
  const float* matrices;
  const uint16_t* position_indices;
  float* out_positions;
  const uint32_t* first_vertex;
  const uint32_t* vertices;
  const float* normals;
  const float* sorted_normals;
  float* out_normals;
  const float* tangents;
  float* out_tangents;
  uint32_t count;
  uint32_t influences;
  SkinNormals mode;
};
using SkinPositionsKernel = void(const SkinArgs& args);

/// areas[4 * i ...] = (p2 - p0) x (p3 - p1) for the four positions of each face: twice the area
/// vector. Reads one float past each position.
struct AreaArgs {
  const float* positions;
  const void* faces;  // 16-bit integers if `narrow`, else 32-bit ones
  float* areas;
  uint32_t count;
  bool narrow;
};
using FaceAreasKernel = void(const AreaArgs& args);

/// Normals of the vertices of `count` positions: the normalized sum of the area vectors of the
/// adjacent faces. On a hard edge the neutral normal is rotated instead, by the shortest rotation
/// from the neutral direction to that sum. Without a direction the neutral normal is copied.
/// Reads one float past each normal.
struct NormalArgs {
  const float* areas;
  const uint32_t* first_adjacent_face;  // [position], + 1
  const void* adjacent_faces;           // 16-bit integers if `narrow`, else 32-bit ones
  const uint32_t* first_vertex;         // [position], + 1
  const uint32_t* vertices;
  const float* normals;  // neutral: x y z of each vertex
  // Ascending: first_position + i for each of the positions i that has vertices on hard edges, perhaps more.
  const uint32_t* hard_positions;
  const float* neutral_directions;  // x y z * of each of these
  float* out_normals;
  uint32_t first_position;
  uint32_t hard_count;
  uint32_t count;
  bool narrow;
};
using SumNormalsKernel = void(const NormalArgs& args);

}  // namespace mien
