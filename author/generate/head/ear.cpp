// SPDX-License-Identifier: MIT
// The ear: rings of the skin run around its root, over the rim and into the bowl.
#include "author/generate/head/skin.h"

namespace mien::head {

using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

/// The place on the head below a place of the outline of the root.
Place SkinMaker::ear_root(double sine, double cosine, double size) const {
  const double p = cosine * (cosine > 0 ? 0.62 : 0.92), q = sine * (sine > 0 ? 1.75 : 1.70);
  const Vec3 at =
      ear_.origin + ear_.back * (p * size * ear_.size) + ear_.up * (q * size * ear_.size);
  // The angle hardly changes the height but changes the depth.
  double low = 0.25 * kPi, high = 0.85 * kPi;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (form_.face(middle, at.y, Side::kAbove).closed.z > at.z ? low : high) = middle;
  }
  return {0.5 * (low + high), at.y};
}

void SkinMaker::place_ear() {
  ear_.size = 1.2 * form_.person().ear;
  const auto [sine, cosine] = exact_sine_cosine(0.44);
  ear_.back = {sine, 0, -cosine};
  ear_.outward = {cosine, 0, sine};
  ear_.up = unit({0.10, 1, -0.16});
  ear_.origin = {form_.face(0.53 * kPi, 0.0, Side::kAbove).closed.x + 0.10, -0.75, -0.8};
}

Place SkinMaker::ear_place(uint32_t k, bool inner) const {
  const auto [s, c] = exact_sine_cosine(kPi + 2 * kPi * k / ring_size_);
  return ear_root(s, c, inner ? 0.97 : 1.22);
}

namespace {

struct FlatPoint {
  double back, up;
};

/// 1 on a line through points, less beside it.
template <int N>
double along(const FlatPoint (&line)[N], FlatPoint at, double wide) {
  double nearest = 1e9;
  for (int i = 0; i + 1 < N; ++i) {
    const double x = line[i + 1].back - line[i].back, y = line[i + 1].up - line[i].up;
    const double u = at.back - line[i].back, v = at.up - line[i].up;
    const double t = author::clamp01((u * x + v * y) / (x * x + y * y));
    const double dx = u - t * x, dy = v - t * y;
    nearest = std::min(nearest, dx * dx + dy * dy);
  }
  return bump(std::sqrt(nearest), 0, 0, 0, wide, 1);
}

/// Height of the inside of the ear above its plane; `back` and `up` from its origin, at size 1.
double inside_ear(double back, double up) {
  struct Part {
    double amount, back, up, wide, high;
  };
  static constexpr Part kParts[] = {
      {-0.60, 0.06, -0.46, 0.50, 0.70},   // concha
      {-0.26, 0.20, 0.50, 0.42, 0.28},    // its upper part, the cymba
      {-0.16, 0.46, 1.36, 0.18, 0.26},    // the fossa between the legs of the antihelix
      {-0.10, 1.30, 0.50, 0.14, 1.00},    // between antihelix and helix
      {0.40, -0.46, -0.50, 0.22, 0.34},   // tragus
      {-0.20, -0.22, -1.06, 0.15, 0.20},  // the notch below it
      {0.24, 0.14, -1.22, 0.24, 0.17},    // antitragus
      {0.10, 0.20, -1.75, 0.50, 0.30},    // lobe
  };
  static constexpr FlatPoint kAntihelix[] = {{0.30, -1.22}, {0.72, -0.90}, {0.98, -0.30},
                                             {1.00, 0.35},  {0.86, 0.95},  {0.72, 1.60}},
                             kLowerLeg[] = {{0.95, 0.65}, {0.55, 0.98}, {0.05, 1.02}},
                             kCrus[] = {{-0.70, 0.66}, {-0.36, 0.26}, {0.20, 0.06}};
  double height = 0.06;
  for (const Part& p : kParts) height += p.amount * bump(back, up, p.back, p.up, p.wide, p.high);
  const FlatPoint at = {back, up};
  height += std::max(0.30 * along(kAntihelix, at, 0.17), 0.22 * along(kLowerLeg, at, 0.14));
  return height + 0.28 * along(kCrus, at, 0.15);
}

}  // namespace

