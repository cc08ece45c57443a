// SPDX-License-Identifier: MIT
#include "author/mesh/edge_collapse.h"

#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"
#include "author/mesh/mirror_places.h"
#include "author/mesh/silhouette.h"
#include "author/mesh/topology.h"

namespace mien::author {

namespace {

// A step along the surface costs as much as a step of 3 % of its length away from it. So short
// edges are removed first where the surface is flat.
constexpr double kAlong = 1e-3;
constexpr double kBorder = 10, kSeam = 1;  // weights of moving off a border or a seam
// Weight of moving off an outline, and the views that have one: front and side.
constexpr double kOutline = 30;
constexpr Vec3 kViews[] = {{0, 0, 1}, {1, 0, 0}};
constexpr double kLeastTurn = 0.2;  // cosine between normals in this LOD and the previous one
// Cosine between a triangle and the mean of the normals that its corners had at first: LODs turn no further.
constexpr double kLeastFacing = 0.2;
// How much more an error counts where an expression stretches the surface to twice its length, as on lips and lids.
constexpr double kFeature = 12;
constexpr double kStraight = 0.995;   // cosine between edges of a border
constexpr uint32_t kLeastLoop = 10;   // places of a border of the skin
constexpr double kSameLength = 1e-3;  // diagonals of a quad that differ by less are equal

/// 1 for an equilateral triangle, 0 for a line.
double shape_of(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const double squares = dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
  return squares > 0 ? 3.4641016151377544 * length(cross(ab, c - a)) / squares : 0;
}

}  // namespace

bool EdgeCollapse::make(const AuthorMesh& mesh, Span<const Shape> poses,
                        const CollapseGuards& guards, Arena& arena, const Allocator& allocator) {
  Arena scratch(allocator);
  mesh_ = &mesh;
  poses_ = poses;
  guards_ = guards;
  const size_t n = mesh.positions.count;
  Span<uint32_t> vertex_places;
  if (!author::make(arena, n, first_) || !author::make(arena, n, valence_) ||
      !author::make(arena, n, locked_) || !author::make(arena, n, border_) ||
      !author::make(arena, n * (poses.count + 1), quadrics_) || !author::make(arena, n, areas_) ||
      !author::make(arena, n, normals_) || !author::make(arena, n, costs_) ||
      !author::make(arena, n, targets_) || !author::make(arena, n, slots_) ||
      !author::make(arena, n, heap_) ||
      !author::make(arena, mesh.component_count, component_counts_) ||
      !author::make(arena, n, loops_) || !find_places(scratch, vertex_places) ||
      (guards.on_plane.empty() && !find_mirror(mesh, vertex_places, arena, scratch, mirror_)) ||
      !make_triangles(vertex_places, arena, scratch) || !make_charts(arena, scratch) ||
      !classify_edges(arena, scratch)) {
    return false;
  }
  const Box box = bounding_box(mesh.positions);
  center_ = (box.low + box.high) * 0.5;
  make_quadrics();
  return guard_outlines(scratch);
}

/// Joins vertices at one position where the borders of two charts run along each other.
bool EdgeCollapse::find_places(Arena& scratch, Span<uint32_t>& vertex_places) const {
  struct Edge {
    uint32_t low, high;  // welded
    uint32_t from, to;   // vertices
    bool operator<(const Edge& other) const {
      if (low != other.low) return low < other.low;
      if (high != other.high) return high < other.high;
      return from != other.from ? from < other.from : to < other.to;
    }
  };
  const AuthorMesh& mesh = *mesh_;
  Span<Edge> edges;
  if (!author::make(scratch, mesh.positions.count, vertex_places) ||
      !author::make(scratch, mesh.corners.count, edges)) {
    return false;
  }
  for (uint32_t v = 0; v < vertex_places.count; ++v) vertex_places[v] = v;
  size_t count = 0;
  for (size_t f = 0; f + 1 < mesh.face_starts.count; ++f) {
    const uint32_t first = mesh.face_starts[f], end = mesh.face_starts[f + 1];
    for (uint32_t c = first; c < end; ++c) {
      const uint32_t from = mesh.corners[c], to = mesh.corners[c + 1 < end ? c + 1 : first];
      const uint32_t a = mesh.welded[from], b = mesh.welded[to];
      if (a != b) edges[count++] = {std::min(a, b), std::max(a, b), from, to};
    }
  }
  std::sort(edges.data, edges.data + count);
  const auto root = [&vertex_places](uint32_t v) {
    while (vertex_places[v] != v) v = vertex_places[v] = vertex_places[vertex_places[v]];
    return v;
  };
  const auto join = [&](uint32_t a, uint32_t b) {
    a = root(a);
    b = root(b);
    vertex_places[std::max(a, b)] = std::min(a, b);
  };
  for (size_t i = 0, end = 0; i < count; i = end) {
    while (end < count && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
    // Borders: edges that no other face has in the opposite direction.
    const Edge* borders[2] = {};
    uint32_t found = 0;
    for (size_t k = i; k < end && end - i <= kMaxRing; ++k) {
      bool is_border = true;
      for (size_t o = i; o < end && is_border; ++o) {
        is_border = edges[o].from != edges[k].to || edges[o].to != edges[k].from;
      }
      if (!is_border) continue;
      if (found < 2) borders[found] = &edges[k];
      ++found;
    }
    if (found != 2 || mesh.welded[borders[0]->from] != mesh.welded[borders[1]->to]) continue;
    join(borders[0]->from, borders[1]->to);
    join(borders[0]->to, borders[1]->from);
  }
  for (uint32_t v = 0; v < vertex_places.count; ++v) vertex_places[v] = root(v);
  return true;
}

/// At which corner the fan of a quad begins. Two quads around a place without others would have the same diagonal
/// beside it: theirs goes through it. Otherwise it is the shorter diagonal, which is so on the other side of a
/// symmetric mesh too.
uint32_t EdgeCollapse::first_of_quad(const uint32_t* places,
                                     Span<const uint32_t> face_counts) const {
  const auto fewest = [&](uint32_t k) {
    return std::min(face_counts[places[k]], face_counts[places[k + 2]]) <= 2;
  };
  if (fewest(0) != fewest(1)) return fewest(0) ? 0 : 1;
  const Vec3 a = at(places[2], 0) - at(places[0], 0), b = at(places[3], 0) - at(places[1], 0);
  return dot(b, b) < dot(a, a) * (1 - kSameLength) ? 1 : 0;
}

bool EdgeCollapse::make_triangles(Span<const uint32_t> vertex_places, Arena& arena,
                                  Arena& scratch) {
  Span<uint32_t> face_counts;  // around each place
  if (!author::make(scratch, vertex_places.count, face_counts)) return false;
  const AuthorMesh& mesh = *mesh_;
  const size_t faces = mesh.face_starts.count - 1;
  size_t most = 0;
  for (size_t f = 0; f < faces; ++f) most += mesh.face_starts[f + 1] - mesh.face_starts[f] - 2;
  if (!author::make(arena, faces + 1, face_triangles_) || !author::make(arena, 3 * most, places_) ||
      !author::make(arena, 3 * most, vertices_) || !author::make(arena, 3 * most, sources_) ||
      !author::make(arena, 3 * most, next_) || !author::make(arena, most, facing_) ||
      !author::make(arena, most, alive_)) {
    return false;
  }
  for (uint32_t& c : first_) c = kNone;
  for (const uint32_t v : mesh.corners) ++face_counts[vertex_places[v]];
  uint32_t count = 0;
  for (size_t f = 0; f < faces; ++f) {
    face_triangles_[f] = count;
    const uint32_t begin = mesh.face_starts[f], size = mesh.face_starts[f + 1] - begin;
    uint32_t start = 0;
    if (size == 4) {
      uint32_t around[4];
      for (uint32_t i = 0; i < 4; ++i) around[i] = vertex_places[mesh.corners[begin + i]];
      start = first_of_quad(around, face_counts);
    }
    for (uint32_t k = 2; k < size; ++k) {
      const uint32_t corners[3] = {begin + start, begin + start + k - 1,
                                   begin + (start + k) % size};
      uint32_t places[3];
      for (int i = 0; i < 3; ++i) places[i] = vertex_places[mesh.corners[corners[i]]];
      if (places[0] == places[1] || places[1] == places[2] || places[2] == places[0]) continue;
      for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t c = 3 * count + i;
        places_[c] = places[i];
        vertices_[c] = mesh.corners[corners[i]];
        sources_[c] = corners[i];
        next_[c] = first_[places[i]];
        first_[places[i]] = c;
        ++valence_[places[i]];
      }
      ++component_counts_[mesh.component[places[0]]];
      alive_[count++] = 1;
    }
  }
  face_triangles_[faces] = alive_count_ = count;
  alive_.count = facing_.count = count;
  places_.count = 3 * size_t{count};
  return true;
}

/// Corners of one part that have the same texture coordinate get the same number: files often have
/// a coordinate of its own for each corner.
bool EdgeCollapse::make_charts(Arena& arena, Arena& scratch) {
  const AuthorMesh& mesh = *mesh_;
  Span<uint32_t> order;
  const size_t corners = places_.count;
  if (!author::make(arena, corners, charts_) || !author::make(scratch, corners, order))
    return false;
  uint32_t face = 0, p = 0;
  for (uint32_t t = 0; t < alive_.count; ++t) {
    while (face_triangles_[face + 1] <= t) ++face;
    while (mesh.parts[p].first_face + mesh.parts[p].face_count <= face) ++p;
    for (uint32_t i = 0; i < 3; ++i) charts_[3 * t + i] = p;
  }
  if (mesh.corner_uvs.empty()) return true;
  const auto uv = [&](uint32_t c) { return mesh.uvs[mesh.corner_uvs[sources_[c]]]; };
  const auto compare = [&](uint32_t a, uint32_t b) {
    if (charts_[a] != charts_[b]) return charts_[a] < charts_[b] ? -1 : 1;
    const Uv x = uv(a), y = uv(b);
    if (x.u != y.u) return x.u < y.u ? -1 : 1;
    return x.v != y.v ? (x.v < y.v ? -1 : 1) : 0;
  };
  for (uint32_t c = 0; c < corners; ++c) order[c] = c;
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const int sign = compare(a, b);
    return sign != 0 ? sign < 0 : a < b;
  });
  Span<uint32_t> numbers;
  if (!author::make(scratch, corners, numbers)) return false;
  for (size_t i = 1; i < corners; ++i) {
    numbers[i] = numbers[i - 1] + (compare(order[i - 1], order[i]) != 0);
  }
  for (size_t i = 0; i < corners; ++i) charts_[order[i]] = numbers[i];
  return true;
}

