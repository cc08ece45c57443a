// SPDX-License-Identifier: MIT
#include "author/generate/head/form.h"

#include <algorithm>

namespace mien::head {

using author::clamp01;
using author::exact_atan2;
using author::exact_exp;
using author::exact_pow;
using author::exact_sine_cosine;
using author::mix;
using author::smooth_step;

// Sections --------------------------------------------------------------------------------------

double bump(double x, double y, double cx, double cy, double sx, double sy) {
  const double u = (x - cx) / sx, v = (y - cy) / sy, d = u * u + v * v;
  return d > 18 ? 0 : exact_exp(-d);
}

namespace {

// y, half width, front, back, exponent.
//
// Breadths follow the means of young adults that Farkas published ("Anthropometry of the Head and Face", 2nd
// ed., 1994; women and men of North America), cm: head 14.4 and 15.1 (eu-eu), forehead 11.2 and 11.6 (ft-ft),
// cheekbones 13.0 and 13.7 (zy-zy), angles of the jaw 9.1 and 9.7 (go-go, on bone). Heights: nose to chin 11.1
// and 12.1 (n-gn), lower face 6.4 and 7.3 (sn-gn). Eyeballs are a third larger than life, so that lids of the length of
// people's lie on them; the slit and the iris have the size of people's.
constexpr int kKnotColumns = 5;
constexpr double kKnots[][kKnotColumns] = {
    {-22.0, 10.2, 4.6, -7.4, 2.4}, {-21.6, 11.4, 5.4, -8.6, 2.45}, {-20.6, 12.4, 5.6, -9.3, 2.4},
    {-19.4, 12.5, 5.0, -9.3, 2.3}, {-18.3, 11.6, 4.3, -8.9, 2.2},  {-17.4, 9.7, 3.8, -8.4, 2.15},
    {-16.6, 7.5, 3.55, -7.9, 2.1}, {-15.8, 6.1, 3.45, -7.4, 2.05}, {-14.4, 5.2, 3.55, -6.8, 2.0},
    {-12.6, 4.95, 3.9, -6.4, 2.0}, {-11.5, 4.65, 4.95, -6.2, 2.0}, {-10.9, 4.8, 7.0, -6.1, 2.0},
    {-10.3, 5.2, 8.5, -6.1, 1.84}, {-9.2, 5.5, 8.9, -6.2, 1.92},   {-8.0, 5.75, 9.0, -6.4, 2.0},
    {-6.0, 6.05, 8.85, -6.9, 2.1}, {-4.0, 6.5, 9.0, -7.8, 2.2},    {-1.5, 6.95, 9.1, -8.9, 2.25},
    {0.6, 7.15, 9.25, -9.6, 2.2},  {3.0, 7.45, 9.5, -10.0, 2.26},  {5.0, 7.55, 9.12, -10.1, 2.28},
    {7.5, 7.25, 8.15, -9.7, 2.16}, {9.8, 6.2, 6.6, -8.5, 2.15},    {11.4, 4.6, 4.7, -6.6, 2.12},
    {12.25, 2.7, 2.2, -4.0, 2.1},  {12.6, 0.6, -0.3, -1.5, 2.0},
};
constexpr int kKnotCount = sizeof(kKnots) / sizeof(kKnots[0]);

/// Monotone cubic through (y, value) pairs, ascending in y, `stride` doubles apart: no overshoot
/// between them (slopes of Fritsch and Butland). Constant beyond the ends.
double interpolate(double y, const double* ys, const double* values, int stride, int count) {
  const auto at = [stride](const double* of, int i) { return of[i * stride]; };
  y = std::min(std::max(y, at(ys, 0)), at(ys, count - 1));
  int i = 0;
  while (i < count - 2 && y > at(ys, i + 1)) ++i;
  const auto slope = [&](int k) {
    return (at(values, k + 1) - at(values, k)) / (at(ys, k + 1) - at(ys, k));
  };
  const auto tangent = [&](int k) {
    if (k == 0) return slope(0);
    if (k == count - 1) return slope(count - 2);
    const double a = slope(k - 1), b = slope(k);
    if (a * b <= 0) return 0.0;
    const double h0 = at(ys, k) - at(ys, k - 1), h1 = at(ys, k + 1) - at(ys, k);
    return 3 * (h0 + h1) / ((2 * h1 + h0) / a + (h1 + 2 * h0) / b);
  };
  const double h = at(ys, i + 1) - at(ys, i), t = (y - at(ys, i)) / h, t2 = t * t, t3 = t2 * t;
  return at(values, i) * (2 * t3 - 3 * t2 + 1) + at(values, i + 1) * (3 * t2 - 2 * t3) +
         h * (tangent(i) * (t3 - 2 * t2 + t) + tangent(i + 1) * (t3 - t2));
}

template <int N>
double interpolate(double y, const double (&table)[N][2]) {
  return interpolate(y, &table[0][0], &table[0][1], 2, N);
}

constexpr double kCenterZ = -0.4;

/// The larger one, slightly raised where they meet.
double smooth_max(double a, double b, double width) {
  const double h = std::max(0.0, 1 - std::abs(a - b) / width);
  return std::max(a, b) + 0.25 * width * h * h;
}

/// The collar, in front; its row runs up to the neck at the sides and behind.
constexpr double kCollarY = -17.5;

double collar_rise(double y, double cosine) {
  const double front = std::max(cosine, 0.0);
  return 1.5 * (1 - front * front) * bump(0, y, 0, kCollarY, 1, 2.3);
}

/// How far a place is inside the jaw, in the view from the side: its border runs from the chin to
/// the angle below the ear and up from there. Negative on the neck.
double inside_jaw(double y, double z) {
  const double below = y - mix(-7.3, -10.6, (z - 1.0) / 7.0);
  const double before = (z - 0.9) + 0.14 * (y + 7.3);
  const double both = std::min(below * 0.92, before);
  // The angle of the jaw is round.
  const double h = std::max(0.0, 1 - std::abs(below * 0.92 - before) / 2.8);
  return both - 0.7 * h * h;
}

}  // namespace

Form::Section Form::section(double y, double cosine) const {
  const auto at = [y](int column) {
    return interpolate(y, kKnots[0], kKnots[0] + column, kKnotColumns, kKnotCount);
  };
  Section s = {at(1), at(2), at(3), at(4)};
  // The nape has no jaw.
  static constexpr double kNape[][2] = {{-22.0, 10.2}, {-21.6, 11.4}, {-20.6, 12.4}, {-19.4, 12.5},
                                        {-18.3, 11.6}, {-17.4, 10.0}, {-16.6, 8.1},  {-15.6, 6.4},
                                        {-13.6, 5.2},  {-11.8, 4.9},  {-10.5, 4.9},  {-7.5, 5.3},
                                        {-4.5, 6.1},   {-1.5, 6.85},  {0.6, 7.15}};
  if (y < 0.6)
    s.half_width = mix(s.half_width, interpolate(y, kNape), smooth_step(0.65, -0.45, cosine));
  const Person& p = person_;
  s.half_width *= 1 + 0.10 * p.weight * bump(0, y, 0, -6.8, 1, 4.5);
  s.half_width *= mix(1, p.jaw, bump(0, y, 0, -8.2, 1, 3.2));
  s.half_width *= mix(1, p.face, bump(0, y, 0, -2.0, 1, 3.0));
  s.half_width *= mix(1, p.breadth, smooth_step(0, 6, y));
  s.back = mix(s.back, kCenterZ + (s.back - kCenterZ) * p.length, smooth_step(-10, -2, y));
  s.front += p.forehead * smooth_step(3.5, 9, y);
  const double neck = mix(1, p.neck, smooth_step(-9.8, -12.2, y));
  s.half_width *= neck;
  s.front = mix(-1.4, s.front, neck);
  s.back = mix(-1.4, s.back, neck);
  return s;
}

// Relief ----------------------------------------------------------------------------------------

double Form::mouth_line(double x) const {
  const double s = std::min(std::abs(x) / kMouthHalfWidth, 1.3);
  // The tubercle of the upper lip hangs in the middle; beside it the line rises.
  return kMouthY - 0.09 * bump(s, 0, 0, 0, 0.26, 1) + 0.05 * bump(s, 0, 0.46, 0, 0.26, 1) +
         (0.03 + person_.corners) * s * s * s * s;
}

double Form::lip_height(double x, int which) const {
  const double s = std::min(std::abs(x) / (1.04 * kMouthHalfWidth), 1.0), end = 1 - s * s;
  const double full = mix(1, person_.lips, 0.5) * (1 - 0.18 * which * person_.lip_share);
  if (which < 0)
    return full * (0.80 * exact_pow(end, 0.54) - 0.05 * bump(s, 0, 0, 0, 0.30, 1) * end);
  const double bow = 0.57 + 0.11 * bump(s, 0, 0.24, 0, 0.20, 1) - 0.06 * bump(s, 0, 0, 0, 0.11, 1);
  return bow * full * exact_pow(end, 0.54);
}

FrontPlace Form::lip_curve(double out, int which) const {
  if (which == 0) return {out * kMouthHalfWidth, kMouthY};
  const double x = out * 1.04 * kMouthHalfWidth;
  return {x, kMouthY + which * lip_height(x, which)};
}

double Form::lid_line(double x) const {
  const double s = along_eye(x), inside = std::max(0.0, 1 - s * s);
  return kEye.y + (0.15 + 1.5 * person_.eye_tilt) * std::min(std::max(s, -1.4), 1.4) -
         0.36 * inside - 0.10 * person_.epicanthus * bump(s, 0, -1, 0, 0.30, 1);
}

Vec3 Form::spread_eyes(Vec3 p, Vec3 look) const {
  const double u = (look.x - kEye.x) / 1.70, v = (look.y - 0.8) / 1.9;
  p.x += person_.eye_gap * smooth_step(3.2, 1.25, u * u + v * v) * smooth_step(2.0, 4.0, look.z);
  return p;
}

FrontPlace Form::lid_curve(double along, int which) const {
  if (which == 0) return {kEye.x + along * eye_half_width(), kEye.y};
  const double height = (which > 0 ? 1.36 : -0.85) * exact_pow(1 - along * along, 0.6);
  return {kEye.x + 1.13 * along * eye_half_width(), kEye.y + height};
}

// The slit is 30 by 10.5 mm in life size, and the upper lid covers 1 to 2 mm of the iris, which the lower one touches.
// S. Read et al. measured a height of 9.7 mm (standard deviation 1.2) in young adults ("The Morphology of the Palpebral
// Fissure in Different Directions of Vertical Gaze", Optometry and Vision Science 83, 2006).
double Form::upper_opening(double x) const {
  const double s = along_eye(x), inside = std::max(0.0, 1 - s * s);
  return 0.50 * person_.eyes * exact_pow(inside, 0.62) * (1 + (0.22 * person_.lid_peak - 0.08) * s);
}

double Form::lower_opening(double x) const {
  const double s = along_eye(x), inside = std::max(0.0, 1 - s * s);
  return -0.155 * person_.lower_lid * exact_pow(inside, 0.80) * (1 + 0.16 * s);
}

/// The nose above the face around it, of a nose of height 1 and width 1: a dome in each row, and a wing.
Form::NoseBodies Form::nose_bodies(double x, double y) const {
  const Person& p = person_;
  // y, height of the ridge, half width, steepness of the sides (less is steeper), bluntness
  static constexpr double kRows[][5] = {
      {-4.82, 0.00, 0.6, 1.20, 0},   {-4.62, 0.18, 0.76, 1.10, 0},   {-4.44, 0.56, 0.92, 1.00, 0},
      {-4.26, 1.14, 1.10, 1.00, 0},  {-4.06, 1.74, 1.30, 1.05, 0},   {-3.83, 2.14, 1.48, 1.20, 0.1},
      {-3.5, 2.36, 1.60, 1.45, 0.4}, {-3.1, 2.42, 1.66, 1.65, 0.8},  {-2.7, 2.32, 1.60, 2.00, 0.9},
      {-2.2, 2.02, 1.56, 2.00, 0.6}, {-1.5, 1.62, 1.38, 1.70, 0.25}, {-0.6, 1.12, 1.28, 1.60, 0},
      {0.4, 0.48, 1.24, 1.70, 0},    {1.2, 0.14, 1.45, 1.90, 0},     {2.4, 0.16, 2.2, 1.80, 0},
      {4.2, 0.00, 2.4, 1.50, 0}};
  constexpr int kCount = sizeof(kRows) / sizeof(kRows[0]);
  const auto at = [y](int column) {
    return interpolate(y, kRows[0], kRows[0] + column, 5, kCount);
  };
  const double bridge = mix(1, p.bridge, smooth_step(-2.6, -1.4, y) * smooth_step(2.4, 0.8, y));
  const double t = x / (at(2) * bridge);
  // Its foot is round: the dome goes to 0 a little outside.
  const double left = 1 - t * t, above = 0.5 * (left + std::sqrt(left * left + 0.006));
  NoseBodies out;
  if (t < 1.4) {
    const double blunt = 1 + at(4) * std::min(t * t, 1.0);
    out.dome = at(1) * exact_pow(above, at(3)) * blunt * smooth_step(1.4, 1.0, t);
  }
  // The tip is a ball of its own, as are the wings, with steep sides.
  const double ball = 1 + 0.16 * p.tip;
  out.dome += (0.16 + 0.10 * p.tip) * bump(x, y, 0, -3.02, 0.62 * ball, 0.55 * ball);
  const double dx = (x - 1.10) / 0.70, dy = (y + 3.54) / (y > -3.54 ? 0.58 : 0.78),
               from = std::sqrt(dx * dx + dy * dy), inside = 1 - from * from;
  // Its foot is steep behind and flat where it runs into the sill of the nostril.
  const double steepness = mix(0.50, 1.0, smooth_step(-0.4, 0.8, dy)) +
                           0.35 * smooth_step(-0.4, -0.9, dy) * smooth_step(1.1, 0.4, dx) +
                           0.50 * smooth_step(0.1, 0.6, dy) * smooth_step(0.2, 0.8, dx);
  out.wing = (1.38 + 0.08 * p.tip) *
             exact_pow(0.5 * (inside + std::sqrt(inside * inside + 0.004)), steepness) *
             smooth_step(1.35, 1.0, from);
  return out;
}

double Form::NoseBodies::height() const { return smooth_max(dome, wing, 0.40); }

double Form::nose(double x, double y) const {
  return person_.nose * nose_bodies(std::abs(x) / person_.nose_width, y).height();
}

FrontPlace Form::nostril_curve(double angle, double size) const {
  const Nostril n(person_);
  const auto [s, c] = exact_sine_cosine(angle);
  const double along = -size * s, across = -size * c * n.half_width(along);
  const double x = n.x + along * n.half_length * n.axis_x + across * n.axis_height,
               height = n.height + along * n.half_length * n.axis_height - across * n.axis_x;
  // The row of the nose's base that has this height.
  double low = -4.75, high = -3.55;
  for (int i = 0; i < 30; ++i) {
    const double y = 0.5 * (low + high);
    (nose_bodies(x, y).height() < height ? low : high) = y;
  }
  return {person_.nose_width * x, 0.5 * (low + high)};
}

namespace {

/// How far the rim of the nostril, a roll 2 to 3 mm thick, and the columella hang below the base of the nose, at `x` and
/// a height above the face.
///
/// In the view from the side the lower edge of the columella is 2 to 4 mm below the rims (A. Ding and Y. Zhang, "What is
/// the perfect nose?", Rhinology Online 3, 2020).
struct NoseBase {
  NoseBase(const Nostril& n, double x, double height, double y) {
    const double dx = x - n.x, dh = height - n.height;
    const double along = (dx * n.axis_x + dh * n.axis_height) / n.half_length;
    const double across = (dx * n.axis_height - dh * n.axis_x) / n.half_width(along);
    const double from = std::sqrt(along * along + across * across);
    // Low at the columella and at the sill in front of the lip.
    const double share = smooth_step(-3.65, -3.9, y) * mix(0.3, 1, smooth_step(-1.0, -0.2, along)) *
                         mix(0.3, 1, smooth_step(0.40, 0.90, x));
    rim = share * (0.12 * bump(from, 0, 1.35, 0, 0.30, 1) - 0.06 * smooth_step(1.20, 0.95, from));
    columella = 0.06 * bump(x, 0, 0, 0, 0.32, 1) * smooth_step(0.1, 0.5, height) *
                smooth_step(2.0, 1.3, height) * smooth_step(-3.6, -3.9, y);
  }
  double rim, columella;
};

}  // namespace

/// What a height above the face cannot have: the groove around the wing, the rim of the nostril, and the columella
/// between the nostrils. An offset.
Vec3 Form::nose_detail(double x, double y) const {
  const double at_x = x / person_.nose_width;
  if (y < -4.9 || y > -2.2 || at_x > 2.3) return {0, 0, 0};
  constexpr double kStep = 0.01;
  const NoseBodies here = nose_bodies(at_x, y), beside = nose_bodies(at_x + kStep, y),
                   above = nose_bodies(at_x, y + kStep);
  const double height = here.height();
  const double slope_x = (beside.height() - height) / kStep,
               slope_y = (above.height() - height) / kStep;
  const double steep = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
  // The bodies meet in the groove, from behind the wing over it to the lobule of the tip, where it fades.
  const auto apart = [](const NoseBodies& b) { return b.wing - b.dome; };
  const double change_x = (apart(beside) - apart(here)) / kStep,
               change_y = (apart(above) - apart(here)) / kStep;
  const double change = std::sqrt(change_x * change_x + change_y * change_y);
  const double from = apart(here) / std::max(change, 0.5) * std::min(steep, 2.5);
  const double below =
      mix(smooth_step(-3.75, -3.35, y), smooth_step(-4.3, -3.8, y), smooth_step(1.1, 1.5, at_x));
  const double groove = mix(0.09, 0.12, smooth_step(0.9, 1.3, at_x)) *
                        bump(from, 0, 0, 0, 0.13, 1) * below * smooth_step(0.5, 0.9, at_x) *
                        smooth_step(-2.70, -3.0, y);
  const NoseBase base(Nostril(person_), at_x, height, y);
  const double in = groove / steep;
  return Vec3{at_x > 0 ? in * slope_x : 0, in * slope_y - base.rim - base.columella,
              0.2 * base.rim - in} *
         person_.nose;
}

double Form::relief(double x, double y) const {
  const Person& p = person_;
  double z = nose(x, y);
  struct Bump {
    double amount, cx, cy, sx, sy;
  };
  const double wing = p.nose_width;
  const Bump bumps[] = {
      {-0.42 - p.sockets, 3.1, 0.25, 1.8, 1.25},              // sockets
      {-0.22 + 0.17 * p.epicanthus, 1.60, 0.35, 0.60, 0.95},  // inner corners of the eyes
      {0.22, 3.3, 1.30, 1.30, 0.50},                          // below the brow
      {0.30 + p.hood, 3.8, 1.60, 1.5, 0.70},                  // skin that hangs over the crease
      {0.24 + p.brow_ridge, 1.9, 2.45, 1.4, 0.70},            // brow ridge, inner half
      {0.36 + p.brow_ridge, 4.4, 2.45, 1.2, 0.70},     // and above the outer corner of the eye
      {0.18 + 0.5 * p.brow_ridge, 0, 2.4, 1.0, 0.7},   // glabella
      {-0.10, 1.90 * wing, -3.7, 0.26, 0.55},          // behind the wing of the nose
      {0.34 + 0.34 * p.cheek, 4.8, -1.45, 1.4, 1.00},  // cheekbones
      {0.30, 3.2, -2.7, 1.3, 1.2},                     // apple of the cheek
      {-0.20, 2.7, -1.00, 1.0, 0.35},  // from the inner corner of the eye to the cheek
      {-0.14 - 0.22 * p.cheek, 4.8, -4.5, 1.4, 1.4},    // hollow of the cheek
      {0.50 + 0.74 * p.muzzle, 0, -5.7, 2.6, 1.9},      // muzzle
      {-0.06 - 0.24 * p.age, 2.25, -4.35, 0.30, 0.85},  // from nose to mouth
      {-0.16, 2.60, -6.02, 0.62, 0.80},                 // corners of the mouth, behind the cheek
      {-0.15, 2.52, -6.01, 0.25, 0.20},                 // and the pit at the end of each
      {0.12, 3.30, -6.25, 0.75, 0.95},                  // the muscles that meet beside them
      {0.45 * p.weight, 4.3, -5.2, 1.6, 1.9},           // fat of the cheeks
      {0.30 * p.weight, 3.0, -8.6, 1.8, 1.2},           // and of the jaw
      {p.nose_hump, 0, -0.7, 0.7, 0.8},                 // bridge of the nose: convex or hollow
      {-0.16, 0, -4.85, 0.24, 0.60},                    // philtrum
      {0.09, 0.42, -5.05, 0.18, 0.48},                  // its edges
      {0.10 * p.age, 3.2, -1.35, 1.1, 0.35},            // below the eyes
      {-0.30 * p.age, 4.6, -4.0, 1.2, 1.2},             // cheeks sink
      {0.28 * p.age, 3.6, -8.4, 1.5, 1.2},              // jowls
      {-0.34, 0, -7.70, 1.5, 0.50},                     // fold above the chin
      {0.26 + 0.62 * p.chin, 0, -9.25, 1.25, 0.95},     // chin
      {0.10, 0.75, -9.35, 0.6, 0.6},                    // its two tubercles
      {-p.cleft, 0, -9.25, 0.26, 0.75},                 // and the cleft between them
      {-0.16, 2.3, -9.0, 0.7, 1.0},                     // beside it, before the jowl
      {0.22, 1.7, 5.6, 1.7, 1.5},                       // frontal eminences
      {-0.10, 0, 4.3, 1.6, 0.7},                        // between them and the brow ridge
      {-0.36, 6.0, 2.4, 0.9, 1.5},                      // temples
  };
  for (const Bump& b : bumps) z += b.amount * bump(std::abs(x), y, b.cx, b.cy, b.sx, b.sy);
  return z;
}

/// How far the sides of the head stand out beyond their sections, along x.
double Form::side_relief(double z, double y) const {
  struct Bump {
    double amount, z, y, sz, sy;
  };
  const double lean = 0.5 * person_.cheek;
  const Bump bumps[] = {
      {0.18 + 0.4 * lean, 2.8, -1.2, 2.3, 1.20},  // arch of the cheekbone
      {-0.02 - 0.3 * lean, 2.9, -4.3, 2.0, 1.4},  // below it
      {0.28 + 0.08 * person_.sex + person_.angle, 0.9, -6.8, 1.7,
       1.6},                        // angle of the jaw, with the muscle on it
      {-0.32, 3.6, 2.6, 1.9, 1.5},  // temple
      {0.22, 5.3, 4.4, 0.9, 1.7},   // line from the brow up, where the forehead turns
  };
  double x = 0;
  for (const Bump& b : bumps) x += b.amount * bump(z, y, b.z, b.y, b.sz, b.sy);
  return x;
}

/// How far the lips protrude: most at a third of their height from the line between them, where both are
/// round.
double Form::lips(double x, double y) const {
  const double d = y - mouth_line(x), s = std::abs(x) / (1.04 * kMouthHalfWidth);
  if (s >= 1) return 0;
  const int which = d > 0 ? 1 : -1;
  const double height = lip_height(x, which), q = std::abs(d) / height;
  const double end = std::sqrt(1 - s * s);
  // Beyond the border of the red runs a low roll.
  const double roll = 0.056 * end * bump(height * (q - 1), 0, 0.07, 0, 0.07, 1);
  if (q >= 1) return roll;
  return (which > 0 ? 0.30 : 0.40) * (1 - 0.25 * which * person_.lip_share) * person_.lips * end *
             2.6 * std::sqrt(q) * (1 - q) -
         0.08 * end * (1 - q) + roll;
}

// The face --------------------------------------------------------------------------------------

Vec3 turn_lid(Vec3 p, double angle) {
  const auto [s, c] = exact_sine_cosine(angle);
  const double y = p.y - kEye.y, z = p.z - kEye.z;
  return {p.x, kEye.y + c * y + s * z, kEye.z - s * y + c * z};
}

double from_lids(double x, double y) {
  const double u = (x - kEye.x) / 1.70, v = (y - kEye.y) / 1.30;
  return u * u + v * v;
}

double off_lids(Vec3 look) { return smooth_step(0.95, 2.2, from_lids(std::abs(look.x), look.y)); }

double Form::raised(double y) const {
  return y + (person_.height - 1) * std::max(0.0, y - 3) * smooth_step(3, 7, y);
}

double Form::angle_of(double x, double y) const {
  const Section at = section(y, 1);
  const double s = exact_pow(std::min(x / at.half_width, 1.0), at.exponent / 2);
  return exact_atan2(s, std::sqrt(1 - s * s));
}

/// The neck below the border of the jaw: the hollow there, the muscles from behind the ears to the breast bone
/// (sternomastoids), the larynx, clavicles and the hollows beside and above them.
Vec3 Form::neck_form(Vec3 p, double angle) const {
  const auto [sine, cosine] = exact_sine_cosine(angle);
  // The border of the jaw overhangs.
  if (p.y < 0) {
    const double below = smooth_step(0.45, -1.15, inside_jaw(p.y, p.z)) *
                         smooth_step(-2.6, 0.6, p.z) * smooth_step(-3.0, -6.0, p.y) *
                         smooth_step(-15.5, -11.5, p.y);
    p.x *= 1 - 0.14 * below;
  }
  if (cosine < -0.3 || p.y > -5) return p;
  // Below the chin fat fills the angle to the neck.
  double out = 0.9 * std::max(0.0, person_.weight) * bump(p.x, p.y, 0, -11.8, 3.2, 1.3) *
               smooth_step(0.2, 0.6, cosine);
  // Lean necks show more.
  const double lean = mix(1, 0.55, clamp01(0.5 + 0.5 * person_.weight));
  const double down = (-5.0 - p.y) / 11.2;
  if (down < 1.15) {
    // One strap from behind the ear, its front edge the sharper one; its two heads end at the breast bone and on the
    // clavicle.
    const double end = smooth_step(1.10, 0.97, down), split = smooth_step(0.45, 0.95, down);
    const double from = angle - mix(1.78, 0.13, exact_pow(clamp01(down), 0.9));
    const double width = mix(0.24, 0.072, split) * (from < 0 ? 0.75 : 1.25);
    out += lean * end * smooth_step(0.10, 0.45, down) *
           (mix(0.50, 0.66, split) * bump(from, 0, 0, 0, width, 1) +
            0.34 * split * bump(angle, 0, mix(1.5, 0.42, down), 0, 0.13, 1));
    // Larynx and the notch above the breast bone.
    out += (0.26 + 0.16 * person_.sex) * bump(p.x, p.y, 0, -13.1, 0.75, 0.95) -
           0.40 * bump(p.x, p.y, 0, -16.1, 0.50, 0.55);
  }
  p.x += out * sine;
  p.z += out * cosine;
  if (cosine > 0 && p.y < -14) {
    // From the breast bone the clavicles run outwards and a little up, bent to the front near it.
    const double bone = -16.55 + 0.05 * p.x, beside = smooth_step(0.5, 1.2, p.x);
    const double ridge =
        0.42 * beside * smooth_step(8.5, 4.0, p.x) *
        (bump(p.y, 0, bone, 0, 0.50, 1) + 0.15 * bump(p.x, p.y, 1.3, bone, 0.7, 0.55));
    const double hollow = 0.36 * lean * bump(p.x, p.y, 4.6, bone + 1.05, 1.3, 0.70);
    p.z += (ridge - hollow) * smooth_step(0, 0.3, cosine);
    p.y += 0.25 * ridge;
  }
  return p;
}

FacePoint Form::face(double angle, double row, Side side) const {
  const auto [sine, cosine] = exact_sine_cosine(angle);
  const double y = row + collar_rise(row, cosine);
  const Section at = section(y, cosine);
  const double across = exact_pow(std::max(sine, 0.0), 2 / at.exponent);
  const double along = exact_pow(std::abs(cosine), 2 / at.exponent);
  const double front_mask = smooth_step(0, 0.42, cosine);
  Vec3 p;
  p.x = at.half_width * across;
  p.z = cosine > 0 ? kCenterZ + (at.front - kCenterZ) * along
                   : kCenterZ - (kCenterZ - at.back) * along;

  // Rows rise towards the back around the jaw, so that its edge runs up to the ear.
  const auto lift_at = [c = cosine](double at_row) {
    return 2.6 * smooth_step(0.98, -0.05, c) * smooth_step(-0.65, 0.05, c) *
               bump(0, at_row, 0, -10.2, 1, 4.2) -
           0.9 * smooth_step(0.2, -0.9, c) * bump(0, at_row, 0, -9, 1, 3);
  };
  p.y = y + lift_at(y);
  // Rows of the eyes and of the mouth follow the edges of lids and lips.
  const double s = along_eye(p.x);
  p.y += (lid_line(p.x) - kEye.y) * smooth_step(2.4, 0.7, std::abs(y - kEye.y)) *
         smooth_step(2.2, 1.2, std::abs(s)) * front_mask;
  p.y += (mouth_line(p.x) - kMouthY - lift_at(kMouthY)) *
         smooth_step(2.6, 0.9, std::abs(y - kMouthY)) *
         smooth_step(1.9, 1.1, p.x / kMouthHalfWidth) * front_mask;

  const double standing_out = side_relief(p.z, p.y);
  const Vec3 detail = nose_detail(p.x, p.y) * front_mask;
  p.z += front_mask * (relief(p.x, p.y) + lips(p.x, p.y));
  p = p + detail;
  p.x += standing_out * smooth_step(0.35, 0.9, sine);
  p = neck_form(p, angle);
  const Vec3 look = p;
  // Long and short noses, their tips turned up or down; broad and narrow mouths.
  const double base = smooth_step(-0.4, -3.3, y) * smooth_step(-5.5, -4.3, y) *
                      smooth_step(3.6, 2.0, look.x) * front_mask;
  p.y -= base * (person_.nose_drop + person_.tip_drop * bump(look.x, y, 0, -3.0, 1.0, 0.9));
  p.x *= 1 + (person_.mouth_width - 1) * smooth_step(5.4, 2.6, look.x) * front_mask *
                 smooth_step(-4.5, -5.6, look.y) * smooth_step(-8.8, -7.2, look.y);
  // Long and short chins; high and low skulls.
  p.y -= person_.chin_drop * smooth_step(-7.0, -9.9, y) * smooth_step(-16.0, -11.5, y);
  p.y = raised(p.y);
  // The bust is cut along an arch: deep at the breast bone, high at the shoulders.
  p.y += 0.016 * p.x * p.x * smooth_step(-17.5, kBottomY, y);
  // The collar of a shirt.
  const double cloth = 0.20 * smooth_step(-0.10, 0.12, kCollarY - row) *
                       mix(0.7, 1, bump(0, row, 0, kCollarY - 0.35, 1, 0.3));
  p.x += cloth * sine;
  p.z += cloth * cosine;
  // Lids lie on a ball around the eye, and the face runs smoothly into it.
  const double dx = p.x - kEye.x, dy = p.y - kEye.y, from = from_lids(p.x, p.y);
  if (front_mask > 0 && from < 5) {
    const double r = std::sqrt(dx * dx + dy * dy), edge = 0.95 * kLidRadius;
    const double steep = edge / std::sqrt(kLidRadius * kLidRadius - edge * edge);
    double ball = kEye.z + std::sqrt(kLidRadius * kLidRadius - std::min(r * r, edge * edge));
    if (r > edge) ball -= (r - edge) * steep;
    p.z = mix(p.z, smooth_max(p.z, ball, 0.8), front_mask);
    // Above the crease skin hangs from the brow.
    const double above = p.y - lid_line(p.x);
    const double crease = person_.crease * (0.42 + 0.46 * std::max(0.0, 1 - s * s));
    const double hood = smooth_step(1.12, 0.52, above / crease);
    const double inner = smooth_step(-1.22, -0.90, s);
    p.z = mix(p.z, ball,
              front_mask * hood * inner *
                  mix(smooth_step(1.2, 0.7, from), smooth_step(1.5, 0.3, from),
                      smooth_step(0.1, -0.5, dy)));
  }

  FacePoint out;
  out.closed = p;
  out.look = {look.x, look.y, p.z};
  if (std::abs(s) >= 1 || front_mask <= 0) return out;
  // Lids: full turn at the edge, none from the crease on.
  const double line = lid_line(p.x);
  const double edge_z = std::sqrt(
      std::max(0.04, kLidRadius * kLidRadius - dx * dx - (line - kEye.y) * (line - kEye.y)));
  const double at_edge = exact_atan2(line - kEye.y, edge_z);
  const double here = exact_atan2(dy, std::max(p.z - kEye.z, 0.05));
  if (side == Side::kAbove) {
    // The part below the crease turns as a whole; the rest is folded up there.
    const double up = here - at_edge;
    out.lid = upper_opening(p.x) * (1 - smooth_step(0.10, 1.02, up));
    const double fold = 0.10 * bump(up, 0, 0.62 * person_.crease, 0, 0.15, 1) *
                        smooth_step(0.1, 0.4, up) * (1 - s * s);
    out.closed = kEye + (p - kEye) * (1 - fold / kLidRadius);
  } else {
    out.lid = lower_opening(p.x) * (1 - smooth_step(0, 0.75, at_edge - here));
  }
  return out;
}

Form::BrowArch Form::brow_arch(double along) const {
  const double y = 1.94 + person_.brow_height +
                   (0.66 + person_.brow_arch) * exact_sine(kPi * clamp01(along * 0.66 + 0.12)) -
                   0.4 * person_.brow_arch + person_.brow_slope * (along - 0.4) - 0.10 * along;
  const double half = 0.34 * person_.brow * exact_pow(clamp01((1 - along) * 1.9), 0.75) *
                      mix(0.72, 1, smooth_step(0, 0.3, along));
  return {mix(1.22, 5.25, along), y, half + 0.03};
}

// Colors ---------------------------------------------------------------------------------------

Color Form::skin_color(Vec3 p, double row, double lid) const {
  const Color& skin = person_.skin;
  const double x = std::abs(p.x);
  const double in_front = smooth_step(2.5, 5.0, p.z);
  const Color blush = redder(skin, 0.85);
  Color c = skin;
  // Blood shows at cheeks, nose, chin and ears; the forehead is paler.
  const double red =
      0.06 * bump(x, p.y, 4.0, -2.6, 2.2, 1.8) + 0.14 * bump(x, p.y, 0, -3.2, 1.2, 0.8) +
      0.05 * bump(x, p.y, 0, -9.4, 1.6, 0.9) + 0.12 * bump(x, p.y, 3.2, -0.6, 1.6, 0.55) +
      0.10 * bump(x, p.y, 3.2, 1.3, 1.7, 0.7) + 0.12 * bump(x, p.y, 1.3, -3.7, 0.5, 0.5);
  c = mix(c, blush, std::min(red, 0.8) * in_front);
  // Between the hairs of the brows skin is dark with their roots.
  const double along = (x - 1.22) / (5.25 - 1.22);
  if (in_front > 0 && along > -0.1 && along < 1) {
    const BrowArch brow = brow_arch(clamp01(along));
    const double inside = smooth_step(1.25, 0.35, std::abs(p.y - brow.y) / brow.half) *
                          smooth_step(-0.04, 0.18, along) * smooth_step(1.0, 0.75, along);
    c = mix(c, mix(person_.brow_hair, mix(skin, {0, 0, 0}, 0.4), 0.5), 0.65 * inside);
  }
  // Lips.
  if (x < 1.06 * kMouthHalfWidth && p.z > 4) {
    const double d = p.y - mouth_line(p.x);
    const double height = lip_height(x, d > 0 ? 1 : -1);
    // The border is soft, more so below and towards the corners.
    const double soft = mix(d > 0 ? 0.10 : 0.20, 0.16, smooth_step(0.4, 1.0, x / kMouthHalfWidth));
    const double inside = smooth_step(height + 0.05, height - soft, std::abs(d));
    c = mix(c, person_.lip, inside * smooth_step(1.03, 0.93, x / kMouthHalfWidth));
    c = mix(c, mix(person_.lip, {60, 16, 20}, 0.5), 0.7 * inside * bump(0, d, 0, 0, 1, 0.05));
  }
  // Little light comes into the corners of the mouth.
  c = mix(c, mix(skin, {64, 22, 22}, 0.6), 0.60 * bump(x, p.y, 2.48, mouth_line(p.x), 0.17, 0.10));
  // Edges of the upper lids are dark with lashes, which do not reach the inner corner.
  if (lid > 0) {
    const double open = upper_opening(p.x), lashes = smooth_step(-0.92, -0.66, along_eye(p.x));
    c = mix(c, mix(skin, {60, 30, 26}, 0.5),
            open > 0 ? lashes * smooth_step(0.94, 1.0, lid / open) : 0);
  }
  // A shirt.
  const double below = kCollarY - row;
  c = mix(c, mix(person_.shirt, {16, 18, 24}, 0.35 * bump(0, below, 0, 0.55, 1, 0.12)),
          smooth_step(-0.04, 0.10, below));
  return c;
}

}  // namespace mien::head
