// SPDX-License-Identifier: MIT
#include "integrations/program/render/noise.h"

#include <cstdint>

namespace mien::render {

using namespace math;

namespace {

uint32_t hash_cell(int x, int y, int z) {
  uint32_t h = uint32_t(x) * 73856093u ^ uint32_t(y) * 19349663u ^ uint32_t(z) * 83492791u;
  h = (h ^ h >> 16) * 2246822519u;
  h = (h ^ h >> 13) * 3266489917u;
  return h ^ h >> 16;
}

/// 0 ... 1 from 8 bits of a hash.
float share_of_hash(uint32_t hash, int byte) {
  return float(hash >> (8 * byte) & 255) * (1.0f / 255);
}

}  // namespace

float noise(Vec3 p) {
  const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const int x = int(fx), y = int(fy), z = int(fz);
  const float u = eased(p.x - fx), v = eased(p.y - fy), w = eased(p.z - fz);
  const auto at = [&](int i, int j, int k) {
    return float(hash_cell(x + i, y + j, z + k) & 65535) * (2.0f / 65535) - 1;
  };
  const auto along_x = [&](int j, int k) { return at(0, j, k) + (at(1, j, k) - at(0, j, k)) * u; };
  const float low = along_x(0, 0) + (along_x(1, 0) - along_x(0, 0)) * v;
  const float high = along_x(0, 1) + (along_x(1, 1) - along_x(0, 1)) * v;
  return low + (high - low) * w;
}

float spots(Vec3 p, float radius, float share) {
  const float fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  // Neighbors only where their spots reach; the margin is for rounding.
  const float reach = radius + 0.01f;
  const auto first = [reach](float within) { return within < reach ? -1 : 0; };
  const auto last = [reach](float within) { return 1 - within < reach ? 1 : 0; };
  const int left = first(p.x - fx), right = last(p.x - fx);
  const int low = first(p.y - fy), high = last(p.y - fy);
  const int back = first(p.z - fz), front = last(p.z - fz);
  float most = 0;
  for (int k = back; k <= front; ++k) {
    for (int j = low; j <= high; ++j) {
      for (int i = left; i <= right; ++i) {
        const uint32_t h = hash_cell(int(fx) + i, int(fy) + j, int(fz) + k);
        if (share_of_hash(h, 3) >= share) continue;
        const Vec3 d =
            Vec3{fx + float(i) + share_of_hash(h, 0), fy + float(j) + share_of_hash(h, 1),
                 fz + float(k) + share_of_hash(h, 2)} -
            p;
        const float t = 1 - dot(d, d) / (radius * radius);
        most = std::max(most, t);
      }
    }
  }
  return most;
}

}  // namespace mien::render