/// Finds borders, and places where the surface is not a manifold: those are never removed.
bool EdgeCollapse::classify_edges(Arena& arena, Arena& scratch) {
  struct Edge {
    uint32_t low, high, corner;
    bool operator<(const Edge& other) const {
      if (low != other.low) return low < other.low;
      return high != other.high ? high < other.high : corner < other.corner;
    }
  };
  Span<Edge> edges;
  Span<uint8_t> borders;
  Span<uint64_t> border_edges;
  size_t border_count = 0;
  if (!author::make(scratch, places_.count, edges) ||
      !author::make(scratch, places_.count, border_edges) ||
      !author::make(scratch, first_.count, borders)) {
    return false;
  }
  for (uint32_t c = 0; c < places_.count; ++c) {
    const uint32_t a = places_[c], b = places_[next_corner(c)];
    edges[c] = {std::min(a, b), std::max(a, b), c};
  }
  std::sort(edges.begin(), edges.end());
  for (size_t i = 0, end = 0; i < edges.count; i = end) {
    const Edge& e = edges[i];
    while (end < edges.count && edges[end].low == e.low && edges[end].high == e.high) ++end;
    // Both triangles of an edge run along it, in opposite directions.
    const bool is_odd =
        end - i > 2 || (end - i == 2 && places_[e.corner] == places_[edges[i + 1].corner]);
    if (is_odd) locked_[e.low] = locked_[e.high] = 1;
    if (end - i == 1) {
      border_edges[border_count++] = uint64_t{e.low} << 32 | e.high;
      for (const uint32_t place : {e.low, e.high}) {
        border_[place] = 1;
        borders[place] = static_cast<uint8_t>(std::min(borders[place] + 1, 3));
      }
    }
  }
  for (uint32_t place = 0; place < first_.count; ++place) {
    if (valence_[place] == 0) continue;
    if (valence_[place] > kMaxRing || (border_[place] && borders[place] != 2) ||
        (!locked_[place] && !is_one_fan(place))) {
      locked_[place] = 1;
    }
  }
  for (const CollapseTuple& tuple : guards_.tuples) {
    for (uint32_t i = 1; i < CollapseTuple::kMaxSize; ++i) {
      for (uint32_t k = 0; k < i; ++k) {
        if (tuple.vertices[i] != kNone && tuple.vertices[i] == tuple.vertices[k])
          locked_[tuple.vertices[i]] = 1;
      }
    }
  }
  return find_loops(border_edges.first(border_count), arena);
}

