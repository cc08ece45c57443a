// SPDX-License-Identifier: MIT
// Shells over the skull with a texture of short hairs, thin at the border of the hair and where hair is thin: all of
// short hair, and what shows between locks and curls.
#include <algorithm>

#include "author/generate/head/scalp.h"

namespace mien::head {

using author::clamp01;
using author::kPi;
using author::mix;
using author::smooth_step;

namespace {

/// Columns in half of the head, by share of pi: close where the line turns, at most 3 cm apart, which is half of the
/// texture.
constexpr double kColumns[] = {0,     0.09,  0.18,  0.245, 0.30, 0.345, 0.385, 0.415, 0.438,
                               0.452, 0.466, 0.495, 0.535, 0.58, 0.66,  0.77,  0.885, 1};
constexpr uint32_t kIntervals = sizeof(kColumns) / sizeof(kColumns[0]) - 1;
constexpr uint32_t kMostWide = 3;

/// Angles and texture coordinates of the columns, from behind over the right of the head and its front.
struct Columns {
  double around[2 * kIntervals * kMostWide], u[2 * kIntervals * kMostWide];
  uint32_t count;

  explicit Columns(uint32_t wide) : count(2 * kIntervals * wide) {
    // Back and forth within the texture, which may be mirrored at each column.
    constexpr double kLow = 0.002, kHigh = 0.498, kWide = (kHigh - kLow) / 6.0;
    double at[kIntervals + 1] = {kLow};
    for (uint32_t i = 0; i < kIntervals; ++i) {
      const double step = (kColumns[i + 1] - kColumns[i]) * 26 * kWide;
      at[i + 1] = at[i] + step <= kHigh ? at[i] + step : at[i] - step;
    }
    const uint32_t half = kIntervals * wide;
    for (uint32_t k = 0; k < count; ++k) {
      const uint32_t from_front = k < half ? half - k : k - half, i = from_front / wide;
      const double t = static_cast<double>(from_front % wide) / wide;
      const uint32_t next = std::min(i + 1, kIntervals);
      around[k] = kPi * mix(kColumns[i], kColumns[next], t) * (k < half ? -1 : 1);
      u[k] = mix(at[i], at[next], t);
    }
  }
};

/// Up in every other fold and down in the others, 0 ... 1.
double folded(double at) {
  const double within = at - 2 * std::floor(at / 2);
  return within <= 1 ? within : 2 - within;
}

}  // namespace

void add_shells(const Scalp& scalp, uint32_t lod, HalfMesh& out) {
  const Person& person = scalp.person();
  const HairShape& shape = scalp.shape();
  const Columns columns(lod > 0 ? 1 : shape.shells > 1 ? kMostWide : 2);
  const uint32_t rows = at_lod(14, 5, lod) + 1, wide = columns.count;
  const uint32_t shells = lod < 2 ? shape.shells : 1;
  const bool hangs = shape.hang < 0;
  const double begin = hangs ? 0.01 : -0.05;
  // Of flat faces, which would cut into the skull.
  const double flat = lod < 3 ? 0 : lod == 3 ? (hangs ? 0.3 : 0.05) : 0.15;
  // Below locks there is room for them.
  const bool bare = shape.shells > 1 || lod > 3;
  for (uint32_t shell = 0; shell < shells; ++shell) {
    const double share = bare ? (shell + 1.0) / shells : hangs ? (lod == 0 ? 0.36 : 0.12) : 0.82;
    const uint32_t first = out.vertices.count();
    for (uint32_t row = 0; row < rows; ++row) {
      // Rows are dense at the line; outer shells begin above it.
      const double even = static_cast<double>(row) / (rows - 1);
      const double t = mix(begin + 0.055 * shell, 0.93, even * mix(0.35, 1, even));
      for (uint32_t k = 0; k < wide; ++k) {
        const double ragged = 0.013 * scatter(k + 500) * smooth_step(0.2, 0, t);
        const double at = t + ragged;
        const Scalp::Root root = scalp.root(columns.around[k], at);
        const double body = scalp.body(columns.around[k], at, root) * share *
                            (1 + 0.08 * scatter(row * wide + k + 900));
        const double grown = smooth_step(-0.05, 0.16, t - 0.045 * shell);
        const double dark = 0.30 * (1 - share) + 0.10 * scatter(k * 7 + row);
        Color c = mix(person.hair, {14, 10, 9}, clamp01(dark));
        const double border = hangs ? mix(lod < 4 ? 0.5 : 1, 1, smooth_step(0, 0.05, t))
                                    : smooth_step(-0.04, 0.075, t - 0.045 * shell);
        // Where hair is thinnest it is single cards.
        const double dense =
            clamp01((scalp.density(root.row + 0.7 * scatter(k + 700)) - 0.42) / 0.58);
        // The lower a place of the texture, the fewer hairs, by its square.
        const double full = border * std::sqrt(dense);
        c = mix(c, person.skin, 0.5 * (1 - border * dense));
        Vertex v = scalp.above(root, mix(0.03, body + flat, grown), c);
        v.u = columns.u[k];
        v.v = mix(0.205, 0.40, full) + 0.19 * full * full * folded(5.0 * std::max(0.0, t));
        out.vertices.add(v);
      }
    }
    const Scalp::Root top = scalp.root(0, 1);
    const bool closed = scalp.density(top.row) > 0.5;
    Vertex v = scalp.above(top, shape.high * share + flat, person.hair);
    v.u = 0.25, v.v = 0.5;
    const uint32_t crown = closed ? out.vertices.add(v) : 0;
    for (uint32_t k = 0; k < wide; ++k) {
      const uint32_t next = (k + 1) % wide;
      for (uint32_t row = 0; row + 1 < rows; ++row) {
        const uint32_t low = first + row * wide, high = low + wide;
        out.quad(low + k, low + next, high + next, high + k);
      }
      const uint32_t last = first + (rows - 1) * wide;
      if (closed) out.triangle(last + k, last + next, crown);
    }
  }
}

}  // namespace mien::head
