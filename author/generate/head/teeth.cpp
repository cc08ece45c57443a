// SPDX-License-Identifier: MIT
// Teeth with their gums, and the tongue.
#include <algorithm>

#include "author/generate/head/mesh.h"

namespace mien::head {

using author::clamp01;
using author::exact_pow;
using author::exact_sine;
using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

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

constexpr uint32_t kToothCount =
    7;  // from the middle: two incisors, canine, two premolars, two molars

/// Breadth along the arch, height above the gum, depth at the neck and at the edge, and how much the edge is
/// rounded off.
struct Tooth {
  double breadth, height, neck, edge, round;
};
constexpr Tooth kTeeth[2][kToothCount] = {{{0.86, 1.00, 0.22, 0.07, 0.35},
                                           {0.68, 0.92, 0.20, 0.07, 0.50},
                                           {0.76, 1.02, 0.26, 0.09, 0.95},
                                           {0.70, 0.84, 0.30, 0.22, 0.60},
                                           {0.68, 0.80, 0.30, 0.24, 0.50},
                                           {0.98, 0.76, 0.36, 0.33, 0.35},
                                           {0.80, 0.70, 0.34, 0.31, 0.35}},
                                          {{0.54, 0.88, 0.18, 0.06, 0.25},
                                           {0.60, 0.88, 0.19, 0.06, 0.35},
                                           {0.68, 0.96, 0.24, 0.08, 0.90},
                                           {0.70, 0.84, 0.27, 0.20, 0.60},
                                           {0.72, 0.80, 0.28, 0.22, 0.50},
                                           {1.05, 0.74, 0.34, 0.32, 0.35},
                                           {0.86, 0.70, 0.33, 0.31, 0.35}}};

// Necks of teeth in v of the texture, above the gum, and how much teeth take up of it. The upper jaw has the lower half;
// u is 1/2 in the middle of the face.
constexpr double kNeckV = 0.20, kToothV = 0.28;

/// The arch of one jaw: places along it, outwards from it, and from the edges of the teeth to the gum.
struct Arch {
  double half, deep, front, edge_y, sign;  // sign 1: upper jaw
  double total = 0;                        // sum of the breadths

