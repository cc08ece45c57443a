// SPDX-License-Identifier: MIT
// Where the positions of one mesh lie on another.
#pragma once

#include "author/document/pose.h"
#include "runtime/base/arena.h"

namespace mien::author {

/// How meshes are compared.
enum class Match : uint32_t {
  kSurface,  // the nearest place in space
  kUv,       // the nearest place in the texture
};

/// For each position of a mesh a place on a triangle of another.
struct SurfaceMatch {
  struct Place {
    uint32_t positions[3];
    double weights[3];
    double distance;  // in space or in the texture
  };
  Span<Place> places;
  bool by_number = false;  // position v lies on position v of the other mesh

  /// The interpolated value of a position's place.
  Vec3 at(size_t position, Span<const Vec3> values) const {
    const Place& p = places[position];
    return values[p.positions[0]] * p.weights[0] + values[p.positions[1]] * p.weights[1] +
           values[p.positions[2]] * p.weights[2];
  }
};

bool positions_of(const dna::Mesh& mesh, Arena& arena, Span<Vec3>& out);

/// Each position lies on the one of the same number. False if memory ran out.
bool match_by_number(size_t positions, Arena& arena, SurfaceMatch& out);

/// `positions` replace those of `on`, which has triangles. `of` has other faces. False if memory ran out.
/// Needs texture coordinates of both for kUv.
bool match_surfaces(Span<const Vec3> of_positions, const dna::Mesh& of,
                    Span<const Vec3> on_positions, const dna::Mesh& on, Match match, Arena& arena,
                    SurfaceMatch& out);

/// True if the mesh has a triangle, and texture coordinates if they are needed.
bool can_match(const dna::Mesh& mesh, Match match);

}  // namespace mien::author
