// SPDX-License-Identifier: MIT
// Hanging hair: layers of cards that do not cut each other. The ways of hairs begin along the parting, from its front end
// around the crown and back on its other side, and form one sheet:
//
//      row 0  +--+--+--+--+  parting        A card is a strip of the sheet. All cards have the same rows, so that they
//             |  |  |  |  |                 bend alike. Their edge away from the face lies on the next one, as shingles
//      last   +----+----+----+  hem         do; inner layers begin farther down.
#include <algorithm>

#include "author/generate/head/scalp.h"

namespace mien::head {

using author::clamp01;
using author::exact_sine;
using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

namespace {

constexpr uint32_t kWays = 129;
constexpr double kAtCrown = 0.4;  // share of the ways that begin around it

struct Layer {
  uint32_t cards;  // at LOD 0
  uint32_t first;  // row, of 14
  double height;   // of the thickness of the hair
  uint32_t last_lod;
};
constexpr Layer kLayers[] = {{52, 5, 0.50, 1}, {64, 3, 0.71, 3}, {88, 0, 0.92, 3}};
constexpr double kShingle = 0.10;  // height of an edge above the one that it covers, cm
constexpr double kOverlap = 0.45;  // of the width of a card

/// Its tips are cut, and its roots are as short as those of other hair.
HairLane hanging(HairLane lane) {
  lane.root += 0.09;
  lane.tip -= 0.14;
  return lane;
}

class HairSheet {
 public:
  HairSheet(const Scalp& scalp, uint32_t lod, HalfMesh& out)
      : scalp_(scalp), lod_(lod), rows_(lod == 0  ? kMaxCardRows
                                        : lod < 3 ? 8
                                                  : 6),
        out_(out) {}

  void make();

 private:
  void trace(uint32_t number);
  void even_out();
  MapPlace at(double across, uint32_t row) const;
  void add(const Layer& layer, double from, double to, double tilt, const HairLane& lane,
           uint32_t number);

