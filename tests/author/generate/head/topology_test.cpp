// SPDX-License-Identifier: MIT
// The quads of the skin: loops around eyes and mouth, poles where they belong, no folded quads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "author/generate/head/mesh.h"

namespace mien {
namespace {

/// The left half of the skin at LOD 0, with its edges in both directions.
struct Skin {
  Arena arena{default_allocator()};
  head::HalfMesh mesh{arena};
  using Edge = std::pair<uint32_t, uint32_t>;
  std::map<Edge, uint32_t> face_of;  // the face that has the edge in this direction
  std::vector<std::set<uint32_t>> around;

  explicit Skin(uint64_t seed) {
    EXPECT_TRUE(head::make_part(head::Form(head::make_person(seed)), head::Part::kHead, mesh));
    around.resize(mesh.vertices.count());
    for (uint32_t f = 0; f < mesh.faces.count(); ++f) {
      const head::Face& face = mesh.faces[f];
      for (uint32_t i = 0; i < face.count; ++i) {
        const uint32_t a = face.corners[i], b = face.corners[(i + 1) % face.count];
        face_of[{a, b}] = f;
        around[a].insert(b);
        around[b].insert(a);
      }
    }
  }

  const head::Vertex& vertex(uint32_t i) const { return mesh.vertices[i]; }
  uint32_t valence(uint32_t i) const {
    uint32_t count = 0;
    for (uint32_t other : around[i]) count += mesh.on_plane(i) && !mesh.on_plane(other) ? 2 : 1;
    return count;
  }
  /// Lids, the inside of mouth, nostril and ear are made to be folded.
  bool is_outside(const head::Face& face) const {
    for (uint32_t i = 0; i < face.count; ++i) {
      const head::Vertex& v = vertex(face.corners[i]);
      if (v.depth > 0 || v.lid != 0 || is_ear(v.position) || is_nostril(v)) return false;
    }
    return true;
  }
  static bool is_ear(Vec3 p) { return p.x > 6 && p.z < 1 && p.y > -4 && p.y < 3; }
  static bool is_nostril(const head::Vertex& v) {
    return length(v.position - v.look) > 0.01 && v.position.z > 6;
  }