/// Places of the borders of the skin that hang together.
bool EdgeCollapse::find_loops(Span<const uint64_t> border_edges, Arena& arena) {
  if (!author::make(arena, first_.count, loop_counts_)) return false;
  for (uint32_t place = 0; place < loops_.count; ++place) {
    loops_[place] = border_[place] && mesh_->is_skin[place] ? place : kNone;
  }
  const auto root = [this](uint32_t place) {
    while (loops_[place] != place) place = loops_[place] = loops_[loops_[place]];
    return place;
  };
  for (const uint64_t edge : border_edges) {
    const auto a = static_cast<uint32_t>(edge >> 32), b = static_cast<uint32_t>(edge);
    if (loops_[a] == kNone || loops_[b] == kNone) continue;
    const uint32_t x = root(a), y = root(b);
    loops_[std::max(x, y)] = std::min(x, y);
  }
  for (uint32_t place = 0; place < loops_.count; ++place) {
    if (loops_[place] == kNone) continue;
    loops_[place] = root(place);
    ++loop_counts_[loops_[place]];
  }
  return true;
}

/// True if the triangles around the place are connected by edges.
bool EdgeCollapse::is_one_fan(uint32_t place) {
  Ring ring;
  find_ring(place, ring);
  bool reached[kMaxRing] = {true};
  uint32_t count = 1;
  for (bool grows = true; grows;) {
    grows = false;
    for (uint32_t i = 0; i < ring.corner_count; ++i) {
      for (uint32_t k = 0; k < ring.corner_count && !reached[i]; ++k) {
        if (!reached[k]) continue;
        const uint32_t a = ring.corners[i], b = ring.corners[k];
        reached[i] = places_[next_corner(a)] == places_[third_corner(b)] ||
                     places_[third_corner(a)] == places_[next_corner(b)];
        count += reached[i];
        grows = grows || reached[i];
      }
    }
  }
  return count == ring.corner_count;
}

