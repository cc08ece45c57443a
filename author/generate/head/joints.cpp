// SPDX-License-Identifier: MIT
#include "author/generate/head/joints.h"

#include <algorithm>

namespace mien::head {

using author::clamp01;
using author::kPi;
using author::mix;
using author::smooth_step;

namespace {

/// A joint of the skin, at a place in the front view; left half and middle only.
struct SkinJoint {
  const char* name;
  double x, y;
  uint8_t tier, group;
  bool below;
};

enum Group : uint8_t {
  kMouthGroup,
  kJawGroup,
  kBrowGroup,
  kLeftEyeGroup,
  kRightEyeGroup,
  kCheekGroup
};

constexpr SkinJoint kPlaces[] = {
    {"LipUpper", 0, -5.55, 0, kMouthGroup, false},
    {"LipLower", 0, -6.65, 0, kJawGroup, true},
    {"Chin", 0, -9.3, 0, kJawGroup, true},
    {"MouthCorner", 2.55, -6.0, 0, kMouthGroup, false},
    {"Cheek", 4.2, -3.0, 0, kCheekGroup, false},
    {"Brow", 2.9, 3.1, 0, kBrowGroup, false},

    {"NoseTip", 0, -2.8, 1, kCheekGroup, false},
    {"LipUpperMiddle", 1.3, -5.55, 1, kMouthGroup, false},
    {"LipLowerMiddle", 1.3, -6.6, 1, kJawGroup, true},
    {"BrowInner", 1.3, 2.95, 1, kBrowGroup, false},

    {"NoseWing", 1.3, -3.1, 0, kCheekGroup, false},
    {"CheekLower", 4.3, -5.4, 2, kCheekGroup, false},
    {"BrowOuter", 4.6, 3.2, 2, kBrowGroup, false},

    {"Glabella", 0, 2.7, 3, kBrowGroup, false},
    {"Forehead", 2.0, 5.4, 3, kBrowGroup, false},
    {"UnderEye", 3.3, -1.3, 3, kCheekGroup, false},
    {"JawSide", 3.0, -8.7, 3, kJawGroup, true},

    {"LipUpperOuter", 2.0, -5.65, 4, kMouthGroup, false},
    {"LipLowerOuter", 2.0, -6.4, 4, kJawGroup, true},
    {"Nasolabial", 2.4, -4.2, 4, kMouthGroup, false},
    {"Cheekbone", 5.8, -1.0, 4, kCheekGroup, false},

    {"ForeheadMiddle", 0, 5.6, 5, kBrowGroup, false},
    {"Philtrum", 0, -4.6, 5, kMouthGroup, false},
    {"ChinFold", 0, -7.7, 5, kJawGroup, true},
    {"ChinSide", 1.4, -8.9, 5, kJawGroup, true},
    {"JawLine", 4.6, -7.4, 0, kJawGroup, true},

    {"NoseBridge", 0, 0.2, 6, kCheekGroup, false},
    {"LipUpperInner", 0.65, -5.5, 6, kMouthGroup, false},
    {"LipLowerInner", 0.65, -6.65, 6, kJawGroup, true},
    {"NoseSide", 1.1, -1.4, 6, kCheekGroup, false},
    {"NasolabialUpper", 2.0, -2.7, 6, kCheekGroup, false},
    {"EyeOuter", 5.6, 0.8, 6, kCheekGroup, false},

    {"Throat", 0, -11.6, 7, kJawGroup, true},
    {"NeckSide", 3.0, -12.4, 0, kCheekGroup, false},
    {"Larynx", 0, -13.0, 0, kJawGroup, false},
    {"LipCornerUpper", 2.35, -5.15, 7, kMouthGroup, false},
    {"MouthCornerLower", 2.5, -6.1, 0, kJawGroup, true},
    {"PhiltrumSide", 1.2, -4.7, 7, kMouthGroup, false},
    {"ChinFoldSide", 1.4, -7.6, 7, kJawGroup, true},
    {"CheekFront", 3.3, -5.0, 7, kMouthGroup, false},
    {"CheekSide", 5.5, -3.8, 7, kCheekGroup, false},
    {"CheekUpper", 4.9, -1.9, 7, kCheekGroup, false},
    {"CheekBottom", 3.5, -7.1, 7, kMouthGroup, false},
    {"UnderEyeInner", 1.9, -0.8, 7, kCheekGroup, false},
    {"UnderEyeOuter", 4.8, -0.9, 7, kCheekGroup, false},
    {"BrowMiddle", 2.1, 3.05, 7, kBrowGroup, false},
    {"BrowSide", 3.8, 3.25, 7, kBrowGroup, false},
    {"BrowUpper", 3.0, 4.2, 7, kBrowGroup, false},
    {"ForeheadSide", 4.3, 5.5, 7, kBrowGroup, false},
    {"Temple", 5.9, 3.6, 7, kBrowGroup, false},
    {"EyeCrease", 3.2, 2.3, 7, kBrowGroup, false},
};

class SkeletonMaker {
 public:
  explicit SkeletonMaker(Skeleton& out) : out_(out) {}

