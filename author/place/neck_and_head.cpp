// SPDX-License-Identifier: MIT
// The joints of chest, neck and head, from the middle group in depth.
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
  // Halfway, but above `low` even if both round to the same number.
  const double middle = (low + high) / 2;
  out = split_at(placing, places, middle > low ? middle : high);
  return true;
}

/// Area, mean and spread of a surface, which do not depend on how densely it is divided.
struct Moments {
  double area = 0;
  Vec3 sum;                    // of places times area
  double products[3][3] = {};  // of their coordinates

  void add(double weight, Vec3 p) {
    const double d[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) products[i][k] += weight * d[i] * d[k];
    }
  }
  void add_point(Vec3 p) {
    area += 1;
    sum = sum + p;
    add(1, p);
  }
  void add_triangle(Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 corners = a + b + c;
    const double size = length(cross(b - a, c - a)) / 2;
    area += size;
    sum = sum + corners * (size / 3);
    for (const Vec3 p : {a, b, c, corners}) add(size / 12, p);
  }
  /// The principal axis nearest to +Y; zero if none is within 45 degrees.
  Vec3 upward_axis() const {
    if (!(area > 0)) return {};
    const Vec3 mean = sum * (1 / area);
    const double m[3] = {mean.x, mean.y, mean.z};
    double spread[3][3], axes[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) spread[i][k] = products[i][k] - area * m[i] * m[k];
    }
    diagonalize(spread, axes);
    Vec3 best;
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = {axes[0][k], axes[1][k], axes[2][k]};
      if (std::abs(axis.y) > std::abs(best.y)) best = axis.y < 0 ? -axis : axis;
    }
    return best.y >= kSteepest ? best : Vec3{};
  }
};

/// A convex part of a triangle.
struct Polygon {
  Vec3 corners[8];
  uint32_t count = 0;

  /// The part where `side` is not positive, a linear function of the place.
  template <class SideOf>
  Polygon cut(const SideOf& side) const {
    Polygon out;
    for (uint32_t i = 0; i < count; ++i) {
      const Vec3 a = corners[i], b = corners[(i + 1) % count];
      const double from = side(a), to = side(b);
      if (from <= 0) out.corners[out.count++] = a;
      if ((from < 0 && to > 0) || (from > 0 && to < 0)) {
        out.corners[out.count++] = a + (b - a) * (from / (from - to));
      }
    }
    return out;
  }
};

/// Calls visit(triangle) for the faces of the skin. Those with more corners are split about their middle, which does
/// not depend on the corner that comes first.
template <class Visit>
void visit_skin(const AuthorMesh& mesh, const Visit& visit) {
  for (size_t f = 0; f + 1 < mesh.face_starts.count; ++f) {
    const uint32_t first = mesh.face_starts[f], count = mesh.face_starts[f + 1] - first;
    if (count < 3 || !mesh.is_skin[mesh.corners[first]]) continue;
    const auto at = [&](uint32_t i) { return mesh.positions[mesh.corners[first + i % count]]; };
    if (count == 3) {
      visit(Polygon{{at(0), at(1), at(2)}, 3});
      continue;
    }
    Vec3 middle;
    for (uint32_t i = 0; i < count; ++i) middle = middle + at(i) * (1.0 / count);
    for (uint32_t i = 0; i < count; ++i) visit(Polygon{{at(i), at(i + 1), middle}, 3});
  }
}

/// Calls visit(slice, place) for what bounds the skin in each of `count` slices of the same height.
template <class Visit>
void visit_slices(const AuthorMesh& mesh, double low, double high, int count, const Visit& visit) {
  const double step = (high - low) / count;
  visit_skin(mesh, [&](const Polygon& whole) {
    const auto [least, most] =
        std::minmax({whole.corners[0].y, whole.corners[1].y, whole.corners[2].y});
    for (int slice = 0; slice < count; ++slice) {
      const double from = low + step * slice, to = from + step;
      if (most < from || least > to) continue;
      const Polygon part =
          whole.cut([&](Vec3 p) { return from - p.y; }).cut([&](Vec3 p) { return p.y - to; });
      for (uint32_t i = 0; i < part.count; ++i) visit(slice, part.corners[i]);
    }
  });
}

/// All of the skin, and its part below the cut.
struct SkinMoments {
  Moments all, below;
};

