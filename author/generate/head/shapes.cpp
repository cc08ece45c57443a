// SPDX-License-Identifier: MIT
#include "author/generate/head/shapes.h"

#include <algorithm>

namespace mien::head {

using author::clamp01;
using author::exact_pow;
using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

// Jaw -------------------------------------------------------------------------------------------

namespace {

/// 1 in the middle of the mouth, 0 from the corners on. An open mouth is rounder than an ellipse.
double inside_mouth(double x) {
  const double s = std::abs(x) / kMouthHalfWidth;
  return s < 1 ? 1 - exact_pow(s, 2.6) : 0;
}

}  // namespace

double jaw_weight(const Vertex& v) {
  const Vec3 p = v.look;
  const double by_height = smooth_step(-4.0, -8.6, p.y);
  const double by_lip = v.side == Side::kBelow ? 1 : 0;
  // Round at the corners of the mouth, softer away from the lips.
  const double apart = std::min(std::abs(v.above_mouth), 2.0);
  double w = mix(by_height, by_lip, exact_pow(inside_mouth(p.x), 0.5 + 0.8 * apart));
  w *= smooth_step(-15.6, -10.4, p.y) * smooth_step(-2.5, 3.5, p.z);
  // The floor of the mouth hangs between chin and throat, which does not move.
  w *= mix(1, 0.25 + 0.75 * smooth_step(2.0, 8.2, p.z), smooth_step(-8.6, -11.8, p.y));
  // The back of the mouth hangs between both jaws.
  return mix(w, 0.45, smooth_step(0.7, 1.0, v.depth));
}

Vec3 move_with_jaw(const JointTurns& turns, Vec3 p) {
  const auto [s, c] = exact_sine_cosine(turns.jaw_open * kPi / 180);
  const Vec3 d = p - kJawJoint;
  return kJawJoint + turns.jaw_shift + Vec3{d.x, c * d.y - s * d.z, s * d.y + c * d.z};
}

// Windows ---------------------------------------------------------------------------------------

namespace {

/// How far the mouth opens.
double between_corners(double x) { return std::sqrt(inside_mouth(x)); }

struct Window {
  Vec3 look;
  double at(double cx, double cy, double sx, double sy) const {
    return bump(look.x, look.y, cx, cy, sx, sy);
  }
};

/// The fold from the wing of the nose past the corner of the mouth to the side of the chin: a valley, and beside it,
/// towards the cheek, the mass that hangs over it.
struct Fold {
  explicit Fold(Vec3 look) {
    constexpr double kWingX = 1.75, kWingY = -3.0, kCornerX = 3.35, kCornerY = -5.8, kEndY = -7.6;
    const double down = (look.y - kWingY) / (kCornerY - kWingY);
    // Straight from the wing to beside the corner; below it bends back.
    const double past = std::max(0.0, down - 0.8);
    const double line = mix(kWingX, kCornerX, down) - 1.1 * past * past;
    constexpr double kLean = 0.89;  // cosine of the angle between the line and the vertical
    const double across = (look.x - line) * kLean;
    const double along = smooth_step(kWingY + 0.9, kWingY - 0.9, look.y) *
                         smooth_step(kEndY, kCornerY + 0.2, look.y);
    valley = bump(across, 0, 0, 0, across > 0 ? 0.40 : 0.50, 1) * along;
    roll = smooth_step(-0.1, 1.0, across) * smooth_step(2.6, 0.6, across) * along;
  }
  double valley, roll;
};

/// Moves one lip to a line between where the open jaw has put both.
Vec3 seal(const Vertex& v, bool above) {
  if (above != (v.side == Side::kAbove)) return {};
  JointTurns jaw;
  jaw.jaw_open = kJawOpenAngle;
  const Vec3 look = v.look;
  const Vec3 gap = (move_with_jaw(jaw, look) - look) *
                   (between_corners(look.x) * smooth_step(-15.6, -10.4, look.y) *
                    smooth_step(-2.5, 3.5, look.z));
  const double line = v.above_mouth;
  const double near = above ? bump(0, line, 0, 0, 1, 1.5) : bump(0, line, 0, 0, 1, 2.3);
  return gap * (near * (above ? 0.36 : -0.64));
}

/// Where both move the skin in one direction, it goes as far as the root of the sum of their squares, not as far as
/// their sum. Two that round the lips go as far as the larger one, or they would swell.
Vec3 not_twice(const Corrective& pair, const Vertex& v, Vec3 a, Vec3 b) {
  if (v.lid != 0) return {};
  const Vec3 sum = a + b;
  if (dot(a, b) <= 0) return {};
  const double a2 = dot(a, a), b2 = dot(b, b);
  const bool both_round = kExpressions[pair.first].motion == Motion::kFunnel &&
                          kExpressions[pair.second].motion == Motion::kPucker;
  return sum * (std::sqrt(both_round ? std::max(a2, b2) : a2 + b2) / length(sum) - 1);
}

}  // namespace

Vec3 Shapes::lids(Motion motion, const Vertex& v) const {
  if (v.lid == 0) return {};
  const JointTurns t = turns_of(motion);
  const double share = 1 + (v.lid > 0 ? t.upper_lid : t.lower_lid);
  return turn_lid(v.closed, v.lid * share) - v.position;
}

Vec3 Shapes::one_side(Motion motion, Vec3 look, const Vertex& v) const {
  const Window w = {look};
  const Fold fold(look);
  const double line = v.above_mouth;
  const double apart = between_corners(look.x);
  const bool above = v.side == Side::kAbove;
  // Corners pull the lips along, less toward the middle: lines of lips bend without a kink.
  const double out = std::min(std::max(look.x, 0.0) / kMouthHalfWidth, 1.1);
  const double corner = out * out * bump(0, line, 0, 0, 1, 1.45) * smooth_step(5.3, 2.5, look.x);
  Vec3 d;
  const auto add = [&d](double amount, Vec3 way) { d = d + way * amount; };
  switch (motion) {
    case Motion::kBlink:
      add(w.at(3.2, 2.9, 2.0, 0.9), {0, -0.10, 0});
      add(w.at(3.3, -1.4, 1.6, 0.8), {0, 0.08, 0.03});
      break;
    case Motion::kWide: add(w.at(3.2, 3.0, 2.2, 1.0), {0, 0.16, 0}); break;
    case Motion::kSquint:
      add(w.at(3.6, -1.8, 1.8, 1.0), {0, 0.42, 0.30});
      add(w.at(5.4, 0.4, 0.9, 1.2), {-0.18, 0, 0.05});
      add(w.at(3.0, 2.8, 2.0, 0.8), {-0.04, -0.16, 0});
      break;
    case Motion::kCheekSquint:
      add(w.at(3.8, -2.2, 1.7, 1.1), {0.02, 0.48, 0.36});
      add(w.at(5.5, 0.2, 0.9, 1.2), {-0.10, 0.08, 0.05});
      break;
    case Motion::kLookUp: add(w.at(3.2, 3.0, 2.2, 1.0), {0, 0.10, 0}); break;
    case Motion::kLookDown: add(w.at(3.2, 2.9, 2.2, 1.0), {0, -0.08, 0}); break;
    case Motion::kLookIn:
    case Motion::kLookOut: break;
    case Motion::kSmile:
      // The line of the lips bends up at its ends; its middle loses the bow. Stretched lips are thinner.
      add(corner, {0.80, 0.76 * mix(0.36, 1, out), -0.60});
      add(bump(look.x, line, 0, 0, 0.8, 0.9), {0, 0.09, 0});
      add(bump(look.x, line, 0, 0, 2.0, 0.9), {0, -0.20 * line, -0.08});
      add(w.at(0.9, -5.2, 1.1, 0.7), {0.05, 0.06, -0.08});
      // The cheek is pushed up below the eye, round in front, and hangs over the fold.
      add(w.at(3.8, -3.0, 1.7, 1.4), {0.08, 0.60, 0});
      add(w.at(3.5, -3.5, 1.35, 1.25), {0, 0, 0.60});
      add(w.at(4.9, -3.6, 1.5, 1.7), {0.30, 0.12, 0.16});
      add(fold.roll, {0.02, 0.20, 0.26});
      add(fold.valley, {0.04, 0.02, -0.18});
      add(w.at(3.3, -1.35, 1.4, 0.5), {0, 0.08, 0.12});
      // A dimple beside the corner.
      add(w.at(3.40, -5.80, 0.45, 0.50), {0, 0, -0.08});
      add(w.at(1.3, -3.0, 0.5, 0.5), {0.12, 0.06, 0});
      break;
    case Motion::kFrown:
      add(corner, {0.14, -0.66, -0.12});
      add(w.at(2.8, -7.0, 1.1, 0.9), {0.06, -0.22, 0.03});
      add(w.at(0.0, -6.3, 1.4, 0.9), {0, 0.10, 0.06});
      add(w.at(0.9, -8.9, 1.2, 1.0), {0, 0.22, 0.10});
      break;
    case Motion::kDimple:
      add(w.at(2.7, -6.0, 1.1, 1.0), {0.60, 0.16, -0.62});
      add(w.at(3.6, -5.8, 0.70, 0.85), {0, 0, -0.34});
      add(w.at(4.6, -4.6, 1.2, 1.3), {0.10, 0.06, 0.16});
      break;
    case Motion::kStretch:
      add(w.at(2.7, -6.1, 1.5, 1.3), {0.88, -0.26, -0.46});
      add(w.at(1.8, -7.4, 1.4, 1.0), {0.25, -0.18, -0.08});
      add(w.at(3.0, -12.0, 1.6, 2.0), {0.28, 0, 0.18});
      break;
    case Motion::kPress: {
      const double g = bump(look.x, line, 1.3, 0, 1.3, 0.85);
      add(g, {0.06, -0.56 * line, -0.24});
      add(w.at(2.7, -5.95, 0.8, 0.9), {0.16, 0.10, -0.20});
      break;
    }
    case Motion::kLowerDown:
      if (above) break;
      add(bump(look.x, line, 1.25, -0.2, 1.25, 1.3) * std::sqrt(apart), {0.08, -0.85, 0.04});
      break;
    case Motion::kUpperUp:
      add(w.at(1.35, -3.4, 0.8, 0.8), {0.02, 0.22, 0.05});
      if (!above) break;
      add(bump(look.x, line, 1.0, 0.2, 1.35, 1.25) * std::sqrt(apart), {0.06, 0.66, 0.10});
      break;
    case Motion::kBrowDown:
      add(w.at(2.5, 3.05, 2.3, 1.15), {-0.18, -0.74, 0.16});
      // Skin between the brows is pushed together: a furrow on each side, and it slides down the root of the nose.
      add(w.at(1.15, 2.7, 0.55, 0.9), {-0.14, -0.10, 0.14});
      add(w.at(0.42, 2.75, 0.24, 0.80), {0, 0, -0.18});
      add(w.at(0.3, 1.9, 1.0, 0.9), {0, -0.12, 0});
      break;
    case Motion::kBrowOuterUp:
      add(w.at(4.1, 3.2, 2.2, 1.45), {0.02, 0.84, 0.04});
      add(w.at(4.0, 5.4, 2.0, 1.3), {0, 0.42, 0});
      break;
    case Motion::kSneer:
      add(w.at(1.25, -3.0, 0.85, 0.95), {0.10, 0.52, 0.10});
      add(w.at(1.05, -0.5, 0.8, 1.1), {-0.06, 0.26, 0.14});
      add(w.at(2.6, -2.6, 1.2, 1.2), {0, 0.30, 0.20});
      add(w.at(1.3, 2.8, 1.1, 0.9), {-0.14, -0.34, 0.06});
      add(fold.valley, {0, 0.05, -0.12});
      add(fold.roll, {0, 0.10, 0.14});
      // The lip is pulled up from above; its edge hardly leaves the other one.
      if (above) {
        add(bump(look.x, line, 1.2, 1.0, 1.5, 1.0) * mix(0.12, 1, smooth_step(0, 0.8, line)),
            {0.05, 0.42, 0.10});
      }
      break;
    case Motion::kMouthLeft:
      add(bump(look.x, look.y, 0.3, kMouthY, 3.2, 2.0), {1.05, 0.02, -0.06});
      add(w.at(3.2, -5.6, 1.3, 1.3), {0.10, 0.16, 0.06});
      add(w.at(0, -3.0, 1.2, 0.9), {0.16, 0, 0});
      break;
    case Motion::kLidPress:
      add(w.at(3.3, -1.4, 1.7, 0.9), {0, 0.18, 0.10});
      add(w.at(5.1, 0.3, 0.8, 0.9), {-0.16, 0, 0.03});
      add(w.at(3.0, 2.8, 2.0, 0.8), {-0.02, -0.14, 0.05});
      break;
    case Motion::kLipsPress:
      // The red goes inwards, the skin around it comes forward.
      add(bump(look.x, line, 1.3, 0, 1.4, 0.9), {0.02, -0.34 * line, -0.16});
      add(bump(look.x, line, 1.3, 0, 1.2, 0.4), {0, 0, -0.24});
      add(bump(look.x, line, 1.3, 1.15, 1.3, 0.4), {0, 0.04, 0.16});
      add(bump(look.x, line, 1.3, -1.35, 1.3, 0.5), {0, -0.04, 0.20});
      break;
    case Motion::kTogetherUpper:
    case Motion::kTogetherLower: {
      // One lip of one half; at the line between them both, which stay together.
      const bool own = above == (motion == Motion::kTogetherUpper);
      const double half = smooth_step(-0.9, 0.9, look.x);
      add(half * bump(look.x, line, 0, 0, 2.4, own ? 0.7 : 0.3), {0, -0.22 * line, -0.16});
      break;
    }
    case Motion::kSealUpper: add(smooth_step(-0.9, 0.9, look.x), seal(v, true)); break;
    case Motion::kSealLower: add(smooth_step(-0.9, 0.9, look.x), seal(v, false)); break;
    case Motion::kDilate:
      add(w.at(1.35, -3.55, 0.45, 0.55), {0.30, 0.03, 0.05});
      add(w.at(1.75, -3.3, 0.5, 0.7), {0.10, 0.04, 0.04});
      break;
    case Motion::kDeepenFold:
      add(fold.valley, {0, 0.03, -0.24});
      add(fold.roll, {0.02, 0.14, 0.28});
      add(w.at(3.4, -3.2, 1.1, 1.0), {0.02, 0.20, 0.14});
      break;
    case Motion::kClench:  // masseter and temple
      add(w.at(5.5, -6.5, 0.8, 1.4), {0.36, 0, 0.26});
      add(w.at(6.0, 2.4, 0.8, 1.1), {0.16, 0, 0.06});
      break;
    case Motion::kNeckStretch:
      // Bands of the platysma below the jaw; it pulls the corners of the mouth down and out.
      add(w.at(2.7, -12.6, 0.40, 2.4), {0.14, 0, 0.34});
      add(w.at(1.2, -12.8, 0.32, 2.2), {0.02, 0, 0.26});
      add(w.at(2.7, -6.8, 1.2, 1.2), {0.24, -0.24, -0.10});
      add(w.at(3.4, -9.8, 1.2, 1.2), {0.16, -0.14, 0.04});
      break;
    case Motion::kMastoid: {
      // From behind the ear to the notch between the clavicles.
      const double down = (-5.0 - look.y) / 11.2;
      add(bump(look.x, 0, mix(5.1, 0.8, down), 0, 0.65, 1) * smooth_step(0.45, 0.70, down) *
              smooth_step(1.08, 0.92, down),
          {0.22, 0, 0.52});
      break;
    }
    case Motion::kBrowsApart:  // wide eyes leave less room for a lowered brow
      add(w.at(3.0, 3.0, 1.8, 1.0), {0.04, 0.26, 0});
      break;
    case Motion::kLessWide:  // an open smile is narrower and higher than the sum
      add(w.at(2.7, -5.95, 1.35, 1.3), {-0.22, 0.10, 0.10});
      if (!above) add(bump(look.x, line, 0.9, -0.2, 1.4, 1.2) * apart, {0, 0.18, -0.05});
      break;
    default: break;
  }
  // Left and right meet in the middle without passing it.
  if (d.x < 0) d.x *= smooth_step(-0.1, 1.9, look.x);
  return d * off_lids(look);
}

Vec3 Shapes::both_sides(Motion motion, const Vertex& v) const {
  const Vec3 look = v.look;
  const Window w = {look};
  const double line = v.above_mouth, apart = between_corners(look.x);
  const bool above = v.side == Side::kAbove;
  const double lips = bump(look.x, line, 0, 0, 2.7, 1.5);
  const double narrow = smooth_step(5.4, 2.2, look.x) * bump(0, line, 0, 0, 1, 1.5);
  // Lips that are pushed forward come to lie in one plane: their corners go farther than their middle.
  const auto forward = [x = look.x](double middle, double corners) {
    return mix(middle, corners, smooth_step(0, 2.4, x)) * smooth_step(5.0, 2.4, x);
  };
  Vec3 d;
  const auto add = [&d](double amount, Vec3 way) { d = d + way * amount; };
  switch (motion) {
    case Motion::kMouthClose:
      add(bump(look.x, line, 0, 0, 2.4, 0.7), {0, -0.24 * line, -0.10});
      break;
    case Motion::kSeal:
      add(1, seal(v, above));
      // Cheeks and corners are drawn in.
      add(w.at(3.0, -6.2, 1.0, 1.2), {-0.15, 0, -0.15});
      break;
    case Motion::kThroatUp:
      // The larynx, as in swallowing: it takes the skin along, slides below it to under the chin, and leaves a hollow.
      add(w.at(0, -13.0, 1.05, 1.6), {0, 1.0, 0});
      add(w.at(0, -12.9, 0.75, 0.70), {0, 0, 0.45});
      add(w.at(0, -14.6, 0.80, 0.80), {0, 0, -0.35});
      add(w.at(0, -11.2, 1.4, 0.9), {0, 0.20, 0.10});
      break;
    case Motion::kThroatDown:
      add(w.at(0, -13.2, 1.1, 1.7), {0, -0.95, 0});
      add(w.at(0, -13.9, 0.85, 0.95), {0, 0, 0.32});
      add(w.at(0, -12.3, 1.0, 0.9), {0, 0, -0.30});
      add(w.at(0, -11.3, 1.8, 0.8), {0, 0.06, -0.18});
      break;
    case Motion::kFunnel:
      add(narrow, {-0.36 * look.x, 0, 0});
      add(bump(0, line, 0, 0, 1, 1.5), {0, 0, forward(0.60, 0.80)});
      add(bump(0, line, 0, 0, 1, 0.8), {0, 0, forward(0.35, 0.50)});
      add(bump(look.x, line, 0, 0, 0.7, 0.8), {0, 0.08, 0});
      // The lips are turned outwards.
      add(lips * apart, {0, above ? 0.22 : -0.26, 0.06});
      add(bump(look.x, line, 0, 0, 2.2, 0.4) * apart, {0, above ? 0.10 : -0.10, 0.06});
      break;
    case Motion::kPucker:
      add(narrow, {-0.55 * look.x, 0, 0});
      add(bump(0, line, 0, 0, 1, 1.5), {0, 0, forward(0.40, 0.70)});
      add(bump(0, line, 0, 0, 1, 0.8), {0, 0, forward(0.62, 0.74)});
      // Lips become as round as they are wide.
      add(bump(look.x, line, 0, 0, 2.1, 0.75), {0, 0.30 * line, 0});
      add(bump(look.x, line, 2.0, 0, 0.6, 0.55), {0, 0.25 * line, 0});
      add(bump(look.x, line, 0, 0, 2.6, 0.28), {0, 0, 0.10 * apart});
      add(w.at(4.2, -5.2, 1.3, 1.6), {-0.25, 0, -0.12});
      break;
    case Motion::kJawOpen:  // cheeks are drawn tight between the jaws, and the corners in
      add(smooth_step(4.0, 2.2, look.x) * bump(0, line, 0, 0, 1, 0.9), {-0.06 * look.x, 0, 0});
      add(bump(look.x, line, 0, 0, 0.7, 0.8), {0, 0.06, 0});
      break;
    case Motion::kLessRaise: add(lips * apart, {0, above ? -0.10 : 0.85, 0.10}); break;
    case Motion::kLessRound:  // the jaw has opened the lips already
      add(lips * apart, {0, above ? -0.18 : 0.42, 0.05});
      break;
    case Motion::kRollLower:
      if (above) break;
      // What is around the red comes to the line between the lips, which stays where it is.
      add(bump(look.x, line, 0, -0.28, 2.1, 0.60), {0, -0.62 * line, -0.52});
      add(bump(look.x, line, 0, -1.0, 2.0, 0.55), {0, 0.24, -0.10});
      add(w.at(0, -8.9, 1.6, 1.0), {0, 0.14, 0.06});
      break;
    case Motion::kRollUpper:
      if (!above) break;
      add(bump(look.x, line, 0, 0.22, 2.1, 0.55), {0, -0.62 * line, -0.56});
      add(bump(look.x, line, 0, 0.8, 2.0, 0.50), {0, -0.20, -0.08});
      break;
    case Motion::kShrugLower:
      add(bump(look.x, line, 0, 0, 2.2, 1.1), {0, 0.42, 0.16});
      if (!above) add(bump(look.x, line, 0, -0.55, 1.8, 0.5) * clamp01(-4 * line), {0, 0.06, 0.30});
      add(w.at(0, -8.9, 1.8, 1.2), {0, 0.50, 0.20});
      add(w.at(2.5, -6.2, 0.9, 0.9), {0, -0.30, 0});
      break;
    case Motion::kShrugUpper:
      if (above) {
        add(bump(look.x, line, 0, 0.25, 2.1, 1.0) * std::sqrt(apart), {0, 0.48, 0.34});
      } else {
        add(bump(look.x, line, 0, -0.1, 2.0, 0.9) * std::sqrt(apart), {0, 0.38, 0.16});
      }
      break;
    case Motion::kBrowInnerUp:
      add(w.at(1.0, 3.05, 1.95, 1.35), {0.04, 0.86, 0.08});
      add(w.at(1.4, 5.4, 2.1, 1.4), {0, 0.45, 0.02});
      break;
    case Motion::kCheekPuff:
      add(w.at(4.2, -5.2, 1.9, 2.0), {0.95, 0, 1.10});
      add(w.at(1.6, -4.7, 1.2, 0.8), {0.05, 0, 0.30});
      add(w.at(1.4, -7.6, 1.3, 0.8), {0.05, 0, 0.22});
      add(bump(look.x, line, 0, 0, 2.2, 0.7), {-0.06 * look.x, -0.15 * line, 0.08});
      break;
    case Motion::kTongueOut: add(lips * apart, {0, above ? 0.20 : -0.34, 0.12}); break;
    default: break;
  }
  // The middle does not move sideways; motions that scale x keep it there anyway.
  const bool by_share =
      motion == Motion::kPucker || motion == Motion::kFunnel || motion == Motion::kJawOpen;
  if (!by_share) d.x *= clamp01(look.x / 0.8);
  return d * off_lids(look);
}

Vec3 Shapes::skin_displacement(uint32_t index, const Vertex& v) const {
  const Shape s = shape(index);
  if (s.motion == Motion::kNotTwice) {
    const Corrective& pair = list_[index - kExpressionCount];
    return not_twice(pair, v, skin_displacement(pair.first, v), skin_displacement(pair.second, v));
  }
  Vec3 d;
  // Windows are those of the front view: nothing moves at the back. Inside the mouth the skin follows the
  // lips less with depth.
  const double share = smooth_step(-0.5, 3.0, v.look.z) * (1 - smooth_step(0.08, 0.50, v.depth));
  if (share > 0) {
    if (s.side == 0) {
      d = both_sides(s.motion, v);
    } else if (s.side > 0) {
      d = one_side(s.motion, v.look, v);
    } else {
      d = mirrored(one_side(s.motion, mirrored(v.look), v));
    }
    d = d * share;
  }
  if (s.side >= 0) {
    const bool undo = s.motion == Motion::kKeepLidsShut;
    const Motion lid_motion =
        undo ? kExpressions[list_[index - kExpressionCount].undone].motion : s.motion;
    d = d + lids(lid_motion, v) * (undo ? -1.0 : 1.0);
  }
  return d;
}

Vec3 Shapes::with_jaw(uint32_t index, const Vertex& v, Vec3 d) const {
  const Motion motion = shape(index).motion;
  const bool undoes = index >= kExpressionCount && undoes_jaw(motion);
  if (!undoes && !moves_jaw(motion)) return d;
  const uint32_t turned = undoes ? list_[index - kExpressionCount].undone : index;
  const Vec3 carried = (move_with_jaw(turns(turned, 1), v.position) - v.position) * jaw_weight(v);
  return undoes ? d - carried : d + carried;
}

Vec3 Shapes::displacement(uint32_t index, const Vertex& v) const {
  return with_jaw(index, v, skin_displacement(index, v));
}

void Shapes::displacements(const Vertex& v, Vec3 (&out)[kMaxShapes]) const {
  Vec3 skin[kExpressionCount];
  for (uint32_t s = 0; s < kExpressionCount; ++s) {
    skin[s] = skin_displacement(s, v);
    out[s] = with_jaw(s, v, skin[s]);
  }
  for (uint32_t s = kExpressionCount; s < count(); ++s) {
    const Corrective& pair = list_[s - kExpressionCount];
    out[s] = is_moderation(s) ? not_twice(pair, v, skin[pair.first], skin[pair.second])
                              : displacement(s, v);
  }
}

bool Displacements::make(uint32_t vertex_count, Arena& arena) {
  return author::make(arena, vertex_count, found_) &&
         author::make(arena, size_t{vertex_count} * shapes_.count(), items_);
}

void Displacements::find(const Vertex& v) {
  if (found_[v.number]) return;
  found_[v.number] = 1;
  Vec3 of_shapes[kMaxShapes];
  shapes_.displacements(v, of_shapes);
  for (uint32_t s = 0; s < shapes_.count(); ++s) {
    items_[size_t{s} * found_.count + v.number] = of_shapes[s];
  }
}

}  // namespace mien::head
