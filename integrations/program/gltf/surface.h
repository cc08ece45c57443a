// SPDX-License-Identifier: MIT
// The nearest point of a surface of triangles.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "integrations/program/math/vector.h"

namespace mien::gltf {

struct SurfacePoint {
  uint32_t triangle = 0;
  double weights[3] = {1, 0, 0};  // of its corners
  double distance = 0;
};

class Surface {
 public:
  /// `triangles` are three positions each; there is at least one.
  Surface(std::vector<math::Vec3d> positions, std::vector<uint32_t> triangles);

  SurfacePoint nearest(const math::Vec3d& point) const;

 private:
  uint64_t cell_of(int64_t x, int64_t y, int64_t z) const;
  void see(uint32_t triangle, const math::Vec3d& point, SurfacePoint& best) const;

  std::vector<math::Vec3d> positions_;
  std::vector<uint32_t> triangles_;
  double size_ = 1;  // of a cell
  math::Boxd box_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
};

}  // namespace mien::gltf