  uint16_t add(const char* name, Vec3 position, uint16_t parent, Drive drive, uint8_t tier,
               uint8_t group, bool below) {
    const uint16_t index = static_cast<uint16_t>(out_.count++);
    out_.joints[index] = {name, position, parent, index, 0, tier, group, below, drive};
    return index;
  }
  /// The joint of the left half, followed by that of the right.
  uint16_t add_pair(const char* name, Vec3 position, uint16_t parent, Drive drive, uint8_t tier,
                    uint8_t group, uint8_t right_group, bool below) {
    const uint16_t left = add(name, position, parent, drive, tier, group, below);
    position.x = -position.x;
    const uint16_t right = add(name, position, parent, drive, tier, right_group, below);
    out_.joints[left].side = 1;
    out_.joints[right].side = -1;
    out_.joints[left].twin = right;
    out_.joints[right].twin = left;
    return left;
  }

 private:
  Skeleton& out_;
};

}  // namespace

Skeleton::Skeleton(const Form& form) {
  SkeletonMaker maker(*this);
  const auto fixed = [&maker](const char* name, Vec3 at, uint16_t parent) {
    return maker.add(name, at, parent, Drive::kNone, 0, kJawGroup, false);
  };
  root = fixed("Root", {0, kBottomY, -1.5}, 0);
  neck_low = fixed("Neck01", {0, -15.6, -1.9}, root);
  neck_high = fixed("Neck02", {0, -12.2, -1.3}, neck_low);
  head = fixed("Head", {0, -8.6, -0.6}, neck_high);
  face = fixed("Face", {0, -8.6, -0.6}, head);
  upper_teeth = fixed("TeethUpper", {0, -5.4, 6.5}, face);
  jaw = maker.add("Jaw", kJawJoint, face, Drive::kJaw, 0, kJawGroup, true);
  lower_teeth = maker.add("TeethLower", {0, -6.8, 6.2}, jaw, Drive::kNone, 0, kJawGroup, true);
  const double tip = form.face(0, kMouthY, Side::kBelow).closed.z - 2.0;
  uint16_t parent = jaw;
  static constexpr const char* kTongueNames[] = {"Tongue01", "Tongue02", "Tongue03"};
  for (int i = 0; i < 3; ++i) {
    const Vec3 at = {0, kMouthY - 1.2 + 0.25 * i, mix(2.0, tip, 0.15 + 0.33 * i)};
    parent = tongue[i] = maker.add(kTongueNames[i], at, parent, Drive::kTongue,
                                   static_cast<uint8_t>(2 * i), kJawGroup, true);
  }
  const Vec3 middle = form.eye();
  eye[0] =
      maker.add_pair("Eye", middle, face, Drive::kGaze, 0, kLeftEyeGroup, kRightEyeGroup, false);
  upper_lid[0] = maker.add_pair("LidUpper", middle, face, Drive::kUpperLid, 0, kLeftEyeGroup,
                                kRightEyeGroup, false);
  half_lid[0] = maker.add_pair("LidUpperHalf", middle, face, Drive::kHalfLid, 0, kLeftEyeGroup,
                               kRightEyeGroup, false);
  lower_lid[0] = maker.add_pair("LidLower", middle, face, Drive::kLowerLid, 0, kLeftEyeGroup,
                                kRightEyeGroup, false);
  for (uint16_t* pair : {eye, upper_lid, half_lid, lower_lid}) pair[1] = joints[pair[0]].twin;

  for (const SkinJoint& place : kPlaces) {
    const Side side = place.below ? Side::kBelow : Side::kAbove;
    const FacePoint at = form.face(form.angle_of(place.x, place.y), place.y, side);
    Vec3 position = form.spread_eyes(at.closed, at.look);
    const uint16_t on = place.below ? jaw : face;
    if (place.x == 0) {
      position.x = 0;
      maker.add(place.name, position, on, Drive::kFit, place.tier, place.group, place.below);
    } else {
      maker.add_pair(place.name, position, on, Drive::kFit, place.tier, place.group, place.group,
                     place.below);
    }
  }

  // The joint turns by the largest turn of any part of a lid.
  for (int i = -20; i <= 20; ++i) {
    const double x = kEye.x + form.eye_half_width() * i / 20.0;
    upper_lid_angle = std::max(upper_lid_angle, form.upper_opening(x));
    lower_lid_angle = std::max(lower_lid_angle, -form.lower_opening(x));
  }
  upper_lid_angle *= 180 / kPi;
  lower_lid_angle *= 180 / kPi;
}

// Weights ---------------------------------------------------------------------------------------

namespace {

class Weigher {
 public:
  void add(uint16_t joint, double weight) {
    if (weight <= 0) return;
    for (uint32_t i = 0; i < count_; ++i) {
      if (joints_[i] != joint) continue;
      values_[i] += weight;
      return;
    }
    joints_[count_] = joint;
    values_[count_++] = weight;
  }