/// How much an expression stretches a triangle: the largest change of an edge over its length, at most 1. Lips and
/// lids open, so their edges grow to a multiple; skin that moves along does not.
double EdgeCollapse::stretch_of(uint32_t triangle) const {
  double most = 0;
  for (uint32_t c = 3 * triangle; c < 3 * triangle + 3; ++c) {
    const uint32_t a = places_[c], b = places_[next_corner(c)];
    const Vec3 edge = at(b, 0) - at(a, 0);
    for (size_t pose = 1; pose <= poses_.count; ++pose) {
      const double change = length(at(b, pose) - at(a, pose) - edge);
      if (change > most * length(edge)) most = change / length(edge);
      if (!(most < 1)) return 1;
    }
  }
  return most;
}

void EdgeCollapse::make_quadrics() {
  const size_t poses = poses_.count + 1;
  for (uint32_t t = 0; t < alive_.count; ++t) {
    double weight = 1 + kFeature * stretch_of(t);
    if (!guards_.weights.empty()) {
      double sum = 0;
      for (uint32_t c = 3 * t; c < 3 * t + 3; ++c) sum += double{guards_.weights[places_[c]]};
      weight *= sum / 3;
    }
    for (size_t pose = 0; pose < poses; ++pose) {
      const Vec3 n = normal_of(t, pose);
      const double twice = length(n);
      if (!(twice > 0)) continue;
      for (uint32_t c = 3 * t; c < 3 * t + 3; ++c) {
        quadrics_[places_[c] * poses + pose].add_plane(n * (1 / twice), at(places_[c], pose),
                                                       weight * twice / 6);
        if (pose > 0) continue;
        areas_[places_[c]] += weight * twice / 6;
        normals_[places_[c]] = normals_[places_[c]] + n;
      }
    }
    for (uint32_t c = 3 * t; c < 3 * t + 3; ++c) {
      const uint32_t across = across_of(c);
      if (across == kNone) {
        const uint32_t a = places_[c], b = places_[next_corner(c)];
        if (border_[a] && border_[b] && !(is_on_plane(a) && is_on_plane(b))) add_border(c, kBorder);
      } else if (charts_[across] != charts_[c] ||
                 charts_[third_corner(across)] != charts_[next_corner(c)]) {
        add_border(c, kSeam);
      }
    }
  }
  for (Vec3& normal : normals_) normal = normalized(normal);
}

/// The corner at the same place in the triangle across the edge to the next corner, or kNone.
uint32_t EdgeCollapse::across_of(uint32_t corner) const {
  const uint32_t a = places_[corner], b = places_[next_corner(corner)];
  uint32_t across = kNone;
  for (uint32_t other = first_[a]; other != kNone && valence_[a] <= kMaxRing;
       other = next_[other]) {
    if (other != corner && places_[third_corner(other)] == b) across = other;
  }
  return across;
}

/// Moving an edge of an outline across it costs, too: the plane through the edge and along the view is one more of
/// the planes of its ends.
bool EdgeCollapse::guard_outlines(Arena& scratch) {
  const size_t poses = poses_.count + 1;
  for (const Vec3 view : kViews) {
    Silhouette silhouette;
    if (places_.empty()) return true;
    if (!silhouette.make(mesh_->positions, places_, view, scratch)) return false;
    const auto is_facing = [&](uint32_t corner) { return dot(normal_of(corner / 3, 0), view) > 0; };
    for (uint32_t c = 0; c < places_.count; ++c) {
      if (!is_facing(c)) continue;
      const uint32_t across = across_of(c), a = places_[c], b = places_[next_corner(c)];
      // Across an edge on the plane is the mirror image of this triangle.
      const bool turns =
          across == kNone ? is_on_plane(a) && is_on_plane(b) && view.x != 0 : !is_facing(across);
      if (!turns) continue;
      const Vec3* p = mesh_->positions.data;
      const Vec3 along = p[b] - p[a], n = normalized(cross(along, view));
      if (is_zero(n) || !silhouette.is_outline(p[a], p[b], p[places_[third_corner(c)]])) continue;
      for (const uint32_t place : {a, b}) {
        quadrics_[place * poses].add_plane(n, at(place, 0), kOutline * dot(along, along));
      }
    }
  }
  return true;
}

