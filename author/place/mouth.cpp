// SPDX-License-Identifier: MIT
#include "author/place/mouth.h"

#include <algorithm>

#include "author/base/dna_making.h"

namespace mien::author {

namespace {

// A way along the section is a detour by its length less this many times the distance of its ends: it ends
// where lips turn away from each other.
constexpr double kDetour = 2;
constexpr double kLeastDetour = 0.15;  // of the distance from the nose to the floor: deep enough
constexpr size_t kMostPoints = 700;    // of one section, which are compared in pairs

/// Where an edge of the mesh crosses the section, and the next ones along it.
struct Crossing {
  uint64_t edge = 0;
  double y = 0, z = 0;
  uint32_t next[2] = {kNone, kNone};

  void link(uint32_t other) {
    if (next[0] == kNone) {
      next[0] = other;
    } else if (next[1] == kNone && next[0] != other) {
      next[1] = other;
    }
  }
};

/// The section of the skin at one x.
class Section {
 public:
  /// False if memory ran out.
  bool cut(const AuthorMesh& mesh, double x, Arena& scratch) {
    const auto is_left = [&](uint32_t v) { return mesh.positions[v].x > x; };
    size_t count = 0;
    for (size_t t = 0; t + 2 < mesh.triangles.count; t += 3) {
      const uint32_t* c = mesh.triangles.data + t;
      count +=
          mesh.is_skin[c[0]] && (is_left(c[0]) != is_left(c[1]) || is_left(c[0]) != is_left(c[2]));
    }
    Span<Crossing> both;  // of each triangle, one after the other
    Span<uint64_t> edges;
    if (!make(scratch, 2 * count, both) || !make(scratch, 2 * count, edges)) return count == 0;
    size_t used = 0;
    for (size_t t = 0; t + 2 < mesh.triangles.count; t += 3) {
      const uint32_t* c = mesh.triangles.data + t;
      if (!mesh.is_skin[c[0]]) continue;
      for (int k = 0; k < 3; ++k) {
        uint32_t a = mesh.welded[c[k]], b = mesh.welded[c[(k + 1) % 3]];
        if (is_left(c[k]) == is_left(c[(k + 1) % 3])) continue;
        if (a > b) std::swap(a, b);
        const Vec3 p = mesh.positions[a], q = mesh.positions[b];
        const double s = (x - p.x) / (q.x - p.x);
        both[used].edge = uint64_t{a} << 32 | b;
        both[used].y = p.y + (q.y - p.y) * s;
        both[used].z = p.z + (q.z - p.z) * s;
        edges[used] = both[used].edge;
        ++used;
      }
    }
    std::sort(edges.begin(), edges.begin() + used);
    const size_t distinct =
        static_cast<size_t>(std::unique(edges.begin(), edges.begin() + used) - edges.begin());
    if (!make(scratch, distinct, points_)) return distinct == 0;
    for (size_t i = 0; i + 1 < used; i += 2) {
      uint32_t at[2];
      for (int k = 0; k < 2; ++k) {
        at[k] = static_cast<uint32_t>(
            std::lower_bound(edges.begin(), edges.begin() + distinct, both[i + k].edge) -
            edges.begin());
        Crossing& point = points_[at[k]];
        point.edge = both[i + k].edge;
        point.y = both[i + k].y;
        point.z = both[i + k].z;
      }
      points_[at[0]].link(at[1]);
      points_[at[1]].link(at[0]);
    }
    return true;
  }

  /// The foremost segment that crosses a height: its lower and its upper end. False if there is none.
  bool foremost(double y, uint32_t& lower, uint32_t& upper) const {
    bool found = false;
    double most = 0;
    for (uint32_t i = 0; i < points_.count; ++i) {
      for (const uint32_t j : points_[i].next) {
        if (j == kNone || !(points_[i].y <= y && points_[j].y > y)) continue;
        const double t = (y - points_[i].y) / (points_[j].y - points_[i].y);
        const double z = points_[i].z + (points_[j].z - points_[i].z) * t;
        if (found && !(z > most)) continue;
        found = true;
        most = z;
        lower = i;
        upper = j;
      }
    }
    return found;
  }

  /// From one point by the next to the end of the section, or to `last`. The inside of the mouth may be lower
  /// than the chin, so heights do not say where to stop. Returns how many points are in `out`.
  size_t walk(uint32_t from, uint32_t to, uint32_t last, Span<uint32_t> out, bool& ended) const {
    size_t count = 0;
    out[count++] = from;
    const uint32_t start = from;
    ended = false;
    while (to != kNone && to != start && count < out.count) {
      out[count++] = to;
      if (to == last) return count;
      const Crossing& point = points_[to];
      const uint32_t after = point.next[0] == from ? point.next[1] : point.next[0];
      from = to;
      to = after;
    }
    ended = to == kNone;
    return count;
  }

  const Crossing& operator[](uint32_t i) const { return points_[i]; }
  size_t count() const { return points_.count; }

