// SPDX-License-Identifier: MIT
#include "author/fit/procrustes.h"

#include "author/mesh/eigenvectors.h"

namespace mien::author {

void closest_rotation(const Vec3 map[3], double max_half_sine, Vec3 out[3]) {
  const Vec3 &a = map[0], &b = map[1], &c = map[2];
  double form[4][4] = {{a.x + b.y + c.z, c.y - b.z, a.z - c.x, b.x - a.y},
                       {c.y - b.z, a.x - b.y - c.z, a.y + b.x, a.z + c.x},
                       {a.z - c.x, a.y + b.x, b.y - a.x - c.z, b.z + c.y},
                       {b.x - a.y, a.z + c.x, b.z + c.y, c.z - a.x - b.y}};
  double vectors[4][4];
  diagonalize(form, vectors);
  int best = 0;
  for (int i = 1; i < 4; ++i) {
    if (form[i][i] > form[best][best]) best = i;
  }
  double q[4];
  for (int k = 0; k < 4; ++k) q[k] = vectors[0][best] < 0 ? -vectors[k][best] : vectors[k][best];
  const double half_sine = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (half_sine > max_half_sine) {
    q[0] = std::sqrt(1 - max_half_sine * max_half_sine);
    for (int k = 1; k < 4; ++k) q[k] *= max_half_sine / half_sine;
  }
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  out[0] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)};
  out[1] = {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)};
  out[2] = {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
}

Vec3 euler_angles(const Vec3 rotation[3]) {
  const Vec3 &a = rotation[0], &b = rotation[1], &c = rotation[2];
  const double across = std::sqrt(a.x * a.x + b.x * b.x);
  // Gimbal lock: x and z turn about the same axis, and z is set to 0.
  const double x = across > 1e-9 ? exact_atan2(c.y, c.z) : exact_atan2(-b.z, b.y);
  const double z = across > 1e-9 ? exact_atan2(b.x, a.x) : 0;
  return Vec3{x, exact_atan2(-c.x, across), z} * (180 / kPi);
}

}  // namespace mien::author
