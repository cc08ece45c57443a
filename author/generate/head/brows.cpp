// SPDX-License-Identifier: MIT
// Brows and lashes: cards of a few hairs each. The first vertex of a mesh has the plain color of its hairs.
#include <algorithm>

#include "author/generate/head/cards.h"

namespace mien::head {

using author::clamp01;
using author::exact_pow;
using author::exact_sine;
using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

namespace {

/// A place beyond the edge of a lid: `s` -1 at the inner corner, 1 at the outer one; turned up by `lift`.
Vertex beside_lid(const Form& form, Side side, double s, double radius, double lift) {
  const double x = kEye.x + s * form.eye_half_width(), dx = x - kEye.x;
  const FacePoint edge = form.face(form.angle_of(x, kEye.y), kEye.y, side);
  const double line_y = form.lid_line(x) - kEye.y;
  const double z = std::sqrt(std::max(0.05, kLidRadius * kLidRadius - dx * dx - line_y * line_y));
  const Vec3 at = Vec3{dx, line_y, z};
  Vertex v =
      plain(turn_lid(kEye + at * (radius / length(at)), lift), Color(), 0, 0, Carrier::kSkin);
  v.look = edge.closed;
  v.lid = side == Side::kAbove ? form.upper_opening(x) : form.lower_opening(x);
  v.side = side;
  v.position = turn_lid(v.closed, v.lid);
  return v;
}

struct LashRow {
  uint32_t count;
  double size, wide;  // cm
  double from, to;    // along the lid
  Side side;
};

/// Groups of lashes, each a card that curves away from the eye.
void add_lash_row(const Form& form, const LashRow& row, uint32_t steps, uint32_t number, Color hair,
                  HalfMesh& out) {
  // Out of the lid, and up from there or down, of the length.
  static constexpr double kOut[] = {-0.04, 0.36, 0.70, 0.92}, kUp[] = {0, 0.02, 0.16, 0.44};
  const double up = row.side == Side::kAbove ? 1 : -1;
  for (uint32_t i = 0; i < row.count; ++i, ++number) {
    const double s = mix(row.from, row.to, (i + 0.5 + 0.35 * scatter(number)) / row.count);
    const double full = smooth_step(-1.10, -0.30, s) *
                        exact_pow(std::max(0.0, 1 - s * s * s * s), 0.25) *
                        mix(0.7, 1.1, 0.5 + 0.5 * s);
    const double size = row.size * full * (0.90 + 0.18 * scatter(number + 100));
    // They fan out, and neighbors lean towards each other.
    const double lean = size * (0.50 * s + 0.22 * scatter(number + 200));
    CardRow rows[4];
    for (uint32_t k = 0; k < steps; ++k) {
      const uint32_t at = k * 3 / (steps - 1);
      const double far = at / 3.0;
      CardRow& r = rows[k];
      r.middle = beside_lid(form, row.side, s, kLidRadius + size * kOut[at],
                            up * size * kUp[at] / kLidRadius);
      r.middle.position.x += lean * far * far;
      r.middle.closed.x += lean * far * far;
      r.middle.color = hair;
      r.half = {row.wide * mix(1, 0.35, far), 0, 0};
    }
    add_card(rows, steps, lash_lane(number), out);
  }
}

}  // namespace

void add_lashes(const Form& form, uint32_t lod, HalfMesh& out) {
  const Color hair = mix(form.person().brow_hair, {16, 12, 12}, 0.7);
  const uint32_t steps = lod < 2 ? 4 : lod < 5 ? 3 : 2;
  const uint32_t upper = at_lod(34, 5, lod), lower = at_lod(22, 3, lod);
  const double size = 0.62 - 0.08 * form.person().sex;
  add_lash_row(form, {upper, size, 0.062 * 34 / upper, -0.93, 0.985, Side::kAbove}, steps, 0, hair,
               out);
  add_lash_row(form, {lower, 0.48 * size, 0.055 * 22 / lower, -0.72, 0.95, Side::kBelow}, steps,
               1000, mix(hair, form.person().skin, 0.12), out);
}

/// Where in the brow a share of its hairs ends, counted from the inner end: there they are few, and more and more over
/// the first 5 mm.
static double along_brow(double share) {
  constexpr double kBegin = -0.02, kFade = 0.13, kHairs = 0.5 * kFade / (1 - kBegin - 0.5 * kFade);
  return share < kHairs ? kBegin + kFade * std::sqrt(share / kHairs)
                        : mix(kBegin + kFade, 1, (share - kHairs) / (1 - kHairs));
}

/// Rows of cards that lie on the skin, denser in the middle of the brow.
void add_brow(const Form& form, uint32_t lod, HalfMesh& out) {
  const Person& person = form.person();
  const auto place = [&form](double x, double y, double raise, Color color) {
    const FacePoint at = form.face(form.angle_of(x, y), y, Side::kAbove);
    const Vec3 out_of_face = unit({at.closed.x * 0.55, 0.8, at.closed.z});
    Vertex v = plain(at.closed + out_of_face * raise, color, 0, 0, Carrier::kSkin);
    v.look = at.closed;
    v.normal = out_of_face * 1.5;  // the cards are shaded like the skin
    return v;
  };
  const uint32_t count = at_lod(122, 9, lod), steps = lod < 4 ? 3 : 2;
  const double wider = std::sqrt(122.0 / count);
  for (uint32_t i = 0; i < count; ++i) {
    // The inner hairs stand up and fan out, those of the middle lean outwards, those of the tail lie flat and down. Upper
    // and lower ones lean towards the middle.
    const double t = along_brow((i + 0.5) / count) + 0.012 * scatter(i + 300);
    const double inner = smooth_step(0.16, -0.03, t);
    const double edge = scatter(i);
    const double across = edge * mix(0.45, 0.95, std::abs(edge));
    const Form::BrowArch at = form.brow_arch(t);
    const double size = (0.50 + 0.12 * scatter(i + 500)) * mix(1, 0.8, inner) *
                        mix(1, 0.75, smooth_step(0.7, 1, t)) * std::sqrt(wider);
    const double lean = mix(1.05, 0.30, smooth_step(0, 0.30, t)) + 0.45 * inner -
                        0.55 * smooth_step(0.35, 0.95, t) - 0.55 * across +
                        mix(0.22, 0.34, inner) * scatter(i + 600);
    const auto [s, c] = exact_sine_cosine(lean);
    const double x = at.x - 0.35 * size * c, y = at.y + across * at.half * 0.9 - 0.28 * size * s;
    const Color color =
        mix(person.brow_hair, person.skin, 0.22 + 0.12 * scatter(i + 700) + 0.15 * inner);
    const double wide = 0.105 * wider * mix(1, 0.75, inner) * mix(1, 0.7, smooth_step(0.8, 1, t));
    CardRow rows[3];
    for (uint32_t k = 0; k < steps; ++k) {
      static constexpr double kRaise[] = {0.006, 0.045, 0.04}, kWidth[] = {0.7, 1, 0.35};
      const uint32_t of = k * 2 / (steps - 1);
      const double far = of / 2.0;
      // Bent a little, as hairs are.
      CardRow& r = rows[k];
      r.middle = place(x + size * far * c, y + size * far * (s - 0.12 * far),
                       kRaise[of] + 0.006 * scatter(i + 800), color);
      r.half = Vec3{s, -c, 0} * (wide * kWidth[of]);
    }
    add_card(rows, steps, brow_lane(i), out);
  }
  if (out.vertices.count() > 0) out.vertices[0].color = person.brow_hair;
}

}  // namespace mien::head
