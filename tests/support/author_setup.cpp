// SPDX-License-Identifier: MIT
#include "tests/support/author_setup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "author/generate/head/shapes.h"
#include "tests/support/head_lods.h"

namespace mien::author {

namespace {

template <class T>
Span<const T> span(const std::vector<T>& items) {
  return {items.data(), items.size()};
}
Name name_of(const std::string& s) { return {s.data(), s.size()}; }

}  // namespace

uint32_t AuthorSetup::add_vertex(Vec3 p) {
  positions.push_back(p);
  return static_cast<uint32_t>(positions.size() - 1);
}

void AuthorSetup::add_face(const std::vector<uint32_t>& vertices) {
  corners.insert(corners.end(), vertices.begin(), vertices.end());
  face_starts.push_back(static_cast<uint32_t>(corners.size()));
  for (size_t i = 2; i < vertices.size(); ++i) {
    triangles.insert(triangles.end(), {vertices[0], vertices[i - 1], vertices[i]});
  }
}

void AuthorSetup::add_bone(const std::string& name, Vec3 at, BoneKind kind, uint32_t parent) {
  Bone bone;
  bone.position = at;
  bone.parent = parent;
  bone.mirror = static_cast<uint32_t>(bones.size());
  bone.kind = kind;
  bone_names.push_back(name);
  bones.push_back(bone);
}

void AuthorSetup::add_trunk() {
  add_bone("root", {0, -20, 0}, BoneKind::kRoot, 0);
  add_bone("neck", {0, -12, -1}, BoneKind::kNeck, 0);
  add_bone("head", {0, -5, -1}, BoneKind::kHead, 1);
  add_bone("face", {0, -5, -1}, BoneKind::kFace, 2);
}

void AuthorSetup::weigh(uint32_t m, uint32_t kept, std::vector<uint16_t>& out_joints,
                        std::vector<float>& out_weights) const {
  out_joints.assign(positions.size() * m, 0);
  out_weights.assign(positions.size() * m, 0);
  const uint32_t first = placement.first_facial;
  for (size_t v = 0; v < positions.size(); ++v) {
    std::vector<std::pair<double, uint16_t>> near;
    for (uint32_t j = first; j < first + kept; ++j) {
      near.push_back({length(positions[v] - bones[j].position) + 1e-6, static_cast<uint16_t>(j)});
    }
    std::sort(near.begin(), near.end());
    const double radius = near.size() > m ? near[m].first * 1.0001 : near.back().first * 2;
    const size_t count = std::min<size_t>(m, near.size());
    double sum = 0;
    std::vector<double> w(count);
    for (size_t i = 0; i < count; ++i) {
      const double x = (radius - near[i].first) / (radius * near[i].first);
      w[i] = x * x;
      sum += w[i];
    }
    for (size_t i = 0; i < count; ++i) {
      out_joints[v * m + i] = near[i].second;
      out_weights[v * m + i] = static_cast<float>(w[i] / sum);
    }
  }
}

void AuthorSetup::finish(uint32_t m) {
  welded.clear();
  for (uint32_t v = 0; v < positions.size(); ++v) welded.push_back(v);
  component.assign(positions.size(), 0);
  is_skin.assign(positions.size(), 1);
  shapes.clear();
  moving.assign(displacements.size(), {});
  for (size_t s = 0; s < displacements.size(); ++s) {
    for (uint32_t v = 0; v < positions.size(); ++v) {
      const Vec3f d = displacements[s][v];
      if (d.x != 0 || d.y != 0 || d.z != 0) moving[s].push_back(v);
    }
    shapes.push_back({name_of(shape_names[s]), span(displacements[s]), span(moving[s])});
  }
  if (parts.empty()) {
    parts.push_back({{"head", 4},
                     0,
                     static_cast<uint32_t>(positions.size()),
                     0,
                     static_cast<uint32_t>(face_starts.size() - 1)});
  }
  for (size_t j = 0; j < bones.size(); ++j) bones[j].name = name_of(bone_names[j]);
  uint32_t facial = 0, first = 0;
  for (uint32_t j = 0; j < bones.size(); ++j) {
    if (bones[j].kind != BoneKind::kFacial) continue;
    if (facial == 0) first = j;
    bones[j].rank = facial++;
  }
  if (lod_facial_counts.empty()) lod_facial_counts.push_back(facial);
  placement.bones = span(bones);
  placement.first_facial = first;
  placement.facial_count = facial;
  placement.lod_facial_counts = span(lod_facial_counts);
  placement.mask = span(mask);
  mesh.positions = span(positions);
  mesh.face_starts = span(face_starts);
  mesh.corners = span(corners);
  mesh.triangles = span(triangles);
  mesh.welded = span(welded);
  mesh.component = span(component);
  mesh.component_count = 1;
  mesh.is_skin = span(is_skin);
  mesh.parts = span(parts);
  mesh.shapes = span(shapes);
  Vec3 low = positions[0], high = positions[0];
  for (const Vec3& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  mesh.diagonal = length(high - low);
  if (joints.empty()) weigh(m, facial, joints, weight_values);
  weights = {{joints.data(), joints.size()}, {weight_values.data(), weight_values.size()}, m};
}

void make_author_head(uint32_t lod, uint32_t bones, uint32_t influences, uint32_t lods,
                      AuthorSetup& out) {
  const head::Shapes shapes;
  const head::HalfMesh& half = head_lods(head::Part::kHead).at[lod];
  std::vector<uint32_t> twin, left;  // vertex of the other half; of each vertex, its left one
  for (uint32_t v = 0; v < half.vertices.count(); ++v) {
    left.push_back(out.add_vertex(half.vertices[v].position));
  }
  for (uint32_t v = 0; v < half.vertices.count(); ++v) {
    const Vec3 p = half.vertices[v].position;
    twin.push_back(half.on_plane(v) ? v : out.add_vertex({-p.x, p.y, p.z}));
    if (!half.on_plane(v)) left.push_back(v);
  }
  for (const head::Face& f : half.faces.span()) {
    std::vector<uint32_t> here(f.corners, f.corners + f.count), there;
    out.add_face(here);
    for (uint32_t i = f.count; i-- > 0;) there.push_back(twin[f.corners[i]]);
    out.add_face(there);
  }
  for (uint32_t s = 0; s < head::kArkitCount; ++s) {
    out.add_shape(head::kExpressions[s].name, [&](uint32_t v) -> Vec3 {
      const head::Vertex& at = half.vertices[left[v]];
      if (at.carrier != head::Carrier::kSkin) return {};
      if (v < half.vertices.count()) return shapes.displacement(s, at);
      const Vec3 d = shapes.displacement(shapes.twin(s), at);
      return {-d.x, d.y, d.z};
    });
  }
  // Bones: each the farthest place from those before it, where motion counts.
  std::vector<double> motion(out.positions.size()), far(out.positions.size(), 1e9);
  for (const std::vector<Vec3f>& shape : out.displacements) {
    for (size_t v = 0; v < shape.size(); ++v) {
      motion[v] += std::abs(double{shape[v].x}) + std::abs(double{shape[v].y}) +
                   std::abs(double{shape[v].z});
    }
  }
  out.add_trunk();
  for (uint32_t v = 0; v < motion.size(); ++v) {
    if (motion[v] > 0.01) out.mask.push_back(v);
  }
  for (uint32_t j = 0; j < bones; ++j) {
    uint32_t best = out.mask[0];
    for (uint32_t v : out.mask) {
      if (far[v] * std::sqrt(motion[v]) > far[best] * std::sqrt(motion[best])) best = v;
    }
    for (uint32_t v : out.mask) {
      far[v] = std::min(far[v], length(out.positions[v] - out.positions[best]));
    }
    out.add_bone("FACIAL_" + std::to_string(j), out.positions[best], BoneKind::kFacial, 3);
  }
  for (uint32_t l = 0; l < lods; ++l) out.lod_facial_counts.push_back(bones >> l);
  out.finish(influences);
}

}  // namespace mien::author
