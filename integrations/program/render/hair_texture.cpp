// SPDX-License-Identifier: MIT
#include "integrations/program/render/hair_texture.h"

#include <algorithm>
#include <cmath>

namespace mien::render {

namespace {

constexpr int kHairWide = 512, kHairHigh = 640;

/// -1 ... 1, by number.
float hair_scatter(uint32_t i) {
  uint32_t h = i * 2654435761u;
  h = (h ^ h >> 15) * 2246822519u;
  return float((h ^ h >> 13) >> 8) * (2.0f / 16777216) - 1;
}

/// A wave of period 1 between -1 and 1, from parabolas: the same bits everywhere, which sines are not.
float hair_wave(float t) {
  const float s = 2 * (t - std::floor(t)) - 1;
  return 4 * s * (1 - std::fabs(s));
}

/// Part of the texture in pixels, y upwards.
struct Lane {
  float left, low, width, height;
};

/// One hair from its root at `from` to its tip at `to`, in pixels of a lane.
struct Strand {
  float from_x, from_y, to_x, to_y;
  float bend = 0;             // how far its middle is beside the straight line
  float waves = 0, sway = 0;  // of curls: how many, and how far they go
  float phase = 0;
  float width = 1;      // half of it, at the widest
  float root = 0.6f;    // the width at the root, of that
  float full = 0.35f;   // where along it begins to taper
  float soft_root = 0;  // how much of it fades in from the root
  float shade = 1;      // gray, of 1
  float dark_root = 0;  // how much darker it is at its root
  float opacity = 1;
};

class HairPainter {
 public:
  HairPainter() : gray_(size_t{kHairWide} * kHairHigh, 0.78f), alpha_(gray_.size(), 0.0f) {}

  void draw(const Lane& lane, const Strand& s);
  HairMap finish() const;