SkinMoments measure_skin(const Placing& placing, const NeckCut& cut) {
  SkinMoments out;
  visit_skin(placing.mesh, [&](const Polygon& whole) {
    const Vec3* c = whole.corners;
    out.all.add_triangle(c[0], c[1], c[2]);
    // The cut has a bend at the throat.
    const auto above = [&cut](Vec3 p) { return cut.above(p); };
    for (const double way : {1.0, -1.0}) {
      const Polygon part = whole.cut([&](Vec3 p) { return way * (p.z - cut.z); }).cut(above);
      for (uint32_t i = 2; i < part.count; ++i) {
        out.below.add_triangle(part.corners[0], part.corners[i - 1], part.corners[i]);
      }
    }
  });
  return out;
}

/// The axis of the places below the cut, each as heavy as the others.
Vec3 axis_of_places(const Placing& placing) {
  const NeckCut cut = placing.report.throat.cut();
  Moments moments;
  for (const Vec3& p : placing.points) {
    if (cut.above(p) < 0) moments.add_point(p);
  }
  return moments.area < 3 ? Vec3{} : moments.upward_axis();
}

/// How far the line from `from` along `direction` runs until it leaves the skin or passes its
/// lowest point.
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

namespace {

/// Where the neck ends: it is narrowest somewhere below the throat, and half as wide again at the
/// shoulders. What is at the end of the mesh stays on the chest.
void measure_neck(const Placing& placing, NeckCut& cut) {
  constexpr int kSlices = 32;
  constexpr double kShoulders = 1.5, kLowest = 0.25, kLength = 1.5;
  const double low = placing.box.low.y, height = cut.y - low;
  cut.base = low + kLowest * std::max(height, 0.0);
  if (!(height > 0)) return;
  double widths[kSlices] = {};  // half of them, from the throat down
  visit_slices(placing.mesh, low, cut.y, kSlices, [&](int slice, Vec3 p) {
    double& width = widths[kSlices - 1 - slice];
    width = std::max(width, std::abs(p.x - placing.plane));
  });
  int narrowest = -1, slice = 0;
  for (; slice < kSlices; ++slice) {
    if (!(widths[slice] > 0)) continue;
    if (narrowest >= 0 && widths[slice] > kShoulders * widths[narrowest]) break;
    if (narrowest < 0 || widths[slice] < widths[narrowest]) narrowest = slice;
  }
  if (narrowest < 0) return;
  cut.half_width = widths[narrowest];
  const double shoulders = cut.y - height * slice / kSlices;
  // A neck at least three quarters as long as wide, where the mesh has room for it.
  const double highest = std::max(cut.y - kLength * cut.half_width, low);
  cut.base = std::max(cut.base, std::min(shoulders, highest));
}

/// In the middle between front and back of the neck: about a joint in front of it or behind it the
/// neck would grow and shrink as the head nods.
void move_to_axis(const Placing& placing, const NeckCut& cut, Vec3& head) {
  constexpr int kSlices = 8;
  double front[kSlices], back[kSlices];
  bool has[kSlices] = {};
  visit_slices(placing.mesh, cut.base, cut.y, kSlices, [&](int slice, Vec3 p) {
    front[slice] = has[slice] ? std::max(front[slice], p.z) : p.z;
    back[slice] = has[slice] ? std::min(back[slice], p.z) : p.z;
    has[slice] = true;
  });
  double sum = 0, count = 0;
  for (int slice = 0; slice < kSlices; ++slice) {
    if (!has[slice]) continue;
    // Higher places follow the head more.
    const double share = (slice + 0.5) * (slice + 0.5);
    sum += share * (front[slice] + back[slice]) / 2;
    count += share;
  }
  if (count > 0) head.z = sum / count;
}

/// Splits the middle group in depth by height; false if memory ran out.
bool split_middle(Placing& placing, Means& means) {
  PlaceReport& report = placing.report;
  const Throat& throat = report.throat;
  Span<uint32_t> middle;
  if (!make(placing.scratch, placing.points.count, middle)) return false;
  // If there are not three groups: all but the front and the back one.
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

  report.neck_split = NeckSplit::kLinkage;
  if (!split_by_linkage(placing, places, placing.options.area_density, means)) return false;
  if (throat.found && !(means.lower.y < throat.y)) {
    report.neck_split = NeckSplit::kAreaLinkage;
    if (!split_by_linkage(placing, places, true, means)) return false;
    if (!(means.lower.y < throat.y)) {
      report.neck_split = NeckSplit::kPlane;
      means = split_at(placing, places, throat.y);
    }
  }
  return true;
}

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
  const Throat& throat = report.throat;
  const bool by_surface = throat.found && !placing.options.paper;
  Means means;
  Vec3 axis;
  if (by_surface) {
    report.neck_split = NeckSplit::kPlane;
    const SkinMoments skin = measure_skin(placing, throat.cut());
    const double rest = skin.all.area - skin.below.area;
    means.lower_count = skin.below.area > 0;
    means.upper_count = rest > 0;
    if (means.lower_count) means.lower = skin.below.sum * (1 / skin.below.area);
    if (means.upper_count) means.upper = (skin.all.sum - skin.below.sum) * (1 / rest);
    axis = skin.below.upward_axis();
  } else if (!split_middle(placing, means)) {
    return no_memory(placing);
  } else if (throat.found) {
    axis = axis_of_places(placing);
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

  if (placing.symmetric) axis = normalized({0, axis.y, axis.z});
  const bool has_neck = !is_zero(axis);
  if (!has_neck) axis = normalized(means.upper - means.lower);
  if (!(axis.y > 0)) axis = {0, 1, 0};
  neck = means.lower - axis * reach_down(placing, means.lower, -axis);

  head = means.upper;
  if (by_surface) {
    // Where the lines of neck and head meet says little: both are nearly vertical.
    head.y = throat.y;
  } else {
    // The point of the vertical through the head's mean that is nearest to the line of the neck.
    const Vec3 apart = means.upper - means.lower;
    const double across = 1 - axis.y * axis.y;
    const double rise = across > 1e-9 ? (axis.y * dot(axis, apart) - apart.y) / across
                                      : (means.lower.y - means.upper.y) / 2;
    // Not below the throat: the mean of the lower group lies within the neck.
    const double least = throat.found ? std::max(means.lower.y, throat.y) : means.lower.y;
    // A line through both means would meet the vertical at the mean of the head, which is not a
    // pivot.
    const double most = has_neck ? means.upper.y : least;
    head.y = std::min(std::max(head.y + rise, least), std::min(most, means.upper.y));
  }
  hold(neck);
  hold(head);
  return Status::kOk;
}

}  // namespace

