// SPDX-License-Identifier: MIT
// Eyeballs, teeth and tongue; functions that all parts share.
#include <algorithm>

#include "author/generate/head/mesh.h"

namespace mien::head {

using author::clamp01;
using author::exact_cosine;
using author::exact_pow;
using author::exact_sine;
using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

void join_rows(HalfMesh& out, uint32_t first, uint32_t rows, uint32_t columns) {
  for (uint32_t row = 0; row + 1 < rows; ++row) {
    for (uint32_t column = 0; column + 1 < columns; ++column) {
      const uint32_t at = first + row * columns + column;
      out.quad(at, at + 1, at + columns + 1, at + columns);
    }
  }
}

uint32_t at_lod(uint32_t full, uint32_t least, uint32_t lod) {
  static constexpr double kShare[kLodCount] = {1, 0.7, 0.5, 0.38, 0.27, 0.2, 0.15, 0.1};
  return std::max(least, static_cast<uint32_t>(full * kShare[lod] + 0.5));
}

double scatter(uint32_t i) {
  uint32_t h = i * 2654435761u;
  h = (h ^ h >> 15) * 2246822519u;
  return static_cast<double>((h ^ h >> 13) >> 8) * (2.0 / 16777216) - 1;
}

Vertex plain(Vec3 position, Color color, double u, double v, Carrier carrier) {
  Vertex out;
  out.position = out.closed = out.look = position;
  out.color = color;
  out.u = u;
  out.v = v;
  out.carrier = carrier;
  return out;
}

// Eyes ------------------------------------------------------------------------------------------

void add_eyeball(const Form& form, uint32_t lod, HalfMesh& out) {
  // Angle from the middle of the pupil.
  static constexpr double kFine[] = {0.08, 0.155, 0.172, 0.25, 0.33, 0.39, 0.425, 0.465,
                                     0.55, 0.70,  0.90,  1.2,  1.5,  1.9,  2.3,   2.7};
  static constexpr double kPlain[] = {0.155, 0.18, 0.40, 0.465, 0.9, 1.5, 2.2};
  const bool fine = lod < 3;
  const double* angles = fine ? kFine : kPlain;
  const uint32_t rings = fine ? 16 : 7, around = at_lod(48, 8, lod);
  out.mirrored = false;
  // The flat faces of coarse lids would cut into a ball that fits round lids.
  static constexpr double kShrunk[kLodCount] = {1, 1, 1, 0.995, 0.985, 0.97, 0.955, 0.94};
  const double radius = kEyeRadius * kShrunk[lod];
  const Color iris = form.person().iris;
  const auto color = [&](double angle, uint32_t k) -> Color {
    const Color pupil = {14, 12, 14}, white = {206, 199, 192};
    if (angle < 0.16) return pupil;
    const double high = 0.5 + 0.5 * exact_sine(2 * kPi * k / around);  // 1 above the pupil
    if (angle < 0.44) {
      // Darker above, in the shadow of the lid and of the limbus, lighter below, where the cornea gathers light;
      // a ring of another shade around the pupil; streaks.
      const double streak = 0.07 * exact_sine(2.0 * kPi * 13 * k / around) +
                            0.05 * exact_sine(2.0 * kPi * 7 * k / around + 5 * angle);
      Color c = mix(iris, {206, 186, 140}, clamp01(0.30 * (1 - high) + streak));
      c = mix(c, {110, 74, 40}, 0.40 * smooth_step(0.27, 0.17, angle));
      c = mix(c, {14, 14, 18}, 0.62 * high * high);
      return mix(c, {20, 21, 26}, 0.80 * smooth_step(0.32, 0.43, angle));
    }
    // The limbus is soft; the white is shaded by the upper lid and pink towards the corners.
    Color c = mix(white, mix(iris, {60, 58, 62}, 0.6), 0.55 * smooth_step(0.56, 0.44, angle));
    c = mix(c, {120, 92, 84}, 0.42 * smooth_step(0.55, 1.0, high));
    return mix(c, {196, 126, 116}, 0.75 * smooth_step(0.62, 1.15, angle));
  };
  // The cornea stands out beyond the ball, from the limbus on, as far as the lids leave room.
  const auto bulge = [lod](double angle) {
    return lod < 2 ? 0.06 * smooth_step(0.50, 0.05, angle) : 0.0;
  };
  const uint32_t front = out.vertices.add(
      plain(kEye + Vec3{0, 0, radius + bulge(0)}, {14, 12, 14}, 0.5, 0.5, Carrier::kEyeball));
  uint32_t before = front;
  for (uint32_t r = 0; r < rings; ++r) {
    const auto [s, c] = exact_sine_cosine(angles[r]);
    const uint32_t here = out.vertices.count();
    for (uint32_t k = 0; k < around; ++k) {
      const auto [sk, ck] = exact_sine_cosine(2 * kPi * k / around);
      const Vec3 at = kEye + Vec3{ck * s, sk * s, c} * (radius + bulge(angles[r]));
      const double wide = 0.5 * angles[r] / kPi;
      out.vertices.add(
          plain(at, color(angles[r], k), 0.5 + wide * ck, 0.5 + wide * sk, Carrier::kEyeball));
    }
    for (uint32_t k = 0; k < around; ++k) {
      const uint32_t next = (k + 1) % around;
      if (r == 0) {
        out.triangle(front, here + k, here + next);
      } else {
        out.quad(before + k, here + k, here + next, before + next);
      }
    }
    before = here;
  }
  const uint32_t pole = out.vertices.add(
      plain(kEye + Vec3{0, 0, -radius}, {214, 150, 140}, 0.5, 0.99, Carrier::kEyeball));
  for (uint32_t k = 0; k < around; ++k) out.triangle(before + (k + 1) % around, before + k, pole);
}

// Mouth -----------------------------------------------------------------------------------------

namespace {

/// Angle on an ellipse with these half axes, at a share 0 ... 1 of the length of its quarter.
double ellipse_angle(double a, double b, double share) {
  constexpr int kSteps = 64;
  double lengths[kSteps + 1] = {0};
  for (int i = 0; i < kSteps; ++i) {
    const auto [s, c] = exact_sine_cosine(kPi / 2 * (i + 0.5) / kSteps);
    lengths[i + 1] = lengths[i] + std::sqrt(a * a * c * c + b * b * s * s);
  }
  int i = 0;
  while (i < kSteps - 1 && lengths[i + 1] < share * lengths[kSteps]) ++i;
  const double t = (share * lengths[kSteps] - lengths[i]) / (lengths[i + 1] - lengths[i]);
  return kPi / 2 * (i + t) / kSteps;
}

}  // namespace

void add_teeth(const Form& form, uint32_t lod, HalfMesh& out) {
  // From the middle: two incisors, canine, two premolars, two molars.
  static constexpr double kWidths[2][7] = {{0.86, 0.66, 0.76, 0.70, 0.68, 0.96, 0.70},
                                           {0.54, 0.60, 0.68, 0.70, 0.72, 1.05, 0.70}};
  // Height from the edge of the lips, offset from the arc; gum, tooth, edge, back.
  static constexpr double kRows[][2] = {{1.55, -0.16}, {1.15, 0.05}, {0.80, 0.085},  {0.75, 0.02},
                                        {0.42, 0.09},  {0.02, 0.08}, {-0.13, -0.01}, {-0.10, -0.20},
                                        {0.60, -0.38}, {1.55, -0.50}};
  constexpr uint32_t kRowCount = 10;
  // Columns of a tooth are close together at the gaps: its face is flat.
  static constexpr double kSix[] = {0, 0.06, 0.22, 0.5, 0.78, 0.94}, kFour[] = {0, 0.12, 0.5, 0.88},
                          kTwo[] = {0, 0.5};
  const uint32_t per_tooth = lod == 0 ? 6 : lod < 3 ? 4 : lod < 5 ? 2 : 1;
  const double* columns_at = lod == 0 ? kSix : lod < 3 ? kFour : kTwo;
  const uint32_t columns = 7 * per_tooth + 1;

  const Vec3 lips = form.face(0, kMouthY, Side::kBelow).closed;
  const Color white = {244, 236, 218}, gum = {200, 108, 102}, gap = {204, 170, 140};
  for (int lower = 0; lower < 2; ++lower) {
    double total = 0;
    for (double w : kWidths[lower]) total += w;
    const double sign = lower ? -1 : 1;
    const double front = lips.z - (lower ? 1.20 : 0.98), half = lower ? 2.35 : 2.60;
    const double deep = lower ? 3.5 : 3.7;
    const double base = kMouthY - (lower ? 0.30 : 0.19);
    const uint32_t first = out.vertices.count();
    for (uint32_t row = 0; row < kRowCount; ++row) {
      double start = 0;
      for (uint32_t k = 0; k < columns; ++k) {
        const uint32_t tooth = std::min(k / per_tooth, 6u);
        if (k % per_tooth == 0 && k > 0) start += kWidths[lower][k / per_tooth - 1];
        const double within = columns_at[k % per_tooth];
        const double share =
            (start + (k < columns - 1 ? within * kWidths[lower][tooth] : 0)) / total;
        // 0 at the gap between two teeth, 1 in the middle of one.
        const double middle = k == 0 || k == columns - 1 ? 0.0 : exact_sine(kPi * within);
        const double round = per_tooth > 1 ? exact_pow(middle, 0.4) : 1;
        const auto [s, c] = exact_sine_cosine(ellipse_angle(half, deep, share));
        double y = kRows[row][0], offset = kRows[row][1];
        // Gums end in arches, with points between the teeth.
        if (row == 2 || row == 3) y += 0.17 * (round - 0.75);
        if (row >= 3 && row <= 6) offset -= (row == 4 ? 0.06 : 0.09) * (1 - round);
        if (row == 5 || row == 6) y += 0.06 * (1 - round);
        if (tooth == 2 && row >= 5 && row <= 7) y -= 0.05 * middle;
        if (tooth == 1 && !lower && row >= 5 && row <= 7) y += 0.05;
        if (share > 0.60 && row >= 5 && row <= 7) y += 0.08;
        Vec3 at = {(half + offset) * s, base + sign * y, front - deep * (1 - c) + offset * c};
        if (k == 0) at.x = 0;
        Color color = row <= 2 || row == 9 ? gum : white;
        if (row == 2) color = mix(gum, {214, 134, 122}, 0.6);
        if (row >= 3 && row <= 5) color = mix(gap, color, 0.30 + 0.70 * round);
        color = mix(color, {84, 38, 36}, 0.90 * smooth_step(0.35, 0.95, share));
        if (k == columns - 1) color = {92, 34, 36};  // its end is dark
        out.vertices.add(plain(at, color, share, (row + 10 * lower) / 20.0,
                               lower ? Carrier::kLowerTeeth : Carrier::kUpperTeeth));
      }
    }
    for (uint32_t row = 0; row < kRowCount; ++row) {
      const uint32_t next = (row + 1) % kRowCount;
      for (uint32_t k = 0; k + 1 < columns; ++k) {
        const uint32_t a = first + row * columns + k, b = first + next * columns + k;
        if (lower) {
          out.quad(a, a + 1, b + 1, b);
        } else {
          out.quad(b, b + 1, a + 1, a);
        }
      }
    }
    // The end of the last tooth.
    const uint32_t end = first + columns - 1;
    for (uint32_t row = 1; row + 2 < kRowCount; ++row) {
      const uint32_t a = end, b = end + row * columns, c = end + (row + 1) * columns;
      if (lower) {
        out.triangle(a, c, b);
      } else {
        out.triangle(a, b, c);
      }
    }
  }
}

void add_tongue(const Form& form, uint32_t lod, HalfMesh& out) {
  const uint32_t rows = at_lod(24, 4, lod) + 1, around = at_lod(14, 3, lod) + 1;
  const double tip_z = form.face(0, kMouthY, Side::kBelow).closed.z - 2.0;
  const uint32_t first = out.vertices.count();
  for (uint32_t row = 0; row < rows; ++row) {
    const double t = static_cast<double>(row) / rows;  // the tip is one vertex
    const double z = mix(2.0, tip_z, t);
    const double y =
        kMouthY - 1.55 + 1.05 * exact_sine(kPi * clamp01(0.12 + 0.62 * t)) * (1 - 0.25 * t);
    // Broad at the back, narrower from the middle on, round at the tip.
    const double end = clamp01((t - 0.70) / 0.30), taper = std::sqrt(1 - 0.98 * end * end);
    const double half = mix(1.66, 1.30, smooth_step(0.2, 0.9, t)) * taper;
    const double thick = 0.52 * mix(1.25, 0.62, t) * std::sqrt(taper);
    for (uint32_t k = 0; k < around; ++k) {
      const auto [s, c] = exact_sine_cosine(kPi * (static_cast<double>(k) / (around - 1) - 0.5));
      // A furrow along the middle, which ends before the tip; sides that curl up a little.
      const double top = std::max(s, 0.0), furrow = bump(c, 0, 0, 0, 0.30, 1) * top;
      const double rise = 0.16 * bump(c, 0, 0.86, 0, 0.22, 1) * top - 0.20 * furrow;
      Vec3 at = {half * exact_pow(std::max(c, 0.0), 0.7),
                 y + thick * s + rise * smooth_step(0.98, 0.60, t), z};
      if (k == 0 || k == around - 1) at.x = 0;
      // Papillae: pale and uneven above, smooth and redder at the border and below.
      Color color = mix({198, 96, 98}, {120, 44, 50}, 0.8 * (1 - t));
      const double grain = 0.5 + 0.5 * scatter(row * 64 + k);
      color = mix(color, {226, 152, 144}, (0.12 + 0.30 * grain) * top * smooth_step(0.15, 0.5, t));
      color = mix(color, {150, 58, 66}, 0.45 * furrow + 0.25 * std::max(-s, 0.0));
      Vertex v = plain(at, color, 0.5 + 0.5 * k / (around - 1.0), t, Carrier::kTongue);
      v.along = t;
      out.vertices.add(v);
    }
  }
  join_rows(out, first, rows, around);
  Vertex tip = plain({0, kMouthY - 1.55 + 1.05 * exact_sine(kPi * 0.74) * 0.75, tip_z},
                     {196, 92, 96}, 0.5, 1, Carrier::kTongue);
  tip.along = 1;
  const uint32_t front = out.vertices.add(tip);
  for (uint32_t k = 0; k + 1 < around; ++k) {
    const uint32_t at = first + (rows - 1) * around + k;
    out.triangle(at, at + 1, front);
    if (k > 0) out.triangle(first, first + k + 1, first + k);
  }
}

// Together --------------------------------------------------------------------------------------

void set_normals(HalfMesh& mesh) {
  for (const Face& f : mesh.faces.span()) {
    // Area-weighted, from the diagonals of a quad.
    const auto at = [&](int i) { return mesh.vertices[f.corners[i]].position; };
    const Vec3 a = f.count == 4 ? at(2) - at(0) : at(1) - at(0);
    const Vec3 b = f.count == 4 ? at(3) - at(1) : at(2) - at(0);
    const Vec3 n = cross(a, b);
    for (uint32_t i = 0; i < f.count; ++i) {
      Vertex& v = mesh.vertices[f.corners[i]];
      v.normal = v.normal + n;
    }
  }
  for (uint32_t i = 0; i < mesh.vertices.count(); ++i) {
    Vertex& v = mesh.vertices[i];
    if (mesh.on_plane(i)) v.normal.x = 0;
    v.normal = length(v.normal) > 0 ? unit(v.normal) : Vec3{0, 1, 0};
  }
}

bool make_part(const Form& form, Part part, uint32_t lod, HalfMesh& out) {
  switch (part) {
    case Part::kHead: add_skin(form, lod, out); break;
    case Part::kTeeth: add_teeth(form, lod, out); break;
    case Part::kTongue: add_tongue(form, lod, out); break;
    case Part::kEyeLeft:
    case Part::kEyeRight: add_eyeball(form, lod, out); break;
    case Part::kHair: add_hair(form, lod, out); break;
    case Part::kBrows: add_brow(form, lod, out); break;
    case Part::kLashes: add_lashes(form, lod, out); break;
  }
  if (out.failed()) return false;
  set_normals(out);
  for (Vertex& v : out.vertices.span()) v.above_mouth = v.look.y - form.mouth_line(v.look.x);
  return true;
}

}  // namespace mien::head
