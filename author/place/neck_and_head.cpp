// SPDX-License-Identifier: MIT
// The joints of neck and head, from the middle group in depth.
#include <algorithm>

#include "author/base/dna_making.h"
#include "author/mesh/eigenvectors.h"
#include "author/place/face_mask.h"

namespace mien::author {

namespace {

constexpr double kSteepest = 0.70710678118654752;  // cosine of 45 degrees

struct Means {
  Vec3 lower, upper;
  uint32_t lower_count = 0, upper_count = 0;
};

/// Means of the places below and above the height.
Means split_at(const Placing& placing, Span<const uint32_t> places, double height) {
  Means means;
  for (uint32_t i : places) {
    const Vec3 p = placing.points[i];
    if (p.y < height) {
      means.lower = means.lower + p;
      ++means.lower_count;
    } else {
      means.upper = means.upper + p;
      ++means.upper_count;
    }
  }
  if (means.lower_count) means.lower = means.lower * (1.0 / means.lower_count);
  if (means.upper_count) means.upper = means.upper * (1.0 / means.upper_count);
  return means;
}

/// Two groups by height; false if memory ran out.
bool split_by_linkage(Placing& placing, Span<const uint32_t> places, bool by_area, Means& out) {
  Span<double> heights, weights;
  if (!make(placing.scratch, places.count, heights)) return false;
  for (size_t i = 0; i < places.count; ++i) heights[i] = placing.points[places[i]].y;
  if (by_area) {
    if (!make(placing.scratch, places.count, weights)) return false;
    const Vec3 size = placing.box.size();
    for (size_t i = 0; i < places.count; ++i) {
      weights[i] = placing.areas[placing.skin[places[i]]] + 1e-12 * size.x * size.y;
    }
  }
  Linkage linkage;
  if (!link_on_line(heights, weights, placing.scratch, placing.scratch, linkage)) return false;
  uint32_t starts[2];
  linkage.group_starts(2, starts);
  const double low = heights[linkage.order[starts[1] - 1]],
               high = heights[linkage.order[starts[1]]];
  // Halfway, but above `low` also where the two round to one.
  const double middle = (low + high) / 2;
  out = split_at(placing, places, middle > low ? middle : high);
  return true;
}

/// The principal axis nearest to +Y of the places below the cut; zero if none is within 45 degrees.
Vec3 neck_axis(const Placing& placing) {
  const NeckCut cut = placing.report.throat.cut();
  Vec3 mean;
  double count = 0;
  for (const Vec3& p : placing.points) {
    if (cut.above(p) >= 0) continue;
    mean = mean + p;
    ++count;
  }
  if (count < 3) return {};
  mean = mean * (1 / count);
  double spread[3][3] = {}, axes[3][3];
  for (const Vec3& p : placing.points) {
    if (cut.above(p) >= 0) continue;
    const double d[3] = {p.x - mean.x, p.y - mean.y, p.z - mean.z};
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) spread[i][k] += d[i] * d[k];
    }
  }
  diagonalize(spread, axes);
  Vec3 best;
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = {axes[0][k], axes[1][k], axes[2][k]};
    if (std::abs(axis.y) > std::abs(best.y)) best = axis.y < 0 ? -axis : axis;
  }
  return best.y >= kSteepest ? best : Vec3{};
}

/// How far the line from `from` along `direction` runs until it leaves the skin or passes its lowest
/// point.
double reach_down(const Placing& placing, Vec3 from, Vec3 direction) {
  double reach = (from.y - placing.box.low.y) / -direction.y;
  const AuthorMesh& mesh = placing.mesh;
  for (size_t t = 0; t + 2 < mesh.triangles.count; t += 3) {
    const uint32_t* corner = mesh.triangles.data + t;
    if (!mesh.is_skin[corner[0]]) continue;
    const Vec3 a = mesh.positions[corner[0]];
    const Vec3 ab = mesh.positions[corner[1]] - a, ac = mesh.positions[corner[2]] - a;
    const Vec3 h = cross(direction, ac);
    const double determinant = dot(ab, h);
    if (determinant == 0) continue;
    const double u = dot(from - a, h) / determinant;
    const Vec3 q = cross(from - a, ab);
    const double v = dot(direction, q) / determinant;
    const double distance = dot(ac, q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0) reach = std::min(reach, distance);
  }
  return reach;
}

