// SPDX-License-Identifier: MIT
#include "runtime/author/place/face_mask.h"

#include <algorithm>

#include "runtime/author/dna_making.h"
#include "runtime/author/mesh/point_tree.h"

namespace mien::author {

namespace {

// A head is at least as deep as this part of its width; the front of one is not.
constexpr double kFaceOnlyDepth = 0.75;
// Motion that adds a place to the mask, part of the diagonal.
constexpr double kMoves = 1e-3;
// Mean distance of mirrored places to the mesh, part of the diagonal of the mask.
constexpr double kSymmetric = 0.005;

}  // namespace

Status find_skin(Placing& placing) {
  const AuthorMesh& mesh = placing.mesh;
  const size_t n = mesh.positions.count;
  if (!make(placing.scratch, n, placing.areas)) return no_memory(placing);
  size_t count = 0;
  for (uint32_t v = 0; v < n; ++v) count += mesh.is_skin[v] && mesh.welded[v] == v;
  if (!make(placing.scratch, count, placing.skin) ||
      !make(placing.scratch, count, placing.points)) {
    return no_memory(placing);
  }
  count = 0;
  for (uint32_t v = 0; v < n; ++v) {
    if (mesh.is_skin[v] && mesh.welded[v] == v) placing.skin[count++] = v;
  }
  // The order decides which random number meets which place, so it must not be that of the file.
  std::sort(placing.skin.begin(), placing.skin.end(), [&](uint32_t a, uint32_t b) {
    const Vec3 p = mesh.positions[a], q = mesh.positions[b];
    if (p.z != q.z) return p.z < q.z;
    if (p.y != q.y) return p.y < q.y;
    if (p.x != q.x) return p.x < q.x;
    const int order = compare_displacements(mesh.shapes, a, b, 0);
    return order != 0 ? order < 0 : a < b;
  });
  for (size_t i = 0; i < count; ++i) placing.points[i] = mesh.positions[placing.skin[i]];
  placing.box = bounding_box(placing.points);
  placing.plane = (placing.box.low.x + placing.box.high.x) / 2;
  vertex_areas(mesh, placing.areas);
  return Status::kOk;
}

namespace {

void count_groups(Placing& placing) {
  PlaceReport& report = placing.report;
  report.group_count = placing.options.groups;
  for (const uint8_t group : placing.group) ++report.group_sizes[group];
}

Status take_groups(Placing& placing) {
  const uint32_t groups = placing.options.groups;
  for (size_t i = 0; i < placing.group.count; ++i) {
    const uint8_t group = placing.options.own_groups[placing.skin[i]];
    if (group >= groups) {
      return fail(placing.error, Status::kAuthorMesh, kNoOffset,
                  "a position of the face is in group %u in depth: there are %u", group, groups);
    }
    placing.group[i] = group;
  }
  count_groups(placing);
  return Status::kOk;
}

/// Groups as intervals of z.
Status link_depths(Placing& placing, Span<const double> weights) {
  PlaceReport& report = placing.report;
  const uint32_t groups = placing.options.groups;
  const size_t n = placing.points.count;
  Span<double> depths;
  if (!make(placing.scratch, n, depths)) return no_memory(placing);
  for (size_t i = 0; i < n; ++i) depths[i] = placing.points[i].z;
  if (!link_on_line(depths, weights, placing.arena, placing.scratch, report.linkage)) {
    return no_memory(placing);
  }
  uint32_t starts[kMaxGroups];
  report.linkage.group_starts(groups, starts);
  report.border_count = groups - 1;
  for (uint32_t g = 0; g < groups; ++g) {
    // Groups ascend in z; the front one is the last.
    const uint32_t from = starts[groups - 1 - g];
    const size_t to = g == 0 ? n : starts[groups - g];
    for (size_t i = from; i < to; ++i)
      placing.group[report.linkage.order[i]] = static_cast<uint8_t>(g);
    if (g + 1 < groups) {
      report.borders[g] =
          (depths[report.linkage.order[from]] + depths[report.linkage.order[from - 1]]) / 2;
    }
  }
  return Status::kOk;
}

}  // namespace

Status group_in_depth(Placing& placing) {
  const PlaceOptions& options = placing.options;
  PlaceReport& report = placing.report;
  const Vec3 size = placing.box.size();
  const size_t n = placing.points.count;
  report.face_only = options.own_groups.empty() && size.z / size.x < kFaceOnlyDepth;
  if (report.face_only) return Status::kOk;
  if (n < options.groups) {
    return fail(placing.error, Status::kAuthorRefused, kNoOffset,
                "the skin has %zu places: %u groups in depth need as many", n, options.groups);
  }
  if (!make(placing.scratch, n, placing.group)) return no_memory(placing);
  if (!options.own_groups.empty()) return take_groups(placing);
  Span<double> weights;
  if (options.area_density) {
    if (!make(placing.scratch, n, weights)) return no_memory(placing);
    for (size_t i = 0; i < n; ++i) {
      weights[i] = placing.areas[placing.skin[i]] + 1e-12 * size.x * size.y;
    }
  }
  if (options.group_in_space) {
    if (!link_in_space(placing.points, weights, options.groups, placing.arena, placing.scratch,
                       report.linkage, placing.group)) {
      return no_memory(placing);
    }
  } else if (Status status = link_depths(placing, weights); status != Status::kOk) {
    return status;
  }
  count_groups(placing);
  return Status::kOk;
}

namespace {

/// Places that a shape moves by more than the least amount; null if memory ran out.
Status find_moving(Placing& placing, Span<uint8_t>& out) {
  const AuthorMesh& mesh = placing.mesh;
  Span<uint8_t> moves;
  if (!make(placing.scratch, mesh.positions.count, moves) ||
      !make(placing.scratch, placing.skin.count, out)) {
    return no_memory(placing);
  }
  const double least = kMoves * mesh.diagonal;
  for (const Shape& shape : mesh.shapes) {
    for (uint32_t v : shape.moving) {
      const Vec3f d = shape.displacements[v];
      if (length({d.x, d.y, d.z}) > least) moves[mesh.welded[v]] = 1;
    }
  }
  for (size_t i = 0; i < placing.skin.count; ++i) out[i] = moves[placing.skin[i]];
  return Status::kOk;
}

/// Places of which a copy is in the caller's mask.
Status take_mask(Placing& placing, Span<uint8_t>& out) {
  const AuthorMesh& mesh = placing.mesh;
  Span<uint8_t> marked;
  if (!make(placing.scratch, mesh.positions.count, marked) ||
      !make(placing.scratch, placing.skin.count, out)) {
    return no_memory(placing);
  }
  for (size_t v = 0; v < marked.count; ++v) {
    if (placing.options.own_mask[v]) marked[mesh.welded[v]] = 1;
  }
  for (size_t i = 0; i < placing.skin.count; ++i) out[i] = marked[placing.skin[i]];
  return Status::kOk;
}

Status add_rings(Placing& placing, uint32_t rings, Span<uint8_t> places) {
  SurfaceGraph graph;
  Span<uint8_t> marked;
  if (!make_surface_graph(placing.mesh, placing.scratch, placing.scratch, graph) ||
      !make(placing.scratch, placing.mesh.positions.count, marked)) {
    return no_memory(placing);
  }
  for (size_t i = 0; i < places.count; ++i) marked[placing.skin[i]] = places[i];
  for (uint32_t ring = 1; ring <= rings; ++ring) {
    for (uint32_t v : placing.skin) {
      for (uint32_t e = graph.starts[v]; e < graph.starts[v + 1] && !marked[v]; ++e) {
        const uint8_t there = marked[graph.neighbors[e]];
        if (there != 0 && there <= ring) marked[v] = static_cast<uint8_t>(ring + 1);
      }
    }
  }
  for (size_t i = 0; i < places.count; ++i) places[i] = marked[placing.skin[i]] != 0;
  return Status::kOk;
}

}  // namespace

Status find_mask(Placing& placing) {
  const PlaceOptions& options = placing.options;
  PlaceReport& report = placing.report;
  const size_t n = placing.points.count;
  if (options.neck_cut && !report.face_only) {
    report.throat = find_throat(front_profile(placing.mesh, placing.plane));
  }
  if (!make(placing.scratch, n, placing.in_mask)) return no_memory(placing);
  const auto above_cut = [&](size_t i) {
    return !report.throat.found || report.throat.cut().above(placing.points[i]) >= 0;
  };
  Span<uint8_t> moving, given;
  if (!options.own_mask.empty()) {
    if (Status status = take_mask(placing, given); status != Status::kOk) return status;
  } else if (!placing.mesh.shapes.empty() && !options.paper) {
    if (Status status = find_moving(placing, moving); status != Status::kOk) return status;
  }
  if (options.mask_from_shapes && given.empty()) {
    if (moving.empty()) {
      return fail(placing.error, Status::kAuthorRefused, kNoOffset,
                  "the mask is to come from shapes, but there are none to use");
    }
    if (Status status = add_rings(placing, 2, moving); status != Status::kOk) return status;
  }
  size_t count = 0;
  for (size_t i = 0; i < n; ++i) {
    const bool front = report.face_only || placing.group[i] == 0;
    bool in = !given.empty()             ? given[i] != 0
              : options.mask_from_shapes ? moving[i] != 0
                                         : front && above_cut(i);
    if (!in && !moving.empty() && moving[i] && above_cut(i)) {
      in = true;
      ++report.added_by_shapes;
    }
    placing.in_mask[i] = in;
    count += in;
  }
  report.mask_places = static_cast<uint32_t>(count);
  if (count < 4) {
    return fail(placing.error, Status::kAuthorRefused, kNoOffset,
                "the face mask has %zu of %zu places: at least 4 are needed", count, n);
  }
  if (!make(placing.scratch, count, placing.mask)) return no_memory(placing);
  count = 0;
  for (uint32_t i = 0; i < n; ++i) {
    if (placing.in_mask[i]) placing.mask[count++] = i;
  }
  return Status::kOk;
}

namespace {

/// Squared distance of `p` to the triangle.
double squared_distance_to(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const auto to = [&](Vec3 q) { return dot(p - q, p - q); };
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const Vec3 normal = cross(ab, ac);
  const double area = dot(normal, normal);
  if (area > 0) {
    const double v = dot(cross(ap, ac), normal) / area, w = dot(cross(ab, ap), normal) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) {
      const double height = dot(ap, normal);
      return height * height / area;
    }
  }
  double best = to(a);
  const Vec3 ends[3][2] = {{a, b}, {b, c}, {c, a}};
  for (const auto& end : ends) {
    const Vec3 along = end[1] - end[0];
    const double size = dot(along, along);
    double t = size > 0 ? dot(p - end[0], along) / size : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    best = std::min(best, to(end[0] + along * t));
  }
  return best;
}

}  // namespace