  /// The largest weights, scaled to a sum of 1; the same on both sides of the plane if asked for.
  Weights finish(const Skeleton& skeleton, bool symmetric) {
    if (symmetric) {
      for (uint32_t i = 0; i < count_; ++i) {
        const uint16_t twin = skeleton.joints[joints_[i]].twin;
        const bool alone = std::find(joints_, joints_ + count_, twin) == joints_ + count_;
        if (alone) values_[i] = 0;
      }
    }
    uint16_t order[kRoom];
    for (uint16_t i = 0; i < count_; ++i) order[i] = i;
    std::sort(order, order + count_, [this](uint16_t a, uint16_t b) {
      return values_[a] > values_[b] || (values_[a] == values_[b] && joints_[a] < joints_[b]);
    });
    uint32_t kept = 0;
    while (kept < std::min(count_, kMaxInfluences) && values_[order[kept]] >= 2e-4) ++kept;
    // Keeps both joints of a pair or none.
    if (symmetric && kept == kMaxInfluences && kept < count_) {
      const uint16_t twin = skeleton.joints[joints_[order[kept - 1]]].twin;
      if (joints_[order[kept]] == twin && twin != joints_[order[kept - 1]]) --kept;
    }
    double sum = 0;
    for (uint32_t i = 0; i < kept; ++i) sum += values_[order[i]];
    Weights out;
    for (uint32_t i = 0; i < kept; ++i) {
      out.joints[i] = joints_[order[i]];
      out.values[i] = static_cast<float>(values_[order[i]] / sum);
    }
    out.count = kept;
    return out;
  }

 private:
  static constexpr uint32_t kRoom = 24;
  uint16_t joints_[kRoom];
  double values_[kRoom];
  uint32_t count_ = 0;
};

/// Shares `total` among the nearest skin joints of one side of the tree by compact Shepard weights, which
/// reach 0 where the next joint would come in; far from all of them, the rest goes to `rest`.
void share(const Skeleton& skeleton, uint32_t lod, bool below, Vec3 at, double total, double near,
           double far, Weigher& out, double& rest) {
  constexpr uint32_t kNearest = 4;
  rest = total;
  if (total <= 0) return;
  uint16_t joints[kNearest + 1];
  double squares[kNearest + 1];
  uint32_t found = 0;
  for (uint16_t j = 0; j < skeleton.count; ++j) {
    const Joint& joint = skeleton.joints[j];
    if (joint.drive != Drive::kFit || joint.below != below || !Skeleton::in_lod(joint, lod)) {
      continue;
    }
    const Vec3 d = at - joint.position;
    const double square = dot(d, d);
    if (found > kNearest && square >= squares[kNearest]) continue;
    uint32_t i = found > kNearest ? kNearest : found++;
    for (; i > 0 && squares[i - 1] > square; --i) {
      squares[i] = squares[i - 1];
      joints[i] = joints[i - 1];
    }
    squares[i] = square;
    joints[i] = j;
  }
  const double fade = smooth_step(near, far, std::sqrt(squares[0]));
  if (fade >= 1) return;
  const uint32_t count = std::min(found, kNearest);
  const double end = found > kNearest ? std::sqrt(squares[kNearest]) * 1.0001 + 0.15 : far * 2;
  double shares[kNearest], sum = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const double d = std::sqrt(squares[i]) + 0.15;
    const double s = std::max(0.0, (end - d) / (end * d));
    shares[i] = s * s;
    sum += shares[i];
  }
  for (uint32_t i = 0; i < count; ++i) out.add(joints[i], total * (1 - fade) * shares[i] / sum);
  rest = total * fade;
}

}  // namespace