  Vec3 at(double along, double outwards, double up) const {
    const auto [s, c] = exact_sine_cosine(ellipse_angle(half, deep, along / total));
    return {(half + outwards) * s, edge_y + sign * up, front - deep * (1 - c) + outwards * c};
  }
};

/// In the shadow of the cheeks, far back.
Color in_shadow(Color c, double share) {
  return mix(c, {110, 58, 48}, 0.80 * smooth_step(0.40, 1.0, share));
}

/// A tooth: rings around it from the neck, within the gum, to the edge.
void add_tooth(const Arch& arch, const Tooth& tooth, double start, Carrier carrier, double v_at,
               HalfMesh& out) {
  // Height, breadth and lean outwards of the rings.
  static constexpr double kRings[][3] = {{1.18, 0.72, -0.02}, {0.96, 0.88, 0.02},
                                         {0.62, 1.00, 0.05},  {0.28, 1.00, 0.04},
                                         {0.08, 0.95, 0.01},  {0.00, 0.80, 0.00}};
  constexpr uint32_t rings = 6, around = 12;
  const Color white = {240, 231, 211}, neck = {222, 200, 164}, edge = {222, 222, 218};
  const double middle = start + 0.5 * tooth.breadth, share = middle / arch.total;
  uint32_t before = 0;
  for (uint32_t r = 0; r < rings; ++r) {
    const double(&ring)[3] = kRings[r];
    const uint32_t here = out.vertices.count();
    const double depth =
        mix(tooth.edge, tooth.neck, smooth_step(0, 0.9, ring[0])) * (ring[0] == 0 ? 0.7 : 1);
    for (uint32_t k = 0; k < around; ++k) {
      // An outline between an ellipse and a box, with a flat front.
      const auto [s, c] = exact_sine_cosine(2 * kPi * (k + 0.5) / around);
      const double bent =
          1 / exact_pow(exact_pow(std::abs(c), 3) + exact_pow(std::abs(s), 3), 1 / 3.0);
      const double side = c * bent, front = s * bent;
      // The edge is rounded towards both sides, and the neck is an arch in the gum.
      const double up =
          tooth.height * ring[0] + 0.10 * tooth.round * side * side * smooth_step(0.5, 0, ring[0]);
      const double bulge = front > 0 ? 0.05 * (1 - side * side) : 0;
      const Vec3 at = arch.at(middle + 0.485 * tooth.breadth * ring[1] * side,
                              ring[2] + depth * front + bulge - 0.21, up);
      Color color = mix(white, neck, smooth_step(0.55, 1.0, ring[0]));
      color = mix(color, edge, 0.6 * smooth_step(0.30, 0.0, ring[0]));
      color = mix(color, neck, 0.55 * smooth_step(0.70, 1.0, std::abs(side)));
      color = mix(color, {150, 112, 96}, 0.5 * smooth_step(-0.2, -0.9, front));
      const double along = (middle + 0.5 * tooth.breadth * ring[1] * side) / arch.total;
      out.vertices.add(plain(at, in_shadow(color, share), 0.5 + 0.5 * along,
                             v_at + kNeckV + kToothV * clamp01(1 - ring[0] / 1.2), carrier));
    }
    for (uint32_t k = 0; r > 0 && k < around; ++k) {
      const uint32_t next = (k + 1) % around;
      if (arch.sign < 0) {
        out.quad(before + k, here + k, here + next, before + next);
      } else {
        out.quad(before + next, here + next, here + k, before + k);
      }
    }
    before = here;
  }
  // Molars have a hollow crown.
  const double hollow = tooth.edge > 0.15 ? 0.09 : -0.01;
  const uint32_t crown = out.vertices.add(
      plain(arch.at(middle, -0.21, hollow), in_shadow(mix(white, neck, 0.4), share),
            0.5 + 0.5 * share, v_at + kNeckV + kToothV, carrier));
  for (uint32_t k = 0; k < around; ++k) {
    const uint32_t next = (k + 1) % around;
    if (arch.sign < 0) {
      out.triangle(before + k, crown, before + next);
    } else {
      out.triangle(before + next, crown, before + k);
    }
  }
}

/// The gum of one jaw: a ridge that rises between the teeth and is arched over each.
void add_gum(const Arch& arch, const Tooth (&teeth)[kToothCount], Carrier carrier, double v_at,
             HalfMesh& out) {
  // From the front, over the ridge, to the back: height above the edge and place outwards.
  static constexpr double kRows[][2] = {{1.64, -0.30}, {1.34, 0.02},  {1.02, 0.06}, {0.80, -0.02},
                                        {0.74, -0.42}, {1.20, -0.62}, {1.64, -0.72}};
  constexpr uint32_t kRowCount = 7;
  // In the texture, what is in front has most room.
  static constexpr double kRowV[kRowCount] = {0, 0.05, 0.10, 0.135, 0.15, 0.16, 0.17};
  constexpr uint32_t per_tooth = 4, columns = kToothCount * per_tooth + 1;
  const Color gum = {196, 106, 102}, border = {214, 134, 124}, back = {120, 56, 58};
  const uint32_t first = out.vertices.count();
  for (uint32_t row = 0; row < kRowCount; ++row) {
    double start = 0;
    for (uint32_t k = 0; k < columns; ++k) {
      const uint32_t number = std::min(k / per_tooth, kToothCount - 1);
      if (k % per_tooth == 0 && k > 0) start += teeth[k / per_tooth - 1].breadth;
      const double within = static_cast<double>(k % per_tooth) / per_tooth;
      const double along = k + 1 < columns ? start + within * teeth[number].breadth : arch.total;
      const double arched = k + 1 < columns ? exact_sine(kPi * within) : 0;
      const bool ridge = row >= 2 && row <= 4;
      const double up = kRows[row][0] + (ridge ? 0.20 * arched : 0);
      const double root = row == 1 || row == 2 ? 0.05 * arched : 0;  // roots show through
      Vec3 at = arch.at(along, kRows[row][1] + root - 0.02, up);
      if (k == 0) at.x = 0;
      Color color = mix(gum, border, row == 2 || row == 3 ? 0.7 : 0.0);
      color = mix(color, back, row > 4 ? 0.6 : 0);
      color = mix(in_shadow(color, along / arch.total), {92, 34, 36}, k + 1 == columns ? 1 : 0);
      out.vertices.add(
          plain(at, color, 0.5 + 0.5 * along / arch.total, v_at + kRowV[row], carrier));
    }
  }
  for (uint32_t row = 0; row < kRowCount; ++row) {
    const uint32_t next = (row + 1) % kRowCount;
    for (uint32_t k = 0; k + 1 < columns; ++k) {
      const uint32_t a = first + row * columns + k, b = first + next * columns + k;
      if (arch.sign < 0) {
        out.quad(a, a + 1, b + 1, b);
      } else {
        out.quad(b, b + 1, a + 1, a);
      }
    }
  }
  const uint32_t end = first + columns - 1;  // behind the last tooth
  for (uint32_t row = 1; row + 1 < kRowCount; ++row) {
    const uint32_t b = end + row * columns, c = end + (row + 1) * columns;
    if (arch.sign < 0) {
      out.triangle(end, c, b);
    } else {
      out.triangle(end, b, c);
    }
  }
}

}  // namespace