Status find_symmetry(Placing& placing) {
  if (placing.options.paper || placing.options.symmetry == Symmetry::kOff) return Status::kOk;
  const AuthorMesh& mesh = placing.mesh;
  // Triangles around each place.
  Span<uint32_t> starts, around;
  PointTree tree;
  if (!make(placing.scratch, mesh.positions.count + 1, starts) ||
      !make(placing.scratch, mesh.triangles.count, around) ||
      !tree.build(placing.points, placing.scratch)) {
    return no_memory(placing);
  }
  const auto first_at = [&](size_t corner) { return mesh.welded[mesh.triangles[corner]]; };
  for (size_t c = 0; c < mesh.triangles.count; ++c) ++starts[first_at(c) + 1];
  for (size_t v = 0; v + 1 < starts.count; ++v) starts[v + 1] += starts[v];
  for (size_t c = mesh.triangles.count; c-- > 0;) {
    around[--starts[first_at(c) + 1]] = static_cast<uint32_t>(c / 3);
  }
  // starts[v + 1] is now where the triangles of v begin; the next entry is where they end.
  const auto begin_of = [&](uint32_t v) { return starts[v + 1]; };
  const auto end_of = [&](uint32_t v) {
    return v + 2 < starts.count ? starts[v + 2] : static_cast<uint32_t>(around.count);
  };
  double sum = 0;
  Vec3 low = placing.points[placing.mask[0]], high = low;
  for (uint32_t i : placing.mask) {
    const Vec3 p = placing.points[i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    const Vec3 mirrored = {2 * placing.plane - p.x, p.y, p.z};
    constexpr uint32_t kNearest = 4;
    Near near[kNearest];
    const uint32_t found = tree.nearest(mirrored, kNearest, near);
    double best = near[0].squared_distance;
    for (uint32_t f = 0; f < found && best > 0; ++f) {
      const uint32_t v = placing.skin[near[f].point];
      for (uint32_t t = begin_of(v); t < end_of(v); ++t) {
        const uint32_t* corner = mesh.triangles.data + size_t{3} * around[t];
        best = std::min(best,
                        squared_distance_to(mirrored, mesh.positions[corner[0]],
                                            mesh.positions[corner[1]], mesh.positions[corner[2]]));
      }
    }
    sum += std::sqrt(best);
  }
  placing.report.symmetry_error =
      sum / static_cast<double>(placing.mask.count) / length(high - low);
  placing.symmetric =
      placing.options.symmetry == Symmetry::kOn || placing.report.symmetry_error < kSymmetric;
  return Status::kOk;
}

}  // namespace mien::author