 private:
  std::vector<float> gray_, alpha_;  // rows from below
};

/// Row by row: hairs run rather upwards than across. What leaves the lane is cut off.
void HairPainter::draw(const Lane& lane, const Strand& s) {
  const float rise = s.to_y - s.from_y;
  if (rise <= 0) return;
  const int first = std::max(int(std::floor(s.from_y)), 0);
  const int last = std::min(int(std::ceil(s.to_y)), int(lane.height) - 1);
  for (int y = first; y <= last; ++y) {
    const float t = (float(y) + 0.5f - s.from_y) / rise;
    if (t < 0 || t > 1) continue;
    const float x = s.from_x + (s.to_x - s.from_x) * t + 4 * s.bend * t * (1 - t) +
                    s.sway * hair_wave(s.waves * t + s.phase);
    const float thick =
        t < s.full ? s.root + (1 - s.root) * (t / s.full) : 1 - (t - s.full) / (1 - s.full);
    const float half = s.width * std::max(thick, 0.0f);
    const float fade = s.soft_root > 0 ? std::min(t / s.soft_root, 1.0f) : 1;
    const int left = std::max(int(std::floor(x - half - 1)), 0);
    const int right = std::min(int(std::ceil(x + half + 1)), int(lane.width) - 1);
    for (int column = left; column <= right; ++column) {
      const float from_middle = std::fabs(float(column) + 0.5f - x);
      const float cover =
          std::min(std::max(half + 0.5f - from_middle, 0.0f), std::min(2 * half, 1.0f)) * fade *
          s.opacity;
      if (cover <= 0) continue;
      // A round hair is darker at its sides.
      float round = half > 0.6f ? 1 - 0.22f * std::min(from_middle / (half + 0.5f), 1.0f) : 1;
      round *= 1 - s.dark_root * std::max(1 - 2.5f * t, 0.0f);
      const size_t at =
          (size_t(lane.low) + size_t(y)) * kHairWide + size_t(lane.left) + size_t(column);
      gray_[at] += (s.shade * round - gray_[at]) * (alpha_[at] > 0 ? cover : 1);
      alpha_[at] += (1 - alpha_[at]) * cover;
    }
  }
}

HairMap HairPainter::finish() const {
  HairMap map{Image(kHairWide, kHairHigh, {}), std::vector<uint8_t>(gray_.size())};
  for (int y = 0; y < kHairHigh; ++y) {
    for (int x = 0; x < kHairWide; ++x) {
      const size_t from = size_t(kHairHigh - 1 - y) * kHairWide + size_t(x);
      const auto byte = [](float share) {
        return int(std::lround(255 * std::min(std::max(share, 0.0f), 1.0f)));
      };
      // Few grays make a small file.
      const auto gray = uint8_t(byte(gray_[from]) & ~3);
      map.gray.set(x, y, {gray, gray, gray});
      map.alpha[size_t(y) * kHairWide + size_t(x)] = uint8_t(byte(alpha_[from]) & ~7);
      if (alpha_[from] > 0.97f) map.alpha[size_t(y) * kHairWide + size_t(x)] = 255;
    }
  }
  return map;
}

// Kinds -------------------------------------------------------------------------------------------

/// How the hairs of a lane lie.
struct LockStyle {
  int hairs;
  float roots;  // part of the lane in which they begin
  float tips;   // part of it in which they end
  float width;
  float shade;
};

/// Hairs that lie over each other in strands, the last ones on top and lighter.
void paint_lock(HairPainter& out, int number, const LockStyle& style) {
  const Lane lane{float(64 * number), 384, 64, 256};
  constexpr int kStrands = 7;
  for (int i = 0; i < style.hairs; ++i) {
    const uint32_t n = uint32_t(1000 * number + 10 * i);
    const uint32_t strand = uint32_t(100 + 50 * number + i * 5 % kStrands);
    const float share = float(i) / float(style.hairs);
    Strand s{};
    s.from_x = 32 + 27 * hair_scatter(n);
    const float out_by = (s.from_x - 32) / 27;
    const float late = std::fabs(hair_scatter(n + 1));
    s.from_y = 2 + 250 * style.roots * (0.55f * late + 0.45f * out_by * out_by);
    // Hairs of a strand come together. The outer ones end early.
    const float gathered = 32 + 24 * hair_scatter(strand);
    s.to_x = 0.55f * (32 + 24 * out_by) + 0.45f * gathered + 3 * hair_scatter(n + 2);
    const float early = std::fabs(hair_scatter(n + 3));
    s.to_y = 252 - 250 * style.tips * (0.6f * early + 0.4f * out_by * out_by);
    s.bend = 4 * hair_scatter(strand + 7) + 2 * hair_scatter(n + 4);
    s.width = style.width * (1 + 0.3f * hair_scatter(n + 5));
    s.root = 0.2f;
    s.full = 0.4f;
    s.shade = style.shade * (0.70f + 0.18f * share + 0.11f * hair_scatter(n + 6) +
                             0.09f * hair_scatter(strand + 3));
    s.dark_root = 0.14f;
    out.draw(lane, s);
  }
}

/// Hairs of a few millimeters, all over: what leaves the tile on one side is mirrored there.
void paint_short(HairPainter& out) {
  const Lane lane{0, 128, 256, 256};
  for (int i = 0; i < 2900; ++i) {
    const uint32_t n = uint32_t(40000 + 10 * i);
    Strand s{};
    s.from_x = 128 + 128 * hair_scatter(n);
    s.from_y = 118 + 138 * hair_scatter(n + 1);
    if (s.from_y < 110 * std::sqrt(std::fabs(hair_scatter(n + 7)))) continue;
    s.to_x = s.from_x + 9 * hair_scatter(n + 2);
    s.to_y = s.from_y + 30 + 10 * hair_scatter(n + 3);
    s.bend = 2 * hair_scatter(n + 4);
    s.width = 0.8f + 0.2f * hair_scatter(n + 5);
    s.shade = 0.56f + 0.32f * float(i) / 2900 + 0.12f * hair_scatter(n + 6);
    out.draw(lane, s);
  }
}

void paint_curl(HairPainter& out, int number) {
  const Lane lane{float(256 + 64 * number), 128, 64, 256};
  for (int i = 0; i < 44; ++i) {
    const uint32_t n = uint32_t(60000 + 1000 * number + 10 * i);
    Strand s{};
    s.from_x = 32 + 20 * hair_scatter(n);
    s.from_y = 2 + 12 * std::fabs(hair_scatter(n + 1));
    s.to_x = 32 + 15 * hair_scatter(n + 2);
    s.to_y = 252 - 60 * std::fabs(hair_scatter(n + 3));
    s.waves = 2.2f + 0.25f * hair_scatter(n + 4) + 0.3f * float(number);
    s.sway = 9 + 3 * hair_scatter(n + 5);
    s.phase = 0.25f * float(number) + 0.12f * hair_scatter(n + 6);
    s.width = 1.3f + 0.4f * hair_scatter(n + 7);
    s.full = 0.6f;
    s.shade = 0.56f + 0.32f * float(i) / 44 + 0.12f * hair_scatter(n + 8);
    out.draw(lane, s);
  }
}

/// A few hairs of about one direction.
void paint_brow(HairPainter& out, int number) {
  const Lane lane{float(128 + 32 * number), 0, 32, 128};
  for (int i = 0; i < 8; ++i) {
    const uint32_t n = uint32_t(70000 + 1000 * number + 10 * i);
    Strand s{};
    s.from_x = 4 + 3.4f * float(i) + 1.5f * hair_scatter(n);
    s.from_y = 2 + 50 * std::fabs(hair_scatter(n + 1));
    s.to_x = s.from_x + 5 * hair_scatter(n + 2);
    s.to_y = 126 - 50 * std::fabs(hair_scatter(n + 3));
    s.bend = 3.5f * hair_scatter(n + 4);
    s.width = 1.15f + 0.25f * hair_scatter(n + 5);
    s.root = 0.5f;
    s.full = 0.3f;
    s.soft_root = 0.1f;
    s.shade = 0.80f + 0.16f * hair_scatter(n + 6);
    out.draw(lane, s);
  }
}

/// Hairs side by side at the lid, whose tips come together.
void paint_lash(HairPainter& out, int number) {
  const Lane lane{float(number < 4 ? 32 * number : 256 + 32 * number), 0, 32, 128};
  const int hairs = 3 + number % 2;
  for (int i = 0; i < hairs; ++i) {
    const uint32_t n = uint32_t(80000 + 1000 * number + 10 * i);
    const float place = (float(i) + 0.5f) / float(hairs) - 0.5f;
    Strand s{};
    s.from_x = 16 + 24 * place + 1.5f * hair_scatter(n);
    s.from_y = 0;
    s.to_x = 16 + 8 * place + 3 * hair_scatter(n + 1);
    s.to_y = 126 - 34 * std::fabs(hair_scatter(n + 2));
    s.bend = 2.5f * hair_scatter(n + 3);
    s.width = 2.1f + 0.3f * hair_scatter(n + 4);
    s.root = 0.9f;
    s.full = 0.12f;
    s.shade = 0.80f + 0.1f * hair_scatter(n + 5);
    out.draw(lane, s);
  }
}

}  // namespace

HairMap make_hair_map() {
  HairPainter painter;
  static constexpr float kTones[] = {0.99f, 1.06f, 0.94f, 1.03f, 0.97f};
  for (int lane = 0; lane < 5; ++lane) {
    paint_lock(painter, lane, {78 - 5 * lane, 0.20f, 0.38f, 1.15f, kTones[lane]});
  }
  paint_lock(painter, 5, {46, 0.40f, 0.35f, 0.95f, 1.0f});  // of the line
  paint_lock(painter, 6, {14, 0.40f, 0.60f, 0.72f, 1.0f});  // thin
  paint_lock(painter, 7, {7, 0.30f, 0.45f, 0.85f, 1.05f});  // loose
  paint_short(painter);
  for (int lane = 0; lane < 4; ++lane) {
    paint_curl(painter, lane);
  }
  for (int lane = 0; lane < 8; ++lane) {
    paint_brow(painter, lane);
    paint_lash(painter, lane);
  }
  return painter.finish();
}

}  // namespace mien::render