/// Moving off the edge within the triangle costs, too.
void EdgeCollapse::add_border(uint32_t corner, double weight) {
  const size_t poses = poses_.count + 1;
  const uint32_t a = places_[corner], b = places_[next_corner(corner)];
  for (size_t pose = 0; pose < poses; ++pose) {
    const Vec3 along = at(b, pose) - at(a, pose);
    const Vec3 n = normalized(cross(along, normal_of(corner / 3, pose)));
    for (const uint32_t place : {a, b}) {
      quadrics_[place * poses + pose].add_plane(n, at(place, pose), weight * dot(along, along));
    }
  }
}

Vec3 EdgeCollapse::at(uint32_t place, size_t pose) const {
  const Vec3 rest = mesh_->positions[place] - center_;
  if (pose == 0) return rest;
  const Vec3f d = poses_[pose - 1].displacements[place];
  return rest + Vec3{double{d.x}, double{d.y}, double{d.z}};
}

/// Its length is twice the area.
Vec3 EdgeCollapse::normal_of(uint32_t triangle, size_t pose) const {
  Vec3 p[3];
  for (uint32_t i = 0; i < 3; ++i) p[i] = at(places_[3 * triangle + i], pose);
  return cross(p[1] - p[0], p[2] - p[0]);
}

/// At rest, once u is at v.
Vec3 EdgeCollapse::normal_after(uint32_t triangle, uint32_t u, uint32_t v) const {
  Vec3 p[3];
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t place = places_[3 * triangle + i];
    p[i] = at(place == u ? v : moved(place), 0);
  }
  return cross(p[1] - p[0], p[2] - p[0]);
}

/// Also removes deleted triangles from the list of the place, which has at most kMaxRing.
void EdgeCollapse::find_ring(uint32_t place, Ring& ring) {
  ring.corner_count = ring.place_count = 0;
  uint32_t* link = &first_[place];
  while (*link != kNone) {
    const uint32_t c = *link;
    if (!alive_[c / 3]) {
      *link = next_[c];
      continue;
    }
    ring.corners[ring.corner_count++] = c;
    for (const uint32_t other : {places_[next_corner(c)], places_[third_corner(c)]}) {
      if (!ring.has(other)) ring.places[ring.place_count++] = other;
    }
    link = &next_[c];
  }
}

/// False if a chart at the place of the ring has no corner, or two, on an edge to v.
bool EdgeCollapse::map_charts(const Ring& ring, uint32_t v, ChartMap& map) const {
  for (uint32_t i = 0; i < ring.corner_count; ++i) {
    const uint32_t c = ring.corners[i];
    const uint32_t at_v = places_[next_corner(c)] == v    ? next_corner(c)
                          : places_[third_corner(c)] == v ? third_corner(c)
                                                          : kNone;
    if (at_v == kNone) continue;
    uint32_t k = 0;
    while (k < map.count && map.from[k] != charts_[c]) ++k;
    if (k < map.count) {
      if (charts_[map.to[k]] != charts_[at_v]) return false;
    } else {
      map.from[map.count] = charts_[c];
      map.to[map.count++] = at_v;
    }
  }
  for (uint32_t i = 0; i < ring.corner_count; ++i) {
    const uint32_t chart = charts_[ring.corners[i]];
    uint32_t k = 0;
    while (k < map.count && map.from[k] != chart) ++k;
    if (k == map.count) return false;
  }
  return true;
}

bool EdgeCollapse::may_collapse(uint32_t u, const Ring& ring, uint32_t v) {
  if (valence_[v] > kMaxRing) return false;
  uint32_t shared = 0, across[2] = {kNone, kNone};  // triangles of the edge; their third places
  for (uint32_t i = 0; i < ring.corner_count; ++i) {
    const uint32_t a = places_[next_corner(ring.corners[i])];
    const uint32_t b = places_[third_corner(ring.corners[i])];
    if (a != v && b != v) continue;
    if (shared == 2) return false;
    across[shared++] = a == v ? b : a;
  }
  if (shared != (border_[u] ? 1u : 2u) || (border_[u] && !border_[v])) return false;
  if (is_on_plane(v)) {
    for (uint32_t i = 0; i < ring.place_count && !is_on_plane(u); ++i) {
      const uint32_t w = ring.places[i];
      if (w != v && w != across[0] && w != across[1] && is_on_plane(w)) return false;
    }
  } else if (is_on_plane(u)) {
    return false;
  }
  if (loops_[u] != kNone && loop_counts_[loops_[u]] <= kLeastLoop && !is_straight(u, ring))
    return false;
  if (valence_[u] + valence_[v] - 2 * shared > kMaxRing) return false;
  // Neighbors of both ends must lie across the edge; otherwise the surface would touch itself.
  Ring other;
  find_ring(v, other);
  uint32_t common = 0;
  for (uint32_t i = 0; i < ring.place_count; ++i) common += other.has(ring.places[i]);
  if (common != shared) return false;
  if (shared == 2) {
    for (uint32_t i = 0; i < other.corner_count; ++i) {
      const uint32_t a = places_[next_corner(other.corners[i])];
      const uint32_t b = places_[third_corner(other.corners[i])];
      if ((a == across[0] && b == across[1]) || (a == across[1] && b == across[0])) return false;
    }
  }
  ChartMap map;
  return map_charts(ring, v, map) && keeps_facing(u, ring, v, map);
}

