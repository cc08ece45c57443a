// SPDX-License-Identifier: MIT
// Long hair, combed from a parting to both sides: a sheet on each side under layers of locks. Hairs run along the
// sheets: f tells where on the parting one begins, 0 at the forehead, 1 at the crown, and s how far along it a place is.
//
//     parting  f=1 --------- s --------> nape
//        |     f=0.5 ------------------> behind the ear
//     forehead f=0 --------------------> along the hair line to the sideburn
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

constexpr double kPart = 0.42;  // angle of the parting

class LockMaker {
 public:
  LockMaker(const Scalp& scalp, uint32_t lod, HalfMesh& out)
      : scalp_(scalp), shape_(scalp.shape()), lod_(lod), out_(out), hangs_(shape_.hang < 0),
        hair_(scalp.person().hair) {}

  void make() {
    for (const double side : {1.0, -1.0}) {
      add_sheet(side);
      add_layers(side);
    }
    add_baby_hairs();
  }

 private:
  struct Place {
    double around, t;
  };
  Place place(double side, double f, double s) const;
  double height(const Place& at, const Scalp::Root& root, double f, double s) const;
  /// On the outside of the sheet, `raise` above it.
  Vertex vertex(double side, double f, double s, double raise, Color color) const {
    const Place at = place(side, f, s);
    const Scalp::Root root = scalp_.root(at.around, at.t);
    return scalp_.above(root, height(at, root, f, s) + raise, color);
  }
  /// The same on all layers, so that without a texture they are one body with locks.
  Color shaded(double f, double s) const {
    const double lock = exact_sine(46 * f + 4 * s) + 0.5 * exact_sine(101 * f - 3 * s);
    return mix(hair_, {14, 10, 9}, clamp01(0.16 + 0.07 * lock + 0.26 * smooth_step(0.15, 0, s)));
  }
  void add_sheet(double side);
  void add_layers(double side);
  void add_baby_hairs();

  const Scalp& scalp_;
  const HairShape& shape_;
  const uint32_t lod_;
  HalfMesh& out_;
  const bool hangs_;
  const Color hair_;
};

/// Seen from above the crown, with 1 - t as the distance from it: hairs of the forehead run around it along the line,
/// those of the crown straight away from it.
LockMaker::Place LockMaker::place(double side, double f, double s) const {
  const double inner = clamp01(f), left = 1 - s;
  const double front = hangs_ ? 0.375 : 0.455;  // where the first hairs end, of pi
  const double end = side * kPi * mix(front, 1.0, exact_pow(inner, 0.8));
  const double from = 1 - (f < 0 ? f : 0.97 * inner);
  const double turned = hangs_ ? 1 - left * std::abs(left) : s;
  const double arc_angle = mix(kPart, end, turned), arc_far = mix(from, 1, s);
  const auto [sine, cosine] = exact_sine_cosine(arc_angle);
  const auto [start_x, start_z] = exact_sine_cosine(kPart);
  const auto [end_x, end_z] = exact_sine_cosine(end);
  const double straight = smooth_step(0.05, 0.75, inner);
  const double x = mix(arc_far * sine, mix(from * start_x, end_x, s), straight);
  const double z = mix(arc_far * cosine, mix(from * start_z, end_z, s), straight);
  const double far = std::sqrt(x * x + z * z);
  // Hairs of the forehead lie above the line for most of their way.
  const double lift = 0.05 * exact_sine(kPi * clamp01(s)) * (1 - inner);
  return {author::exact_atan2(x, z), std::min(1 - far + lift, 0.99)};
}

double LockMaker::height(const Place& at, const Scalp::Root& root, double f, double s) const {
  const double share = std::abs(at.around) / kPi;
  double body = mix(shape_.low, shape_.high, smooth_step(0.05, 0.6, at.t));
  // A wave over the forehead.
  const double front = smooth_step(0.42, 0.05, share);
  body += 0.75 * shape_.sweep * front * bump(f, s, 0.20, 0.30, 0.20, 0.30);
  if (root.below > 0) {
    body += 0.65 * smooth_step(0, 2.5, root.below) - 0.75 * smooth_step(4.2, 6.4, root.below);
  }
  if (hangs_) body += 0.8 * bump(share, root.skin.y, 0.52, 0.5, 0.10, 3);
  // Flat at the parting, at the hair line and, unless it hangs, where it ends.
  body *= mix(0.10, 1, smooth_step(-0.02, 0.16, s));
  const double inside = hangs_ ? smooth_step(-0.02, 0.10, f + 0.25 * smooth_step(0.3, 0.6, s))
                               : smooth_step(-0.02, 0.13, f);
  body = mix(-0.05, body, inside);
  return hangs_ ? body : mix(body, 0.10 * inside, smooth_step(0.70, 1.0, s));
}

