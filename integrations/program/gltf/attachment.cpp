// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/attachment.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "integrations/program/gltf/surface.h"

namespace mien::gltf {

namespace {

using math::Vec3d;

Vec3d vector(const Float3& v) { return {v[0], v[1], v[2]}; }
Float3 floats(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::vector<Vec3d> vectors(const std::vector<Float3>& values) {
  std::vector<Vec3d> result;
  for (const Float3& value : values) result.push_back(vector(value));
  return result;
}

// Frames of triangles ------------------------------------------------------------------------------

/// Axes at right angles to each other, and a point.
struct Frame {
  Vec3d origin, axes[3];

  Vec3d to_local(const Vec3d& p) const {
    const Vec3d off = p - origin;
    return {dot(off, axes[0]), dot(off, axes[1]), dot(off, axes[2])};
  }
  Vec3d turned(const Vec3d& local) const {
    return axes[0] * local.x + axes[1] * local.y + axes[2] * local.z;
  }
};

/// At the point of the triangle. A triangle without area gets the axes of the world.
Frame frame_at(const std::vector<Vec3d>& positions, const uint32_t* corners,
               const double* weights) {
  const Vec3d a = positions[corners[0]], b = positions[corners[1]], c = positions[corners[2]];
  Frame frame{a * weights[0] + b * weights[1] + c * weights[2], {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const Vec3d normal = cross(b - a, c - a);
  if (!(length(normal) > 0)) return frame;
  frame.axes[0] = (b - a) * (1 / length(b - a));
  frame.axes[2] = normal * (1 / length(normal));
  frame.axes[1] = cross(frame.axes[2], frame.axes[0]);
  return frame;
}

// Parts --------------------------------------------------------------------------------------------

/// Number of the connected part of each vertex.
std::vector<uint32_t> parts_of(const Attachment& attachment, size_t& count) {
  std::vector<uint32_t> above(attachment.positions.size());
  std::iota(above.begin(), above.end(), 0u);
  const auto root = [&](uint32_t v) {
    while (above[v] != v) v = above[v] = above[above[v]];
    return v;
  };
  for (size_t i = 0; i + 2 < attachment.triangles.size(); i += 3) {
    for (size_t k = 1; k < 3; ++k) {
      above[root(attachment.triangles[i + k])] = root(attachment.triangles[i]);
    }
  }
  std::vector<uint32_t> numbers(above.size(), kNone), parts(above.size());
  count = 0;
  for (uint32_t v = 0; v < above.size(); ++v) {
    uint32_t& number = numbers[root(v)];
    if (number == kNone) number = static_cast<uint32_t>(count++);
    parts[v] = number;
  }
  return parts;
}

/// The rotation that best turns `from` to `to`, sums of products of centered points: the eigenvector of Horn's
/// matrix (1987) with the largest eigenvalue, by shifted power iteration.
math::Quaternion best_rotation(const double (&s)[3][3]) {
  const double n[4][4] = {
      {s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
      {s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
      {s[2][0] - s[0][2], s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
      {s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1]}};
  double shift = 0;  // no eigenvalue is below its negative
  for (const auto& row : n) {
    double sum = 0;
    for (const double value : row) sum += std::abs(value);
    shift = std::max(shift, sum);
  }
  double q[4] = {1, 0, 0, 0};  // turns of a face are small
  for (int step = 0; step < 200; ++step) {
    double next[4], squared = 0;
    for (int r = 0; r < 4; ++r) {
      next[r] = shift * q[r];
      for (int c = 0; c < 4; ++c) next[r] += n[r][c] * q[c];
      squared += next[r] * next[r];
    }
    if (!(squared > 0)) break;
    for (int r = 0; r < 4; ++r) q[r] = next[r] / std::sqrt(squared);
  }
  return {q[1], q[2], q[3], q[0]};
}

/// Puts each part where a rotation and a translation of its neutral vertices agree best with `posed`.
void make_rigid(const std::vector<Vec3d>& neutral, const std::vector<uint32_t>& parts, size_t count,
                std::vector<Vec3d>& posed) {
  std::vector<Vec3d> before(count), after(count);
  std::vector<double> sizes(count);
  for (size_t v = 0; v < neutral.size(); ++v) {
    before[parts[v]] += neutral[v];
    after[parts[v]] += posed[v];
    ++sizes[parts[v]];
  }
  for (size_t p = 0; p < count; ++p) {
    before[p] = before[p] * (1 / sizes[p]);
    after[p] = after[p] * (1 / sizes[p]);
    double products[3][3] = {};
    for (size_t v = 0; v < neutral.size(); ++v) {
      if (parts[v] != p) continue;
      const Vec3d a = neutral[v] - before[p], b = posed[v] - after[p];
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) products[r][c] += a[r] * b[c];
      }
    }
    const math::Matrix turn = math::matrix_of({{}, best_rotation(products), {1, 1, 1}});
    for (size_t v = 0; v < neutral.size(); ++v) {
      if (parts[v] != p) continue;
      const Vec3d a = neutral[v] - before[p];
      posed[v] = after[p] + Vec3d{turn.m[0][0] * a.x + turn.m[0][1] * a.y + turn.m[0][2] * a.z,
                                  turn.m[1][0] * a.x + turn.m[1][1] * a.y + turn.m[1][2] * a.z,
                                  turn.m[2][0] * a.x + turn.m[2][1] * a.y + turn.m[2][2] * a.z};
    }
  }
}

// Meshes -------------------------------------------------------------------------------------------

std::vector<Float3> normals_of(const std::vector<Vec3d>& positions,
                               const std::vector<uint32_t>& triangles) {
  std::vector<Vec3d> sums(positions.size());
  for (size_t i = 0; i + 2 < triangles.size(); i += 3) {
    const Vec3d a = positions[triangles[i]];
    const Vec3d normal = cross(positions[triangles[i + 1]] - a, positions[triangles[i + 2]] - a);
    for (size_t k = 0; k < 3; ++k) sums[triangles[i + k]] += normal;
  }
  std::vector<Float3> normals;
  for (const Vec3d& sum : sums) normals.push_back(floats(normalized(sum, Vec3d{0, 1, 0})));
  return normals;
}

constexpr double kLeastMove = 1e-6, kLeastTurn = 1e-2;  // meters, radians

MorphTarget target_of(const std::string& name, float weight, const std::vector<Vec3d>& neutral,
                      const std::vector<Vec3d>& posed, const std::vector<Float3>& neutral_normals,
                      const std::vector<Float3>& normals) {
  MorphTarget target;
  target.name = name;
  target.weight = weight;
  for (uint32_t v = 0; v < neutral.size(); ++v) {
    const Vec3d move = posed[v] - neutral[v];
    const Vec3d turn = vector(normals[v]) - vector(neutral_normals[v]);
    if (length(move) > kLeastMove) {
      target.vertices.push_back(v);
      target.positions.push_back(floats(move));
    }
    if (length(turn) > kLeastTurn) {
      target.normal_vertices.push_back(v);
      target.normals.push_back(floats(turn));
    }
  }
  return target;
}

/// Of the corners' weights together, the heaviest.
void add_skin(const Mesh& base, const uint32_t* corners, const double* shares, Mesh& mesh) {
  std::vector<std::pair<double, uint16_t>> influences;
  for (size_t k = 0; k < 3; ++k) {
    for (uint32_t i = 0; i < base.influences; ++i) {
      const size_t at = size_t{corners[k]} * base.influences + i;
      const double weight = shares[k] * base.weights[at];
      if (!(weight > 0)) continue;
      const auto same = std::find_if(influences.begin(), influences.end(), [&](const auto& other) {
        return other.second == base.joints[at];
      });
      if (same == influences.end()) {
        influences.emplace_back(weight, base.joints[at]);
      } else {
        same->first += weight;
      }
    }
  }
  std::sort(influences.begin(), influences.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  if (influences.size() > base.influences) influences.resize(base.influences);
  double sum = 0;
  for (const auto& influence : influences) sum += influence.first;
  for (uint32_t i = 0; i < base.influences; ++i) {
    const bool has = i < influences.size();
    mesh.joints.push_back(has ? influences[i].second : uint16_t{0});
    mesh.weights.push_back(has ? static_cast<float>(influences[i].first / sum) : 0.0f);
  }
}

/// The mesh of the finest LOD that is nearest to most vertices.
uint32_t find_base(const Scene& scene, const std::vector<Vec3d>& points) {
  std::vector<double> nearest(points.size(), HUGE_VAL);
  std::vector<uint32_t> owner(points.size(), kNone);
  for (const uint32_t m : scene.lods.empty() ? std::vector<uint32_t>{} : scene.lods[0]) {
    const Mesh& mesh = scene.meshes[m];
    if (mesh.triangles.empty()) continue;
    const Surface surface(vectors(mesh.positions), mesh.triangles);
    for (size_t v = 0; v < points.size(); ++v) {
      const double distance = surface.nearest(points[v]).distance;
      if (distance >= nearest[v]) continue;
      nearest[v] = distance;
      owner[v] = m;
    }
  }
  std::vector<size_t> votes(scene.meshes.size());
  for (const uint32_t m : owner) {
    if (m != kNone) ++votes[m];
  }
  const auto most = std::max_element(votes.begin(), votes.end());
  if (most == votes.end() || *most == 0) {
    throw ExportError(MIEN_ERROR_DNA_LAYER, "", "there is no surface to attach a mesh to",
                      "leave out --attach");
  }
  return static_cast<uint32_t>(most - votes.begin());
}

}  // namespace

std::vector<Vec3d> Attached::follow(const std::vector<Vec3d>& base_positions) const {
  std::vector<Vec3d> posed;
  for (size_t v = 0; v < binding.locals.size(); ++v) {
    const Frame frame =
        frame_at(base_positions, binding.corners[v].data(), binding.weights[v].data());
    posed.push_back(frame.origin + frame.turned(binding.locals[v]));
  }
  if (!binding.parts.empty()) make_rigid(binding.neutral, binding.parts, parts, posed);
  return posed;
}

Attached attach(const Attachment& attachment, uint32_t material, Scene& scene) {
  Attached result;
  Attached::Binding& binding = result.binding;
  binding.neutral = vectors(attachment.positions);
  const std::vector<Vec3d>& neutral = binding.neutral;
  result.base = find_base(scene, neutral);
  const Mesh base = scene.meshes[result.base];
  const std::vector<Vec3d> base_positions = vectors(base.positions);
  const Surface surface(base_positions, base.triangles);
  size_t part_count = 0;
  const std::vector<uint32_t> parts = parts_of(attachment, part_count);
  if (attachment.rigid) {
    result.parts = part_count;
    binding.parts = parts;
  }

  std::vector<Vec3d> middles(part_count);
  std::vector<double> sizes(part_count);
  for (size_t v = 0; v < neutral.size(); ++v) {
    const SurfacePoint point = surface.nearest(neutral[v]);
    const uint32_t* corners = &base.triangles[size_t{3} * point.triangle];
    binding.locals.push_back(frame_at(base_positions, corners, point.weights).to_local(neutral[v]));
    binding.corners.push_back({corners[0], corners[1], corners[2]});
    binding.weights.push_back({point.weights[0], point.weights[1], point.weights[2]});
    result.mean += point.distance / double(neutral.size());
    result.max = std::max(result.max, point.distance);
    middles[parts[v]] += neutral[v];
    ++sizes[parts[v]];
  }

  Mesh mesh;
  mesh.name = attachment.name;
  mesh.material = material;
  mesh.positions = attachment.positions;
  mesh.uvs = attachment.uvs;
  mesh.triangles = attachment.triangles;
  mesh.normals = normals_of(neutral, mesh.triangles);
  mesh.influences = base.influences;
  std::vector<SurfacePoint> bound_parts;  // those of the middles, for the skin of rigid parts
  for (size_t p = 0; p < part_count && attachment.rigid; ++p) {
    bound_parts.push_back(surface.nearest(middles[p] * (1 / sizes[p])));
  }
  for (size_t v = 0; v < neutral.size() && base.influences != 0; ++v) {
    if (attachment.rigid) {
      const SurfacePoint& point = bound_parts[parts[v]];
      add_skin(base, &base.triangles[size_t{3} * point.triangle], point.weights, mesh);
    } else {
      add_skin(base, binding.corners[v].data(), binding.weights[v].data(), mesh);
    }
  }
  for (const MorphTarget& target : base.targets) {
    std::vector<Vec3d> moved = base_positions;
    for (size_t i = 0; i < target.vertices.size(); ++i) {
      moved[target.vertices[i]] += vector(target.positions[i]);
    }
    const std::vector<Vec3d> posed = result.follow(moved);
    mesh.targets.push_back(target_of(target.name, target.weight, neutral, posed, mesh.normals,
                                     normals_of(posed, mesh.triangles)));
  }
  mesh.correctives = base.correctives;

  result.mesh = static_cast<uint32_t>(scene.meshes.size());
  for (std::vector<uint32_t>& lod : scene.lods) {
    if (std::find(lod.begin(), lod.end(), result.base) != lod.end()) lod.push_back(result.mesh);
  }
  scene.meshes.push_back(std::move(mesh));
  return result;
}

}  // namespace mien::gltf