void add_teeth(const Form& form, HalfMesh& out) {
  const Vec3 lips = form.face(0, kMouthY, Side::kBelow).closed;
  for (int lower = 0; lower < 2; ++lower) {
    Arch arch = {lower ? 2.35 : 2.60, lower ? 3.5 : 3.7, lips.z - (lower ? 1.20 : 0.98),
                 kMouthY + (lower ? -0.17 : -0.32), lower ? -1.0 : 1.0};
    for (const Tooth& tooth : kTeeth[lower]) arch.total += tooth.breadth;
    const Carrier carrier = lower ? Carrier::kLowerTeeth : Carrier::kUpperTeeth;
    add_gum(arch, kTeeth[lower], carrier, 0.5 * lower, out);
    double start = 0;
    for (const Tooth& tooth : kTeeth[lower]) {
      add_tooth(arch, tooth, start, carrier, 0.5 * lower, out);
      start += tooth.breadth;
    }
  }
}

void add_tongue(const Form& form, HalfMesh& out) {
  constexpr uint32_t rows = 25, around = 15;
  const double tip_z = form.face(0, kMouthY, Side::kBelow).closed.z - 2.0;
  const uint32_t first = out.vertices.count();
  for (uint32_t row = 0; row < rows; ++row) {
    const double t = static_cast<double>(row) / rows;  // the tip is one vertex
    const double z = mix(2.0, tip_z, t);
    const double y =
        kMouthY - 1.55 + 1.05 * exact_sine(kPi * clamp01(0.12 + 0.62 * t)) * (1 - 0.25 * t);
    // Broad at the back, narrower from the middle on, round at the tip.
    const double end = clamp01((t - 0.52) / 0.48), taper = std::sqrt(1 - 0.985 * end * end * end);
    const double half = mix(1.70, 1.30, smooth_step(0.15, 0.8, t)) * taper;
    const double thick = mix(0.74, 0.25, smooth_step(0.15, 0.9, t)) * std::sqrt(taper);
    for (uint32_t k = 0; k < around; ++k) {
      const auto [s, c] = exact_sine_cosine(kPi * (static_cast<double>(k) / (around - 1) - 0.5));
      // A furrow along the middle, which ends before the tip; sides that curl up a little.
      const double top = std::max(s, 0.0), furrow = bump(c, 0, 0, 0, 0.24, 1) * top;
      const double rise =
          0.13 * bump(c, 0, 0.52, 0, 0.30, 1) * top - 0.06 * furrow * smooth_step(0.05, 0.30, t);
      // Papillae make it uneven, except at the border.
      const double papilla = 0.016 * scatter(row * 64 + k + 7) * top * smooth_step(0.95, 0.7, c);
      Vec3 at = {half * exact_pow(std::max(c, 0.0), 0.88),
                 y + thick * s + papilla + rise * smooth_step(1.0, 0.72, t), z};
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

}  // namespace mien::head