void SkinMaker::make_ear() {
  // Share of the outline's radius, height above the plane of the ear, and minimum height above the head where
  // the ear grows out of it: from the back, over the rim, into the bowl. Inside the rim, heights
  // are those of inside_ear().
  constexpr uint32_t rings = 15;
  static constexpr double kPath[rings][3] = {
      {0.90, -0.34, 0.04}, {1.00, -0.16, 0.08}, {1.045, 0.05, 0.13}, {1.02, 0.24, 0.19},
      {0.96, 0.30, 0.19},  {0.90, 0.20, 0.11},  {0.84, 0, 0.03},     {0.78, 0, 0},
      {0.72, 0, -0.04},    {0.66, 0, -0.08},    {0.60, 0, -0.12},    {0.52, 0, -0.20},
      {0.42, 0, -0.30},    {0.31, 0, -0.38},    {0.17, 0, -0.42}};
  const auto turn = [&](uint32_t k) { return exact_sine_cosine(kPi + 2 * kPi * k / ring_size_); };
  make_rings(ear_ring_, 1, Layout::Hole::kOther,
             [this](uint32_t k, bool inner) { return ear_place(k, inner); });
  if (out_.failed()) return;

  const Color skin = form_.person().skin, red = redder(skin, 0.45);
  const Color rosy = mix(skin, red, 0.32), deep = redder(mix(skin, {0, 0, 0}, 0.35), 0.5);
  double middle_u = 0, middle_v = 0;
  for (uint32_t k = 0; k < ring_size_; ++k) {
    middle_u += out_.vertices[ring_[k]].u / ring_size_;
    middle_v += out_.vertices[ring_[k]].v / ring_size_;
  }
  uint32_t root[kMaxRing], next[kMaxRing];
  std::copy(ring_, ring_ + ring_size_, root);
  const auto place = [&](uint32_t k, const double(&step)[3], uint32_t r) {
    const auto [s, c] = turn(k);
    const double low = smooth_step(0.2, -1, s);
    // In front there is no rim: the ear runs on into the cheek.
    const double in_front = smooth_step(-0.1, -0.75, c) * smooth_step(0.75, 0.35, s);
    const double share = std::min(step[0], mix(step[0], 0.92 - 0.042 * r, in_front));
    // The bowl is in front of the middle, and low.
    const double inner = 1 - smooth_step(0.25, 0.85, share);
    // The lobe is round.
    const double round = 1 + 0.35 * bump(s, 0, -0.92, 0, 0.25, 1);
    const double p =
        c * (c > 0 ? mix(1.65, 1.05, low) * round : mix(0.95, 0.80, low)) - 0.30 * inner;
    // In front not beyond the root, over the cheek; the lobe is lowest behind its middle.
    const double q =
        s * (s > 0 ? mix(2.4, 1.62, in_front) : mix(2.1, 1.62, smooth_step(0.35, -0.75, c))) -
        0.35 * inner;
    // The rim fades towards the lobe and where the ear grows out of the head.
    const double rim = mix(1, 0.25, std::max(smooth_step(-0.3, -0.9, s), smooth_step(-0.4, -1, c)));
    double height = step[1] * (step[1] > 0 ? rim : 1);
    const double inside = inside_ear(p * share, q * share);
    // The plane of the ear runs into the head in front.
    const double sunk = 0.25 * smooth_step(-0.30, -0.80, p * share);
    height = mix(height, inside + sunk,
                 mix(smooth_step(0.86, 0.83, step[0]), smooth_step(0.99, 0.87, step[0]), in_front));
    const double size = ear_.size;
    const Vertex& from = out_.vertices[root[k]];
    // In front it rises straight out of the cheek: leaning forwards, it would lie on it.
    const Vec3 outward = ear_.outward * (1 - in_front) + Vec3{in_front, 0, 0};
    Vec3 at = ear_.origin + ear_.back * (p * share * size) + ear_.up * (q * share * size) +
              outward * (height * size);
    const double rise = smooth_step(0.92, 0.62, share);
    at.x = mix(at.x, from.closed.x + (inside - 0.06) * rise * size,
               in_front * smooth_step(-0.25, -0.70, p * share));
    const double least = step[2] * (step[2] > 0 ? mix(1, 0.1, in_front) : 1);
    at.x = std::max(at.x, from.closed.x + least * size);
    const double left = 1 - (r + 1.0) / (rings + 1);
    const double shade = smooth_step(-0.02, -0.40, height) * (r > rings / 2);
    return plain(at,
                 mix(mix(from.color, rosy, std::min(1.0, mix(0.4, 0.12, in_front) * (r + 1))), deep,
                     0.55 * shade),
                 mix(middle_u, from.u, left), mix(middle_v, from.v, left), Carrier::kSkin);
  };
  for (uint32_t r = 0; r < rings; ++r) {
    for (uint32_t k = 0; k < ring_size_; ++k) next[k] = out_.vertices.add(place(k, kPath[r], r));
    for (uint32_t k = 0; k < ring_size_; ++k) {
      const uint32_t other = (k + 1) % ring_size_;
      out_.quad(ring_[k], ring_[other], next[other], next[k]);
    }
    std::copy(next, next + ring_size_, ring_);
  }
  static constexpr double kEnd[] = {0, -0.40, -0.42};
  Vertex end = place(0, kEnd, rings - 1);
  end.color = mix(rosy, deep, 0.7);
  const uint32_t middle = out_.vertices.add(end);
  for (uint32_t k = 0; k < ring_size_; ++k) {
    out_.triangle(ring_[k], ring_[(k + 1) % ring_size_], middle);
  }
}

}  // namespace mien::head
