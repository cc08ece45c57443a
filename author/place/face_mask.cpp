// SPDX-License-Identifier: MIT
#include "author/place/face_mask.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/mesh/surface_tree.h"

namespace mien::author {

namespace {

// A head is at least this deep relative to its width; a mask of the front is not.
constexpr double kFaceOnlyDepth = 0.75;
// Motion above which a place is in the mask, relative to the diagonal.
constexpr double kMoves = 1e-3;
// Mean distance of mirrored places to the mesh, part of the diagonal of the mask.
constexpr double kSymmetric = 0.005, kPaired = 0.05;

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
  // The order decides which place gets which random number, so it must not depend on the file.
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

void measure_groups(Placing& placing) {
  PlaceReport& report = placing.report;
  report.group_count = placing.options.groups;
  for (size_t i = 0; i < placing.group.count; ++i) {
    const uint8_t group = placing.group[i];
    const double z = placing.points[i].z;
    DepthRange& range = report.group_depths[group];
    if (report.group_sizes[group]++ == 0) range = {z, z};
    range = {std::max(range.front, z), std::min(range.back, z)};
  }
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
  measure_groups(placing);
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
  if (n < options.groups) {
    if (report.face_only) return Status::kOk;
    return fail(placing.error, Status::kAuthorRefused, kNoOffset,
                "the skin has only %zu positions, fewer than the %u groups in depth", n,
                options.groups);
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
  measure_groups(placing);
  return Status::kOk;
}

namespace {

/// Places with a vertex in the caller's mask; without a mask, those that a shape moves by more than
/// the least amount.
Status mark_places(Placing& placing, Span<uint8_t>& out) {
  const AuthorMesh& mesh = placing.mesh;
  const Span<const uint8_t> own = placing.options.own_mask;
  Span<uint8_t> marked;
  if (!make(placing.scratch, mesh.positions.count, marked) ||
      !make(placing.scratch, placing.skin.count, out)) {
    return no_memory(placing);
  }
  for (size_t v = 0; v < own.count; ++v) {
    if (own[v]) marked[mesh.welded[v]] = 1;
  }
  const double least = kMoves * mesh.diagonal;
  for (size_t s = 0; s < mesh.shapes.count && own.empty(); ++s) {
    for (const uint32_t v : mesh.shapes[s].moving) {
      const Vec3f d = mesh.shapes[s].displacements[v];
      if (length({d.x, d.y, d.z}) > least) marked[mesh.welded[v]] = 1;
    }
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
  const Landmark& nose = report.landmarks[LandmarkKind::kNose];
  const Landmark& throat = report.landmarks[LandmarkKind::kThroat];
  placing.profile =
      find_throat(closed_profile(placing.mesh, placing.plane), nose.given ? &nose.at : nullptr);
  if (throat.given) {
    placing.profile.found = true;
    placing.profile.y = throat.at.y;
    placing.profile.z = throat.at.z;
  }
  if (throat.given || (options.neck_cut && !report.face_only)) report.throat = placing.profile;
  if (!make(placing.scratch, n, placing.in_mask)) return no_memory(placing);
  const auto above_cut = [&](size_t i) {
    return !report.throat.found || report.throat.cut().above(placing.points[i]) >= 0;
  };
  Span<uint8_t> moving, given;
  if (!options.own_mask.empty()) {
    if (Status status = mark_places(placing, given); status != Status::kOk) return status;
  } else if (!placing.mesh.shapes.empty() && !options.paper) {
    if (Status status = mark_places(placing, moving); status != Status::kOk) return status;
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
  report.mask_positions = static_cast<uint32_t>(count);
  if (count < 4) {
    return fail(placing.error, Status::kAuthorRefused, kNoOffset,
                "the face mask has %zu of %zu positions: at least 4 are needed", count, n);
  }
  if (!make(placing.scratch, count, placing.mask)) return no_memory(placing);
  count = 0;
  for (uint32_t i = 0; i < n; ++i) {
    if (placing.in_mask[i]) placing.mask[count++] = i;
  }
  return Status::kOk;
}

Status find_symmetry(Placing& placing) {
  if (placing.options.paper || placing.options.symmetry == Symmetry::kOff) return Status::kOk;
  const AuthorMesh& mesh = placing.mesh;
  Span<uint32_t> triangles;
  SurfaceTree surface;
  if (!make(placing.scratch, mesh.triangles.count, triangles)) return no_memory(placing);
  size_t count = 0;
  for (size_t t = 0; t < mesh.triangles.count; t += 3) {
    if (!mesh.is_skin[mesh.triangles[t]]) continue;
    for (size_t k = 0; k < 3; ++k) triangles[count++] = mesh.triangles[t + k];
  }
  if (count == 0) return Status::kOk;
  if (!surface.build(mesh.positions, triangles.first(count), placing.scratch)) {
    return no_memory(placing);
  }
  double sum = 0;
  Vec3 low = placing.points[placing.mask[0]], high = low;
  for (uint32_t i : placing.mask) {
    const Vec3 p = placing.points[i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    sum += surface.distance({2 * placing.plane - p.x, p.y, p.z});
  }
  placing.report.symmetry_error =
      sum / static_cast<double>(placing.mask.count) / length(high - low);
  placing.symmetric =
      placing.options.symmetry == Symmetry::kOn || placing.report.symmetry_error < kSymmetric;
  placing.paired = !placing.symmetric && placing.report.symmetry_error < kPaired;
  return Status::kOk;
}

}  // namespace mien::author
