// SPDX-License-Identifier: MIT
// Openings of the skin: nostrils and the mouth.
#include "author/generate/head/skin.h"

namespace mien::head {

using author::exact_pow;
using author::exact_sine;
using author::kPi;
using author::mix;
using author::smooth_step;

Place SkinMaker::nostril_place(uint32_t k, bool inner) const {
  // The border of its hole begins nearer to the tip.
  return on_form(form_.nostril_curve(2 * kPi * (k - 1.2) / ring_size_, inner ? 1 : 1.2));
}

void SkinMaker::make_nostril() {
  make_rings(nostril_, 1, Layout::Hole::kOther,
             [this](uint32_t k, bool inner) { return nostril_place(k, inner); });
  if (out_.failed()) return;
  // Inside, it goes up and back.
  static constexpr double kPath[][4] = {// size, up, back, darkness
                                        {0.97, 0.05, 0.02, 0.70},
                                        {0.85, 0.22, 0.10, 1.0},
                                        {0.50, 0.48, 0.24, 1.0}};
  Vec3 middle;
  double middle_u = 0, middle_v = 0;
  for (uint32_t k = 0; k < ring_size_; ++k) {
    const Vertex& v = out_.vertices[ring_[k]];
    middle = middle + v.closed * (1.0 / ring_size_);
    middle_u += v.u / ring_size_;
    middle_v += v.v / ring_size_;
  }
  const Color dark = mix(redder(form_.person().skin, 0.9), {34, 10, 10}, 0.86);
  const auto inside = [&](uint32_t from, const double(&step)[4]) {
    Vertex v = out_.vertices[from];
    v.closed = middle + (v.closed - middle) * step[0] + Vec3{0, step[1], -step[2]};
    v.position = v.closed;
    // The texture has few texels there: what is deep takes those of the middle.
    const double share = exact_pow(step[0], 6);
    v.u = mix(middle_u, v.u, share);
    v.v = mix(middle_v, v.v, share);
    v.color = mix(form_.skin_color(v.look, v.look.y, 0), dark, step[3]);
    return out_.vertices.add(v);
  };
  uint32_t rim[kMaxRing], next[kMaxRing];
  std::copy(ring_, ring_ + ring_size_, rim);
  for (const auto& step : kPath) {
    for (uint32_t k = 0; k < ring_size_; ++k) next[k] = inside(rim[k], step);
    for (uint32_t k = 0; k < ring_size_; ++k) {
      const uint32_t other = (k + 1) % ring_size_;
      out_.quad(ring_[k], ring_[other], next[other], next[k]);
    }
    std::copy(next, next + ring_size_, ring_);
  }
  const uint32_t end = inside(rim[0], {0, 0.50, 0.26, 1.0});
  for (uint32_t k = 0; k < ring_size_; ++k) {
    out_.triangle(ring_[k], ring_[(k + 1) % ring_size_], end);
  }
}

uint32_t SkinMaker::mouth_vertex(uint32_t from, double out, double depth, bool at_back) {
  static constexpr double kPath[][3] = {
      {0.00, 0.00, 0.00},  {0.02, 0.00, -0.004}, {0.12, 0.12, -0.40}, {0.30, 0.85, -0.80},
      {0.48, 1.62, -1.05}, {0.66, 1.75, -2.20},  {0.85, 1.25, -4.20}, {1.00, 0.00, -5.40}};
  int i = 0;
  while (i < 6 && depth > kPath[i + 1][0]) ++i;
  const double t = (depth - kPath[i][0]) / (kPath[i + 1][0] - kPath[i][0]);
  const double rise = mix(kPath[i][1], kPath[i + 1][1], t);
  const double back = mix(kPath[i][2], kPath[i + 1][2], t);
  Vertex v = out_.vertices[from];
  const double up = at_back ? 0 : v.side == Side::kAbove ? 1.0 : -0.85;
  const double open = std::sqrt(std::max(0.0, 1 - out * out));
  v.closed.y += up * rise * open - 0.5 * smooth_step(0.6, 1, depth);
  // Cheeks curve away beside the corners, so it first goes straight in there.
  v.closed.z += back - 0.75 * smooth_step(0, 0.35, depth) * out * out;
  v.closed.x *= 1 + 0.30 * smooth_step(0.20, 0.7, depth);
  v.position = v.closed;
  v.edge = false;
  v.depth = depth;
  v.v = mix(v.v, v_of_row(kMouthY), at_back ? 1 : 0.95 * std::sqrt(depth));
  const Color lip = v.color, wet = {164, 80, 77}, dark = {72, 22, 25};
  v.color =
      mix(mix(lip, wet, smooth_step(0.02, 0.20, depth)), dark, smooth_step(0.30, 0.90, depth));
  return out_.vertices.add(v);
}

Place SkinMaker::lip_place(uint32_t k, bool inner) const {
  const bool above = k > half_;
  const double out = static_cast<double>(above ? ring_size_ - 1 - k : k) / half_;
  return on_form(form_.lip_curve(mix(out, exact_sine(kPi / 2 * out), 0.5), inner   ? 0
                                                                           : above ? 1
                                                                                   : -1));
}

void SkinMaker::make_mouth() {
  make_rings(mouth_, kMouthRings.inside, Layout::Hole::kLips,
             [this](uint32_t k, bool inner) { return lip_place(k, inner); });
  if (out_.failed()) return;
  // Both halves of the ring meet in the back.
  constexpr uint32_t rings = kMouthDepth;
  uint32_t corner[kMouthDepth + 1], back[kMaxRing];
  corner[0] = ring_[half_];
  for (uint32_t d = 1; d <= rings; ++d)
    corner[d] = mouth_vertex(ring_[half_], 1, depth_of(d), d == rings);
  uint32_t before[kMouthDepth + 1];
  for (uint32_t k = 0; k < ring_size_; ++k) {
    const uint32_t twin = ring_size_ - 1 - k;
    const double out = static_cast<double>(std::min(k, twin)) / half_;
    uint32_t chain[kMouthDepth + 1];
    chain[0] = ring_[k];
    for (uint32_t d = 1; d <= rings; ++d) {
      if (k == half_) {
        chain[d] = corner[d];
      } else if (d == rings && k > half_) {
        chain[d] = back[twin];
      } else {
        chain[d] = mouth_vertex(ring_[k], out, depth_of(d), d == rings);
      }
      if (k > 0) out_.quad(before[d - 1], chain[d - 1], chain[d], before[d]);
    }
    back[k] = chain[rings];
    std::copy(chain, chain + rings + 1, before);
  }
}

double SkinMaker::depth_of(uint32_t ring) const {
  const double t = (ring - 1.0) / (kMouthDepth - 1);
  return mix(0.02, 1, t * mix(0.75, 1, t));
}

}  // namespace mien::head
