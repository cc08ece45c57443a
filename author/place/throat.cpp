// SPDX-License-Identifier: MIT
#include "author/place/throat.h"

#include <algorithm>

namespace mien::author {

namespace {

// Part of the height. Human heads have 0.12 to 0.19, the stylized head of this library 0.09 to
// 0.10; the front of a face has 0.07, and meshes without a neck have less.
constexpr double kLeastDepth = 0.085;

struct Point {
  double y, z;
};

/// The part of the segment in each bin.
void enter(Profile& profile, Point a, Point b) {
  if (a.y > b.y) std::swap(a, b);
  const double per_bin = kProfileBins / profile.height;
  const double from = (a.y - profile.low) * per_bin, to = (b.y - profile.low) * per_bin;
  const uint32_t last = kProfileBins - 1;
  const uint32_t first_bin = std::min(last, static_cast<uint32_t>(from > 0 ? from : 0));
  const uint32_t last_bin = std::min(last, static_cast<uint32_t>(to > 0 ? to : 0));
  for (uint32_t bin = first_bin; bin <= last_bin; ++bin) {
    // The highest z of a segment in a bin is at one of the ends of that part.
    for (double edge : {std::max(from, double(bin)), std::min(to, bin + 1.0)}) {
      const double t = to > from ? (edge - from) / (to - from) : 0;
      const double z = a.z + (b.z - a.z) * (t < 0 ? 0 : t > 1 ? 1 : t);
      if (!profile.has[bin] || z > profile.front[bin]) profile.front[bin] = z;
      profile.has[bin] = true;
    }
    if (!(to > from)) {
      profile.front[bin] = std::max(profile.front[bin], std::max(a.z, b.z));
    }
  }
}

}  // namespace

Profile front_profile(const AuthorMesh& mesh, double plane) {
  Profile profile;
  double high = 0;
  bool first = true;
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    if (!mesh.is_skin[v]) continue;
    const double y = mesh.positions[v].y;
    profile.low = first ? y : std::min(profile.low, y);
    high = first ? y : std::max(high, y);
    first = false;
  }
  profile.height = high - profile.low;
  if (!(profile.height > 0)) return profile;
  for (size_t t = 0; t + 2 < mesh.triangles.count; t += 3) {
    const uint32_t* corner = mesh.triangles.data + t;
    if (!mesh.is_skin[corner[0]]) continue;
    Point points[6];
    uint32_t count = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = mesh.positions[corner[k]], b = mesh.positions[corner[(k + 1) % 3]];
      const double da = a.x - plane, db = b.x - plane;
      if (da == 0) points[count++] = {a.y, a.z};
      if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
        const double s = da / (da - db);
        points[count++] = {a.y + (b.y - a.y) * s, a.z + (b.z - a.z) * s};
      }
    }
    for (uint32_t i = 0; i + 1 < count; ++i) enter(profile, points[i], points[i + 1]);
  }
  return profile;
}

namespace {

/// The tip of the nose, or kProfileBins.
uint32_t foremost_bin(const Profile& profile) {
  uint32_t nose = kProfileBins;
  for (uint32_t bin = kProfileBins * 3 / 10; bin < kProfileBins * 9 / 10; ++bin) {
    if (!profile.has[bin]) continue;
    if (nose == kProfileBins || profile.front[bin] > profile.front[nose]) nose = bin;
  }
  return nose;
}

}  // namespace

Profile closed_profile(const AuthorMesh& mesh, double plane) {
  // Of the half width of the head at the nose: beyond the corners of a mouth, but on the chin.
  constexpr double kBeside = 0.42;
  Profile profile = front_profile(mesh, plane);
  const uint32_t nose = foremost_bin(profile);
  if (nose == kProfileBins) return profile;
  const double bin_height = profile.height / kProfileBins, y = profile.y(nose);
  double half_width = 0;
  for (uint32_t v = 0; v < mesh.positions.count; ++v) {
    const Vec3 p = mesh.positions[v];
    if (!mesh.is_skin[v] || std::abs(p.y - y) > 2 * bin_height) continue;
    half_width = std::max(half_width, std::abs(p.x - plane));
  }
  for (const int side : {1, -1}) {
    const Profile beside = front_profile(mesh, plane + side * kBeside * half_width);
    for (uint32_t bin = 0; bin < nose; ++bin) {
      if (!beside.has[bin] || !profile.has[bin]) continue;
      profile.front[bin] = std::max(profile.front[bin], beside.front[bin]);
    }
  }
  return profile;
}

Throat find_throat(const Profile& profile, const Vec3* tip) {
  Throat throat;
  throat.height = profile.height;
  // The ragged edge of a cropped mesh could be taken for a notch.
  const uint32_t lowest = (kProfileBins * 3 + 99) / 100;
  uint32_t nose = foremost_bin(profile);
  if (tip && profile.height > 0) {
    const double at = (tip->y - profile.low) / profile.height * kProfileBins;
    nose = at > 0 ? std::min(kProfileBins - 1, static_cast<uint32_t>(at)) : 0;
  }
  if (nose == kProfileBins) return throat;
  throat.nose_y = tip ? tip->y : profile.y(nose);
  throat.nose_z = tip ? tip->z : profile.front[nose];

  // The hull from the nose down, on the side of larger z.
  uint32_t hull[kProfileBins];
  uint32_t count = 0;
  const auto at = [&](uint32_t bin) { return Point{profile.y(bin), profile.front[bin]}; };
  for (uint32_t bin = nose + 1; bin-- > lowest;) {
    if (!profile.has[bin]) continue;
    while (count >= 2) {
      const Point a = at(hull[count - 2]), b = at(hull[count - 1]), c = at(bin);
      // b stays if it lies in front of the line from a to c.
      const double z = a.z + (c.z - a.z) * (b.y - a.y) / (c.y - a.y);
      if (b.z > z) break;
      --count;
    }
    hull[count++] = bin;
  }
  if (count < 2) return throat;
  throat.has_profile = true;
  for (uint32_t i = 0; i + 1 < count; ++i) {
    const Point a = at(hull[i]), b = at(hull[i + 1]);
    const double run = a.y - b.y;
    for (uint32_t bin = hull[i]; bin > hull[i + 1]; --bin) {
      if (!profile.has[bin]) continue;
      const Point p = at(bin);
      const double on_line = a.z + (b.z - a.z) * (a.y - p.y) / run;
      const double depth = on_line - p.z;
      if (!(depth > throat.depth)) continue;
      throat.depth = depth;
      throat.y = p.y;
      throat.z = p.z;
    }
  }
  throat.found = throat.depth > kLeastDepth * throat.height;
  return throat;
}

}  // namespace mien::author
