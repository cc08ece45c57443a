// SPDX-License-Identifier: MIT
// Styles of hair, and the line where it begins.
#include <algorithm>

#include "author/generate/head/scalp.h"

namespace mien::head {

using author::clamp01;
using author::exact_pow;
using author::exact_sine;
using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

namespace {

/// Height below which hair hangs: that of the ears, and the back of the head.
double skull_end(double share) { return mix(-1.0, 1.6, smooth_step(0.58, 0.85, share)); }

HairShape shape_of(const Person& person) {
  // Temples of men recede, those of women hardly.
  const double temple = 0.25 + 0.30 * person.sex;
  switch (person.style) {
    case HairStyle::kCropped:
      return {0.10, 0.75, 0.25, 0, temple, 0, 0.9, 2.2, 0.8, 0, 0, 2, 300, false};
    case HairStyle::kCurly:
      return {0.35, 1.35, 0.10, -0.1, temple, 0, 3.0, 4.2, 0.5, 0, 0, 1, 300, true};
    case HairStyle::kReceding:
      return {0.10, 0.22, 0, 0.9, 2.3, 0, 0.9, 2.6, 1, 0, 0.60, 2, 480, false};
    case HairStyle::kBob:
      return {0.12, 1.05, 0.25, 0, 0.6 * temple, -6.8, 30, 30, 0.1, 0.8, 0, 1, 0, false};
    default: return {0.16, 1.10, 0.85, 0, temple, 0, 2.6, 6.0, 0.6, 0.8, 0, 1, 190, false};
  }
}

/// Height of the line by share of pi: forehead, temple, sideburn in front of the ear, behind it, nape. `even`: passing
/// the ear by, which the ways of hairs above do.
double line_of(const HairShape& shape, double share, bool even) {
  static constexpr double kLine[][2] = {
      {0.00, 6.75},  {0.06, 6.85},  {0.13, 6.95}, {0.19, 6.80}, {0.235, 6.35}, {0.275, 5.6},
      {0.315, 4.6},  {0.35, 3.8},   {0.385, 2.9}, {0.408, 1.7}, {0.424, 0.2},  {0.436, -0.9},
      {0.446, -1.3}, {0.455, -0.9}, {0.464, 0.4}, {0.478, 1.6}, {0.505, 2.1},  {0.535, 1.7},
      {0.565, 0.6},  {0.61, -1.0},  {0.68, -3.2}, {0.78, -4.7}, {0.90, -5.4},  {1.00, -5.6}};
  static constexpr double kEven[][2] = {{0.00, 6.9},  {0.20, 6.5},  {0.35, 4.5}, {0.50, 1.3},
                                        {0.65, -1.8}, {0.80, -4.6}, {1.00, -5.8}};
  const double(*points)[2] = even ? kEven : kLine;
  const size_t last = (even ? sizeof(kEven) : sizeof(kLine)) / sizeof(kLine[0]) - 2;
  size_t i = 0;
  while (i < last && share > points[i + 1][0]) ++i;
  const double t = clamp01((share - points[i][0]) / (points[i + 1][0] - points[i][0]));
  double y = mix(points[i][1], points[i + 1][1], 0.5 * t + 0.5 * t * t * (3 - 2 * t));
  y += shape.raise_front * bump(share, 0, 0, 0, 0.15, 1);
  y += shape.raise_temple * bump(share, 0, 0.215, 0, 0.095, 1);
  // Not a curve of one stroke.
  return y + (even ? 0 : 0.08 * exact_sine(41 * share + 1) + 0.05 * exact_sine(97 * share));
}

double density_of(const HairShape& shape, double row) {
  return 1 - shape.thin * smooth_step(0.5, 12.0, row);
}

}  // namespace

Scalp::Scalp(const Form& form) : form_(form), shape_(shape_of(form.person())) {}

double Scalp::line(double around) const { return line_of(shape_, std::abs(around) / kPi, false); }

double Scalp::density(double row) const { return density_of(shape_, row); }

double Scalp::row_of(double around, double t) const {
  const double share = std::abs(around) / kPi;
  double low =
      mix(line_of(shape_, share, false), line_of(shape_, share, true), smooth_step(0, 0.3, t));
  if (shape_.hang < 0) {
    low = mix(low, shape_.hang - 0.6 * smooth_step(0.5, 1, share), smooth_step(0.27, 0.37, share));
  }
  return t < 0 ? low + 8 * t : mix(low, kCrownY, 1 - exact_pow(1 - std::min(t, 1.0), 1.35));
}

double Scalp::share_of(double around, double row) const {
  double low = 0, high = 1;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    (row_of(around, middle) < row ? low : high) = middle;
  }
  return low;
}