Status find_body(Placing& placing, Body& out) {
  if (Status status = find_neck_and_head(placing, out.chest, out.head); status != Status::kOk) {
    return status;
  }
  out.cut = placing.report.throat.cut();
  if (out.cut.exists) {
    measure_neck(placing, out.cut);
    if (!placing.options.paper) move_to_axis(placing, out.cut, out.head);
  }
  Landmarks& marks = placing.report.landmarks;
  const Landmark& given_head = marks[LandmarkKind::kHead];
  const Landmark& given_neck = marks[LandmarkKind::kNeck];
  if (given_head.given) out.head = given_head.at;
  const Vec3 along = out.head - out.chest;
  const double rise = out.cut.exists && along.y > 0 ? (out.cut.base - out.chest.y) / along.y : 0;
  const Vec3 base =
      given_neck.given ? given_neck.at : out.chest + along * std::min(std::max(rise, 0.0), 0.75);
  if (given_neck.given && base.y < out.cut.y) out.cut.base = base.y;
  // One joint per half of the width of the neck, along its length.
  const double length_of_neck = length(out.head - base);
  const double links = out.cut.half_width > 0 ? length_of_neck / out.cut.half_width : 1;
  out.neck_count = links > 2.5 ? 3 : links > 1.25 ? 2 : 1;
  for (uint32_t n = 0; n < out.neck_count; ++n) {
    out.necks[n] = base + (out.head - base) * (static_cast<double>(n) / out.neck_count);
  }
  // They lie by the throat; without one their height is a guess.
  const double sure = marks[LandmarkKind::kThroat].known
                          ? 0.3 + 0.6 * marks[LandmarkKind::kThroat].confidence
                          : 0.3;
  marks.found(LandmarkKind::kHead, out.head, sure);
  marks.found(LandmarkKind::kNeck, base, sure);
  marks[LandmarkKind::kHead].is_used = marks[LandmarkKind::kNeck].is_used = true;
  return Status::kOk;
}

}  // namespace mien::author
