// SPDX-License-Identifier: MIT
// Hair: a cap over the skull from the hair line to the crown, sculpted into locks and strands. Styles differ
// in the line, the thickness and the directions of locks; a bob hangs below the skull.
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

struct Style {
  double low, high;       // thickness at the line and above
  double wave;            // the sweep over the forehead from the parting
  double lock, strand;    // how high the ridges of locks and strands are
  double locks, strands;  // how many of them around the head
  double raise_front, raise_temple;
  double hang;  // height that the sides hang down to; 0: they do not hang
};

Style style_of(HairStyle style) {
  switch (style) {
    case HairStyle::kCropped: return {0.18, 0.46, 0.0, 0.02, 0.035, 27, 71, 0.1, 0.2, 0};
    case HairStyle::kCurly: return {0.75, 1.75, 0.0, 0.10, 0.04, 9, 23, -0.2, 0.0, 0};
    case HairStyle::kReceding: return {0.12, 0.42, 0.1, 0.02, 0.03, 25, 71, 1.7, 2.6, 0};
    case HairStyle::kBob: return {0.65, 1.30, 0.7, 0.08, 0.06, 23, 71, 0.0, 0.2, -6.8};
    default: return {0.40, 1.05, 1.0, 0.09, 0.06, 23, 71, 0.0, 0.0, 0};
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

class HairMaker {
 public:
  HairMaker(const Form& form, uint32_t lod, HalfMesh& out)
      : form_(form), lod_(lod), out_(out), style_(style_of(form.person().style)),
        parted_(std::min(style_.wave * 2, 1.0)) {}

  void make() {
    out_.mirrored = false;  // parted on the left
    make_cap();
    if (lod_ < 3 && form_.person().style == HairStyle::kCurly && !out_.failed()) make_strips();
  }

 private:
  static constexpr double kPart = 0.42;   // angle of the parting
  static constexpr double kSkull = -1.0;  // height below which hair hangs

  struct Root {
    Vec3 skin, normal;
    double below;  // how far hair hangs there
  };
  /// The skull at `t` of the way from the hair line, moved by `beyond`, to the crown; `t` below 0 is in front
  /// of the line.
  Root root_at(double around, double t, double beyond) const {
    const double share = std::abs(around) / kPi;
    const double line = hair_line(style_, share) + beyond;
    const double y = t < 0 ? line + 8 * t : mix(line, kCrownY, 1 - exact_pow(1 - t, 1.35));
    const bool hangs = style_.hang < 0;
    Root root;
    root.skin = form_.face(std::abs(around), std::max(y, hangs ? kSkull : y), Side::kAbove).closed;
    root.below = hangs ? std::max(0.0, kSkull - y) : 0.0;
    root.skin.y -= root.below;
    if (around < 0) root.skin.x = -root.skin.x;
    const Vec3 p = root.skin;
    root.normal = unit({p.x / (7.8 * 7.8), (std::max(p.y, kSkull) - 2.5) / (10.2 * 10.2),
                        (p.z + 0.4) / (9.7 * 9.7)});
    return root;
  }

  /// Height of the hair above the skull, without locks.
  double thickness(double around, double t, const Root& root) const {
    const double share = std::abs(around) / kPi, front = smooth_step(0.46, 0.0, share);
    const double wave = wave_at(around);
    double thick = mix(style_.low, style_.high, smooth_step(0.15, 0.8, t));
    thick += 1.05 * wave * bump(t, 0, 0.27, 0, 0.22, 1) +
             0.30 * style_.wave * front * bump(t, 0, 0.28, 0, 0.2, 1);
    // Hanging hair covers the ears and turns in at its end.
    if (root.below > 0) {
      thick += 0.75 * smooth_step(0, 2.5, root.below) - 0.9 * smooth_step(4.6, 6.6, root.below);
    }
    if (style_.hang < 0) thick += 0.8 * bump(share, root.skin.y, 0.52, 0.5, 0.10, 3);
    return thick;
  }
  double wave_at(double around) const {
    return style_.wave * bump(around - kPart, 0, -0.55, 0, 0.75, 1);
  }

  double combed(double around, double t) const;
  double ridges(double around, double count) const;
  void make_cap();
  void make_strips();
  void make_strip(uint32_t number, double from, double to, double start, double end, double wide,
                  double raise);

  const Form& form_;
  const uint32_t lod_;
  HalfMesh& out_;
  const Style style_;
  const double parted_;
};

/// Columns follow the hairs: in front they are combed away from the parting.
double HairMaker::combed(double around, double t) const {
  const double share = std::abs(around) / kPi, away = around - kPart;
  const double left = clamp01(1 - t / 0.85);
  const double sweep = 0.50 * parted_ * smooth_step(0.50, 0.10, share) * left * left;
  return around + sweep * (away < 0 ? -1 : 0.7) * smooth_step(0, 0.6, std::abs(away));
}

/// Round ridges between furrows, `count` of them around the head, of different widths.
double HairMaker::ridges(double around, double count) const {
  const double place = 0.5 + 0.5 * around / kPi;
  const double at = count * place + 0.9 * exact_sine(10 * kPi * place + count) +
                    0.5 * exact_sine(26 * kPi * place + 2 * count);
  const double within = at - std::floor(at);
  return 2 * std::sqrt(std::max(0.0, 4 * within * (1 - within))) - 1;
}

void HairMaker::make_cap() {
  const bool fine = lod_ < 3, curly = form_.person().style == HairStyle::kCurly;
  const uint32_t columns = 2 * (fine ? at_lod(77, 36, lod_) : at_lod(56, 7, lod_)),
                 rows = at_lod(fine ? 30 : 24, 4, lod_) + 1;
  const Color hair = form_.person().hair;
  const bool hangs = style_.hang < 0;
  const uint32_t first = out_.vertices.count();
  for (uint32_t row = 0; row < rows; ++row) {
    // Rows are dense at the hair line.
    const double even = static_cast<double>(row) / rows, t = even * mix(0.55, 1, even);
    for (uint32_t k = 0; k < columns; ++k) {
      const double column = mix(-kPi, kPi, static_cast<double>(k) / columns);
      const double around = combed(column, t);
      const double share = std::abs(around) / kPi, front = smooth_step(0.46, 0.0, share);
      const double from_part = column - kPart;
      // Locks, which part into smaller ones, and hairs, one for each column. All fade at the crown.
      const double fade = smooth_step(1.0, 0.60, t);
      double lock = ridges(column + 0.10 * exact_sine(4 * t + 1), style_.locks);
      double small = ridges(column + 0.04 * exact_sine(9 * t), style_.strands);
      const double single = fine ? scatter(k + 15000) : 0;
      if (curly) {
        lock = exact_sine(11 * around + 3 * exact_sine(9 * t)) * exact_sine(26 * t + 2 * lock);
        small = exact_sine(23 * around + 40 * t);
      }
      // The parting is a furrow from the hair line to near the crown.
      const double parting =
          parted_ * bump(from_part, 0, 0, 0, 0.09, 1) * smooth_step(0.80, 0.40, t);
      // Locks end in points: below the line behind, above the forehead in front.
      const double tips = 0.22 * lock + 0.10 * small + 0.05 * single;
      const double beyond = mix(hangs && share > 0.3 ? -1.6 : -0.7, -1.6, front) * tips *
                                smooth_step(0.20, 0, t) * std::min(1.0, 3 * style_.low) +
                            parted_ * 0.30 * bump(from_part, 0, 0, 0, 0.16, 1);
      Root root = root_at(around, t, beyond);
      const double wave = wave_at(around);
      double thick = thickness(around, t, root);
      thick += (style_.lock * (1 + 0.6 * wave) * lock +
                style_.strand * (1 + 0.6 * wave) * (0.8 * small + 0.4 * single)) *
               fade;
      thick -= 0.42 * parting;
      const double grown = hangs && share > 0.35 ? 1 : smooth_step(0, 0.07 + 0.13 * front, t);
      Vec3 at = root.skin + root.normal * mix(-0.22, thick, grown);
      at.y += 0.55 * wave * bump(t, 0, 0.20, 0, 0.2, 1) * smooth_step(0, 0.1, t);
      // Hanging hair ends in an edge that turns inwards.
      if (hangs && row == 0 && share > 0.33)
        at = at - root.normal * (0.55 * thick) + Vec3{0, 0.25, 0};
      const double depth =
          0.30 * smooth_step(0.3, -1, lock) + 0.28 * smooth_step(0.5, -1, small) - 0.11 * single;
      Color c = mix(hair, {12, 8, 7}, clamp01(depth * fade + 0.12 + 0.45 * parting));
      c = mix(c, mix(hair, {255, 220, 176}, 0.26),
              clamp01(fade * (0.30 * smooth_step(0.2, 1, lock) * smooth_step(-0.2, 1, small) +
                              0.16 * single)));
      // Short hair lets the skin show through where it begins.
      c = mix(c, mix(hair, form_.person().skin, 0.50),
              smooth_step(0.6, 0.15, style_.low) * smooth_step(0.10, 0.0, t));
      c = mix(c, mix(hair, {12, 8, 7}, 0.5), hangs && row == 0 && share > 0.33 ? 1 : 0);
      // Texture coordinates as seen from above, so that no seam is needed.
      const auto [s, cosine] = exact_sine_cosine(column);
      out_.vertices.add(
          plain(at, c, 0.5 + 0.49 * (1 - t) * s, 0.5 - 0.49 * (1 - t) * cosine, Carrier::kSkull));
    }
  }
  const uint32_t crown = out_.vertices.add(
      plain({0, form_.raised(kCrownY) + style_.high, -0.9}, hair, 0.5, 0.5, Carrier::kSkull));
  for (uint32_t k = 0; k < columns; ++k) {
    const uint32_t next = (k + 1) % columns;
    for (uint32_t row = 0; row + 1 < rows; ++row) {
      const uint32_t low = first + row * columns, high = low + columns;
      out_.quad(low + k, low + next, high + next, high + k);
    }
    const uint32_t last = first + (rows - 1) * columns;
    out_.triangle(last + k, last + next, crown);
  }
}

/// A lock as a strip that is bent across, from (`from`, `start`) to (`to`, `end`): angle and `t`.
void HairMaker::make_strip(uint32_t number, double from, double to, double start, double end,
                           double wide, double raise) {
  constexpr uint32_t kMaxSteps = 8;
  const uint32_t steps = lod_ == 0 ? (start - end > 0.3 ? 7 : 4) : lod_ == 1 ? 4 : 3;
  Vec3 path[kMaxSteps + 1], normals[kMaxSteps + 1];
  double bend = 0.5 * scatter(number + 40) * std::abs(start - end);
  for (uint32_t i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    const double around = mix(from, to, 1 - (1 - s) * (1 - s)) + 0.25 * bend * s * (1 - s);
    const double t = mix(start, end, s);
    const Root root = root_at(around, t, 0);
    double high = thickness(around, std::max(t, 0.0), root);
    const double wave = wave_at(around);
    high += (raise + 0.16 * wave) * exact_sine(kPi * clamp01(0.15 + 0.72 * s));
    path[i] = root.skin + root.normal * high;
    path[i].y += 0.55 * wave * bump(t, 0, 0.20, 0, 0.2, 1) * smooth_step(0, 0.1, t);
    normals[i] = root.normal;
  }
  const Color hair = form_.person().hair;
  const double shade = scatter(number + 80);
  const Color light = mix(hair, {255, 222, 180}, 0.16 + 0.08 * shade),
              dark = mix(hair, {14, 9, 8}, 0.24 - 0.10 * shade);
  const auto add = [&](Vec3 at, Color c, double u, double v) {
    return out_.vertices.add(plain(at, c, u, v, Carrier::kSkull));
  };
  uint32_t before[3] = {0, 0, 0};
  for (uint32_t i = 0; i < steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    const Vec3 along = path[i + 1] - path[i > 0 ? i - 1 : 0];
    const Vec3 across = unit(cross(along, normals[i]));
    const double half = wide * mix(0.55, 1, smooth_step(0, 0.35, s)) * smooth_step(1.60, 0.55, s);
    const Vec3 down = normals[i] * (-0.30 * half);
    const Color edge = mix(dark, hair, 0.35 * s), ridge = mix(hair, light, exact_sine(kPi * s));
    const uint32_t here[3] = {add(path[i] - across * half + down, edge, 0.45, s),
                              add(path[i], ridge, 0.5, s),
                              add(path[i] + across * half + down, edge, 0.55, s)};
    for (int k = 0; i > 0 && k < 2; ++k) {
      out_.quad(before[k], before[k + 1], here[k + 1], here[k]);
    }
    std::copy(here, here + 3, before);
  }
  const uint32_t tip = add(path[steps], mix(hair, dark, 0.3), 0.5, 1);
  out_.triangle(before[0], before[1], tip);
  out_.triangle(before[1], before[2], tip);
}

/// Layers of curls, those of the lowest at the hair line, like shingles.
void HairMaker::make_strips() {
  constexpr uint32_t kLayers = 5;
  const double share = lod_ == 0 ? 1 : lod_ == 1 ? 0.7 : 0.5;
  uint32_t number = 0;
  for (uint32_t layer = 0; layer < kLayers; ++layer) {
    const double low = static_cast<double>(layer) / kLayers;
    const uint32_t count = static_cast<uint32_t>(share * 60 * mix(1, 0.40, low));
    for (uint32_t i = 0; i < count; ++i, ++number) {
      const double to = mix(-kPi, kPi, (i + 0.5 + 0.4 * scatter(number)) / count);
      const double end = 0.85 * low + 0.035 + (layer == 0 ? 0.018 : 0.045) * scatter(number + 1000);
      const double start = std::min(end + 0.22 * (1 + 0.25 * scatter(number + 2000)), 0.93);
      if (start - end < 0.06) continue;
      const double from = to + 0.45 * scatter(number + 3000);
      const double raise = 0.30 + 0.15 * scatter(number + 4000) + 0.05 * scatter(number + 6000);
      const double wide =
          0.42 * (1 + 0.3 * scatter(number + 5000)) * mix(1, 0.75, low) / std::sqrt(share);
      make_strip(number, from, to, start, end, wide, raise);
    }
  }
}

}  // namespace

double scalp(const Form& form, double angle, double y) {
  const Style style = style_of(form.person().style);
  if (style.hang < 0 && angle > 0.3 * kPi) return 0;
  return smooth_step(-0.55, 0.55, y - hair_line(style, angle / kPi));
}

void add_hair(const Form& form, uint32_t lod, HalfMesh& out) { HairMaker(form, lod, out).make(); }

}  // namespace mien::head
