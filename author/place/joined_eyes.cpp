// SPDX-License-Identifier: MIT
#include "author/place/joined_eyes.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"
#include "author/mesh/topology.h"
#include "author/place/extra_joints.h"

namespace mien::author {

namespace {

// A radius is a part of the diagonal of the skin; a cell, in which centers are counted, of the smallest one.
constexpr double kSmallestBall = 0.01, kLargestBall = 0.06, kCell = 0.8;
// How much the curvature of the edges around a place may differ, as on a sphere.
constexpr double kEvenly = 0.3;
// Of its sphere a ball covers at least this part. A nose or a chin covers less.
constexpr double kCovered = 0.35;
constexpr double kRound =
    0.06;  // distances of an eyeball's surface from its sphere, as for find_eyes()
constexpr uint32_t kTries = 48;  // the cells with the most votes

/// Where the surface around a place would have its center if it was a sphere.
struct Vote {
  int64_t cell[3];
  double share;  // of the sphere that the surface around the place covers
  Vec3 center;
  uint32_t vertex;

  int compare(const Vote& other) const {
    for (int k = 0; k < 3; ++k) {
      if (cell[k] != other.cell[k]) return cell[k] < other.cell[k] ? -1 : 1;
    }
    return 0;
  }
};

/// Votes of a cell.
struct EyeCell {
  double share = 0;
  Vec3 center;
  double radius = 0;
};

class BallFinder {
 public:
  BallFinder(AuthorMesh& mesh, Arena& arena, const Allocator& allocator)
      : mesh_(mesh), arena_(arena), scratch_(allocator) {}

  bool run() {
    const size_t n = mesh_.positions.count;
    if (!make(scratch_, n, normals_) || !make(scratch_, n, areas_) || !make(scratch_, n, points_) ||
        !make(scratch_, n, in_ball_) ||
        !make(scratch_, mesh_.component_count + kMaxEyes, of_ball_) ||
        !make_surface_graph(mesh_, scratch_, scratch_, graph_) || !find_normals() ||
        !count_votes()) {
      return false;
    }
    for (uint32_t i = 0, found = 0; i < cells_.count && i < kTries && found < kMaxEyes; ++i) {
      uint32_t component = kNone;
      if (!is_ball(cells_[i], component)) continue;
      if (!separate(component)) return false;
      ++found;
    }
    return true;
  }

 private:
  /// Of length 1 or 0, to the outside of their component.
  bool find_normals() {
    Span<Vec3> middles;
    Span<double> counts, volumes;
    const size_t components = mesh_.component_count;
    if (!make(scratch_, components, middles) || !make(scratch_, components, counts) ||
        !make(scratch_, components, volumes)) {
      return false;
    }
    for (uint32_t v = 0; v < mesh_.positions.count; ++v) {
      Vec3& middle = middles[mesh_.component[v]];
      middle = middle + mesh_.positions[v];
      counts[mesh_.component[v]] += 1;
    }
    for (size_t c = 0; c < components; ++c) middles[c] = middles[c] * (1 / counts[c]);
    for (size_t t = 0; t + 2 < mesh_.triangles.count; t += 3) {
      const uint32_t* c = mesh_.triangles.data + t;
      const Vec3 a = mesh_.positions[c[0]], b = mesh_.positions[c[1]], d = mesh_.positions[c[2]];
      const Vec3 normal = cross(b - a, d - a);
      volumes[mesh_.component[c[0]]] += dot(a - middles[mesh_.component[c[0]]], normal);
      for (int k = 0; k < 3; ++k) {
        Vec3& sum = normals_[mesh_.welded[c[k]]];
        sum = sum + normal;
      }
    }
    for (uint32_t v = 0; v < mesh_.positions.count; ++v) {
      normals_[v] = normalized(normals_[v]) * (volumes[mesh_.component[v]] < 0 ? -1.0 : 1.0);
    }
    vertex_areas(mesh_, areas_);
    return true;
  }

  /// By the curvature of the edges around the vertex. False if they do not agree.
  bool radius_at(uint32_t v, double& radius) const {
    const uint32_t first = graph_.starts[v], last = graph_.starts[v + 1];
    double sum = 0, least = 0, most = 0;
    for (uint32_t e = first; e < last; ++e) {
      const Vec3 d = mesh_.positions[graph_.neighbors[e]] - mesh_.positions[v];
      const double curvature = -2 * dot(d, normals_[v]) / dot(d, d);
      least = e == first ? curvature : std::min(least, curvature);
      most = e == first ? curvature : std::max(most, curvature);
      sum += curvature;
    }
    const double mean = sum / std::max(1u, last - first);
    if (!(last - first >= 3 && mean > 0 && most - least < 2 * kEvenly * mean)) return false;
    radius = 1 / mean;
    return radius > kSmallestBall * mesh_.diagonal && radius < kLargestBall * mesh_.diagonal;
  }