  const Scalp& scalp_;
  const uint32_t lod_, rows_;
  HalfMesh& out_;
  MapPlace places_[kWays][kMaxCardRows];
  double wide_[kWays];  // of the sheet up to a way, in all 1
};

/// Follows the hairs from the parting to the hem.
void HairSheet::trace(uint32_t number) {
  constexpr double kStep = 0.4;  // cm
  constexpr uint32_t kMost = 96;
  constexpr double kOff = 0.02, kCrown = 0.006;  // from the parting and from the crown
  const double q = static_cast<double>(number) / (kWays - 1), middle = 2 * q - 1;
  const auto [sine, cosine] = exact_sine_cosine(kParting);
  MapPlace way[kMost];
  if (std::abs(middle) < kAtCrown) {
    const double turn = kParting + kPi - 0.5 * kPi * middle / kAtCrown;
    const auto [s, c] = exact_sine_cosine(turn);
    way[0] = {kCrown * s, kCrown * c};
  } else {
    const double along = 0.993 * (std::abs(middle) - kAtCrown) / (1 - kAtCrown);
    const double off = (middle < 0 ? -1 : 1) * mix(kCrown, kOff, smooth_step(0, 0.1, along));
    way[0] = {along * sine + off * cosine, along * cosine - off * sine};
  }
  uint32_t count = 1;
  double scale = 0.07, rest = 1;  // map per cm; share of the last step
  Vec3 skin = scalp_.root(way[0].around(), 1 - way[0].far()).skin;
  while (count < kMost && rest == 1) {
    const MapPlace p = way[count - 1];
    const double far = scale * kStep;
    const MapPlace half = combed(scalp_, p, 0);
    const MapPlace d = combed(scalp_, {p.x + 0.5 * far * half.x, p.z + 0.5 * far * half.z}, 0);
    MapPlace next = {p.x + far * d.x, p.z + far * d.z};
    if (next.far() > 1 && next.far() > p.far()) {
      rest = clamp01((1 - p.far()) / (next.far() - p.far()));
      next = {mix(p.x, next.x, rest), mix(p.z, next.z, rest)};
    }
    const Vec3 there = scalp_.root(next.around(), 1 - next.far()).skin;
    const double cm = length(there - skin) / std::max(rest, 1e-3);
    scale *= std::min(std::max(kStep / std::max(cm, 1e-6), 0.5), 2.0);
    skin = there;
    way[count++] = next;
  }
  for (uint32_t row = 0; row < rows_; ++row) {
    // Closer above, where hairs bend.
    const double even = static_cast<double>(row) / (rows_ - 1);
    const double to = (count - 2 + rest) * even * mix(0.7, 1, even);
    const uint32_t i = std::min(static_cast<uint32_t>(to), count - 2);
    const double t = i + 2 == count ? clamp01((to - i) / std::max(rest, 1e-3)) : to - i;
    places_[number][row] = {mix(way[i].x, way[i + 1].x, t), mix(way[i].z, way[i + 1].z, t)};
  }
}

/// Cards shall be about as wide as each other halfway down and at the hem.
void HairSheet::even_out() {
  wide_[0] = 0;
  for (uint32_t i = 1; i < kWays; ++i) {
    double sum = 0;
    for (uint32_t row = rows_ / 2; row < rows_; ++row) {
      Vec3 skin[2];
      for (uint32_t k = 0; k < 2; ++k) {
        const MapPlace& p = places_[i - 1 + k][row];
        skin[k] = scalp_.root(p.around(), 1 - p.far()).skin;
      }
      sum += length(skin[1] - skin[0]);
    }
    wide_[i] = wide_[i - 1] + sum + 0.01;
  }
  for (double& wide : wide_) wide /= wide_[kWays - 1];
}

/// `across`: share of the width, 0 ... 1.
MapPlace HairSheet::at(double across, uint32_t row) const {
  uint32_t i = 0;
  while (i + 2 < kWays && wide_[i + 1] < across) ++i;
  const double t = clamp01((across - wide_[i]) / (wide_[i + 1] - wide_[i]));
  const MapPlace &a = places_[i][row], &b = places_[i + 1][row];
  return {mix(a.x, b.x, t), mix(a.z, b.z, t)};
}

/// From one way to another; the last edge is higher than the first by `tilt`, cm, or the other way around.
void HairSheet::add(const Layer& layer, double from, double to, double tilt, const HairLane& lane,
                    uint32_t number) {
  const uint32_t first = layer.first * (rows_ - 1) / (kMaxCardRows - 1), count = rows_ - first;
  const double depth = 0.16 + 0.5 * std::max(0.0, 0.92 - layer.height);
  const double shade = 0.06 * scatter(number + 600);
  CardRow rows[kMaxCardRows];
  for (uint32_t k = 0; k < count; ++k) {
    const double all = static_cast<double>(first + k) / (rows_ - 1);
    MapPlace places[2];
    Scalp::Root roots[2];
    for (uint32_t e = 0; e < 2; ++e) {
      const double q = e == 0 ? from : to;
      // Strands sway a little, all layers together.
      const double sway = 0.006 * all * exact_sine(2 * kPi * (1.3 * all + 7 * q)) *
                          smooth_step(0, 0.05, q) * smooth_step(1, 0.95, q);
      MapPlace& p = places[e] = at(clamp01(q + sway), first + k);
      if (k + 1 == count) {
        // The hem is cut, but not with one stroke.
        const double longer = 1 + 0.008 * scatter(number + 500);
        p = {p.x * longer, p.z * longer};
      }
      roots[e] = scalp_.root(p.around(), 1 - p.far());
    }
    const Color c = mix(scalp_.person().hair, {14, 10, 9},
                        clamp01(depth + shade + 0.20 * smooth_step(0.25, 0, all)));
    // Narrow where ways come together: less steep there.
    const double raise = tilt * std::min(1.0, length(roots[1].skin - roots[0].skin) / 0.5);
    Vertex edges[2];
    for (uint32_t e = 0; e < 2; ++e) {
      // Not too thin for layers.
      const double body = 0.15 + scalp_.body(places[e].around(), 1 - places[e].far(), roots[e]);
      const double raised = std::max(0.0, e == 0 ? -raise : raise);
      edges[e] = scalp_.above(roots[e], 0.012 + body * layer.height + raised, c);
    }
    CardRow& row = rows[k];
    row.middle = edges[0];
    row.middle.position = (edges[0].position + edges[1].position) * 0.5;
    row.middle.closed = row.middle.look = row.middle.position;
    row.middle.normal = (edges[0].normal + edges[1].normal) * 0.5;
    row.half = (edges[1].position - edges[0].position) * 0.5;
  }
  add_card(rows, count, lane, out_, 0.3);
}

void HairSheet::make() {
  for (uint32_t i = 0; i < kWays; ++i) trace(i);
  even_out();
  for (const Layer& layer : kLayers) {
    if (lod_ > layer.last_lod) continue;
    const uint32_t cards = at_lod(layer.cards, 20, lod_);
    for (uint32_t i = 0; i < cards; ++i) {
      const auto place = [&](uint32_t k) {
        return k == 0 ? 0 : k == cards ? 1 : (k + 0.12 * scatter(k + layer.first * 90)) / cards;
      };
      const bool near_end = i < cards / 2;  // the face is at both ends of the sheet
      const double over = kOverlap / cards;
      const double from = std::max(0.0, near_end ? place(i) : place(i) - over),
                   to = std::min(1.0, near_end ? place(i + 1) + over : place(i + 1));
      const uint32_t number = 100 * layer.first + i;
      add(layer, from, to, near_end ? kShingle : -kShingle, hanging(lock_lane(number)), number);
    }
  }
}

}  // namespace

void add_sheet(const Scalp& scalp, uint32_t lod, HalfMesh& out) {
  HairSheet(scalp, lod, out).make();
}

}  // namespace mien::head
