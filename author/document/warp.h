// SPDX-License-Identifier: MIT
// How space moves with a surface.
#pragma once

#include "author/document/pose.h"
#include "author/mesh/point_tree.h"
#include "runtime/base/arena.h"

namespace mien::author {

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

/// The search for the points near one place begins with those near the place before. Results do not depend on it.
struct WarpHint {
  Vec3 place;
  double radius = -1;  // of the ball that was searched; below 0: none

  uint32_t from = 0,
           to = 0;  // points of the tree, the box around them, and whether space stays there
  Box bounds;
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
  Span<Box> moved_;  // boxes around neighboring points that move
  bool mostly_moves_ = false;
};

}  // namespace mien::author
