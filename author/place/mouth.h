// SPDX-License-Identifier: MIT
// Finds the mouth by the section of the skin in the middle: a hole, or where the section goes inside and
// comes back.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

struct Mouth {
  bool found = false;
  bool is_hole = false;  // lips are borders of the skin, without a cavity behind them
  Vec3 upper, lower;     // lips in the middle plane, where they are in front
  Vec3 left, right;      // corners
  Vec3 chin;             // foremost and lowest below the lower lip
  double depth = 0;      // of the cavity, a share of the distance from the nose to the floor
};

/// Where to look: below the nose, above `floor`, in front of `back`.
struct MouthSearch {
  double plane = 0;  // x of the plane of symmetry
  double nose_y = 0, nose_z = 0;
  double floor = 0;       // y of the throat, or of the lower end of the mesh
  double half_width = 0;  // of the face
};

/// A closed mouth without a slit is not found. False if memory ran out.
bool find_mouth(const AuthorMesh& mesh, const MouthSearch& search, Arena& scratch, Mouth& out);

}  // namespace mien::author
