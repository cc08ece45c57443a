// SPDX-License-Identifier: MIT
// The hair line, and hair of a centimeter: shells over the skull with a texture of short hairs, under curls, too.
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

constexpr double kSkull = -1.0;  // height below which hair hangs

HairShape shape_of(HairStyle style) {
  switch (style) {
    case HairStyle::kCropped: return {0.12, 0.62, 0, 0.1, 0.15, 0};
    case HairStyle::kCurly: return {0.45, 1.30, 0, -0.1, 0.0, 0};
    case HairStyle::kReceding: return {0.08, 0.40, 0, 1.5, 2.3, 0};
    case HairStyle::kBob: return {0.50, 1.20, 0.7, 0.0, 0.1, -6.8};
    default: return {0.30, 1.05, 1.0, 0.0, 0.0, 0};
  }
}

/// Height of the line by share of pi: forehead, temple, sideburn in front of the ear, behind it, nape. `even`: passing
/// the ear by, which the ways of hairs above do.
double line_of(const HairShape& shape, double share, bool even) {
  static constexpr double kLine[][2] = {
      {0.00, 6.9},   {0.10, 6.9},  {0.18, 6.75}, {0.245, 6.35}, {0.30, 5.6},   {0.345, 4.7},
      {0.38, 3.9},   {0.402, 2.8}, {0.42, 1.2},  {0.434, -0.4}, {0.45, -1.25}, {0.483, -1.4},
      {0.498, -0.6}, {0.511, 0.9}, {0.535, 1.8}, {0.57, 0.9},   {0.61, -1.0},  {0.68, -3.2},
      {0.78, -4.8},  {0.90, -5.5}, {1.00, -5.8}};
  static constexpr double kEven[][2] = {{0.00, 6.9},  {0.20, 6.5},  {0.35, 4.5}, {0.50, 1.3},
                                        {0.65, -1.8}, {0.80, -4.6}, {1.00, -5.8}};
  const double(*points)[2] = even ? kEven : kLine;
  const size_t last = (even ? sizeof(kEven) : sizeof(kLine)) / sizeof(kLine[0]) - 2;
  size_t i = 0;
  while (i < last && share > points[i + 1][0]) ++i;
  const double t = clamp01((share - points[i][0]) / (points[i + 1][0] - points[i][0]));
  double y = mix(points[i][1], points[i + 1][1], 0.5 * t + 0.5 * t * t * (3 - 2 * t));
  y += shape.raise_front * bump(share, 0, 0, 0, 0.16, 1);
  y += shape.raise_temple * bump(share, 0, 0.22, 0, 0.09, 1);
  if (shape.hang == 0) return y;
  return mix(y, shape.hang - 0.6 * smooth_step(0.5, 1, share), smooth_step(0.27, 0.37, share));
}

/// Up in every other fold and down in the others, 0 ... 1, over `size` steps each.
double folded(uint32_t at, uint32_t size) {
  const uint32_t within = at % (2 * size);
  return static_cast<double>(within <= size ? within : 2 * size - within) / size;
}

/// Shells of short hairs, the outer ones higher up. The lower half of the tile is thin hair, for the line.
void add_shells(const Scalp& scalp, uint32_t lod, uint32_t count, HalfMesh& out) {
  constexpr uint32_t kFolds = 12;  // of the tile, around the head
  const uint32_t wide = at_lod(9, 2, lod), columns = kFolds * wide;
  const uint32_t rows = at_lod(20, 5, lod) + 1, border = std::max(1u, rows / 5);
  const Person& person = scalp.person();
  const HairShape& shape = scalp.shape();
  for (uint32_t shell = 0; shell < count; ++shell) {
    const double share = (shell + 1.0) / count;
    const uint32_t first = out.vertices.count();
    for (uint32_t row = 0; row < rows; ++row) {
      // Rows are dense at the line; outer shells begin above it.
      const double even = static_cast<double>(row) / rows;
      const double t = mix(-0.05 + 0.055 * shell, 0.97, even * mix(0.45, 1, even));
      for (uint32_t k = 0; k < columns; ++k) {
        const double around = mix(-kPi, kPi, static_cast<double>(k) / columns);
        // The line is not a curve of one stroke.
        const double ragged = 0.018 * scatter(k + 500) * smooth_step(0.2, 0, t);
        const Scalp::Root root = scalp.root(around, t + ragged);
        const double body = mix(shape.low, shape.high, smooth_step(0.05, 0.75, t)) *
                            (1 + 0.10 * scatter(row * columns + k + 900));
        const double grown = smooth_step(-0.05, 0.16, t - 0.045 * shell);
        const double dark = 0.30 * (1 - share) + 0.10 * scatter(k * 7 + row);
        Color c = mix(person.hair, {14, 10, 9}, clamp01(dark));
        c = mix(c, mix(person.hair, person.skin, 0.55), smooth_step(0.10, -0.03, t));
        Vertex v = scalp.above(root, mix(-0.06, body * share, grown), c);
        v.u = mix(0.001, 0.499, folded(k, wide));
        v.v = row <= border ? mix(0.21, 0.40, static_cast<double>(row) / border)
                            : mix(0.40, 0.598, folded(row - border, std::max(1u, rows / 6)));
        out.vertices.add(v);
      }
    }
    Vertex top = scalp.above(scalp.root(0, 1), shape.high * share, person.hair);
    top.u = 0.25, top.v = 0.5;
    const uint32_t crown = out.vertices.add(top);
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
}

}  // namespace