 private:
  Span<Crossing> points_;
};

/// The mouth in one section.
struct Lips {
  bool found = false, is_hole = false;
  double upper_y = 0, upper_z = 0, lower_y = 0, lower_z = 0;
  double depth = 0;  // of the detour, in the unit of the mesh
  double chin_y = 0, chin_z = 0;
};

/// Looks from `top` down to `floor`. `least` is the shortest detour that counts.
bool find_lips(const AuthorMesh& mesh, double x, double top, double floor, double least,
               Arena& scratch, Lips& out) {
  out = Lips();
  Section section;
  Span<uint32_t> down, up, way;
  if (!section.cut(mesh, x, scratch)) return false;
  const size_t room = section.count() + 1;
  if (section.count() == 0) return true;
  if (!make(scratch, room, down) || !make(scratch, room, up) || !make(scratch, 2 * room, way)) {
    return false;
  }
  struct {
    uint32_t lower = kNone, upper = kNone;
  } nose, chin;
  if (!section.foremost(top, nose.lower, nose.upper)) return true;
  const bool has_chin = section.foremost(floor, chin.lower, chin.upper);
  bool ended = false;
  const size_t down_count = section.walk(nose.upper, nose.lower, chin.lower, down, ended);
  // A border: what begins at the chin is the lower lip.
  size_t up_count = 0;
  if (ended && has_chin) {
    bool other_ended = false;
    up_count = section.walk(chin.lower, chin.upper, nose.upper, up, other_ended);
    if (!other_ended) up_count = 0;
  }
  size_t count = 0;
  for (size_t i = 0; i < down_count; ++i) way[count++] = down[i];
  for (size_t i = up_count; i-- > 0;) way[count++] = up[i];
  const size_t step = count / kMostPoints + 1;
  Span<double> along;
  if (!make(scratch, count, along)) return false;
  const auto distance = [&](size_t i, size_t j) {
    const double y = section[way[i]].y - section[way[j]].y,
                 z = section[way[i]].z - section[way[j]].z;
    return std::sqrt(y * y + z * z);
  };
  for (size_t i = 1; i < count; ++i) {
    const double here = distance(i - 1, i);
    // The gap of a hole counts as a detour, so that its borders are lips.
    along[i] = along[i - 1] + (up_count > 0 && i == down_count ? 2 * kDetour * here : here);
  }
  double best = 0;
  size_t first = 0, last = 0;
  for (size_t i = 0; i < count; i += step) {
    if (section[way[i]].y > top) continue;  // a nostril
    for (size_t j = i + step; j < count; j += step) {
      const double detour = along[j] - along[i] - kDetour * distance(i, j);
      if (!(detour > best)) continue;
      best = detour;
      first = i;
      last = j;
    }
  }
  const bool has_gap = up_count > 0 && first < down_count && last >= down_count;
  const double gap = has_gap ? distance(down_count - 1, down_count) : 0;
  const double cavity = best - (has_gap ? kDetour * gap : 0);
  if (!(cavity > least) && !(has_gap && gap > 0)) return true;
  out.found = section[way[first]].y >= section[way[last]].y;
  out.is_hole = !(cavity > least);
  out.depth = cavity;
  out.upper_y = section[way[first]].y;
  out.upper_z = section[way[first]].z;
  out.lower_y = section[way[last]].y;
  out.lower_z = section[way[last]].z;
  // The chin is what stands out most from the line between lip and floor, however far the mouth is open.
  const Crossing &lip = section[way[last]], &end = section[way[count - 1]];
  double most = 0;
  out.chin_y = lip.y;
  out.chin_z = lip.z;
  for (size_t i = last; i < count; ++i) {
    const Crossing& p = section[way[i]];
    const double out_of_line = (p.z - lip.z) * (lip.y - end.y) - (p.y - lip.y) * (lip.z - end.z);
    if (!(out_of_line > most)) continue;
    most = out_of_line;
    out.chin_y = p.y;
    out.chin_z = p.z;
  }
  return true;
}

}  // namespace

bool find_mouth(const AuthorMesh& mesh, const MouthSearch& search, Arena& scratch, Mouth& out) {
  out = Mouth();
  const double span = search.nose_y - search.floor;
  if (!(span > 0)) return true;
  // Beside the plane itself, on which edges of symmetric meshes lie.
  const double beside = 1e-4 * mesh.diagonal;
  Lips lips;
  // From below the tip of the nose, so that nostrils are not taken for a mouth.
  if (!find_lips(mesh, search.plane + beside, search.nose_y, search.floor, kLeastDetour * span,
                 scratch, lips)) {
    return false;
  }
  if (!lips.found) return true;
  out.found = true;
  out.is_hole = lips.is_hole;
  out.depth = lips.depth / span;
  out.upper = {search.plane, lips.upper_y, lips.upper_z};
  out.lower = {search.plane, lips.lower_y, lips.lower_z};
  out.chin = {search.plane, lips.chin_y, lips.chin_z};
  // Corners: to each side as far as there are two lips, by steps, the last of which is halved until the corner does not
  // depend on where steps lie.
  constexpr int kSteps = 40, kHalvings = 10;
  for (const int side : {1, -1}) {
    Vec3& corner = side > 0 ? out.left : out.right;
    corner = (out.upper + out.lower) * 0.5;
    Lips last = lips;
    double step = search.half_width / kSteps, reached = 0;
    for (int steps = 0, halvings = 0; steps < kSteps && halvings <= kHalvings;) {
      const double x = search.plane + side * (beside + reached + step);
      const double top = last.upper_y + 0.25 * (search.nose_y - out.upper.y);
      const double low = std::max(search.floor, last.lower_y - 0.6 * (out.lower.y - out.chin.y));
      Lips here;
      if (!find_lips(mesh, x, top, low, 0.5 * kLeastDetour * span, scratch, here)) return false;
      if (here.found) {
        corner = {x, (here.upper_y + here.lower_y) / 2, (here.upper_z + here.lower_z) / 2};
        last = here;
        reached += step;
      }
      if (!here.found || halvings > 0) {
        step *= 0.5;
        ++halvings;
      } else {
        ++steps;
      }
    }
  }
  return true;
}

}  // namespace mien::author
