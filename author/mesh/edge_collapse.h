// SPDX-License-Identifier: MIT
// Simplifies a mesh: removes one place after another, always the one whose removal costs least.
//
// Triangles are fans of the faces. Each corner lies at a place, and has a vertex and a texture
// coordinate. A place is one vertex, or the vertices that two borders share along a seam. Shells
// that only touch have separate places. When u collapses onto v, triangles that contain both are
// removed. The others get the corner at v in the same chart. So u can only be removed if the edges
// to v have corners of all charts at u; then the chart stays whole.
//
// On a symmetric mesh, each collapse is followed by its mirror image, quads are split alike on both
// sides, and places on the plane stay on it. Collapses that leave the surface unchanged need no mirror
// image. Borders of the skin, such as lips and lids, keep kLeastLoop places where they bend. Edges of the outline that
// the mesh has from the front and from the side cost more than others (silhouette.h).
#pragma once

#include "author/mesh/author_mesh.h"
#include "author/mesh/quadric.h"
#include "runtime/base/arena.h"

namespace mien::author {

/// Vertices that are removed together: each collapses onto the one in the same slot of a neighboring tuple, as those
/// of both edges of a slit do, so that the edges still meet. Unused slots are kNone. A tuple that has a vertex twice,
/// which is where the slit ends, stays.
struct CollapseTuple {
  static constexpr uint32_t kMaxSize = 6;
  uint32_t vertices[kMaxSize] = {kNone, kNone, kNone, kNone, kNone, kNone};
};

/// What the caller knows about a mesh without seams. Arrays are per vertex; empty ones ask for nothing.
struct CollapseGuards {
  Span<const uint8_t>
      on_plane;  // 1: on the plane about which the mesh will be mirrored. They collapse only
                 // along it, and are the only ones of a face or edge on it
  Span<const float> weights;  // by which errors of the surface count more
  Span<const Vec3>
      colors;  // a change of color costs as a step along the surface of this length does
  Span<const uint32_t> tuple_of;  // of `tuples`, or kNone
  Span<const CollapseTuple> tuples;
  double least_shape = 0.05;  // of triangles, 1: equilateral, 0: a line
};

class EdgeCollapse {
 public:
  /// Keeps `mesh`. Displacements of `poses` count as the surface at rest does. With guards.on_plane the mesh is one
  /// half, and is not searched for a symmetry. False if memory ran out.
  bool make(const AuthorMesh& mesh, Span<const Shape> poses, const CollapseGuards& guards,
            Arena& arena, const Allocator& allocator);

  /// Collapses edges until `wanted` triangles are left, or no edge may go. Component c keeps
  /// `floors[c]`.
  void reduce(uint32_t wanted, Span<const uint32_t> floors);

  /// Removes a whole component.
  void remove_component(uint32_t component);

  uint32_t triangle_count() const { return alive_count_; }
  bool is_symmetric() const { return !mirror_.empty(); }
  Span<const uint32_t> component_counts() const { return component_counts_; }
  /// Triangles of face f are first_triangle(f) to first_triangle(f + 1).
  uint32_t first_triangle(uint32_t face) const { return face_triangles_[face]; }
  bool is_alive(uint32_t triangle) const { return alive_[triangle] != 0; }
  /// Of one corner of a triangle.
  uint32_t vertex(uint32_t corner) const { return vertices_[corner]; }
  /// The corner of the mesh whose texture coordinate it has.
  uint32_t source_corner(uint32_t corner) const { return sources_[corner]; }

 private:
  static constexpr uint32_t kMaxRing = 48;  // triangles around a place that takes part

  /// The triangles around a place and the places beside it.
  struct Ring {
    uint32_t corners[kMaxRing], places[2 * kMaxRing];
    uint32_t corner_count = 0, place_count = 0;

    bool has(uint32_t place) const {
      for (uint32_t i = 0; i < place_count; ++i) {
        if (places[i] == place) return true;
      }
      return false;
    }
  };
  /// What a corner at u becomes at v.
  struct ChartMap {
    uint32_t from[2], to[2];  // charts; corners
    uint32_t count = 0;
  };

  bool find_places(Arena& scratch, Span<uint32_t>& vertex_places) const;
  uint32_t first_of_quad(const uint32_t* places, Span<const uint32_t> face_counts) const;
  bool make_triangles(Span<const uint32_t> vertex_places, Arena& arena, Arena& scratch);
  bool make_charts(Arena& arena, Arena& scratch);
  bool classify_edges(Arena& arena, Arena& scratch);
  bool find_loops(Span<const uint64_t> border_edges, Arena& arena);
  bool is_one_fan(uint32_t place);
  double stretch_of(uint32_t triangle) const;
  void make_quadrics();
  bool guard_outlines(Arena& scratch);
  uint32_t across_of(uint32_t corner) const;
  void add_border(uint32_t corner, double weight);

