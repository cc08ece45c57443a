// SPDX-License-Identifier: MIT
// LODs 1 to 7: what is left of LOD 0 when edges collapse onto one of their ends (author/mesh/edge_collapse.h).
// Vertices keep all that they have at LOD 0, so shapes and weights are those of the same places, and normals are
// those of the finest surface.
#include <algorithm>

#include "author/generate/head/mesh.h"
#include "author/generate/head/shapes.h"
#include "author/generate/head/skin.h"
#include "author/mesh/edge_collapse.h"
#include "author/mesh/topology.h"

namespace mien::head {

using author::CollapseGuards;
using author::CollapseTuple;
using author::kNone;
using author::make;
using author::Vec3f;

namespace {

/// How a part is simplified: triangles of its half, or of all of an eye, in LODs 1 to 7, and what a change
/// of color from 0 to 255 costs: as much as a step along the surface of so many centimeters.
struct Plan {
  uint32_t triangles[kLodCount - 1];
  double color;
};
constexpr Plan kSkinPlan = {{8000, 5400, 3570, 2320, 1660, 1250, 830}, 12};
constexpr Plan kTeethPlan = {{1600, 1330, 900, 690, 560, 480, 400}, 5};
constexpr Plan kTonguePlan = {{360, 190, 120, 80, 60, 50, 40}, 8};
constexpr Plan kEyePlan = {{1090, 770, 400, 300, 240, 190, 150}, 120};
constexpr uint32_t kLeastTriangles = 8;  // of a tooth

/// What moves the skin most, each in its own way, besides lids, which close.
constexpr Motion kPosed[] = {Motion::kJawOpen, Motion::kSmile, Motion::kFunnel, Motion::kBrowDown};
constexpr uint32_t kPoseCount = 1 + sizeof(kPosed) / sizeof(kPosed[0]);

constexpr double kSamePlace = 1e-6;  // cm

bool is_same(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// How much errors count: more on nose, mouth, lids, ears, the hair line, the iris, and where the neck bends; less where
/// they are hidden.
double importance(const Form& form, const Vertex& v) {
  const Vec3 p = v.closed;
  switch (v.carrier) {
    case Carrier::kEyeball:
      if (p.z < kEye.z) return 0.05;
      return 1 + 20 * author::smooth_step(0.88, 0.94, (p.z - kEye.z) / kEyeRadius);
    case Carrier::kSkin: break;
    default: return 1;
  }
  if (v.depth > 0.2) return 0.3;
  double w = 1;
  if (p.z > 4) {
    w += 6 * bump(p.x, p.y, 0, -3.4, 1.7, 1.5) + 90 * bump(v.look.x, v.look.y, 0, -3.15, 0.5, 0.5) +
         4 * bump(p.x, p.y, 0, kMouthY, 3.0, 1.3) + 4 * bump(p.x, p.y, kEye.x, kEye.y, 2.0, 1.3);
  }
  w += 6 * bump(0, p.y, 0, -14, 1, 2);
  if (p.x > 5) w += 6 * bump(p.z, p.y, -1.2, -0.7, 1.8, 2.6);
  const double hidden = scalp(form, angle_of_u(v.u), p.y);
  w = (w + 8 * hidden * (1 - hidden)) * (1 - 0.75 * hidden);
  return w * author::mix(1, 0.7, author::smooth_step(-16, -18, p.y));
}

/// Finds the edges of slits, between lids and between lips, whose vertices meet in pairs, and the rims behind them: of
/// lips one row into the mouth, of lids all rows to their back. Rims have the looks of the edge that they begin at.
class Slits {
 public:
  Span<CollapseTuple> tuples;
  Span<uint32_t> tuple_of;

  /// False if memory ran out.
  bool find(const HalfMesh& mesh, Arena& arena, Arena& scratch) {
    mesh_ = &mesh;
    const uint32_t n = mesh.vertices.count();
    if (!make(arena, n, tuple_of) || !make(arena, n, tuples) || !make(scratch, n, same_) ||
        !make(scratch, n, beside_) || !make(scratch, n, order_)) {
      return false;
    }
    for (uint32_t& t : tuple_of) t = kNone;
    tuples.count = 0;
    for (const Face& f : mesh.faces.span()) {
      for (uint32_t i = 0; i < f.count; ++i) link(f.corners[i], f.corners[(i + 1) % f.count]);
    }
    find_pairs();
    find_ends();
    return true;
  }

 private:
  static constexpr uint32_t kRows = CollapseTuple::kMaxSize / 2;  // below; the others are above
  struct Two {
    uint32_t vertices[2] = {kNone, kNone};
    void add(uint32_t v) {
      if (vertices[0] == v || vertices[1] == v) return;
      vertices[vertices[0] == kNone ? 0 : 1] = v;
    }
  };

  const Vertex& at(uint32_t i) const { return mesh_->vertices[i]; }
  bool is_edge(uint32_t i) const { return at(i).edge && is_same(at(i).closed, at(i).look); }

  void link(uint32_t a, uint32_t b) {
    if (is_same(at(a).look, at(b).look)) {
      same_[a].add(b);
      same_[b].add(a);
    }
    if (is_edge(a) && !at(b).edge) beside_[b].add(a);
    if (is_edge(b) && !at(a).edge) beside_[a].add(b);
  }

  /// The edge's vertex and those of the rim behind it.
  void add_rows(uint32_t edge, bool above, CollapseTuple& out) {
    uint32_t before = kNone, v = edge;
    for (uint32_t row = 0; row < kRows && v != kNone; ++row) {
      if (at(v).depth > 0 && row > 1) return;
      out.vertices[row + (above ? kRows : 0)] = v;
      tuple_of[v] = static_cast<uint32_t>(tuples.count);
      const Two& next = same_[v];
      const uint32_t to = next.vertices[0] == before ? next.vertices[1] : next.vertices[0];
      before = v;
      v = to;
    }
  }

  void find_pairs() {
    uint32_t count = 0;
    for (uint32_t i = 0; i < mesh_->vertices.count(); ++i) {
      if (is_edge(i)) order_[count++] = i;
    }
    std::sort(order_.data, order_.data + count, [this](uint32_t a, uint32_t b) {
      const Vec3 p = at(a).look, q = at(b).look;
      if (p.x != q.x) return p.x < q.x;
      if (p.y != q.y) return p.y < q.y;
      return p.z != q.z ? p.z < q.z : a < b;
    });
    for (uint32_t i = 0; i + 1 < count; ++i) {
      const uint32_t a = order_[i], b = order_[i + 1];
      if (length(at(a).look - at(b).look) > kSamePlace) continue;
      const bool above = at(a).lid != 0 ? at(a).lid > 0 : at(a).side == Side::kAbove;
      CollapseTuple tuple;
      add_rows(a, above, tuple);
      add_rows(b, !above, tuple);
      tuples[tuples.count++] = tuple;
    }
  }

  /// Where both edges of a slit meet.
  void find_ends() {
    for (uint32_t i = 0; i < mesh_->vertices.count(); ++i) {
      const Two& edges = beside_[i];
      if (edges.vertices[1] == kNone) continue;
      const uint32_t pair = tuple_of[edges.vertices[0]];
      if (pair == kNone || tuple_of[edges.vertices[1]] != pair) continue;
      CollapseTuple tuple;
      add_rows(i, false, tuple);
      add_rows(i, true, tuple);
      tuples[tuples.count++] = tuple;
    }
  }

  const HalfMesh* mesh_ = nullptr;
  Span<Two> same_, beside_;  // neighbors with the same look; on edges, of vertices that are not
  Span<uint32_t> order_;
};

class LodMaker {
 public:
  LodMaker(const Form& form, const HalfMesh& whole, Arena& scratch, const Allocator& allocator)
      : form_(form), whole_(whole), scratch_(scratch), allocator_(allocator) {}

  /// False if memory ran out.
  bool make(const Plan& plan, PartLods& out) {
    CollapseGuards guards;
    if (!make_mesh() || !make_guards(plan, guards)) return false;
    Span<author::Shape> poses;
    if (is_skin() && !make_poses(poses)) return false;
    if (!left_.make(mesh_, poses, guards, scratch_, allocator_)) return false;
    Span<uint32_t> floors;
    if (!author::make(scratch_, mesh_.component_count, floors) ||
        !author::make(scratch_, whole_.vertices.count(), numbers_)) {
      return false;
    }
    for (uint32_t& f : floors) f = kLeastTriangles;
    for (uint32_t lod = 1; lod < kLodCount; ++lod) {
      left_.reduce(plan.triangles[lod - 1], floors);
      if (!take(out.at[lod])) return false;
    }
    return true;
  }

 private:
  bool is_skin() const { return whole_.vertices[0].carrier == Carrier::kSkin; }

  bool make_mesh() {
    const Span<Face> faces = whole_.faces.span();
    const uint32_t n = whole_.vertices.count();
    uint32_t corners = 0, triangles = 0;
    for (const Face& f : faces) corners += f.count, triangles += f.count - 2;
    Span<Vec3> positions;
    Span<uint32_t> starts, all, fans, welded, component;
    Span<uint8_t> skin;
    Span<author::Part> parts;
    if (!author::make(scratch_, n, positions) || !author::make(scratch_, faces.count + 1, starts) ||
        !author::make(scratch_, corners, all) || !author::make(scratch_, 3 * triangles, fans) ||
        !author::make(scratch_, n, welded) || !author::make(scratch_, n, skin) ||
        !author::make(scratch_, 1, parts)) {
      return false;
    }
    for (uint32_t i = 0; i < n; ++i) {
      positions[i] = whole_.vertices[i].position;
      welded[i] = i;
      skin[i] = is_skin();
    }
    uint32_t corner = 0, fan = 0;
    for (uint32_t f = 0; f < faces.count; ++f) {
      for (uint32_t i = 0; i < faces[f].count; ++i) {
        all[corner++] = faces[f].corners[i];
        for (const uint32_t k : {0u, i, i + 1}) {
          if (i > 0 && i + 1 < faces[f].count) fans[fan++] = faces[f].corners[k];
        }
      }
      starts[f + 1] = corner;
    }
    parts[0].vertex_count = n;
    parts[0].face_count = static_cast<uint32_t>(faces.count);
    mesh_.positions = positions;
    mesh_.face_starts = starts;
    mesh_.corners = all;
    mesh_.triangles = fans;
    mesh_.welded = welded;
    mesh_.is_skin = skin;
    mesh_.parts = parts;
    if (!author::find_components(fans, welded, scratch_, scratch_, component,
                                 mesh_.component_count)) {
      return false;
    }
    mesh_.component = component;
    return true;
  }

  bool make_guards(const Plan& plan, CollapseGuards& out) {
    const uint32_t n = whole_.vertices.count();
    Span<uint8_t> on_plane;
    Span<float> weights;
    Span<Vec3> colors;
    if (!author::make(scratch_, n, on_plane) || !author::make(scratch_, n, colors)) return false;
    for (uint32_t i = 0; i < n; ++i) {
      const Color c = whole_.vertices[i].color;
      on_plane[i] = whole_.on_plane(i);
      colors[i] = Vec3{c.r, c.g, c.b} * (plan.color / 255);
    }
    if (!author::make(scratch_, n, weights)) return false;
    for (uint32_t i = 0; i < n; ++i) {
      weights[i] = static_cast<float>(importance(form_, whole_.vertices[i]));
    }
    out.least_shape = 0.15;
    out.on_plane = on_plane;
    out.colors = colors;
    out.weights = weights;
    if (!is_skin()) return true;
    if (!slits_.find(whole_, scratch_, scratch_)) return false;
    out.tuples = slits_.tuples;
    out.tuple_of = slits_.tuple_of;
    return true;
  }

  bool make_poses(Span<author::Shape>& out) {
    const uint32_t n = whole_.vertices.count();
    if (!author::make(scratch_, kPoseCount, out)) return false;
    const Shapes shapes;
    for (uint32_t pose = 0; pose < kPoseCount; ++pose) {
      Span<Vec3f> moves;
      if (!author::make(scratch_, n, moves)) return false;
      uint32_t shape = 0;
      while (pose > 0 && kExpressions[shape].motion != kPosed[pose - 1]) ++shape;
      for (uint32_t i = 0; i < n; ++i) {
        const Vertex& v = whole_.vertices[i];
        const Vec3 d = pose == 0 ? v.closed - v.position : shapes.displacement(shape, v);
        moves[i] = {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
      }
      out[pose].displacements = moves;
    }
    return true;
  }

  /// The faces that are left. A quad stays one while both of its triangles are there.
  bool take(HalfMesh& out) {
    out.mirrored = whole_.mirrored;
    for (uint32_t& number : numbers_) number = 0;
    for (uint32_t t = 0; t < left_.first_triangle(whole_.faces.count()); ++t) {
      for (uint32_t c = 3 * t; left_.is_alive(t) && c < 3 * t + 3; ++c)
        numbers_[left_.vertex(c)] = 1;
    }
    for (uint32_t i = 0; i < numbers_.count; ++i) {
      if (numbers_[i]) numbers_[i] = out.vertices.add(whole_.vertices[i]);
    }
    const auto at = [this](uint32_t corner) { return numbers_[left_.vertex(corner)]; };
    for (uint32_t f = 0; f < whole_.faces.count(); ++f) {
      const uint32_t first = left_.first_triangle(f), end = left_.first_triangle(f + 1);
      const uint32_t c = 3 * first;
      if (end - first == 2 && left_.is_alive(first) && left_.is_alive(first + 1) &&
          at(c + 3) == at(c) && at(c + 4) == at(c + 2) && at(c + 5) != at(c + 1)) {
        out.quad(at(c), at(c + 1), at(c + 2), at(c + 5));
        continue;
      }
      for (uint32_t t = first; t < end; ++t) {
        if (left_.is_alive(t)) out.triangle(at(3 * t), at(3 * t + 1), at(3 * t + 2));
      }
    }
    return !out.failed();
  }

  const Form& form_;
  const HalfMesh& whole_;
  Arena& scratch_;
  const Allocator& allocator_;
  author::AuthorMesh mesh_;
  author::EdgeCollapse left_;
  Slits slits_;
  Span<uint32_t> numbers_;  // of the vertices in the LOD
};

/// The flat faces of closed coarse lids would cut into the ball that fits round ones.
constexpr double kShrunk[kLodCount] = {1, 1, 1, 0.995, 0.99, 0.985, 0.98, 0.98};

void shrink_eye(Vec3 middle, double by, HalfMesh& eye) {
  for (Vertex& v : eye.vertices.span()) {
    v.position = v.closed = v.look = middle + (v.position - middle) * by;
  }
}

}  // namespace

bool make_lods(const Form& form, Part part, const Allocator& allocator, PartLods& out) {
  if (!make_part(form, part, out.at[0])) return false;
  const auto collapse = [&](const Plan& plan) {
    Arena scratch(allocator);
    return LodMaker(form, out.at[0], scratch, allocator).make(plan, out);
  };
  switch (part) {
    case Part::kHead: return collapse(kSkinPlan);
    case Part::kTeeth: return collapse(kTeethPlan);
    case Part::kTongue: return collapse(kTonguePlan);
    case Part::kEyeLeft:
    case Part::kEyeRight: {
      if (!collapse(kEyePlan)) return false;
      for (uint32_t lod = 1; lod < kLodCount; ++lod)
        shrink_eye(form.eye(), kShrunk[lod], out.at[lod]);
      return true;
    }
    case Part::kHair:
    case Part::kBrows:
    case Part::kLashes: break;
  }
  // Cards of hair do not collapse: further LODs have fewer and wider ones.
  for (uint32_t lod = 1; lod < kLodCount; ++lod) {
    if (!make_hairs(form, part, lod, out.at[lod])) return false;
  }
  return true;
}

}  // namespace mien::head
