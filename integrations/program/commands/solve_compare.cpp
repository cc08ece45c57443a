// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include "integrations/program/commands/solve_landmarks.h"

namespace mien::cli {

namespace {

using math::load3;
using math::Vec3;

constexpr float kSameWay = 0.5f;  // cosine of 60 degrees

/// rotation * p, or with the rotation transposed.
Vec3 turn(const float* rotation, Vec3 p, bool back) {
  const float in[3] = {p.x, p.y, p.z};
  float out[3] = {};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) out[back ? c : r] += rotation[3 * r + c] * in[back ? r : c];
  }
  return {out[0], out[1], out[2]};
}

MienFitCamera camera_of(const SolvedTake& take, const SolveTarget& target, size_t f) {
  MienFitCamera camera = *target.camera;
  const SolvedFrame& frame = take.frames[f];
  if (take.rigid) {
    std::copy_n(frame.rotation, 9, camera.rotation);
    std::copy_n(frame.translation, 3, camera.translation);
    if (frame.focal[0] > 0) std::copy_n(frame.focal, 2, camera.focal);
  } else if (!knows_rotation(camera)) {
    for (const int k : {0, 4, 8}) camera.rotation[k] = 1;
  }
  return camera;
}

/// Compares a landmark in an image. False if it is behind the camera.
bool compare_image(const MienFitCamera& camera, const float* image, SolvedMark& mark) {
  const Vec3 moved = load3(camera.translation, 0);
  const Vec3 seen = turn(camera.rotation, mark.solved, false) + moved;
  if (!(seen.z > 0)) return false;
  const float x = (image[0] - camera.center[0]) / camera.focal[0];
  const float y = (image[1] - camera.center[1]) / camera.focal[1];
  mark.distance =
      std::hypot(camera.focal[0] * (seen.x / seen.z - x), camera.focal[1] * (seen.y / seen.z - y));
  mark.target = turn(camera.rotation, Vec3{x, y, 1} * seen.z - moved, true);
  return true;
}

/// The place of a triangle nearest to p (C. Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 nearest_of_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const float d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  const float va = d3 * d6 - d5 * d4, along = d4 - d3, back = d5 - d6;
  if (va <= 0 && along >= 0 && back >= 0) return b + (c - b) * (along / (along + back));
  const float sum = va + vb + vc;
  return sum > 0 ? a + ab * (vb / sum) + ac * (vc / sum) : a;
}

/// Positions by the cells of a grid that they are in.
class PositionGrid {
 public:
  PositionGrid(const SurfaceMesh& mesh, float cell) : cell_(cell) {
    for (uint32_t p = 0; p < mesh.positions.size() / 3; ++p) {
      const Vec3 at = load3(mesh.positions.data(), p);
      cells_[key(index(at.x), index(at.y), index(at.z))].push_back(p);
    }
  }

  /// Calls use(position) for those that may be within a cell's size of the box. Of boxes of more than ten cells along
  /// an axis it does not: no triangle of a face is so large.
  template <class Use>
  void around(const math::Box& box, const Use& use) const {
    int low[3], high[3];
    for (int k = 0; k < 3; ++k) {
      low[k] = index(box.min[k] - cell_);
      high[k] = index(box.max[k] + cell_);
      if (high[k] - low[k] > kMostCells) return;
    }
    for (int x = low[0]; x <= high[0]; ++x) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int z = low[2]; z <= high[2]; ++z) {
          const auto found = cells_.find(key(x, y, z));
          if (found == cells_.end()) continue;
          for (const uint32_t p : found->second) use(p);
        }
      }
    }
  }

 private:
  static constexpr int kMostCells = 12;  // with one on each side

  int index(float v) const {
    return static_cast<int>(std::clamp(std::floor(v / cell_), -1e6f, 1e6f));
  }
  static uint64_t key(int x, int y, int z) {
    const auto part = [](int v) { return static_cast<uint64_t>(v + (1 << 20)) & 0x1FFFFF; };
    return part(x) << 42 | part(y) << 21 | part(z);
  }

  float cell_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cells_;
};

/// Positions on an edge that only one triangle has; those in the same place are one, as along texture seams.
std::vector<bool> find_border(const SurfaceMesh& surface) {
  const size_t count = surface.positions.size() / 3;
  std::map<std::array<float, 3>, uint32_t> places;
  std::vector<uint32_t> merged(count);
  for (uint32_t p = 0; p < count; ++p) {
    const Vec3 at = load3(surface.positions.data(), p);
    merged[p] = places.try_emplace({at.x, at.y, at.z}, p).first->second;
  }
  std::unordered_map<uint64_t, uint32_t> uses;
  const auto edge = [&](size_t i) {
    const size_t next = i % 3 == 2 ? i - 2 : i + 1;
    const auto [a, b] = std::minmax(merged[surface.triangles[i]], merged[surface.triangles[next]]);
    return std::array<uint32_t, 2>{a, b};
  };
  const auto key_of = [](const std::array<uint32_t, 2>& e) { return uint64_t{e[0]} << 32 | e[1]; };
  for (size_t i = 0; i < surface.triangles.size(); ++i) ++uses[key_of(edge(i))];
  std::vector<bool> border(count);
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    const std::array<uint32_t, 2> e = edge(i);
    if (uses[key_of(e)] == 1) border[e[0]] = border[e[1]] = true;
  }
  for (size_t p = 0; p < count; ++p) border[p] = border[merged[p]];
  return border;
}

}  // namespace