  /// Fills `cells_`, those with the most votes first.
  bool count_votes() {
    const double size = kCell * kSmallestBall * mesh_.diagonal;
    Span<Vote> votes;
    size_t count = 0;
    if (!make(scratch_, mesh_.positions.count, votes)) return false;
    for (uint32_t v = 0; v < mesh_.positions.count; ++v) {
      double radius = 0;
      if (mesh_.welded[v] != v || !radius_at(v, radius)) continue;
      Vote& vote = votes[count++];
      vote.center = mesh_.positions[v] - normals_[v] * radius;
      vote.share = areas_[v] / (4 * kPi * radius * radius);
      vote.vertex = v;
      const double c[3] = {vote.center.x, vote.center.y, vote.center.z};
      for (int k = 0; k < 3; ++k) vote.cell[k] = static_cast<int64_t>(std::floor(c[k] / size));
    }
    // By position within a cell, so that sums do not depend on the order in the file.
    std::sort(votes.data, votes.data + count, [&](const Vote& a, const Vote& b) {
      if (const int order = a.compare(b)) return order < 0;
      const Vec3 p = mesh_.positions[a.vertex], q = mesh_.positions[b.vertex];
      if (p.z != q.z) return p.z < q.z;
      return p.y != q.y ? p.y < q.y : p.x < q.x;
    });
    if (!make(scratch_, count, cells_)) return false;
    size_t used = 0;
    for (size_t i = 0; i < count; ++i) {
      if (i == 0 || votes[i].compare(votes[i - 1]) != 0) cells_[used++] = EyeCell();
      EyeCell& cell = cells_[used - 1];
      const double share = votes[i].share;
      cell.share += share;
      cell.center = cell.center + votes[i].center * share;
      cell.radius += share * length(mesh_.positions[votes[i].vertex] - votes[i].center);
    }
    cells_.count = used;
    for (EyeCell& cell : cells_) {
      if (!(cell.share > 0)) continue;
      cell.center = cell.center * (1 / cell.share);
      cell.radius /= cell.share;
    }
    std::sort(cells_.begin(), cells_.end(), [](const EyeCell& a, const EyeCell& b) {
      if (a.share != b.share) return a.share > b.share;
      if (a.center.x != b.center.x) return a.center.x > b.center.x;
      return a.center.y != b.center.y ? a.center.y > b.center.y : a.center.z > b.center.z;
    });
    return true;
  }

  /// Marks what lies on the sphere, with its outside to the outside, and finds its component. False if it is not
  /// enough, or if it is all of its component already.
  bool is_ball(const EyeCell& cell, uint32_t& component) {
    const double rounds[] = {0.25, 0.12, 0.08, 0.06};  // distances from the sphere, in radii
    Sphere sphere;
    sphere.center = cell.center;
    sphere.radius = cell.radius;
    for (const double off : rounds) {
      size_t count = 0;
      for (uint32_t v = 0; v < mesh_.positions.count; ++v) {
        const Vec3 d = mesh_.positions[v] - sphere.center;
        const double away = length(d);
        in_ball_[v] = mesh_.welded[v] == v &&
                      std::abs(away - sphere.radius) < off * sphere.radius &&
                      dot(d, normals_[v]) > 0.85 * away;
        if (in_ball_[v]) points_[count++] = mesh_.positions[v];
      }
      if (!fit_sphere(points_.first(count), sphere)) return false;
    }
    if (sphere.radius < kSmallestBall * mesh_.diagonal ||
        sphere.radius > kLargestBall * mesh_.diagonal) {
      return false;
    }
    // Of several components that lie on it, such as a cornea, the one with the most vertices.
    for (uint32_t& count : of_ball_) count = 0;
    of_ball_.count = mesh_.component_count;
    for (uint32_t v = 0; v < mesh_.positions.count; ++v) {
      of_ball_[mesh_.component[v]] += in_ball_[v];
    }
    component = 0;
    for (uint32_t c = 1; c < mesh_.component_count; ++c) {
      if (of_ball_[c] > of_ball_[component]) component = c;
    }
    if (is_whole_ball(component, sphere)) return false;
    double covered = 0;
    for (size_t t = 0; t + 2 < mesh_.triangles.count; t += 3) {
      const uint32_t* c = mesh_.triangles.data + t;
      bool is_inside = mesh_.component[c[0]] == component;
      for (int k = 0; k < 3; ++k) is_inside = is_inside && in_ball_[mesh_.welded[c[k]]];
      const Vec3 a = mesh_.positions[c[0]];
      if (is_inside) {
        covered += length(cross(mesh_.positions[c[1]] - a, mesh_.positions[c[2]] - a)) / 2;
      }
    }
    return covered > kCovered * 4 * kPi * sphere.radius * sphere.radius;
  }

  /// Whether the component is an eyeball as it is.
  bool is_whole_ball(uint32_t component, const Sphere& ball) {
    size_t count = 0;
    for (uint32_t v = 0; v < mesh_.positions.count; ++v) {
      if (mesh_.welded[v] != v || mesh_.component[v] != component) continue;
      points_[count++] = mesh_.positions[v];
    }
    Sphere all;
    return fit_sphere(points_.first(count), all) && all.error < kRound * all.radius &&
           all.radius < 1.1 * ball.radius;
  }

  /// Makes a component of what is marked.
  bool separate(uint32_t component) {
    Span<uint32_t> components;
    Span<uint8_t> is_skin;
    if (!make(arena_, mesh_.positions.count, components) ||
        !make(arena_, mesh_.positions.count, is_skin)) {
      return false;
    }
    for (uint32_t v = 0; v < components.count; ++v) {
      const bool is_in = mesh_.component[v] == component && in_ball_[mesh_.welded[v]];
      components[v] = is_in ? mesh_.component_count : mesh_.component[v];
      is_skin[v] = is_in ? 0 : mesh_.is_skin[v];
    }
    mesh_.component = components;
    mesh_.is_skin = is_skin;
    ++mesh_.component_count;
    return true;
  }

  AuthorMesh& mesh_;
  Arena& arena_;
  Arena scratch_;
  SurfaceGraph graph_;
  Span<Vec3> normals_, points_;
  Span<double> areas_;
  Span<uint8_t> in_ball_;
  Span<uint32_t> of_ball_;  // marked vertices of each component
  Span<EyeCell> cells_;
};

}  // namespace

bool separate_eyeballs(AuthorMesh& mesh, Arena& arena, const Allocator& allocator) {
  return BallFinder(mesh, arena, allocator).run();
}

}  // namespace mien::author