void LockMaker::add_sheet(double side) {
  const uint32_t rows = at_lod(15, 6, lod_) + 1, columns = at_lod(16, 8, lod_) + 1;
  const uint32_t first = out_.vertices.count();
  const HairLane lane = dense_lane();
  for (uint32_t row = 0; row < rows; ++row) {
    const double even = static_cast<double>(row) / (rows - 1),
                 f = mix(lod_ < 5 ? 0.045 : 0.0, 1, even * mix(0.7, 1, even));
    for (uint32_t k = 0; k < columns; ++k) {
      const double s = (hangs_ ? 0.96 : 0.92) * k / (columns - 1);
      Vertex v = vertex(side, f, s, -0.04, shaded(f, s));
      if (row == 0) v.color = mix(hair_, scalp_.person().skin, 0.4);
      v.u = row % 2 == 0 ? lane.left : lane.right;
      v.v = mix(lane.root, lane.tip, static_cast<double>(k) / (columns - 1));
      out_.vertices.add(v);
    }
  }
  // Rows go up; on the left of the head, columns go to the right as seen from outside.
  for (uint32_t row = 0; row + 1 < rows; ++row) {
    for (uint32_t k = 0; k + 1 < columns; ++k) {
      const uint32_t at = first + row * columns + k, above = at + columns;
      side > 0 ? out_.quad(at, at + 1, above + 1, above) : out_.quad(at, above, above + 1, at + 1);
    }
  }
}

/// Locks over the sheet, down to LOD 4. Those of outer layers begin farther from the parting.
void LockMaker::add_layers(double side) {
  const uint32_t layers = lod_ < 3 ? 3 : lod_ < 5 ? 2 : 0, count = at_lod(22, 5, lod_);
  const uint32_t steps = lod_ == 0 ? 9 : lod_ < 3 ? 7 : 5;
  const double spacing = 1.0 / count;
  uint32_t number = side > 0 ? 0 : 5000;
  for (uint32_t layer = 0; layer < layers; ++layer) {
    for (uint32_t i = 0; i < count; ++i, ++number) {
      const double f = (i + 0.5 + 0.42 * scatter(number)) * spacing;
      const double begin = layer == 0   ? 0.0
                           : layer == 1 ? 0.16 + 0.14 * scatter(number + 100)
                                        : 0.42 + 0.16 * scatter(number + 200);
      const double end = 1.0 + (hangs_ ? 0.10 : 0.07) * scatter(number + 300);
      const double drift = 0.6 * spacing * scatter(number + 400);
      const double raise = 0.05 + 0.055 * layer + 0.05 * scatter(number + 500);
      const double shade = scatter(number + 600),
                   wide = spacing * (0.80 + 0.15 * scatter(number + 700));
      CardRow rows[kMaxCardRows];
      for (uint32_t k = 0; k < steps; ++k) {
        const double along = static_cast<double>(k) / (steps - 1), s = mix(begin, end, along);
        const double at = std::min(f + drift * along * (1 - along) * 2, 1.03);
        const double width = wide * mix(0.7, 1, smooth_step(0, 0.25, along)) *
                             mix(1, 0.55, smooth_step(0.6, 1, along));
        // Out from under the layer below, over it, and back to it.
        const double up = raise * smooth_step(0, 0.2, along) - 0.03 * smooth_step(0.15, 0, along) +
                          0.05 * exact_sine(9 * along + 5 * shade) * smooth_step(0, 0.3, along);
        const Color c = shaded(at, s);
        const Vertex low = vertex(side, at - width, s, up, c),
                     high = vertex(side, at + width, s, up, c);
        rows[k].middle = vertex(side, at, s, up, c);
        rows[k].middle.position = (low.position + high.position) * 0.5;
        rows[k].middle.closed = rows[k].middle.look = rows[k].middle.position;
        // As seen with the tip above, the crown is on the left of the locks on the left of the head.
        rows[k].half = (high.position - low.position) * (side > 0 ? -0.5 : 0.5);
      }
      add_card(rows, steps, layer == 2 && i % 3 == 0 ? short_lock_lane() : lock_lane(number), out_);
    }
  }
}

/// Thin hairs from the hair line of the forehead and the temples, so that it is not an edge.
void LockMaker::add_baby_hairs() {
  const uint32_t count = at_lod(72, 9, lod_), steps = 3;
  const double reach = hangs_ ? 0.29 : 0.45;
  for (uint32_t i = 0; i < count; ++i) {
    const double around = kPi * reach * (2 * (i + 0.5 + 0.4 * scatter(i + 40)) / count - 1);
    const double side = around > kPart ? 1 : -1;
    const double shade = scatter(i + 50), size = 0.13 + 0.05 * scatter(i + 60);
    // Up and away from the parting; in the temples backwards.
    const double away = side * (0.14 + 0.06 * scatter(i + 70));
    CardRow rows[3];
    for (uint32_t k = 0; k < steps; ++k) {
      const double s = k / 2.0;
      const double t = -0.02 + 0.014 * scatter(i + 80) + size * (0.75 * s + 0.25 * s * s);
      const Scalp::Root root = scalp_.root(around + away * s * s, t);
      const Color c = mix(hair_, scalp_.person().skin, 0.75 - 0.65 * s + 0.1 * shade);
      rows[k].middle = scalp_.above(root, 0.015 + (0.16 + 0.07 * shade) * s, c);
      const Vec3 across = scalp_.root(around + away * s * s + 0.02, t).skin - root.skin;
      rows[k].half =
          unit(across) * (0.34 * mix(0.8, 1, s) * 72.0 / count * mix(0.6, 1, count / 72.0));
    }
    add_card(rows, steps, thin_lane(), out_);
  }
}

}  // namespace

void add_long_hair(const Scalp& scalp, uint32_t lod, HalfMesh& out) {
  LockMaker(scalp, lod, out).make();
}

}  // namespace mien::head
