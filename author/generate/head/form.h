// SPDX-License-Identifier: MIT
// The form of the procedural head: surfaces as functions of a direction and a height, so that any
// number of rows and columns can be sampled from them.
//
// The face is designed with its lids CLOSED: skin lies on a ball around each eyeball and two edges
// share one line across it. The neutral pose turns the lids open about the eye's x axis; blinking
// turns them back, and so ends exactly where the edges meet.
//
// Frame: centimeters, x to the character's left, y up, z to the front. Everything is computed for
// x >= 0 and mirrored.
#pragma once

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"

namespace mien::head {

/// sRGB, 0 ... 255.
struct Color {
  double r = 0, g = 0, b = 0;
};

inline Color mix(Color a, Color b, double t) {
  return {author::mix(a.r, b.r, t), author::mix(a.g, b.g, t), author::mix(a.b, b.b, t)};
}

/// The same place on the other side of the head.
inline Vec3 mirrored(Vec3 v) { return {-v.x, v.y, v.z}; }

/// As with more blood under the skin; keeps dark skin dark.
Color redder(Color c, double amount);

enum class HairStyle : uint8_t { kParted, kCropped, kCurly, kReceding, kBob };

/// The properties that differ from seed to seed. Factors are 1 for seed 0.
struct Person {
  // Of the skull: its breadth, length and height, the face at the cheekbones and the jaw.
  double breadth = 1, length = 1, height = 1, face = 1, jaw = 1, neck = 1;
  double chin = 1, nose = 1, nose_width = 1, cheek = 1, muzzle = 1, lips = 1, eyes = 1, brow = 1,
         ear = 1;
  double sex = 0;                                      // -1 female ... 1 male; 0 is in between
  double weight = 0;                                   // -1 lean ... 1 heavy
  double nose_hump = 0, brow_height = 0;               // cm
  double chin_drop = 0, forehead = 0, brow_ridge = 0;  // cm: longer, farther in front
  double nose_drop = 0, tip_drop = 0;                  // cm: base and tip of the nose, lower
  double bridge = 1, mouth_width = 1;                  // breadths
  double tip = 0;         // -1 a fine tip of the nose with small wings ... 1 a round one
  double lip_share = 0;   // -1 a full upper lip ... 1 a full lower lip
  double corners = 0;     // cm: corners of the mouth, higher
  double hood = 0;        // cm: skin that hangs over the crease of the upper lid
  double crease = 1;      // its height above the edge of the lid
  double epicanthus = 0;  // 0 ... 1: a fold of the upper lid over the inner corner of the eye
  double eye_width = 1,
         lower_lid = 1;  // length of the slit between the lids; how far the lower one is open
  double eye_gap = 0;    // cm: eyes farther out
  double lid_peak = 0;   // -1 the upper lid is highest inside ... 1 outside
  double iris_size = 1;
  double brow_arch = 0, brow_slope = 0;  // cm: higher in the middle; higher at the outer end
  double sockets = 0;                    // cm: deeper
  double angle = 0;                      // cm: angles of the jaw, farther out
  double cleft = 0;                      // cm: depth of the cleft in the chin
  double eye_tilt = 0;                   // radians by which the outer corner is higher
  double age = 1.0 / 6;                  // 0 ... 1: 20 ... 80 years
  HairStyle style = HairStyle::kParted;
  Color skin, lip, hair, brow_hair, iris, shirt;
};
Person make_person(uint64_t seed);

// Landmarks -------------------------------------------------------------------------------------

constexpr Vec3 kEye = {3.1, 0.3, 6.8};  // center of the left eyeball
constexpr double kEyeRadius = 1.60;
constexpr double kLidRadius = 1.78;     // outside of the lids
constexpr double kEyeHalfWidth = 1.52;  // of the opening between the lids, of the designed person

/// The nostril of a nose of width 1, seen from below: x, and the height above the face. Its axis converges with the other
/// one's towards the tip, where it is narrow.
struct Nostril {
  double x, height = 0.91, half_length = 0.52;
  double axis_x = -0.42, axis_height = 0.9075;
  double breadth;
  explicit Nostril(const Person& p) : x(0.735 + 0.03 * p.tip), breadth(0.305 + 0.03 * p.tip) {}
  double half_width(double along) const { return breadth * (1 - 0.26 * along); }
};

constexpr double kMouthY = -6.0;
constexpr double kMouthHalfWidth = 2.45;
constexpr double kCrownY = 12.6;
constexpr double kBottomY = -22.0;
constexpr Vec3 kJawJoint = {0, -1.6, 0.4};
constexpr double kJawOpenAngle = 22;  // degrees

/// A place on the face, before the neutral pose opens the lids.
struct FacePoint {
  Vec3 closed;
  Vec3 look;       // the same with nose, mouth and chin where the designed person has them
  double lid = 0;  // radians that the neutral pose turns it: upper lid > 0, lower lid < 0
};

/// A place in the front view; `y` is a row, which facial features bend.
struct FrontPlace {
  double x, y;
};

enum class Side { kBelow, kAbove };  // of the slits between lids and between lips

class Form {
 public:
  explicit Form(const Person& person) : person_(person) {}