/// No triangle may flip, on the surface or in the texture, or become a sliver.
bool EdgeCollapse::keeps_facing(uint32_t u, const Ring& ring, uint32_t v,
                                const ChartMap& map) const {
  for (uint32_t i = 0; i < ring.corner_count; ++i) {
    const uint32_t c = ring.corners[i], a = next_corner(c), b = third_corner(c);
    const uint32_t at_a = moved(places_[a]), at_b = moved(places_[b]);
    if (at_a == v || at_b == v || at_a == at_b) continue;
    const Vec3 n = normalized(normal_after(c / 3, u, v));
    if (is_zero(n) || (!is_zero(facing_[c / 3]) && dot(n, facing_[c / 3]) < kLeastTurn)) {
      return false;
    }
    const Vec3 first = normals_[v] + normals_[at_a] + normals_[at_b];
    if (dot(n, first) < kLeastFacing * length(first)) {
      const Vec3 now = normalized(normal_of(c / 3, 0));
      if (dot(n, first) < dot(now, first)) return false;
    }
    const double shape = shape_of(at(v, 0), at(at_a, 0), at(at_b, 0));
    if (shape < guards_.least_shape &&
        shape < shape_of(at(u, 0), at(places_[a], 0), at(places_[b], 0)))
      return false;
    if (mesh_->corner_uvs.empty()) continue;
    const auto uv = [this](uint32_t corner) {
      const Uv x = mesh_->uvs[mesh_->corner_uvs[sources_[corner]]];
      return Vec3{double{x.u}, double{x.v}, 0};
    };
    uint32_t k = 0;
    while (map.from[k] != charts_[c]) ++k;
    const double before = cross(uv(a) - uv(c), uv(b) - uv(c)).z;
    const double after = cross(uv(a) - uv(map.to[k]), uv(b) - uv(map.to[k])).z;
    if (before * after < 0) return false;
  }
  return true;
}

double EdgeCollapse::cost(uint32_t u, uint32_t v) const {
  const size_t poses = poses_.count + 1;
  double sum = 0;
  for (size_t pose = 0; pose < poses; ++pose) {
    const Vec3 to = at(v, pose), step = to - at(u, pose);
    sum += std::max(0.0, quadrics_[u * poses + pose].at(to)) +
           std::max(0.0, quadrics_[v * poses + pose].at(to)) + kAlong * areas_[u] * dot(step, step);
  }
  if (!guards_.colors.empty()) {
    const Vec3 change = guards_.colors[v] - guards_.colors[u];
    sum += kAlong * areas_[u] * dot(change, change);
  }
  return sum;
}

double EdgeCollapse::whole_cost(uint32_t u, uint32_t v) const {
  if (const CollapseTuple* from = tuple_of(u)) {
    const CollapseTuple* to = tuple_of(v);
    if (!to || to == from) return std::numeric_limits<double>::infinity();
    // The mean, because it removes as many triangles more.
    double sum = 0, count = 0;
    for (uint32_t i = 0; i < CollapseTuple::kMaxSize; ++i) {
      if (from->vertices[i] == kNone || to->vertices[i] == kNone) continue;
      sum += cost(from->vertices[i], to->vertices[i]);
      ++count;
    }
    return sum / count;
  }
  // Vertices beside a slit that went to its edge would leave slivers along it.
  if (tuple_of(v)) return std::numeric_limits<double>::infinity();
  // The same on both sides: expressions of one side count on the other one too.
  const uint32_t other = partner_of(u), to = partner_of(v);
  const bool is_pair = other != kNone && other != u && to != kNone;
  return cost(u, v) + (is_pair ? cost(other, to) : 0);
}

/// Whether the collapse leaves the surface as it is.
bool EdgeCollapse::is_flat(uint32_t u, uint32_t v) const {
  double along = 0;
  for (size_t pose = 0; pose <= poses_.count; ++pose) {
    const Vec3 step = at(v, pose) - at(u, pose);
    along += kAlong * areas_[u] * dot(step, step);
  }
  return cost(u, v) <= 1.01 * along;
}

