// SPDX-License-Identifier: MIT
#include "author/generate/head/cage.h"

#include <algorithm>

#include "author/generate/head/cage_table.h"

namespace mien::head {

using author::kPi;
using author::mix;
using author::smooth_step;
using namespace cage;

namespace {

uint32_t count_of(Strip strip, const Segments& s) {
  const uint32_t corner = s.nose + s.eye_low + s.corner;  // of the mouth, from the middle above
  switch (strip) {
    case kOne: return 1;
    case kCollar:
    case kTipRows: return 2;
    case kNoseColumns: return s.nose;
    case kNostrilColumns: return s.nose - 2;
    case kWingRows: return s.wing;
    case kCheekRows: return s.cheek;
    case kInnerLowRows: return s.inner_low;
    case kInnerHighRows: return s.inner_high;
    case kInnerRows: return s.inner_low + s.inner_high;
    case kOuterLowRows: return s.outer_low;
    case kOuterHighRows: return s.outer_high;
    case kEyeLow: return s.eye_low;
    case kEyeHigh: return s.eye_high;
    case kMuzzle: return s.wing + 3;
    case kLips: return s.corner + corner;
    case kSide: return s.side;
    case kBeforeEar: return s.before_ear;
    case kEar: return s.ear;
    case kBehindEar: return s.behind_ear;
    case kEarRows: return s.cheek + s.outer_low;
    case kBehindFace: return s.before_ear + s.ear + s.behind_ear;
    case kForehead: return s.forehead;
    case kNeck: return s.neck;
    case kChest: return s.chest;
    case kAllColumns: return s.nose + s.eye_high + s.side + s.before_ear + s.ear + s.behind_ear;
    case kStripCount: break;
  }
  return 0;
}

/// Noses of other widths take the cage along. `designed`: the person of seed 0, at whose angles the sides of the jaw
/// are, because those of a narrow jaw at the same x would be far back.
Place place_of(const Form& form, const Form& designed, At at) {
  if (at.around) return {at.x * kPi, at.y};
  const double wide = (form.person().nose_width - 1) * smooth_step(-5.6, -4.2, at.y) *
                      smooth_step(-1.2, -2.4, at.y) * smooth_step(4.2, 1.9, at.x);
  const double side = smooth_step(-3.5, -5.0, at.y) * smooth_step(2.4, 3.8, at.x);
  return {mix(form.angle_of(at.x * (1 + wide), at.y), designed.angle_of(at.x, at.y), side), at.y};
}

/// Lengths in the plane, for even segments to begin with: cm per radian.
constexpr double kAroundScale = 7;

double distance(Place a, Place b) {
  const double x = kAroundScale * (b.angle - a.angle), y = b.y - a.y;
  return std::sqrt(x * x + y * y);
}

/// Catmull-Rom, between b and c.
double spline(double a, double b, double c, double d, double t) {
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

}  // namespace

void Layout::make_curves() {
  const Form designed(make_person(0));
  const auto add = [this](Place place, bool plane, bool level) {
    Spot spot;
    spot.place = place;
    spot.keep_angle = plane;
    spot.keep_y = level;
    return spots.add(spot);
  };
  const auto is_level = [](At at) {
    return at.y == kBottomY || at.y == kCrownRow || (at.y < -17.3 && at.y > -17.7);
  };
  const auto on_plane = [](At at) { return at.x == (at.around ? 1 : 0); };
  for (uint32_t n = 1; n < kNodeCount; ++n) {
    const At at = kNodes[n];
    nodes_[n] = add(place_of(form_, designed, at), on_plane(at), is_level(at));
  }
  if (failed()) return;
  constexpr uint32_t kSteps = 12, kMaxPoints = 7;
  for (uint32_t c = 0; c < kCurveCount; ++c) {
    const Curve& curve = kCurves[c];
    const uint32_t count = count_of(curve.strip, segments_);
    Place points[kMaxPoints + 2];  // one more at each end
    uint32_t n = 1;
    points[n++] = place_of(form_, designed, kNodes[curve.from]);
    for (uint32_t i = 0; i < curve.via_count; ++i)
      points[n++] = place_of(form_, designed, curve.via[i]);
    points[n++] = place_of(form_, designed, kNodes[curve.to]);
    points[0] = between(points[1], points[2], -1);
    points[n] = between(points[n - 2], points[n - 1], 2);
    Place path[kSteps * kMaxPoints + 1];
    double length[kSteps * kMaxPoints + 1] = {};
    uint32_t steps = 0;
    path[0] = points[1];
    for (uint32_t p = 1; p + 1 < n; ++p) {
      for (uint32_t i = 1; i <= kSteps; ++i) {
        const double t = static_cast<double>(i) / kSteps;
        const auto at = [&](double Place::*v) {
          return spline(points[p - 1].*v, points[p].*v, points[p + 1].*v, points[p + 2].*v, t);
        };
        path[++steps] = {at(&Place::angle), at(&Place::y)};
        length[steps] = length[steps - 1] + distance(path[steps - 1], path[steps]);
      }
    }
    if (!author::make(arena_, count + 1, lines_[c].spots)) {
      failed_ = true;
      return;
    }
    const Span<uint32_t> line = lines_[c].spots;
    line[0] = nodes_[curve.from];
    line[count] = nodes_[curve.to];
    const Spot &from = spots[line[0]], &to = spots[line[count]];
    const bool plane = from.keep_angle && to.keep_angle && from.place.angle == to.place.angle;
    const bool level = from.keep_y && to.keep_y && from.place.y == to.place.y;
    const double plane_angle = from.place.angle, level_y = from.place.y;
    uint32_t step = 0;
    for (uint32_t i = 1; i < count; ++i) {
      const double wanted = length[steps] * i / count;
      while (step + 1 < steps && length[step + 1] < wanted) ++step;
      Place place = between(path[step], path[step + 1],
                            (wanted - length[step]) / (length[step + 1] - length[step]));
      if (plane) place.angle = plane_angle;
      if (level) place.y = level_y;
      line[i] = add(place, plane, level);
      spots[line[i]].home = place;
      spots[line[i]].hold = curve.hold;
    }
  }
}

/// The spots along a list of nodes; returns their number.
uint32_t Layout::side_of(const uint8_t* nodes, uint32_t* out) const {
  uint32_t count = 0;
  out[count++] = nodes_[nodes[0]];
  for (uint32_t n = 0; n < 4 && nodes[n + 1] != kEnd; ++n) {
    for (uint32_t c = 0; c < kCurveCount; ++c) {
      const Span<uint32_t> line = lines_[c].spots;
      const bool forth = kCurves[c].from == nodes[n] && kCurves[c].to == nodes[n + 1];
      const bool back = kCurves[c].to == nodes[n] && kCurves[c].from == nodes[n + 1];
      for (size_t i = 1; (forth || back) && i < line.count; ++i) {
        out[count++] = line[forth ? i : line.count - 1 - i];
      }
    }
  }
  return count;
}

/// Transfinite interpolation between the sides.
void Layout::make_patch(const uint8_t (&sides)[4][5]) {
  uint32_t bottom[kMaxRing], right[kMaxRing], top[kMaxRing], left[kMaxRing];
  const uint32_t columns_here = side_of(sides[0], bottom), rows = side_of(sides[1], right);
  if (side_of(sides[2], top) != columns_here || side_of(sides[3], left) != rows) {
    failed_ = true;  // the table of segments is wrong
    return;
  }
  const auto at = [this](uint32_t spot) { return spots[spot].place; };
  const Place corners[4] = {at(bottom[0]), at(bottom[columns_here - 1]), at(top[0]),
                            at(top[columns_here - 1])};
  uint32_t before[kMaxRing], here[kMaxRing];
  std::copy(bottom, bottom + columns_here, before);
  for (uint32_t r = 1; r < rows; ++r) {
    const double v = static_cast<double>(r) / (rows - 1);
    for (uint32_t c = 0; c < columns_here; ++c) {
      const double u = static_cast<double>(c) / (columns_here - 1);
      if (r + 1 == rows) {
        here[c] = top[c];
      } else if (c == 0) {
        here[c] = left[r];
      } else if (c + 1 == columns_here) {
        here[c] = right[r];
      } else {
        const Place across = between(at(left[r]), at(right[r]), u),
                    along = between(at(bottom[c]), at(top[c]), v),
                    both = between(between(corners[0], corners[1], u),
                                   between(corners[2], corners[3], u), v);
        Spot spot;
        spot.place = {across.angle + along.angle - both.angle, across.y + along.y - both.y};
        spot.keep_y = spots[left[r]].keep_y && spots[right[r]].keep_y;  // the collar
        if (spot.keep_y) spot.place.y = across.y;
        here[c] = spots.add(spot);
      }
    }
    for (uint32_t c = 0; c + 1 < columns_here; ++c) {
      quads.add({{before[c], before[c + 1], here[c + 1], here[c]}, 4});
    }
    std::copy(here, here + columns_here, before);
  }
}

void Layout::make() {
  make_curves();
  if (failed()) return;
  for (const auto& patch : kPatches) {
    make_patch(patch);
    if (failed()) return;
  }
  static constexpr uint8_t kCrown[] = {kCrownFront, kCrownBack, kEnd},
                           kBottom[] = {kBottomFront, kBottomSide, kBottomBack, kEnd};
  crown_count = side_of(kCrown, crown_ends);
  bottom_count = side_of(kBottom, bottom_ends);
  for (Spot& spot : spots.span()) {
    spot.lid = spot.place.y > kEye.y ? Side::kAbove : Side::kBelow;
    spot.lip = spot.place.y > kMouthY ? Side::kAbove : Side::kBelow;
  }
}

Ring Layout::ring_of(const uint8_t* nodes, bool whole) const {
  Ring ring;
  ring.whole = whole;
  for (uint32_t n = 0; nodes[n + 1] != kEnd; ++n) {
    const uint8_t pair[] = {nodes[n], nodes[n + 1], kEnd};
    ring.count += side_of(pair, ring.at + ring.count) - 1;
  }
  if (!whole) ++ring.count;
  ring.half = whole ? ring.count / 2 : (ring.count - 1) / 2;
  return ring;
}

Ring Layout::eye() const {
  static constexpr uint8_t kNodesOf[] = {kInner,     kInnerLow,  kOuterLow, kOuter,
                                         kOuterHigh, kInnerHigh, kInner,    kEnd};
  return ring_of(kNodesOf, true);
}

Ring Layout::mouth() const {
  static constexpr uint8_t kNodesOf[] = {kLipBottom, kLipSide, kWing, kLipTop, kEnd};
  return ring_of(kNodesOf, false);
}

namespace {

/// Starts in the middle of the last side.
void turn_by(Ring& ring, uint32_t steps) {
  std::rotate(ring.at, ring.at + (ring.count - steps), ring.at + ring.count);
}

}  // namespace

Ring Layout::nostril() const {
  static constexpr uint8_t kNodesOf[] = {kNostrilLowIn,  kNostrilLowOut, kNostrilHighOut,
                                         kNostrilHighIn, kNostrilLowIn,  kEnd};
  Ring ring = ring_of(kNodesOf, true);
  turn_by(ring, segments_.wing / 2);
  return ring;
}

Ring Layout::ear() const {
  static constexpr uint8_t kNodesOf[] = {kEarFrontLow,  kEarBackLow,  kEarBackHigh,
                                         kEarFrontHigh, kEarFrontLow, kEnd};
  Ring ring = ring_of(kNodesOf, true);
  turn_by(ring, (segments_.cheek + segments_.outer_low) / 2);
  return ring;
}

void Layout::even_out(uint32_t rounds) {
  const uint32_t count = spots.count();
  struct Sum {
    double angle, y, weight;
  };
  Span<Vec3> at;
  Span<Sum> sums;
  if (failed() || !author::make(arena_, count, at) || !author::make(arena_, count, sums)) {
    failed_ = true;
    return;
  }
  for (uint32_t round = 0; round < rounds; ++round) {
    // Edges change slowly: their lengths are measured now and then.
    if (round % 16 == 0) {
      for (uint32_t i = 0; i < count; ++i) {
        const Spot& s = spots[i];
        at[i] = form_.face(s.place.angle, s.place.y, s.lid).closed;
      }
    }
    std::fill(sums.begin(), sums.end(), Sum{0, 0, 0});
    for (const Face& quad : quads.span()) {
      for (int k = 0; k < 4; ++k) {
        const uint32_t a = quad.corners[k], b = quad.corners[(k + 1) % 4];
        const double weight = length(at[b] - at[a]);
        const Place pa = spots[a].place, pb = spots[b].place;
        sums[a].angle += weight * pb.angle;
        sums[a].y += weight * pb.y;
        sums[a].weight += weight;
        sums[b].angle += weight * pa.angle;
        sums[b].y += weight * pa.y;
        sums[b].weight += weight;
      }
    }
    for (uint32_t i = 0; i < count; ++i) {
      Spot& s = spots[i];
      constexpr double kShare = 0.7;
      const Place even =
          between({sums[i].angle / sums[i].weight, sums[i].y / sums[i].weight}, s.home, s.hold);
      if (!s.keep_angle) s.place.angle = mix(s.place.angle, even.angle, kShare);
      if (!s.keep_y) s.place.y = mix(s.place.y, even.y, kShare);
    }
  }
}

}  // namespace mien::head