  const Person& person() const { return person_; }

  /// `angle`: 0 in front, pi behind; `row`: its height in front. Beyond the ends of the lids' slit both sides are
  /// the same.
  FacePoint face(double angle, double row, Side side) const;

  /// The height, on a skull of this size, of the place that is at `y` on others.
  double raised(double y) const;

  /// The angle at which the row `y` has this |x|, in front.
  double angle_of(double x, double y) const;

  double eye_half_width() const { return kEyeHalfWidth * person_.eye_width; }
  /// -1 at the inner corner of the eye, 1 at the outer one.
  double along_eye(double x) const { return (x - kEye.x) / eye_half_width(); }
  /// Where a person has what is designed around kEye: all of an eye moves as far, and the face around it less. `look`:
  /// where the place is on the designed face.
  Vec3 spread_eyes(Vec3 p, Vec3 look) const;
  Vec3 eye() const { return kEye + Vec3{person_.eye_gap, 0, 0}; }
  /// Height of the closed lids' edges, and of the row of the mouth, which is bent as well.
  double lid_line(double x) const;
  double mouth_line(double x) const;
  /// Curves around the slits, `which` 1 above, -1 below: the crease of the lids, `along` -1 ... 1
  /// from the inner to the outer corner; the border of the lips' red, `out` 0 ... 1 from the middle
  /// to the corner. 0 is the slit itself.
  FrontPlace lid_curve(double along, int which) const;
  FrontPlace lip_curve(double out, int which) const;
  /// Around the nostril's opening, or a larger or smaller curve like it: 0 is towards the columella, a quarter turn on
  /// towards the lip.
  FrontPlace nostril_curve(double angle, double size) const;
  /// Height of the lips' red above (`which` 1) or below the line between them.
  double lip_height(double x, int which) const;
  /// Angle by which the neutral pose opens the edges of the lids.
  double upper_opening(double x) const;
  double lower_opening(double x) const;

  /// Where the middle of the brow is in the front view, and half of its height; `along` 0 ... 1 from the nose outwards.
  struct BrowArch {
    double x, y, half;
  };
  BrowArch brow_arch(double along) const;

  Color skin_color(Vec3 look, double row, double lid) const;

 private:
  struct Section {
    double half_width, front, back, exponent;
  };
  /// `cosine` of the angle.
  Section section(double y, double cosine) const;
  double relief(double x, double y) const;
  double side_relief(double z, double y) const;
  struct NoseBodies {
    double dome = 0, wing = 0;
    double height() const;
  };
  NoseBodies nose_bodies(double x, double y) const;
  double nose(double x, double y) const;
  Vec3 nose_detail(double x, double y) const;
  double lips(double x, double y) const;
  Vec3 neck_form(Vec3 p, double angle) const;

  Person person_;
};

/// Turns `p` about the x axis through the eye, upwards in front.
Vec3 turn_lid(Vec3 p, double angle);

/// How far outside the lids a place of the front view is: 0 in the middle of the eye, 1 at the end of the
/// area that follows the ball.
double from_lids(double x, double y);

/// 0 on the lids, which stay on their ball, 1 away from them.
double off_lids(Vec3 look);

/// exp(-((x - cx) / sx)^2 - ((y - cy) / sy)^2)
double bump(double x, double y, double cx, double cy, double sx, double sy);

}  // namespace mien::head
