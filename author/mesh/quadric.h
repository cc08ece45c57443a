// SPDX-License-Identifier: MIT
// Sums of squared distances to planes, each with a weight.
#pragma once

#include "runtime/base/vector.h"

namespace mien::author {

struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  Vec3 linear;
  double constant = 0;

  /// `normal` has unit length.
  void add_plane(Vec3 normal, Vec3 point, double weight) {
    const double offset = dot(normal, point);
    xx += weight * normal.x * normal.x;
    xy += weight * normal.x * normal.y;
    xz += weight * normal.x * normal.z;
    yy += weight * normal.y * normal.y;
    yz += weight * normal.y * normal.z;
    zz += weight * normal.z * normal.z;
    linear = linear - normal * (weight * offset);
    constant += weight * offset * offset;
  }
  void add(const Quadric& q) {
    xx += q.xx;
    xy += q.xy;
    xz += q.xz;
    yy += q.yy;
    yz += q.yz;
    zz += q.zz;
    linear = linear + q.linear;
    constant += q.constant;
  }
  double at(Vec3 p) const {
    return p.x * (xx * p.x + 2 * (xy * p.y + xz * p.z)) + p.y * (yy * p.y + 2 * yz * p.z) +
           zz * p.z * p.z + 2 * dot(linear, p) + constant;
  }
};

}  // namespace mien::author
