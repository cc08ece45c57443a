// SPDX-License-Identifier: MIT
#include "author/place/jaw_share.h"

#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"

namespace mien::author {

namespace {

constexpr double kRadian = kPi / 180;
// Shares are smoothed over this part of the distance from nose to chin, in so many rounds.
constexpr double kSmoothed = 0.1;
constexpr int kShareSmoothing = 15;

/// Directions in the plane of symmetry: `forward` from the jaw's axis to the corners of the mouth.
struct Wedge {
  Vec3 pivot;
  double y = 0, z = 1;  // forward
  double reach = 1;     // distance of the mouth

  double along(Vec3 p) const { return ((p.y - pivot.y) * y + (p.z - pivot.z) * z) / reach; }
  /// Below the line to the mouth, in radians.
  double below(Vec3 p) const {
    const double dy = p.y - pivot.y, dz = p.z - pivot.z;
    return exact_atan2(y * dz - z * dy, dy * y + dz * z);
  }
};

/// All vertices of the skin that are nearest to a point of a lip, on the lip's side of it.
Status nearest_on_lip(Placing& placing, Vec3 lip, int side, Span<uint32_t>& out) {
  double best = std::numeric_limits<double>::infinity();
  size_t count = 0;
  for (const bool fill : {false, true}) {
    if (fill && !make(placing.scratch, count, out)) return no_memory(placing);
    count = 0;
    for (size_t i = 0; i < placing.skin.count; ++i) {
      const Vec3 d = placing.points[i] - lip;
      if (side * d.y < 0) continue;
      if (!fill) {
        best = std::min(best, dot(d, d));
      } else if (dot(d, d) <= best * (1 + 1e-6)) {
        out[count++] = placing.skin[i];
      }
    }
    if (!fill) {
      for (size_t i = 0; i < placing.skin.count; ++i) {
        const Vec3 d = placing.points[i] - lip;
        count += side * d.y >= 0 && dot(d, d) <= best * (1 + 1e-6);
      }
    }
  }
  return Status::kOk;
}

}  // namespace

Vec3 jaw_by_proportions(const Landmarks& landmarks) {
  // In shares of the height from chin to nose: above the upper lip, and behind it.
  constexpr double kAbove = 0.44, kBehind = 1.32;
  const Vec3 nose = landmarks[LandmarkKind::kNose].at, chin = landmarks[LandmarkKind::kChin].at;
  // As if the lower lip was at the upper one, which an open mouth leaves where it is.
  const Vec3 mouth = landmarks[LandmarkKind::kLipUpper].at;
  const double gap = mouth.y - landmarks[LandmarkKind::kLipLower].at.y;
  const double height = nose.y - chin.y - gap;
  return {mouth.x, mouth.y + kAbove * height, mouth.z - kBehind * height};
}

Status make_jaw_share(Placing& placing, const NeckCut& cut, Span<float>& out) {
  const AuthorMesh& mesh = placing.mesh;
  const Landmarks& marks = placing.report.landmarks;
  const size_t n = mesh.positions.count;
  SurfaceGraph graph;
  Span<uint32_t> above, below;
  Span<double> to_upper, to_lower, share, next;
  if (Status status = nearest_on_lip(placing, marks[LandmarkKind::kLipUpper].at, 1, above);
      status != Status::kOk) {
    return status;
  }
  if (Status status = nearest_on_lip(placing, marks[LandmarkKind::kLipLower].at, -1, below);
      status != Status::kOk) {
    return status;
  }
  if (!make_surface_graph(mesh, placing.scratch, placing.scratch, graph) ||
      !make(placing.scratch, n, to_upper) || !make(placing.scratch, n, to_lower) ||
      !make(placing.scratch, n, share) || !make(placing.scratch, n, next) ||
      !make(placing.arena, n, out) ||
      !surface_distances(mesh, graph, above, placing.scratch, to_upper) ||
      !surface_distances(mesh, graph, below, placing.scratch, to_lower)) {
    return no_memory(placing);
  }
  const Vec3 left = marks[LandmarkKind::kMouthLeft].at, right = marks[LandmarkKind::kMouthRight].at;
  const Vec3 corners = (left + right) * 0.5, chin = marks[LandmarkKind::kChin].at;
  const double half_mouth = std::max(length(left - right) / 2, 1e-3 * mesh.diagonal);
  Wedge wedge;
  wedge.pivot = marks[LandmarkKind::kJaw].at;
  wedge.y = corners.y - wedge.pivot.y;
  wedge.z = corners.z - wedge.pivot.z;
  wedge.reach = std::max(std::sqrt(wedge.y * wedge.y + wedge.z * wedge.z), 1e-6 * mesh.diagonal);
  wedge.y /= wedge.reach;
  wedge.z /= wedge.reach;
  const double at_chin = wedge.below(chin), chin_above = cut.above(chin);
  for (uint32_t v = 0; v < n; ++v) {
    if (mesh.welded[v] != v) continue;
    const Vec3 p = mesh.positions[v];
    const double angle = wedge.below(p);
    double here = smooth_step(-10 * kRadian, 10 * kRadian, angle);
    // Lips, and the inside of the mouth behind them, belong to the lip that is nearer along the skin.
    const double near = std::min(to_upper[v], to_lower[v]) / half_mouth;
    if (near < 2) {
      const double side = (to_upper[v] - to_lower[v]) / (to_upper[v] + to_lower[v] + 1e-12);
      here = mix(smooth_step(-0.25, 0.25, side), here, smooth_step(0.8, 2, near));
    }
    const double front = smooth_step(0.15, 0.5, wedge.along(p));
    const double of_neck = cut.exists && chin_above > 0
                               ? smooth_step(0, 0.5 * chin_above, cut.above(p))
                               : smooth_step(at_chin + 40 * kRadian, at_chin + 10 * kRadian, angle);
    share[v] = here * front * of_neck;
  }
  // Each round spreads a share by about the length of an edge, so on a coarse mesh it is mixed in part.
  const double width = kSmoothed * (marks[LandmarkKind::kNose].at.y - chin.y);
  Span<double> parts;
  if (!make(placing.scratch, n, parts)) return no_memory(placing);
  for (uint32_t v = 0; v < n; ++v) {
    double squares = 0;
    const uint32_t first = graph.starts[v], last = graph.starts[v + 1];
    for (uint32_t e = first; e < last; ++e) squares += graph.lengths[e] * graph.lengths[e];
    const double spread = kShareSmoothing * squares / (1 + last - first);
    parts[v] = spread > 0 ? std::min(1.0, 2 * width * width / spread) : 0;
  }
  for (int round = 0; round < kShareSmoothing; ++round) {
    for (uint32_t v = 0; v < n; ++v) {
      const uint32_t first = graph.starts[v], last = graph.starts[v + 1];
      double sum = share[v];
      for (uint32_t e = first; e < last; ++e) sum += share[graph.neighbors[e]];
      next[v] = mix(share[v], sum / (1 + last - first), parts[v]);
    }
    std::swap(share, next);
  }
  for (uint32_t v = 0; v < n; ++v) out[v] = static_cast<float>(share[mesh.welded[v]]);
  return Status::kOk;
}

}  // namespace mien::author
