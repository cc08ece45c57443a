// SPDX-License-Identifier: MIT
// The rotation that comes closest to a linear map.
#pragma once

#include "author/base/joint_motion.h"

namespace mien::author {

/// The rotation R with the largest trace of transpose(R) * `map`, turned back to `max_half_sine` =
/// sin(angle / 2) if it turns further; the identity if `map` is zero. Rows of `map`. By the unit
/// quaternion with the largest value of a quadratic form (B. K. P. Horn, "Closed-form solution of
/// absolute orientation using unit quaternions", 1987).
void closest_rotation(const Vec3 map[3], double max_half_sine, Vec3 out[3]);

/// Angles in degrees of rotations about x, then y, then z, as motion() takes them.
Vec3 euler_angles(const Vec3 rotation[3]);

}  // namespace mien::author