  uint32_t next_corner(uint32_t c) const { return c % 3 == 2 ? c - 2 : c + 1; }
  uint32_t third_corner(uint32_t c) const { return c % 3 == 0 ? c + 2 : c - 1; }
  /// Pose 0 is at rest.
  Vec3 at(uint32_t place, size_t pose) const;
  Vec3 normal_of(uint32_t triangle, size_t pose) const;
  Vec3 normal_after(uint32_t triangle, uint32_t u, uint32_t v) const;
  void find_ring(uint32_t place, Ring& ring);
  bool map_charts(const Ring& ring, uint32_t v, ChartMap& map) const;
  bool is_flat(uint32_t u, uint32_t v) const;
  bool is_straight(uint32_t u, const Ring& ring) const;
  bool may_collapse(uint32_t u, const Ring& ring, uint32_t v);
  bool keeps_facing(uint32_t u, const Ring& ring, uint32_t v, const ChartMap& map) const;
  double cost(uint32_t u, uint32_t v) const;
  /// Whether the mirror image of the collapse may follow it, or is not needed because nothing changes.
  bool mirror_may_collapse(uint32_t u, uint32_t v);
  /// Whether the whole tuple of u may collapse with it.
  bool tuple_may_collapse(uint32_t u, uint32_t v);
  const CollapseTuple* tuple_of(uint32_t place) const {
    if (guards_.tuple_of.empty() || guards_.tuple_of[place] == kNone) return nullptr;
    return &guards_.tuples[guards_.tuple_of[place]];
  }
  bool is_on_plane(uint32_t place) const {
    return !guards_.on_plane.empty() && guards_.on_plane[place] != 0;
  }
  /// Where a place is after the collapse of the tuple that is being checked.
  uint32_t moved(uint32_t place) const {
    for (uint32_t i = 0; i < move_count_; ++i) {
      if (moves_[i].from == place) return moves_[i].to;
    }
    return place;
  }
  /// Of u, or of its whole tuple, or of u and its mirror image.
  double whole_cost(uint32_t u, uint32_t v) const;
  uint32_t partner_of(uint32_t place) const { return mirror_.empty() ? kNone : mirror_[place]; }
  /// Finds the cheapest collapse of u and enters it into the heap.
  void refresh(uint32_t u);
  void collapse(uint32_t u);
  /// The same for its mirror image, after it.
  void collapse_mirrored(uint32_t u, uint32_t v);
  void collapse_tuple(const CollapseTuple& from, const CollapseTuple& to);

  bool before(uint32_t a, uint32_t b) const {
    return costs_[a] != costs_[b] ? costs_[a] < costs_[b] : a < b;
  }
  void sift(uint32_t slot);
  void remove(uint32_t place);

  struct Move {
    uint32_t from, to;
  };

  const AuthorMesh* mesh_ = nullptr;
  Span<const Shape> poses_;
  CollapseGuards guards_;
  Move moves_[CollapseTuple::kMaxSize];
  uint32_t move_count_ = 0;
  Vec3 center_;

  Span<uint32_t> face_triangles_;               // per face, and the end
  Span<uint32_t> places_, vertices_, sources_;  // per corner of a triangle
  Span<uint32_t> charts_;                       // per corner: equal within a chart around a place
  Span<uint32_t> next_;                         // per corner: another one at the same place
  Span<Vec3> facing_;                           // per triangle: its normal when reduce() began
  Span<uint8_t> alive_;                         // per triangle
  uint32_t alive_count_ = 0;
  Span<uint32_t> component_counts_;  // triangles

  // Per vertex; in use for those that are the first at their place.
  Span<uint32_t> first_, valence_;
  Span<uint8_t> locked_, border_;
  Span<uint32_t>
      mirror_;            // the place on the other side, or kNone; empty: the mesh is not symmetric
  Span<uint32_t> loops_;  // of places on borders of the skin: their loop, else kNone
  Span<uint32_t> loop_counts_;  // places of each loop
  Span<Quadric> quadrics_;      // one for each pose
  Span<Vec3> normals_;          // at rest, before anything was removed; length 1
  Span<double> areas_, costs_;
  Span<uint32_t> targets_, slots_;
  Span<uint32_t> heap_;
  uint32_t heap_count_ = 0;
};

}  // namespace mien::author