/// Whether the border at u runs straight on.
bool EdgeCollapse::is_straight(uint32_t u, const Ring& ring) const {
  Vec3 ends[2];
  uint32_t count = 0;
  for (uint32_t i = 0; i < ring.place_count; ++i) {
    uint32_t triangles = 0;
    for (uint32_t k = 0; k < ring.corner_count; ++k) {
      const uint32_t c = ring.corners[k];
      triangles +=
          places_[next_corner(c)] == ring.places[i] || places_[third_corner(c)] == ring.places[i];
    }
    if (triangles != 1) continue;
    if (count == 2) return false;
    ends[count++] = at(ring.places[i], 0);
  }
  if (count < 2) return false;
  return dot(normalized(at(u, 0) - ends[0]), normalized(ends[1] - at(u, 0))) > kStraight;
}

bool EdgeCollapse::mirror_may_collapse(uint32_t u, uint32_t v) {
  const uint32_t other = partner_of(u), to = partner_of(v);
  if (other == kNone || is_flat(u, v)) return true;
  if (other == u) return to == v;  // stays on the plane
  if (other == v || to == kNone || valence_[other] == 0 || locked_[other]) return false;
  Ring ring;
  find_ring(other, ring);
  return ring.has(to) && may_collapse(other, ring, to);
}

/// The members are checked as they are before any of them moves, and their triangles as they are after all have.
bool EdgeCollapse::tuple_may_collapse(uint32_t u, uint32_t v) {
  const CollapseTuple *from = tuple_of(u), *to = tuple_of(v);
  if (!from) return true;
  if (!to || to == from) return false;
  bool has_v = false, allowed = true;
  for (uint32_t i = 0; i < CollapseTuple::kMaxSize && allowed; ++i) {
    const Move move = {from->vertices[i], to->vertices[i]};
    if (move.from == kNone && move.to == kNone) continue;
    allowed = move.from != kNone && move.to != kNone && valence_[move.from] > 0 &&
              valence_[move.from] <= kMaxRing && !locked_[move.from];
    has_v = has_v || (move.from == u && move.to == v);
    if (allowed) moves_[move_count_++] = move;
  }
  Ring ring;
  for (uint32_t i = 0; i < move_count_ && allowed && has_v; ++i) {
    find_ring(moves_[i].from, ring);
    allowed = ring.has(moves_[i].to) && may_collapse(moves_[i].from, ring, moves_[i].to);
  }
  move_count_ = 0;
  return allowed && has_v;
}

void EdgeCollapse::refresh(uint32_t u) {
  remove(u);
  if (locked_[u] || valence_[u] == 0 || valence_[u] > kMaxRing) return;
  Ring ring;
  find_ring(u, ring);
  double costs[2 * kMaxRing];
  for (uint32_t i = 0; i < ring.place_count; ++i) costs[i] = whole_cost(u, ring.places[i]);
  // The cheapest first, because most collapses are allowed.
  for (uint32_t tried = 0; tried < ring.place_count; ++tried) {
    uint32_t best = tried;
    for (uint32_t i = tried + 1; i < ring.place_count; ++i) {
      if (costs[i] < costs[best] || (costs[i] == costs[best] && ring.places[i] < ring.places[best]))
        best = i;
    }
    std::swap(costs[tried], costs[best]);
    std::swap(ring.places[tried], ring.places[best]);
    if (!(costs[tried] < std::numeric_limits<double>::infinity())) return;
    const uint32_t v = ring.places[tried];
    if (tuple_of(u) ? !tuple_may_collapse(u, v)
                    : !may_collapse(u, ring, v) || !mirror_may_collapse(u, v)) {
      continue;
    }
    costs_[u] = costs[tried];
    targets_[u] = ring.places[tried];
    slots_[u] = heap_count_ + 1;
    heap_[heap_count_++] = u;
    sift(heap_count_ - 1);
    return;
  }
}

