// SPDX-License-Identifier: MIT
// The topology of a mesh: places that several vertices share, components, edges with lengths.
#pragma once

#include "author/mesh/author_mesh.h"
#include "runtime/base/arena.h"

namespace mien::author {

struct Box {
  Vec3 low, high;

  Vec3 size() const { return high - low; }
  double diagonal() const { return length(high - low); }
};
/// `points` is not empty.
Box bounding_box(Span<const Vec3> points);

/// For each vertex the first one at the same place. Places are compared on a grid of 1e-6 of the diagonal
/// of the bounding box, so copies of a vertex count as one. Vertices that a shape moves apart are at
/// different places: lips that touch are two. False if memory ran out.
bool weld(Span<const Vec3> positions, Span<const Shape> shapes, Arena& arena, Arena& scratch,
          Span<uint32_t>& out);

/// Orders vertices by their displacements: less than 0, 0 or more, shape after shape.
int compare_displacements(Span<const Shape> shapes, uint32_t a, uint32_t b, double tolerance);

/// For each vertex the number of its connected component; components are numbered in the order of
/// their first vertices. False if memory ran out.
bool find_components(Span<const uint32_t> triangles, Span<const uint32_t> welded, Arena& arena,
                     Arena& scratch, Span<uint32_t>& out, uint32_t& out_count);

/// Edges of the welded mesh. Vertices that are not the first at their place have none.
struct SurfaceGraph {
  Span<uint32_t> starts;  // vertices + 1
  Span<uint32_t> neighbors;
  Span<double> lengths;
};
bool make_surface_graph(const AuthorMesh& mesh, Arena& arena, Arena& scratch, SurfaceGraph& out);

/// A third of the area of the triangles around each place; 0 for vertices that are not the first at
/// theirs. `out` has the size of the positions.
void vertex_areas(const AuthorMesh& mesh, Span<double> out);

/// Heap of the shortest distance paths: the nearest first, of equal ones the lowest key.
struct Step {
  double distance;
  uint32_t vertex, label;
  double way;  // along the surface, where the distance is another measure

  bool operator<(const Step& other) const {
    if (distance != other.distance) return distance < other.distance;
    return label != other.label ? label < other.label : vertex < other.vertex;
  }
};
class StepHeap {
 public:
  explicit StepHeap(Arena& arena) : arena_(&arena) {}
  /// False if memory ran out.
  bool push(Step step);
  Step pop();
  bool empty() const { return count_ == 0; }

 private:
  Arena* arena_;
  Span<Step> steps_;
  size_t count_ = 0;
};

/// Distance along edges from the nearest of `sources` (vertices); infinite where none can be reached.
bool surface_distances(const AuthorMesh& mesh, const SurfaceGraph& graph,
                       Span<const uint32_t> sources, Arena& scratch, Span<double> out);

}  // namespace mien::author