  /// Follows quads from edge to opposite edge; empty if one of the faces is no quad.
  std::vector<Edge> beyond(const std::vector<Edge>& loop) const {
    std::vector<Edge> next;
    for (const Edge& edge : loop) {
      const auto found = face_of.find(edge);
      if (found == face_of.end() || mesh.faces[found->second].count != 4) return {};
      const head::Face& face = mesh.faces[found->second];
      uint32_t i = 0;
      while (face.corners[i] != edge.first) ++i;
      // The face beyond has this edge in the other direction.
      next.push_back({face.corners[(i + 3) % 4], face.corners[(i + 2) % 4]});
    }
    for (size_t i = 1; i < next.size(); ++i) {
      if (next[i].first != next[i - 1].second) return {};
    }
    return next;
  }
  /// Orders edges to a chain that starts at `first`.
  static std::vector<Edge> chain(const std::map<uint32_t, uint32_t>& edges, uint32_t first) {
    std::vector<Edge> out;
    for (auto at = edges.find(first); at != edges.end() && out.size() < edges.size();
         at = edges.find(at->second)) {
      out.push_back(*at);
    }
    return out;
  }
  /// How many loops of quads lie around a chain, one outside the other.
  size_t loops(std::vector<Edge> chain, bool closed) const {
    size_t count = 0;
    for (;; ++count) {
      chain = beyond(chain);
      if (chain.empty()) return count;
      if (closed ? chain.front().first != chain.back().second
                 : !mesh.on_plane(chain.front().first) || !mesh.on_plane(chain.back().second)) {
        return count;
      }
    }
  }
};

TEST(HeadTopology, LoopsOfQuadsLieAroundEyeAndMouth) {
  const Skin skin(0);
  // The hole behind the lids: edges with a face on one side.
  std::map<uint32_t, uint32_t> hole, slit;
  for (const auto& [edge, f] : skin.face_of) {
    const bool open = !skin.face_of.count({edge.second, edge.first});
    const Vec3 p = skin.vertex(edge.first).position;
    if (open && !(skin.mesh.on_plane(edge.first) && skin.mesh.on_plane(edge.second)) && p.z > 4) {
      hole[edge.first] = edge.second;
    }
    if (open) continue;
    const auto is_inside = [&](uint32_t face) {
      const head::Face& at = skin.mesh.faces[face];
      return std::any_of(at.corners, at.corners + at.count,
                         [&](uint32_t v) { return skin.vertex(v).depth > 0; });
    };
    if (!is_inside(f) && is_inside(skin.face_of.at({edge.second, edge.first}))) {
      slit[edge.first] = edge.second;
    }
  }
  const auto eye = Skin::chain(hole, hole.begin()->first);
  ASSERT_EQ(eye.size(), hole.size());
  // Two of the lids' edges, then those of lids and socket up to the brow.
  EXPECT_GE(skin.loops(eye, true), 2u + 7u + 8u);

  uint32_t first = slit.begin()->first;
  for (const auto& [from, to] : slit) {
    if (skin.mesh.on_plane(from)) first = from;
  }
  const auto mouth = Skin::chain(slit, first);
  ASSERT_EQ(mouth.size(), slit.size());
  // Lips, and the skin around them up to the nasolabial fold.
  EXPECT_GE(skin.loops(mouth, false), 8u + 8u);
}

TEST(HeadTopology, PolesAreFewAndApart) {
  const Skin skin(0);
  uint32_t regular = 0, counted = 0, triangles = 0;
  std::vector<Vec3> poles;
  for (uint32_t i = 0; i < skin.mesh.vertices.count(); ++i) {
    const head::Vertex& v = skin.vertex(i);
    // The tips of the holes of nose and ear, and the crown and the cut under hair and shirt, are fans.
    if (v.depth == 0 && skin.valence(i) > 4) poles.push_back(v.position);
    if (v.depth > 0 || v.lid != 0 || v.position.y > 12 || v.position.y < -20) continue;
    const uint32_t valence = skin.valence(i);
    ++counted;
    regular += valence == 4;
    EXPECT_TRUE(valence <= 5 || Skin::is_ear(v.position) || Skin::is_nostril(v))
        << valence << " at " << v.position.x << " " << v.position.y << " " << v.position.z;
  }
  EXPECT_GT(regular, counted * 0.995);
  for (const head::Face& face : skin.mesh.faces.span()) {
    const Vec3 p = skin.vertex(face.corners[0]).position;
    triangles += face.count == 3 && skin.is_outside(face) && p.y < 12 && p.y > -20;
  }
  EXPECT_EQ(triangles, 0u);
  // At the outer cheek, below and above the outer corner of the eye, below and above the inner one.
  const Vec3 expected[] = {
      {4.8, -3.8, 6.2}, {5.0, -1.2, 7.2}, {5.2, 2.1, 6.8}, {1.5, -1.2, 9.0}, {1.4, 1.9, 9.2}};
  for (const Vec3& at : expected) {
    const auto near =
        std::count_if(poles.begin(), poles.end(), [&](Vec3 p) { return length(p - at) < 1; });
    EXPECT_EQ(near, 1) << at.x << " " << at.y;
  }
}

TEST(HeadTopology, QuadsAreNotFolded) {
  for (uint64_t seed : {0, 1, 2, 3}) {
    const Skin skin(seed);
    uint32_t sharp = 0, folded = 0, quads = 0;
    for (const head::Face& face : skin.mesh.faces.span()) {
      if (face.count != 4 || !skin.is_outside(face)) continue;
      const auto at = [&](uint32_t i) { return skin.vertex(face.corners[i % 4]).position; };
      double angle = 0;
      for (uint32_t i = 0; i < 2; ++i) {  // both diagonals
        const Vec3 n = cross(at(i + 1) - at(i), at(i + 2) - at(i)),
                   m = cross(at(i + 2) - at(i), at(i + 3) - at(i));
        angle = std::max(angle, std::atan2(length(cross(n, m)), dot(n, m)) * 180 / author::kPi);
      }
      ++quads;
      sharp += angle > 45;
      folded += angle > 125;  // the furrow around the wing of the nose is steep
    }
    EXPECT_EQ(folded, 0u) << "seed " << seed;
    EXPECT_LT(sharp, quads / 200) << "seed " << seed;
    RecordProperty("sharp" + std::to_string(seed), static_cast<int>(sharp));
  }
}

TEST(HeadTopology, LengthsOfEdgesChangeSlowly) {
  const Skin skin(0);
  uint32_t counted = 0, sudden = 0;
  for (const auto& [edge, f] : skin.face_of) {
    // The edge that goes on straight beyond a regular vertex: two faces further.
    const head::Face& face = skin.mesh.faces[f];
    const uint32_t middle = edge.second;
    const head::Vertex& v = skin.vertex(middle);
    if (v.depth > 0 || v.lid != 0 || v.position.z < 2 || v.position.y < -11 || v.position.y > 9 ||
        Skin::is_nostril(v) || skin.mesh.on_plane(middle) || skin.valence(middle) != 4 ||
        face.count != 4) {
      continue;
    }
    uint32_t i = 0;
    while (face.corners[i] != middle) ++i;
    const auto beside = skin.face_of.find({face.corners[(i + 1) % 4], middle});
    if (beside == skin.face_of.end()) continue;
    const head::Face& other = skin.mesh.faces[beside->second];
    i = 0;
    while (other.corners[i] != middle) ++i;
    const double here = length(v.position - skin.vertex(edge.first).position),
                 next = length(skin.vertex(other.corners[(i + 1) % other.count]).position -
                               v.position);
    ++counted;
    sudden += std::max(here, next) > 2 * std::min(here, next);
  }
  EXPECT_LT(sudden, counted / 40);
}

}  // namespace
}  // namespace mien
