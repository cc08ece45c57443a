// SPDX-License-Identifier: MIT
// The data that the stages of `mien author` pass on: a mesh with shapes, bones, skin weights.
//
//     AuthorMesh ──place──> Placement ──weigh──> SkinWeights ──fit──> joint matrix ──> DNA
//
// Each is plain data that the next stage reads and a caller can replace. Positions, displacements
// and bones are in the internal frame: centimeters, +X the character's left, +Y up, +Z to the
// front. Vertices are numbered consecutively across all parts.
#pragma once

#include <cstdint>

#include "runtime/base/span.h"
#include "runtime/base/vector.h"

namespace mien::author {

using Name = Span<const char>;

constexpr uint32_t kNone = ~uint32_t{0};

/// How the file's axes lie in the internal frame. A signed permutation: file component `axis[i]`
/// times `sign[i]` is internal component i.
struct Frame {
  uint8_t axis[3] = {0, 1, 2};
  int8_t sign[3] = {1, 1, 1};

  Vec3 to_internal(Vec3 file) const {
    const double f[3] = {file.x, file.y, file.z};
    return {sign[0] * f[axis[0]], sign[1] * f[axis[1]], sign[2] * f[axis[2]]};
  }
  Vec3 to_file(Vec3 internal) const {
    double f[3];
    f[axis[0]] = sign[0] * internal.x;
    f[axis[1]] = sign[1] * internal.y;
    f[axis[2]] = sign[2] * internal.z;
    return {f[0], f[1], f[2]};
  }
};

struct Vec3f {
  float x = 0, y = 0, z = 0;
};
inline Vec3 as_vec3(Vec3f v) { return {double{v.x}, double{v.y}, double{v.z}}; }

struct Uv {
  float u = 0, v = 0;
};

/// An object of the input, written as a mesh of its own.
struct Part {
  Name name;
  uint32_t first_vertex = 0, vertex_count = 0;
  uint32_t first_face = 0, face_count = 0;
};

/// Full displacements at value 1 of one expression.
struct Shape {
  Name name;
  Span<const Vec3f> displacements;  // of every vertex
  Span<const uint32_t> moving;      // vertices with a displacement, ascending
  uint32_t number = 0;              // in the source
};

/// The input, checked: finite positions, indices in range, faces of three corners or more.
struct AuthorMesh {
  Span<const Vec3> positions;

  // Faces as they will be written: face f has corners face_starts[f] ... face_starts[f + 1].
  Span<const uint32_t> face_starts;  // faces + 1
  Span<const uint32_t> corners;      // vertices
  Span<const uint32_t> corner_uvs;   // into uvs; empty: no UVs
  Span<const Uv> uvs;

  Span<const uint32_t> triangles;  // of the faces, 3 vertices each, without degenerate ones
  Span<const uint32_t> welded;     // per vertex: the first vertex at the same place
  Span<const uint32_t> component;  // per vertex: connected component of the welded mesh
  uint32_t component_count = 0;
  Span<const uint8_t> is_skin;  // per vertex: 1 on the surface that facial bones move
  double next_area = 0;         // of the largest other component, relative to that of the skin

  Span<const Part> parts;
  Span<const Shape> shapes;

  Frame frame;
  double diagonal = 0;  // of the bounding box of the skin: lengths are compared with it
};

enum class BoneKind : uint8_t { kRoot, kNeck, kHead, kFace, kFacial, kJaw, kEye, kChest, kTongue };

struct Bone {
  Name name;
  Vec3 position;        // in the mesh, not relative to the parent
  uint32_t parent = 0;  // before this bone; root: itself
  uint32_t mirror = 0;  // its mirror image; itself if it has none or lies on the plane
  uint32_t rank = 0;    // facial bones only: LODs drop the highest ranks first; 0 for all others
  BoneKind kind = BoneKind::kFacial;
};

/// The surface that separates head and neck, and where the neck ends. It rises toward the back.
struct NeckCut {
  bool exists = false;
  double y = 0, z = 0;    // of the throat
  double base = 0;        // y where the neck ends and the chest begins
  double half_width = 0;  // of the neck where it is narrowest; 0: unknown

  double above(Vec3 p) const { return p.y - (y + 0.35 * (z - p.z > 0 ? z - p.z : 0)); }
};

/// Parents come before children, and facial bones follow one another by rank.
struct Placement {
  Span<const Bone> bones;
  uint32_t first_facial = 0, facial_count = 0;
  Span<const uint32_t>
      lod_facial_counts;      // facial bones of each LOD, falling; all others are in every LOD
  Span<const uint32_t> mask;  // vertices that facial bones were placed on, ascending
  double symmetry_plane = 0;  // x
  bool symmetric = false;     // left and right bones are in pairs
  NeckCut neck_cut;
  // How much each vertex follows the jaw, where no shape says it; empty: shapes do, or there is no jaw.
  Span<const float> jaw_share;
};

/// Influences of vertex v: slots v * m ... v * m + m - 1, the heaviest first; unused ones have
/// weight 0 and joint 0. Joints are numbers of bones.
struct SkinWeights {
  Span<uint16_t> joints;  // n * m
  Span<float> weights;    // n * m
  uint32_t m = 0;
};

}  // namespace mien::author