Weights weigh(const Skeleton& skeleton, uint32_t lod, const Vertex& v, bool on_plane) {
  Weigher weigher;
  switch (v.carrier) {
    case Carrier::kSkull: weigher.add(skeleton.head, 1); break;
    case Carrier::kUpperTeeth: weigher.add(skeleton.upper_teeth, 1); break;
    case Carrier::kLowerTeeth: weigher.add(skeleton.lower_teeth, 1); break;
    case Carrier::kEyeball: weigher.add(skeleton.eye[0], 1); break;
    case Carrier::kTongue: {
      // Between joints at 0.15, 0.48 and 0.81 of the length, those that the LOD has.
      uint32_t have = 0;
      while (have < 3 && Skeleton::in_lod(skeleton.joints[skeleton.tongue[have]], lod)) ++have;
      const double at = (v.along - 0.15) / 0.33;
      const uint32_t i = static_cast<uint32_t>(std::min(std::max(at, 0.0), have - 1.0));
      const double t = i + 1 < have ? smooth_step(0, 1, at - i) : 0;
      weigher.add(skeleton.tongue[i], 1 - t);
      if (i + 1 < have) weigher.add(skeleton.tongue[i + 1], t);
      break;
    }
    case Carrier::kSkin: {
      const double lid = v.lid > 0 ? v.lid / (skeleton.upper_lid_angle * kPi / 180)
                                   : -v.lid / (skeleton.lower_lid_angle * kPi / 180);
      double rest = 1;
      if (v.lid > 0) {
        weigher.add(skeleton.upper_lid[0], 2 * lid - 1);
        weigher.add(skeleton.half_lid[0], lid < 0.5 ? 2 * lid : 2 - 2 * lid);
        rest = std::max(0.0, 1 - 2 * lid);
      } else if (v.lid < 0) {
        weigher.add(skeleton.lower_lid[0], lid);
        rest = std::max(0.0, 1 - lid);
      }
      const double jaw = jaw_weight(v) * rest;
      // With fewer joints, each reaches farther.
      static constexpr double kReach[kLodCount] = {1, 1.05, 1.15, 1.25, 1.35, 1.5, 1.6, 1.8};
      const double near = 1.5 * kReach[lod], far = 3.6 * kReach[lod];
      double upper_rest = 0, lower_rest = 0;
      // Inside the mouth only jaws move vertices; on the lids only lid joints do.
      const double outer = std::max(smooth_step(0.08, 0.42, v.depth), 1 - off_lids(v.look));
      share(skeleton, lod, false, v.look, (rest - jaw) * (1 - outer), near, far, weigher,
            upper_rest);
      share(skeleton, lod, true, v.look, jaw * (1 - outer), near, far, weigher, lower_rest);
      lower_rest += jaw * outer;
      upper_rest += (rest - jaw) * outer;
      weigher.add(skeleton.jaw, lower_rest);
      // Head to neck to shoulders, along a slope under the chin.
      const double y = v.closed.y + 0.22 * (v.closed.z + 1);
      const double high = smooth_step(-8.6, -12.2, y), low = smooth_step(-12.4, -15.4, y);
      const double shoulders = smooth_step(-15.2, -17.6, y);
      weigher.add(skeleton.head, upper_rest * (1 - high));
      weigher.add(skeleton.neck_high, upper_rest * high * (1 - low));
      weigher.add(skeleton.neck_low, upper_rest * high * low * (1 - shoulders));
      weigher.add(skeleton.root, upper_rest * high * low * shoulders);
      break;
    }
  }
  return weigher.finish(skeleton, on_plane);
}

}  // namespace mien::head