void place_on_face(Placing& placing, Vec3& neck, Vec3& head) {
  Vec3 mean;
  for (uint32_t i : placing.mask) mean = mean + placing.points[i];
  head = mean * (1.0 / static_cast<double>(placing.mask.count));
  head.z -= placing.box.size().x / 2;
  neck = head;
  neck.y -= placing.box.size().y / 2;
}

}  // namespace

Status find_neck_and_head(Placing& placing, Vec3& neck, Vec3& head) {
  PlaceReport& report = placing.report;
  const auto hold = [&](Vec3& joint) {
    if (placing.symmetric) joint.x = placing.plane;
  };
  if (report.face_only) {
    place_on_face(placing, neck, head);
    hold(neck);
    hold(head);
    return Status::kOk;
  }
  Span<uint32_t> middle;
  if (!make(placing.scratch, placing.points.count, middle)) return no_memory(placing);
  // With another number of groups than three, all but the front one and the back one.
  size_t count = 0;
  const uint32_t back = report.group_count - 1;
  for (uint32_t i = 0; i < placing.points.count; ++i) {
    const uint32_t group = placing.group[i];
    if (group > 0 && (group < back || back < 2)) middle[count++] = i;
  }
  if (count < 2) {  // one group only
    count = 0;
    for (uint32_t i = 0; i < placing.points.count; ++i) middle[count++] = i;
  }
  const Span<const uint32_t> places = middle.first(count);

  const Throat& throat = report.throat;
  Means means;
  report.neck_split = NeckSplit::kLinkage;
  if (!split_by_linkage(placing, places, placing.options.area_density, means)) {
    return no_memory(placing);
  }
  if (throat.found && !(means.lower.y < throat.y)) {
    report.neck_split = NeckSplit::kAreaLinkage;
    if (!split_by_linkage(placing, places, true, means)) return no_memory(placing);
    if (!(means.lower.y < throat.y)) {
      report.neck_split = NeckSplit::kPlane;
      means = split_at(placing, places, throat.y);
    }
  }
  if (means.lower_count == 0 || means.upper_count == 0) {
    report.neck_split = NeckSplit::kNoNeck;
    means.upper = means.lower_count ? means.lower : means.upper;
    means.lower = {means.upper.x, placing.box.low.y, means.upper.z};
  }
  hold(means.lower);
  hold(means.upper);
  report.head_mean = means.upper;
  report.neck_mean = means.lower;

  Vec3 axis = throat.found ? neck_axis(placing) : Vec3{};
  if (placing.symmetric) axis = normalized({0, axis.y, axis.z});
  const bool has_neck = !is_zero(axis);
  if (!has_neck) axis = normalized(means.upper - means.lower);
  if (!(axis.y > 0)) axis = {0, 1, 0};
  neck = means.lower - axis * reach_down(placing, means.lower, -axis);

  // The point of the vertical through the head's mean that is nearest to the line of the neck.
  const Vec3 apart = means.upper - means.lower;
  const double across = 1 - axis.y * axis.y;
  const double rise = across > 1e-9 ? (axis.y * dot(axis, apart) - apart.y) / across
                                    : (means.lower.y - means.upper.y) / 2;
  head = means.upper;
  // Not below the throat: the mean of the lower group lies within the neck.
  const double least = throat.found ? std::max(means.lower.y, throat.y) : means.lower.y;
  // A line through both means meets the vertical at the head's mean, which is no place to turn about.
  const double most = has_neck ? means.upper.y : least;
  head.y = std::min(std::max(head.y + rise, least), std::min(most, means.upper.y));
  hold(neck);
  hold(head);
  return Status::kOk;
}

}  // namespace mien::author
