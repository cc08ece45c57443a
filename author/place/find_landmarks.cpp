// SPDX-License-Identifier: MIT
#include "author/place/find_landmarks.h"

#include <algorithm>
#include <utility>

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"
#include "author/place/mouth.h"

namespace mien::author {

namespace {

using Kind = LandmarkKind;

constexpr std::pair<Kind, Kind> kMirrored[] = {{Kind::kMouthLeft, Kind::kMouthRight},
                                               {Kind::kEyeLeft, Kind::kEyeRight}};

Status refuse(Placing& placing, const char* what, Kind kind, Kind other) {
  return fail(placing.error, Status::kAuthorRefused, kNoOffset, "landmark %s is %s%s",
              kLandmarkNames[static_cast<size_t>(kind)], what,
              other == kind ? "" : kLandmarkNames[static_cast<size_t>(other)]);
}

/// The given one of two mirror images stands for both.
void mirror_given(Placing& placing) {
  for (const auto& [left, right] : kMirrored) {
    for (const auto& [from, to] : {std::make_pair(left, right), std::make_pair(right, left)}) {
      const Landmark& given = placing.report.landmarks[from];
      Landmark& other = placing.report.landmarks[to];
      if (!given.given || other.given || !placing.symmetric) continue;
      other = given;
      other.at.x = 2 * placing.plane - given.at.x;
    }
  }
}

/// How far the nose stands out from what is beside it, in half widths of the face: 0.3 of a human, 0.05 of a
/// ball.
double nose_confidence(const Placing& placing, double half_width) {
  const Throat& throat = placing.profile;
  double beside = 0;
  int count = 0;
  for (const int side : {1, -1}) {
    const Profile profile = front_profile(placing.mesh, placing.plane + side * 0.35 * half_width);
    const double at = (throat.nose_y - profile.low) / profile.height * kProfileBins;
    const uint32_t bin = at > 0 ? std::min(kProfileBins - 1, static_cast<uint32_t>(at)) : 0;
    if (!(profile.height > 0) || !profile.has[bin]) continue;
    beside += profile.front[bin];
    ++count;
  }
  if (count == 0 || !(half_width > 0)) return 0;
  return smooth_step(0.06, 0.22, (throat.nose_z - beside / count) / half_width);
}

/// Of a mouth: how plain it is, and whether it is as wide on both sides and as mouths are.
double mouth_confidence(const Placing& placing, const Mouth& mouth, double half_width) {
  const double left = mouth.left.x - placing.plane, right = placing.plane - mouth.right.x;
  const double wide = (left + right) / (2 * half_width);
  const double even = 1 - std::abs(left - right) / (left + right + 1e-12);
  const double plain = mouth.is_hole ? 0.9 : 0.6 + 0.35 * smooth_step(0.15, 0.6, mouth.depth);
  return plain * even * smooth_step(0.08, 0.2, wide) * smooth_step(0.95, 0.75, wide);
}

/// Where lips and chin of a closed mouth are, by the proportions of a human face.
void guess_mouth(Placing& placing, const MouthSearch& search) {
  constexpr double kUpper = 0.33, kLower = 0.37, kChin = 0.75;  // from the nose to the throat
  constexpr double kWide = 0.3;                                 // of half of the face
  constexpr double kSure = 0.2;
  Landmarks& marks = placing.report.landmarks;
  const auto put = [&](Kind kind, double down, double aside) {
    const double x = placing.plane + aside * search.half_width;
    const double y = search.nose_y - down * (search.nose_y - search.floor);
    const Profile profile = front_profile(placing.mesh, x);
    if (!(profile.height > 0)) return;
    const double at = (y - profile.low) / profile.height * kProfileBins;
    const uint32_t bin = at > 0 ? std::min(kProfileBins - 1, static_cast<uint32_t>(at)) : 0;
    if (profile.has[bin]) marks.found(kind, {x, y, profile.front[bin]}, kSure);
  };
  put(Kind::kLipUpper, kUpper, 0);
  put(Kind::kLipLower, kLower, 0);
  put(Kind::kMouthLeft, (kUpper + kLower) / 2, kWide);
  put(Kind::kMouthRight, (kUpper + kLower) / 2, -kWide);
  put(Kind::kChin, kChin, 0);
}

}  // namespace

Status take_landmarks(Placing& placing) {
  Landmarks& marks = placing.report.landmarks;
  marks = placing.options.landmarks;
  constexpr double kOutside = 0.2;  // of the diagonal
  const double room = kOutside * placing.box.diagonal();
  const Vec3 low = placing.box.low, high = placing.box.high;
  for (uint32_t k = 0; k < kLandmarkCount; ++k) {
    const Landmark& mark = marks.of[k];
    const Vec3 p = mark.at;
    const bool is_inside = p.x >= low.x - room && p.x <= high.x + room && p.y >= low.y - room &&
                           p.y <= high.y + room && p.z >= low.z - room && p.z <= high.z + room;
    if (mark.given && !is_inside) {
      return refuse(placing, "outside the head: is it in the unit and axes of the mesh", Kind(k),
                    Kind(k));
    }
  }
  for (const auto& [left, right] : kMirrored) {
    if (marks.is_given(left) && marks.is_given(right) && marks[left].at.x <= marks[right].at.x) {
      return refuse(placing, "not on the character's left of ", left, right);
    }
  }
  // From the top down.
  constexpr Kind kOrder[] = {Kind::kNose, Kind::kLipUpper, Kind::kLipLower, Kind::kChin,
                             Kind::kThroat};
  const Kind* above = nullptr;
  for (const Kind& kind : kOrder) {
    if (!marks.is_given(kind)) continue;
    if (above && marks[kind].at.y >= marks[*above].at.y) {
      return refuse(placing, "not below ", kind, *above);
    }
    above = &kind;
  }
  return Status::kOk;
}

Status find_landmarks(Placing& placing) {
  PlaceReport& report = placing.report;
  Landmarks& marks = report.landmarks;
  mirror_given(placing);
  const Throat& profile = placing.profile;
  double half_width = 0;
  for (const uint32_t i : placing.mask) {
    half_width = std::max(half_width, std::abs(placing.points[i].x - placing.plane));
  }
  if (profile.has_profile) {
    marks.found(Kind::kNose, {placing.plane, profile.nose_y, profile.nose_z},
                nose_confidence(placing, half_width));
    // The face ends where the throat below it is, if the caller did not say where.
    marks[Kind::kNose].is_used = placing.options.own_mask.empty() && placing.options.neck_cut;
  }
  if (report.throat.found) {
    marks.found(Kind::kThroat, {placing.plane, report.throat.y, report.throat.z},
                smooth_step(0.05, 0.12, profile.depth / profile.height));
  }
  const Landmark& nose = marks[Kind::kNose];
  if (!nose.known) return Status::kOk;

  MouthSearch search;
  search.plane = placing.plane;
  search.nose_y = nose.at.y;
  search.nose_z = nose.at.z;
  search.half_width = half_width;
  search.floor =
      report.throat.found ? report.throat.y : placing.box.low.y + 0.02 * placing.box.size().y;
  Mouth mouth;
  if (!find_mouth(placing.mesh, search, placing.scratch, mouth)) return no_memory(placing);
  placing.has_mouth = mouth.found;
  if (!mouth.found) {
    guess_mouth(placing, search);
  } else {
    const double sure = mouth_confidence(placing, mouth, half_width);
    marks.found(Kind::kLipUpper, mouth.upper, sure);
    marks.found(Kind::kLipLower, mouth.lower, sure);
    marks.found(Kind::kMouthLeft, mouth.left, sure);
    marks.found(Kind::kMouthRight, mouth.right, sure);
    marks.found(Kind::kChin, mouth.chin, sure);
  }
  return Status::kOk;
}

}  // namespace mien::author