void EdgeCollapse::collapse(uint32_t u) {
  const uint32_t v = targets_[u];
  Ring ring;
  ChartMap map;
  find_ring(u, ring);
  map_charts(ring, v, map);
  for (uint32_t i = 0; i < ring.corner_count; ++i) {
    const uint32_t c = ring.corners[i], a = next_corner(c), b = third_corner(c);
    if (places_[a] == v || places_[b] == v) {
      alive_[c / 3] = 0;
      --alive_count_;
      --component_counts_[mesh_->component[u]];
      --valence_[places_[a]];
      --valence_[places_[b]];
      continue;
    }
    uint32_t k = 0;
    while (map.from[k] != charts_[c]) ++k;
    places_[c] = v;
    vertices_[c] = vertices_[map.to[k]];
    sources_[c] = sources_[map.to[k]];
    charts_[c] = charts_[map.to[k]];
    next_[c] = first_[v];
    first_[v] = c;
    ++valence_[v];
  }
  first_[u] = kNone;
  valence_[u] = 0;
  if (loops_[u] != kNone) --loop_counts_[loops_[u]];
  const size_t poses = poses_.count + 1;
  for (size_t pose = 0; pose < poses; ++pose) {
    quadrics_[v * poses + pose].add(quadrics_[u * poses + pose]);
  }
  areas_[v] += areas_[u];
  remove(u);
  refresh(v);
  find_ring(v, ring);
  for (uint32_t i = 0; i < ring.place_count; ++i) refresh(ring.places[i]);
}

void EdgeCollapse::reduce(uint32_t wanted, Span<const uint32_t> floors) {
  if (alive_count_ <= wanted) return;
  for (uint32_t t = 0; t < alive_.count; ++t) {
    if (alive_[t]) facing_[t] = normalized(normal_of(t, 0));
  }
  // Start over: what an earlier floor kept may be removed now.
  for (uint32_t place = 0; place < first_.count; ++place) refresh(place);
  while (alive_count_ > wanted && heap_count_ > 0) {
    const uint32_t u = heap_[0], v = targets_[u], other = partner_of(u);
    const uint32_t component = mesh_->component[u];
    const bool is_pair = other != kNone && other != u;
    if (is_pair && alive_count_ < wanted + 2) break;
    const uint32_t gone = is_pair && mesh_->component[other] == component ? 4 : 2;
    if (component_counts_[component] < floors[component] + gone) {
      remove(u);
      continue;
    }
    // Costs of places up to two edges away may have changed.
    if (const CollapseTuple* from = tuple_of(u)) {
      if (tuple_may_collapse(u, v)) {
        collapse_tuple(*from, *tuple_of(v));
      } else {
        refresh(u);
      }
      continue;
    }
    Ring ring;
    find_ring(u, ring);
    if (may_collapse(u, ring, v) && mirror_may_collapse(u, v)) {
      collapse(u);
      if (is_pair) collapse_mirrored(u, v);
    } else {
      refresh(u);
    }
  }
}

/// Near the plane the first collapse may be in the way of the second one, and flat ones need none.
void EdgeCollapse::collapse_mirrored(uint32_t u, uint32_t v) {
  const uint32_t other = mirror_[u], to = mirror_[v];
  if (valence_[other] == 0 || valence_[other] > kMaxRing) return;
  Ring ring;
  find_ring(other, ring);
  if (to != kNone && !locked_[other] && ring.has(to) && may_collapse(other, ring, to)) {
    targets_[other] = to;
    collapse(other);
  } else {
    mirror_[other] = kNone;
  }
}

void EdgeCollapse::collapse_tuple(const CollapseTuple& from, const CollapseTuple& to) {
  for (uint32_t i = 0; i < CollapseTuple::kMaxSize; ++i) {
    if (from.vertices[i] == kNone) continue;
    targets_[from.vertices[i]] = to.vertices[i];
    collapse(from.vertices[i]);
  }
}

void EdgeCollapse::remove_component(uint32_t component) {
  for (uint32_t t = 0; t < alive_.count; ++t) {
    if (!alive_[t] || mesh_->component[places_[3 * t]] != component) continue;
    alive_[t] = 0;
    --alive_count_;
    --component_counts_[component];
    for (uint32_t c = 3 * t; c < 3 * t + 3; ++c) valence_[places_[c]] = 0;
  }
}

/// Slot 0 means that the place is not in the heap.
void EdgeCollapse::sift(uint32_t slot) {
  const uint32_t place = heap_[slot];
  while (slot > 0 && before(place, heap_[(slot - 1) / 2])) {
    heap_[slot] = heap_[(slot - 1) / 2];
    slots_[heap_[slot]] = slot + 1;
    slot = (slot - 1) / 2;
  }
  for (;;) {
    uint32_t child = 2 * slot + 1;
    if (child >= heap_count_) break;
    if (child + 1 < heap_count_ && before(heap_[child + 1], heap_[child])) ++child;
    if (!before(heap_[child], place)) break;
    heap_[slot] = heap_[child];
    slots_[heap_[slot]] = slot + 1;
    slot = child;
  }
  heap_[slot] = place;
  slots_[place] = slot + 1;
}

void EdgeCollapse::remove(uint32_t place) {
  const uint32_t slot = slots_[place];
  if (slot == 0) return;
  slots_[place] = 0;
  const uint32_t last = heap_[--heap_count_];
  if (last == place) return;
  heap_[slot - 1] = last;
  sift(slot - 1);
}

}  // namespace mien::author
