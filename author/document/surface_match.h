// SPDX-License-Identifier: MIT
// Where the positions of one mesh lie on another, and how space moves with a surface.
#pragma once

#include "author/document/pose.h"
#include "author/mesh/point_tree.h"
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

  /// The interpolated value of a position's place.
  Vec3 at(size_t position, Span<const Vec3> values) const {
    const Place& p = places[position];
    return values[p.positions[0]] * p.weights[0] + values[p.positions[1]] * p.weights[1] +
           values[p.positions[2]] * p.weights[2];
  }
};

bool positions_of(const dna::Mesh& mesh, Arena& arena, Span<Vec3>& out);

/// `positions` replace those of `on`, which has triangles. `of` has other faces. False if memory ran out.
/// Needs texture coordinates of both for kUv.
bool match_surfaces(Span<const Vec3> of_positions, const dna::Mesh& of,
                    Span<const Vec3> on_positions, const dna::Mesh& on, Match match, Arena& arena,
                    SurfaceMatch& out);

/// True if the mesh has a triangle, and texture coordinates if they are needed.
bool can_match(const dna::Mesh& mesh, Match match);

/// A rotation, uniform scale and shift.
struct Similarity {
  Matrix3 turn = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // v * turn
  double scale = 1;
  Vec3 from, to;  // p -> (p - from) * scale * turn + to

  bool is_identity() const {
    return scale == 1 && is_zero(from) && is_zero(to) && turn.m[0][0] == 1 && turn.m[1][1] == 1 &&
           turn.m[2][2] == 1;
  }
  Vec3 direction(Vec3 v) const { return turned(v, turn) * scale; }
  Vec3 operator()(Vec3 p) const { return direction(p - from) + to; }
};

struct Bounds {
  Vec3 low, high;
};

/// The search for the points near one place begins with those near the place before. Results do not depend on it.
struct WarpHint {
  Vec3 place;
  double radius = -1;  // of the ball that was searched; below 0: none

  uint32_t from = 0,
           to = 0;  // points of the tree, the box around them, and whether space stays there
  Bounds bounds;
  bool stays = false;
};

/// Moves space with some points: near a point as the point moves, in between and beyond by the similarity
/// that fits the nearest ones best, weighted by their distance. A rotation, scale and shift of all points
/// is reproduced exactly. Space whose nearest points all stay where they are stays, too.
class Warp {
 public:
  /// Keeps references to both, which are not empty. False if memory ran out.
  bool build(Span<const Vec3> before, Span<const Vec3> after, Arena& arena);

  Similarity at(Vec3 place, WarpHint& hint) const;
  Similarity at(Vec3 place) const {
    WarpHint hint;
    return at(place, hint);
  }

  /// True if at(place) is known to be the identity, in less time.
  bool stays(Vec3 place, WarpHint& hint) const;

 private:
  Span<const Vec3> before_, after_;
  PointTree tree_;
  Span<Bounds> moved_;  // boxes around neighboring points that move
  bool mostly_moves_ = false;
};

}  // namespace mien::author