std::vector<Vec3> outward_normals(const SurfaceMesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size() / 3);
  double volume = 0;
  for (size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    Vec3 corners[3];
    for (size_t k = 0; k < 3; ++k) corners[k] = load3(mesh.positions.data(), mesh.triangles[t + k]);
    const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    for (size_t k = 0; k < 3; ++k) normals[mesh.triangles[t + k]] += normal;
    // Of the mesh about its first position: an open one has none about itself.
    volume += static_cast<double>(dot(normal, corners[0] - load3(mesh.positions.data(), 0)));
  }
  for (Vec3& normal : normals) {
    const float size = length(normal);
    if (size > 0) normal = normal * ((volume < 0 ? -1 : 1) / size);
  }
  return normals;
}

Vec3 place_target(const SolvedFrame& frame, Vec3 place) {
  return turn(frame.rotation, place - load3(frame.translation, 0), true);
}

std::vector<SolvedMark> compare_landmarks(const SolvedTake& take, const SolveTarget& target,
                                          size_t f, const float* row, const PosedMesh& posed) {
  const bool images = target.kind == TargetKind::kLandmarks2;
  const size_t width = images ? 2 : 3;
  const SolvedFrame& frame = take.frames[f];
  std::vector<SolvedMark> marks;
  std::map<uint32_t, const float*> meshes;
  for (const MienSolvePoint& point : target.points) meshes[point.mesh] = nullptr;
  for (auto& [mesh, positions] : meshes) positions = posed(mesh);
  for (size_t i = 0; i < target.points.size(); ++i) {
    const float* const from = row + i * width;
    if (!std::all_of(from, from + width, [](float v) { return std::isfinite(v); })) continue;
    SolvedMark mark;
    mark.point = static_cast<uint32_t>(i);
    const float* const positions = meshes[target.points[i].mesh];
    for (int k = 0; k < 3; ++k) {
      mark.solved += load3(positions, target.points[i].positions[k]) * target.points[i].weights[k];
    }
    // Another person's landmarks are compared with theirs, and drawn where they are on the rig.
    const Vec3 offset =
        target.point_offsets.empty() ? Vec3{} : load3(target.point_offsets.data(), i);
    mark.solved += offset;
    if (images) {
      if (!compare_image(camera_of(take, target, f), from, mark)) continue;
    } else {
      mark.target = place_target(frame, load3(from, 0));
      mark.distance = length(mark.target - mark.solved);
    }
    mark.solved = mark.solved - offset;
    mark.target = mark.target - offset;
    marks.push_back(mark);
  }
  return marks;
}

std::vector<float> spread_distances(const std::vector<SolvedMark>& marks, const float* positions,
                                    size_t count) {
  std::vector<float> all(count, NAN), radii;
  for (const SolvedMark& mark : marks) {
    float nearest = INFINITY;
    for (const SolvedMark& other : marks) {
      const float d = length(mark.solved - other.solved);
      if (d > 0) nearest = std::min(nearest, d);
    }
    radii.push_back(nearest);
  }
  if (radii.empty()) return all;
  std::vector<float> sorted = radii;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  // Where landmarks are sparse, each stands for more of the skin; at least for what the middle one does.
  const float median = sorted[sorted.size() / 2];
  if (!std::isfinite(median)) return all;  // all are in one place
  for (float& radius : radii) radius = std::max(radius, median);
  for (size_t p = 0; p < count; ++p) {
    const Vec3 at = load3(positions, p);
    float sum = 0, weights = 0, nearest = INFINITY;
    for (size_t m = 0; m < marks.size(); ++m) {
      const float share = length(marks[m].solved - at) / radii[m];
      const float weight = std::exp(-share * share);
      sum += weight * marks[m].distance;
      weights += weight;
      nearest = std::min(nearest, share);
    }
    if (nearest < 1.5f) all[p] = sum / weights;
  }
  return all;
}

std::vector<float> find_surface_distances(const SurfaceMesh& mesh, const SurfaceMesh& surface,
                                          float reach) {
  const std::vector<Vec3> own = outward_normals(mesh), theirs = outward_normals(surface);
  const PositionGrid grid(mesh, reach);
  const std::vector<bool> border = find_border(surface);
  std::vector<float> all(own.size(), NAN);
  std::vector<bool> beyond(own.size());  // the nearest place is at a border
  for (size_t t = 0; t + 2 < surface.triangles.size(); t += 3) {
    Vec3 corners[3], normal;
    math::Box box;
    bool at_border = false;
    for (size_t k = 0; k < 3; ++k) {
      at_border = at_border || border[surface.triangles[t + k]];
      corners[k] = load3(surface.positions.data(), surface.triangles[t + k]);
      normal += theirs[surface.triangles[t + k]];
      box.add(corners[k]);
    }
    const float least = kSameWay * length(normal);
    if (box.empty() || !(least > 0)) continue;
    grid.around(box, [&](uint32_t p) {
      if (dot(normal, own[p]) < least) return;
      const Vec3 at = load3(mesh.positions.data(), p);
      const float d = length(at - nearest_of_triangle(at, corners[0], corners[1], corners[2]));
      if (!(d <= reach) || d >= all[p]) return;
      all[p] = d;
      beyond[p] = at_border;
    });
  }
  for (size_t p = 0; p < all.size(); ++p) {
    if (beyond[p]) all[p] = NAN;
  }
  return all;
}

}  // namespace mien::cli
