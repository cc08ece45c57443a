// SPDX-License-Identifier: MIT
// Where the face ends and the neck begins: the deepest notch below the nose in the profile of the
// head.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

constexpr uint32_t kProfileBins = 96;

/// The front of the section of the skin with the plane x = c, by height.
struct Profile {
  double low = 0, height = 0;   // of the skin
  bool has[kProfileBins] = {};  // the section reaches this bin
  double front[kProfileBins] = {};

  double y(uint32_t bin) const { return low + height * (bin + 0.5) / kProfileBins; }
};
Profile front_profile(const AuthorMesh& mesh, double plane);
/// The same for the plane of symmetry, without the gap of an open mouth: where the skin beside the mouth is farther in
/// front, it counts.
Profile closed_profile(const AuthorMesh& mesh, double plane);

struct Throat {
  bool found = false;   // deep enough to be one
  double y = 0, z = 0;  // the deepest point of the notch
  double depth = 0;     // in z, behind the hull of the profile
  double height = 0;    // of the skin
  double nose_y = 0, nose_z = 0;
  bool has_profile = false;  // a nose tip with something below it

  NeckCut cut() const {
    NeckCut out;
    out.exists = found;
    out.y = y;
    out.z = z;
    return out;
  }
};
/// A notch of less than 8.5 % of the height does not count as a throat. `nose`: its tip, if it is known.
Throat find_throat(const Profile& profile, const Vec3* nose = nullptr);

}  // namespace mien::author
