// SPDX-License-Identifier: MIT
// Brows and lashes: single hairs on a darker ground; at coarse LODs only the ground.
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

/// A hair: a strip that ends in a point at its tip, and at its root if it is `fine`.
struct Hair {
  Vertex root, middle, tip;
  Vec3 wide;  // half width at its thickest
  bool fine = false;
};

void add_hair(const Hair& hair, HalfMesh& out) {
  const auto beside = [&out](Vertex v, Vec3 step) {
    v.position = v.position + step;
    v.closed = v.closed + step;
    return out.vertices.add(v);
  };
  if (hair.fine) {
    const uint32_t root = out.vertices.add(hair.root);
    const uint32_t c = beside(hair.middle, hair.wide * -1.0), d = beside(hair.middle, hair.wide);
    out.triangle(root, d, c);
    out.triangle(c, d, out.vertices.add(hair.tip));
    return;
  }
  const uint32_t a = beside(hair.root, hair.wide * -1.0), b = beside(hair.root, hair.wide);
  const uint32_t c = beside(hair.middle, hair.wide * -0.7),
                 d = beside(hair.middle, hair.wide * 0.7);
  out.quad(a, b, d, c);
  out.triangle(c, d, out.vertices.add(hair.tip));
}

}  // namespace

/// A dark line along the edge of the upper lid, and hairs on it.
void add_lashes(const Form& form, uint32_t lod, HalfMesh& out) {
  const uint32_t columns = at_lod(24, 4, lod) + 1;
  const Color dark = mix(form.person().brow_hair, {16, 12, 12}, 0.7);
  /// A vertex on the outside of the lid's edge at `s`, turned up by `lift`.
  const auto place = [&](double s, double radius, double lift, double v_at) {
    const double x = kEye.x + s * kEyeHalfWidth, dx = x - kEye.x;
    const FacePoint edge = form.face(form.angle_of(x, kEye.y), kEye.y, Side::kAbove);
    const double line_y = form.lid_line(x) - kEye.y;
    const double z = std::sqrt(std::max(0.05, kLidRadius * kLidRadius - dx * dx - line_y * line_y));
    const Vec3 at = Vec3{dx, line_y, z};
    Vertex v = plain(turn_lid(kEye + at * (radius / length(at)), lift), dark, 0.5 + 0.5 * s, v_at,
                     Carrier::kSkin);
    v.look = edge.closed;
    v.lid = form.upper_opening(x);
    v.position = turn_lid(v.closed, v.lid);
    return v;
  };
  const auto full_at = [](double s) {
    return smooth_step(-1.02, -0.45, s) * exact_pow(std::max(0.0, 1 - s * s), 0.25) *
           mix(0.55, 1.15, 0.5 + 0.5 * s);
  };
  // A wedge: below, edge, above.
  const double long_hairs = lod > 2 ? 0.20 : 0;
  const uint32_t first = out.vertices.count();
  for (uint32_t row = 0; row < 3; ++row) {
    for (uint32_t k = 0; k < columns; ++k) {
      const double s = mix(-0.96, 0.99, static_cast<double>(k) / (columns - 1));
      const double full = full_at(s);
      const double radius[] = {kLidRadius - 0.05, kLidRadius + (0.035 + long_hairs) * full,
                               kLidRadius - 0.03};
      const double lift[] = {-0.015, (0.02 + 0.3 * long_hairs) * full, 0.03};
      out.vertices.add(place(s, radius[row], lift[row], row / 4.0));
    }
  }
  join_rows(out, first, 3, columns);
  // The back, and both ends.
  for (uint32_t k = 0; k + 1 < columns; ++k) {
    const uint32_t low = first + k, high = first + 2 * columns + k;
    out.quad(high, high + 1, low + 1, low);
  }
  out.triangle(first, first + columns, first + 2 * columns);
  const uint32_t end = first + columns - 1;
  out.triangle(end, end + 2 * columns, end + columns);
  if (lod > 2) return;
  const uint32_t hairs = at_lod(66, 12, lod);
  for (uint32_t i = 0; i < hairs; ++i) {
    const double s = mix(-0.88, 0.985, (i + 0.5 + 0.5 * scatter(i)) / hairs);
    const double full = full_at(s) * (0.80 + 0.30 * scatter(i + 100));
    Hair hair;
    hair.root = place(s, kLidRadius - 0.02, 0.005, 0.6);
    hair.middle = place(s, kLidRadius + 0.24 * full, 0.03 + 0.01 * full, 0.8);
    hair.tip = place(s, kLidRadius + 0.42 * full, 0.16 * full, 1);
    hair.wide = {0.0115, 0, 0};
    const double out_by = full * (0.20 * s + 0.10 * scatter(i + 200));  // they fan out
    const auto lean = [](Vertex& v, double by) {
      v.closed.x += by;
      v.position.x += by;
    };
    lean(hair.middle, 0.45 * out_by);
    lean(hair.tip, out_by);
    add_hair(hair, out);
  }
}