Scalp::Root Scalp::root(double around, double t) const {
  const double y = row_of(around, t);
  const bool hangs = shape_.hang < 0;
  Root root;
  root.row = y;
  const double share = std::abs(around) / kPi, end = hangs ? skull_end(share) : -1.0;
  root.skin = form_.face(std::abs(around), hangs ? std::max(y, end) : y, Side::kAbove).closed;
  root.below = hangs ? std::max(0.0, end - y) : 0.0;
  root.skin.y -= root.below;
  if (around < 0) root.skin.x = -root.skin.x;
  const Vec3 p = root.skin;
  root.normal = unit(
      {p.x / (7.8 * 7.8), (std::max(p.y, end) - 2.5) / (10.2 * 10.2), (p.z + 0.4) / (9.7 * 9.7)});
  if (hangs) {
    // The form ends in a small disk at the crown, the ways of hairs at its middle.
    const double crown = smooth_step(0.985, 1, t);
    root.skin.x *= 1 - crown;
    root.skin.z = mix(root.skin.z, -0.9, crown);
    // The hem turns in, to the jaw and more so to the nape.
    const double in =
        mix(0.18, 0.22, smooth_step(0.45, 0.8, share)) * smooth_step(0, 7.0, root.below);
    root.skin.x *= 1 - in;
    root.skin.z -= in * (root.skin.z + 1.5);
  }
  return root;
}

double Scalp::body(double around, double t, const Root& root) const {
  const double share = std::abs(around) / kPi;
  // Low where it begins: not at the hem.
  const double near = smooth_step(0.03, 0.55, t);
  double body = mix(shape_.low, shape_.high,
                    shape_.hang < 0 ? mix(near, 1, smooth_step(0.29, 0.40, share)) : near);
  body += shape_.wave * smooth_step(0.42, 0.08, share) * bump(t, 0, 0.26, 0, 0.22, 1);
  if (shape_.hang < 0) {
    // From above the ears on, where they hold it off, it falls straight. Behind it has volume.
    body += 1.15 * bump(share, 0, 0.55, 0, 0.25, 1) * smooth_step(6.5, -1.0, root.row);
    body += 0.45 * smooth_step(0.5, 0.8, share) * bump(0, root.row, 0, 6.5, 1, 6);
  }
  const auto [sine, cosine] = exact_sine_cosine(around - kParting);
  const double far = 1 - t;
  return body * (1 - shape_.parting * bump(far * sine, 0, 0, 0, 0.06, 1) *
                         smooth_step(-0.05, 0.15, far * cosine));
}

Vertex Scalp::above(const Root& root, double height, Color color) const {
  Vertex v = plain(root.skin + root.normal * height, color, 0, 0, Carrier::kSkull);
  v.normal = root.normal * 1.5;
  return v;
}

double scalp(const Form& form, double angle, double y) {
  const HairShape shape = shape_of(form.person());
  const double share = angle / kPi, near = 0.012;
  // As far from the line as it is across it, not up: it is steep at temples and ears.
  const double slope =
      (line_of(shape, share + near, false) - line_of(shape, share - near, false)) / (2 * near * 26);
  const double above = (y - line_of(shape, share, false)) / std::sqrt(1 + slope * slope);
  return smooth_step(-0.25, 1.1, above) * density_of(shape, y);
}

void add_hair(const Form& form, uint32_t lod, HalfMesh& out) {
  out.mirrored = false;  // parted on the left
  const Scalp scalp(form);
  add_shells(scalp, lod, out);
  // Shells do from afar.
  if (scalp.shape().hang < 0 && lod < 4) add_sheet(scalp, lod, out);
  add_locks(scalp, lod, out);
  if (out.vertices.count() > 0) out.vertices[0].color = form.person().hair;
}

}  // namespace mien::head
