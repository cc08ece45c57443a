// SPDX-License-Identifier: MIT
// Hair: a cap over the skull from the hair line to the crown, sculpted into locks and strands. Styles
// differ in the line, in thickness and in how locks run; a bob hangs below the skull.
#include <algorithm>

#include "runtime/author/procedural_head_mesh.h"

namespace mien::head {

using author::clamp01;
using author::exact_pow;
using author::exact_sine;
using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

namespace {

struct Style {
  double low, high;       // thickness at the line and above
  double wave;            // the sweep over the forehead from the parting
  double lock, strand;    // how deep locks and strands are
  double locks, strands;  // how many of them
  double raise_front, raise_temple;
  double hang;  // height that the sides hang down to, 0: they do not
};

Style style_of(HairStyle style) {
  switch (style) {
    case HairStyle::kCropped: return {0.18, 0.42, 0.0, 0.03, 0.035, 9, 5, 0.1, 0.2, 0};
    case HairStyle::kCurly: return {0.75, 1.75, 0.0, 0.10, 0.04, 9, 3, -0.2, 0.0, 0};
    case HairStyle::kReceding: return {0.12, 0.40, 0.1, 0.03, 0.03, 7, 5, 1.7, 2.6, 0};
    case HairStyle::kBob: return {0.70, 1.35, 0.7, 0.09, 0.045, 7, 5, 0.0, 0.2, -6.8};
    default: return {0.45, 1.10, 1.0, 0.10, 0.045, 6, 5, 0.0, 0.0, 0};
  }
}

/// Height of the hair line by angle / pi: forehead, temple, in front of the ear, behind it, nape.
double hair_line(const Style& style, double share) {
  static constexpr double kLine[][2] = {{0.00, 6.9},  {0.10, 6.75}, {0.19, 6.25}, {0.27, 5.2},
                                        {0.34, 4.0},  {0.40, 2.3},  {0.445, 0.7}, {0.475, 0.3},
                                        {0.505, 0.9}, {0.55, 1.9},  {0.60, 1.0},  {0.66, -1.4},
                                        {0.75, -4.2}, {0.88, -5.7}, {1.00, -6.1}};
  int i = 0;
  while (i < 13 && share > kLine[i + 1][0]) ++i;
  const double t = clamp01((share - kLine[i][0]) / (kLine[i + 1][0] - kLine[i][0]));
  double y = mix(kLine[i][1], kLine[i + 1][1], 0.5 * t + 0.5 * t * t * (3 - 2 * t));
  y += style.raise_front * bump(share, 0, 0, 0, 0.16, 1);
  y += style.raise_temple * bump(share, 0, 0.22, 0, 0.09, 1);
  if (style.hang == 0) return y;
  return mix(y, style.hang - 0.8 * smooth_step(0.5, 1, share), smooth_step(0.27, 0.37, share));
}

}  // namespace

void add_hair(const Form& form, uint32_t lod, HalfMesh& out) {
  out.mirrored = false;  // parted on the left
  const uint32_t columns = 2 * at_lod(84, 7, lod), rows = at_lod(38, 4, lod) + 1;
  constexpr double kPart = 0.42;   // angle of the parting
  constexpr double kSkull = -1.0;  // hair hangs from here on
  const Style style = style_of(form.person().style);
  const bool curly = form.person().style == HairStyle::kCurly;
  const double parted = std::min(style.wave * 2, 1.0);
  const Color hair = form.person().hair;
  const uint32_t first = out.vertices.count();
  for (uint32_t row = 0; row < rows; ++row) {
    const double t = static_cast<double>(row) / rows;
    for (uint32_t k = 0; k < columns; ++k) {
      const double around = mix(-kPi, kPi, static_cast<double>(k) / columns);
      const double share = std::abs(around) / kPi, front = smooth_step(0.46, 0.0, share);
      // Locks: round ridges between furrows, swept away from the parting in front, straight behind.
      const double from_part = around - kPart;
      const double sweep = 3.4 * t * front * parted * (from_part < 0 ? 1 : -0.6);
      const double fade = smooth_step(1.0, 0.55, t);  // towards the crown, where all locks meet
      const double phase =
          1.2 * t * t + style.locks * around + 0.9 * exact_sine(2 * around + 0.7) + sweep;
      double lock = 2 * std::sqrt(std::abs(exact_sine(phase))) - 1;
      double fine = exact_sine(style.strands * phase + 1.3 * exact_sine(3 * around));
      if (curly) {
        lock = exact_sine(11 * around + 3 * exact_sine(9 * t)) * exact_sine(26 * t + 2 * lock);
        fine = exact_sine(23 * around + 40 * t);
      }
      // The parting is a furrow from the hair line to near the crown.
      const double parting =
          parted * bump(from_part, 0, 0, 0, 0.10, 1) * smooth_step(0.75, 0.35, t);
      const double line = hair_line(style, share) -
                          front * (1.6 * style.lock * lock + 2.5 * style.strand * fine) +
                          parted * 0.35 * bump(from_part, 0, 0, 0, 0.16, 1) -
                          parted * 0.30 * front * smooth_step(0.3, -0.7, from_part) *
                              smooth_step(-1.6, -0.7, from_part);
      const double y = mix(line, kCrownY, 1 - exact_pow(1 - t, 1.35));
      Vec3 skin =
          form.face(std::abs(around), std::max(y, style.hang < 0 ? kSkull : y), Side::kAbove)
              .closed;
      const double below = style.hang < 0 ? std::max(0.0, kSkull - y) : 0.0;
      skin.y -= below;
      if (around < 0) skin.x = -skin.x;
      const Vec3 normal =
          unit({skin.x / (7.8 * 7.8), (std::max(skin.y, kSkull) - 2.5) / (10.2 * 10.2),
                (skin.z + 0.4) / (9.7 * 9.7)});
      const double wave = style.wave * bump(from_part, 0, -0.55, 0, 0.75, 1);
      double thick = mix(style.low, style.high, smooth_step(0.15, 0.8, t));
      thick += 1.25 * wave * bump(t, 0, 0.22, 0, 0.24, 1) +
               0.35 * style.wave * front * bump(t, 0, 0.25, 0, 0.2, 1);
      thick += (style.lock * (1 + 0.4 * wave) * lock + style.strand * fine) * fade;
      thick -= 0.42 * parting;
      // Hair that hangs covers the ears and turns in at its end.
      if (below > 0)
        thick += 0.75 * smooth_step(0, 2.5, below) - 0.9 * smooth_step(4.6, 6.6, below);
      if (style.hang < 0) thick += 0.8 * bump(share, skin.y, 0.52, 0.5, 0.10, 3);
      const double root =
          style.hang < 0 && share > 0.35 ? 1 : smooth_step(0, 0.10 + 0.05 * front, t);
      Vec3 at = skin + normal * mix(-0.30, thick, root);
      at.y += 0.55 * wave * bump(t, 0, 0.20, 0, 0.2, 1) * smooth_step(0, 0.1, t);
      Color c =
          mix(hair, {14, 9, 8},
              (0.45 * smooth_step(0.1, -0.9, lock) - 0.24 * fine) * fade + 0.22 + 0.3 * parting);
      c = mix(c, mix(hair, {255, 222, 180}, 0.25), 0.40 * fade * smooth_step(0.3, 0.95, lock));
      // Short hair lets the skin through where it begins.
      c = mix(c, mix(hair, form.person().skin, 0.45),
              smooth_step(0.3, 0.15, style.low) * smooth_step(0.12, 0.0, t));
      // Texture coordinates as seen from above, so that no seam is needed.
      const auto [s, cosine] = exact_sine_cosine(around);
      out.vertices.add(
          plain(at, c, 0.5 + 0.49 * (1 - t) * s, 0.5 - 0.49 * (1 - t) * cosine, Carrier::kSkull));
    }
  }
  const uint32_t crown = out.vertices.add(
      plain({0, form.raised(kCrownY) + style.high, -0.9}, hair, 0.5, 0.5, Carrier::kSkull));
  for (uint32_t k = 0; k < columns; ++k) {
    const uint32_t next = (k + 1) % columns;
    for (uint32_t row = 0; row + 1 < rows; ++row) {
      const uint32_t low = first + row * columns, high = low + columns;
      out.quad(low + k, low + next, high + next, high + k);
    }
    const uint32_t last = first + (rows - 1) * columns;
    out.triangle(last + k, last + next, crown);
  }
}

}  // namespace mien::head