Scalp::Scalp(const Form& form) : form_(form), shape_(shape_of(form.person().style)) {}

Scalp::Root Scalp::root(double around, double t) const {
  const double share = std::abs(around) / kPi;
  const double low =
      mix(line_of(shape_, share, false), line_of(shape_, share, true), smooth_step(0, 0.3, t));
  const double y =
      t < 0 ? low + 8 * t : mix(low, kCrownY, 1 - exact_pow(1 - std::min(t, 1.0), 1.35));
  const bool hangs = shape_.hang < 0;
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

Vertex Scalp::above(const Root& root, double height, Color color) const {
  Vertex v = plain(root.skin + root.normal * height, color, 0, 0, Carrier::kSkull);
  v.normal = root.normal * 1.5;
  return v;
}

void add_short_hair(const Scalp& scalp, uint32_t lod, HalfMesh& out) {
  add_shells(scalp, lod, lod < 2 ? 3 : lod < 4 ? 2 : 1, out);
}

/// Layers of curls over shells, those of the lowest at the hair line, like shingles.
void add_curls(const Scalp& scalp, uint32_t lod, HalfMesh& out) {
  add_shells(scalp, lod, lod < 2 ? 2 : 1, out);
  constexpr uint32_t kLayers = 7;
  const uint32_t all = at_lod(100, 14, lod), steps = lod < 2 ? 5 : lod < 5 ? 4 : 3;
  const double wider = std::sqrt(100.0 / all);
  const Person& person = scalp.person();
  uint32_t number = 0;
  for (uint32_t layer = 0; layer < kLayers; ++layer) {
    const double low = static_cast<double>(layer) / kLayers;
    const uint32_t count = static_cast<uint32_t>(0.62 * all * mix(1, 0.25, low));
    for (uint32_t i = 0; i < count; ++i, ++number) {
      const double around = mix(-kPi, kPi, (i + 0.5 + 0.45 * scatter(number)) / count);
      const double tip = 0.93 * low + 0.01 + (layer == 0 ? 0.02 : 0.06) * scatter(number + 1000);
      const double size = (0.17 + 0.04 * scatter(number + 2000)) * std::sqrt(wider);
      const double turn = 0.16 * scatter(number + 3000) / std::max(0.25, 1 - low);
      const double shade = scatter(number + 4000);
      CardRow rows[kMaxCardRows];
      for (uint32_t k = 0; k < steps; ++k) {
        const double s = static_cast<double>(k) / (steps - 1);
        const double t = std::min(tip + size * (1 - s), 0.98);
        const double bend = 0.05 * exact_sine(5 * s + 3 * shade) / std::max(0.3, 1 - t);
        const double at = around + turn * (1 - s) + bend;
        const Scalp::Root root = scalp.root(at, t);
        const double body = mix(scalp.shape().low, scalp.shape().high, smooth_step(0.05, 0.7, t)) *
                            smooth_step(-0.10, 0.06, t);
        // They bulge, and their tips stand off.
        const double off = 0.10 + 0.35 * exact_sine(kPi * (0.1 + 0.75 * s)) +
                           (0.16 + 0.16 * scatter(number + 5000)) * s;
        const Color c = mix(person.hair, {14, 10, 9}, clamp01(0.40 - 0.30 * s - 0.15 * shade));
        rows[k].middle = scalp.above(root, body * mix(0.7, 1, s) + off, c);
        const Vec3 along = scalp.root(at - 0.02, t).skin - root.skin;
        const Vec3 across = unit(along);
        static constexpr double kWidth[] = {0.55, 0.9, 1, 0.9, 0.45};
        rows[k].half =
            across * ((0.62 + 0.12 * scatter(number + 7000)) * wider * kWidth[k * 4 / (steps - 1)]);
      }
      add_card(rows, steps, curl_lane(number), out);
    }
  }
}

double scalp(const Form& form, double angle, double y) {
  const HairShape shape = shape_of(form.person().style);
  if (shape.hang < 0 && angle > 0.3 * kPi) return 0;
  return smooth_step(-0.45, 0.65, y - line_of(shape, angle / kPi, false));
}

void add_hair(const Form& form, uint32_t lod, HalfMesh& out) {
  out.mirrored = false;  // parted on the left
  const Scalp scalp(form);
  switch (form.person().style) {
    case HairStyle::kCropped:
    case HairStyle::kReceding: add_short_hair(scalp, lod, out); break;
    case HairStyle::kCurly: add_curls(scalp, lod, out); break;
    default: add_long_hair(scalp, lod, out); break;
  }
  if (out.vertices.count() > 0) out.vertices[0].color = form.person().hair;
}

}  // namespace mien::head