/// Hairs on skin that is a little darker under them.
void add_brow(const Form& form, uint32_t lod, HalfMesh& out) {
  const Color hair_color = form.person().brow_hair, skin = form.person().skin;
  struct Arch {
    double x, y, half;
  };
  const auto arch_at = [&form](double t) {
    const double y = 2.36 + form.person().brow_height +
                     0.66 * exact_sine(kPi * clamp01(t * 0.72 + 0.05)) - 0.10 * t;
    const double half = 0.34 * form.person().brow * exact_pow(clamp01((1 - t) * 1.9), 0.75) *
                        mix(0.72, 1, smooth_step(0, 0.3, t));
    return Arch{mix(1.22, 5.25, t), y, half + 0.03};
  };
  const auto place = [&](double x, double y, double raise, Color color, double u, double v_at) {
    const FacePoint at = form.face(form.angle_of(x, y), y, Side::kAbove);
    const Vec3 out_of_face = unit({at.closed.x * 0.55, 0.8, at.closed.z});
    Vertex v = plain(at.closed + out_of_face * raise, color, u, v_at, Carrier::kSkin);
    v.look = at.closed;
    return v;
  };
  // The ground of the hairs: its border is below the skin, so that it has no visible edge.
  const bool strands = lod < 3;
  const uint32_t columns = at_lod(20, 4, lod) + 1, rows = lod < 5 ? 5 : 3;
  const uint32_t first = out.vertices.count();
  for (uint32_t row = 0; row < rows; ++row) {
    for (uint32_t k = 0; k < columns; ++k) {
      const double t = mix(strands ? 0.02 : 0.0, 1, static_cast<double>(k) / (columns - 1));
      const double across = 2.0 * row / (rows - 1) - 1;
      const Arch at = arch_at(t);
      const double raise =
          strands ? 0.05 * (1 - across * across) - 0.03 : 0.14 * (1 - across * across) - 0.05;
      // The border fades into the skin; less without hairs, because there are few rows.
      const double square = across * across;
      const double fade = std::max(strands ? square * square : square, 1 - clamp01(3 * t));
      const double thin = strands ? mix(0.40 - 0.06 * lod, 1, fade)
                                  : mix(0.24, rows > 3 ? 0.80 : 0.60, fade * fade);
      const Color color = mix(hair_color, skin, thin);
      out.vertices.add(place(at.x, at.y + across * at.half * (strands ? 0.8 : 1), raise, color, t,
                             0.5 + 0.5 * across));
    }
  }
  join_rows(out, first, rows, columns);
  if (!strands) return;
  const uint32_t hairs = lod == 0 ? 270 : lod == 1 ? 125 : 60;
  for (uint32_t i = 0; i < hairs; ++i) {
    // Hairs lean outwards; the inner ones stand up, and those near the tail lie flat.
    const double t = clamp01((i + 0.5) / hairs + 0.02 * scatter(i + 300));
    const double edge = scatter(i);  // dense in the middle
    const double across = 0.85 * edge * mix(0.55, 1, std::abs(edge));
    const Arch at = arch_at(t);
    const double size = (0.36 + 0.15 * scatter(i + 500)) * mix(0.85, 1, smooth_step(0, 0.2, t)) *
                        mix(1, 0.7, smooth_step(0.7, 1, t));
    const double lean =
        mix(0.80, -0.20, smooth_step(-0.05, 0.5, t)) - 0.50 * across + 0.24 * scatter(i + 600);
    const auto [s, c] = exact_sine_cosine(lean);
    const double x = at.x - 0.3 * size * c, y = at.y + across * at.half - 0.3 * size * s;
    const Color color =
        mix(hair_color, mix(skin, {60, 40, 30}, 0.4), 0.40 + 0.26 * scatter(i + 700));
    Hair hair;
    hair.root = place(x, y, 0.0, color, t, 0.5 + 0.4 * across);
    hair.middle =
        place(x + 0.5 * size * c, y + 0.5 * size * s, 0.055, color, t, 0.55 + 0.4 * across);
    hair.tip = place(x + size * c, y + size * (s - 0.15), 0.02, color, t, 0.6 + 0.4 * across);
    const double wide = lod == 0 ? 0.0125 : lod == 1 ? 0.018 : 0.028;
    hair.fine = true;
    hair.wide = {s * wide, -c * wide, 0};
    add_hair(hair, out);
  }
}

}  // namespace mien::head
