// SPDX-License-Identifier: MIT
// Pairs of expressions at full value, measured: what goes wrong beyond what each of the two does alone, in cubic
// centimeters. The pairs that are worst have correctives, which are held to the same measure.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

#include "author/base/random.h"
#include "author/generate/head/dna.h"
#include "tests/support/head_lods.h"

namespace mien::head {
namespace {

using Places = std::vector<Vec3>;
using Corners = std::array<uint32_t, 3>;

struct Damage {
  double crumpled =
      0;               // skin of 2 mm that is folded over, or squeezed to less than 0.4 of its area
  double twice = 0;    // volume that the face gains or loses beyond what either of them does
  double through = 0;  // lips within teeth, or within the other lip

  double total() const { return crumpled + twice + through; }
};

/// Where the front of the teeth is, by x and y.
class TeethFront {
 public:
  TeethFront(const HalfMesh& teeth, Carrier jaw) : z_(size_t{kAcross} * kUp, -1e9) {
    for (const Face& face : teeth.faces.span()) {
      for (uint32_t k = 2; k < face.count; ++k) {
        const Vertex &a = teeth.vertices[face.corners[0]], &b = teeth.vertices[face.corners[k - 1]],
                     &c = teeth.vertices[face.corners[k]];
        if (a.carrier == jaw) draw(a.position, b.position, c.position);
      }
    }
  }
  /// How far a place is behind it.
  double behind(Vec3 p) const {
    const double column = std::abs(p.x) / kStep, row = (p.y - kLow) / kStep;
    if (column >= kAcross || row < 0 || row >= kUp) return 0;
    const double front = z_[static_cast<size_t>(row) * kAcross + static_cast<size_t>(column)];
    return std::max(0.0, front - p.z);
  }

 private:
  static constexpr uint32_t kAcross = 64, kUp = 100;
  static constexpr double kStep = 0.05, kLow = -8.5;

  void draw(Vec3 a, Vec3 b, Vec3 c) {
    const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (std::abs(area) < 1e-9) return;
    for (uint32_t row = 0; row < kUp; ++row) {
      const double y = kLow + (row + 0.5) * kStep;
      if (y < std::min({a.y, b.y, c.y}) || y > std::max({a.y, b.y, c.y})) continue;
      for (uint32_t column = 0; column < kAcross; ++column) {
        const double x = (column + 0.5) * kStep;
        const double u = ((b.x - x) * (c.y - y) - (c.x - x) * (b.y - y)) / area;
        const double v = ((c.x - x) * (a.y - y) - (a.x - x) * (c.y - y)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        double& front = z_[size_t{row} * kAcross + column];
        front = std::max(front, u * a.z + v * b.z + (1 - u - v) * c.z);
      }
    }
  }

  std::vector<double> z_;
};

/// Skin that crumples and lips that collide are those of the left half.
class Pairs {
 public:
  Pairs()
      : mesh_(head_lods(Part::kHead).at[2]), teeth_(head_lods(Part::kTeeth).at[2]),
        upper_(teeth_, Carrier::kUpperTeeth), lower_(teeth_, Carrier::kLowerTeeth) {
    const uint32_t count = mesh_.vertices.count();
    std::map<std::array<double, 3>, uint32_t> edges;
    for (uint32_t i = 0; i < count; ++i) {
      const Vertex& v = mesh_.vertices[i];
      rest_.push_back(v.position);
      used_.push_back(v.depth == 0 && v.lid == 0);
      if (v.depth > 0 || v.lid != 0 || !v.edge) continue;
      const auto [other, is_first] = edges.try_emplace({v.closed.x, v.closed.y, v.closed.z}, i);
      if (is_first) continue;
      const bool above = v.side == Side::kAbove;
      lips_.push_back({above ? other->second : i, above ? i : other->second});
    }
    for (const Face& f : mesh_.faces.span()) {
      for (uint32_t k = 2; k < f.count; ++k) {
        const Corners t = {f.corners[0], f.corners[k - 1], f.corners[k]};
        if (used_[t[0]] && used_[t[1]] && used_[t[2]]) triangles_.push_back(t);
      }
    }
    area_.assign(count, 0);
    for (const Corners& t : triangles_) {
      for (uint32_t i : t) area_[i] += length(twice_area(rest_, t)) / 6;
    }
    for (uint32_t s = 0; s < shapes_.count(); ++s) {
      motions_.emplace_back(count);
      swellings_.emplace_back(count);
      for (uint32_t i = 0; i < count; ++i) {
        const Vertex& v = mesh_.vertices[i];
        motions_[s][i] = shapes_.displacement(s, v);
        swellings_[s][i] = dot(shapes_.skin_displacement(s, v), v.normal);
      }
    }
    for (uint32_t s = 0; s < kExpressionCount; ++s) alone_.push_back(measure({s}));
  }

  const Shapes& shapes() const { return shapes_; }
  const std::vector<Places>& motions() const { return motions_; }
  bool is_used(size_t vertex) const { return used_[vertex]; }

  /// The corrective of a pair; 0 if it has none.
  uint32_t corrective(uint32_t a, uint32_t b) const {
    for (uint32_t i = 0; i < shapes_.corrective_count(); ++i) {
      const Corrective& c = shapes_.corrective(i);
      if (c.first == std::min(a, b) && c.second == std::max(a, b)) return kExpressionCount + i;
    }
    return 0;
  }

  Damage damage(uint32_t a, uint32_t b, bool is_corrected) const {
    std::vector<uint32_t> active = {a, b};
    if (const uint32_t c = is_corrected ? corrective(a, b) : 0) active.push_back(c);
    const Damage both = measure(active), &of_a = alone_[a], &of_b = alone_[b];
    Damage d;
    d.crumpled = std::max(0.0, both.crumpled - std::max(of_a.crumpled, of_b.crumpled));
    d.through = std::max(0.0, both.through - std::max(of_a.through, of_b.through));
    // Of both halves. Skin that goes in here and out there is skin that moves along: they cancel.
    double volume = 0;
    for (uint32_t half = 0; half < 2; ++half) {
      const auto here = [&](uint32_t s) { return half == 0 ? s : shapes_.twin(s); };
      for (size_t i = 0; i < rest_.size(); ++i) {
        if (!used_[i]) continue;
        const double by_a = swellings_[here(a)][i], by_b = swellings_[here(b)][i];
        double all = 0;
        for (uint32_t s : active) all += swellings_[here(s)][i];
        if (by_a * by_b <= 0 || all * by_a <= 0) continue;
        const double more = std::abs(all) - std::max(std::abs(by_a), std::abs(by_b));
        volume += area_[i] * std::copysign(std::max(0.0, more), all);
      }
    }
    d.twice = std::abs(volume);
    return d;
  }

 private:
  static Vec3 twice_area(const Places& p, const Corners& t) {
    return cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
  }

  Damage measure(const std::vector<uint32_t>& active) const {
    constexpr double kSkin = 0.2, kLip = 0.5, kLeastShare = 0.4;  // cm; of the area
    Places p = rest_;
    JointTurns jaw;
    for (uint32_t s : active) {
      for (size_t i = 0; i < p.size(); ++i) p[i] = p[i] + motions_[s][i];
      const JointTurns turns = shapes_.turns(s, 1);
      jaw.jaw_open += turns.jaw_open;
      jaw.jaw_shift = jaw.jaw_shift + turns.jaw_shift;
    }
    Damage d;
    for (const Corners& t : triangles_) {
      const Vec3 before = twice_area(rest_, t), after = twice_area(p, t);
      const double sign = dot(before, after) < 0 ? -1 : 1;
      const double share = sign * length(after) / length(before);
      d.crumpled += kSkin * length(before) / 2 * std::max(0.0, kLeastShare - share);
    }
    JointTurns back;
    back.jaw_open = -jaw.jaw_open;
    for (size_t i = 0; i < p.size(); ++i) {
      const Vertex& v = mesh_.vertices[i];
      if (!used_[i] || std::abs(v.above_mouth) > 1.2 || v.look.z < 4) continue;
      const bool is_lower = v.side == Side::kBelow;
      d.through += area_[i] * (is_lower ? lower_.behind(move_with_jaw(back, p[i] - jaw.jaw_shift))
                                        : upper_.behind(p[i]));
    }
    for (size_t i = 0; i + 1 < lips_.size(); ++i) {
      const auto [below, above] = lips_[i];
      const double wide = std::abs(rest_[lips_[i + 1][0]].x - rest_[below].x);
      d.through += kLip * std::min(wide, 0.5) * std::max(0.0, p[below].y - p[above].y);
    }
    return d;
  }

  const Shapes shapes_;
  const HalfMesh &mesh_, &teeth_;
  const TeethFront upper_, lower_;
  Places rest_;
  std::vector<bool> used_;
  std::vector<std::array<uint32_t, 2>>
      lips_;  // places of the lower one and the upper one that meet
  std::vector<Places> motions_;
  std::vector<std::vector<double>> swellings_;  // outwards, without what the jaw carries along
  std::vector<Corners> triangles_;
  std::vector<double> area_;
  std::vector<Damage> alone_;
};

const Pairs& the_pairs() {
  static const Pairs made;
  return made;
}

struct Pair {
  uint32_t a, b;
  Damage before, after;
};

/// All pairs but mirror images, the worst first.
std::vector<Pair> list_pairs(const Pairs& pairs) {
  std::vector<Pair> list;
  const Shapes& shapes = pairs.shapes();
  for (uint32_t a = 0; a < kExpressionCount; ++a) {
    for (uint32_t b = a + 1; b < kExpressionCount; ++b) {
      const bool on_right = kExpressions[a].side < 0 || kExpressions[b].side < 0;
      const bool on_left = kExpressions[a].side > 0 || kExpressions[b].side > 0;
      if (on_right && (!on_left || shapes.twin(a) < b)) continue;
      list.push_back({a, b, pairs.damage(a, b, false), pairs.damage(a, b, true)});
    }
  }
  std::sort(list.begin(), list.end(),
            [](const Pair& x, const Pair& y) { return x.before.total() > y.before.total(); });
  return list;
}

TEST(Combinations, TheWorstPairsAreCorrected) {
  constexpr size_t kWorst = 30, kShown = 60;
  const Pairs& pairs = the_pairs();
  const std::vector<Pair> list = list_pairs(pairs);
  double before = 0, after = 0;
  std::printf(
      "cm3 of skin that crumples, of volume gained or lost twice, of lips in teeth or lips\n");
  for (size_t i = 0; i < list.size(); ++i) {
    const Pair& p = list[i];
    const bool is_corrected = pairs.corrective(p.a, p.b) != 0;
    if (i < kShown) {
      std::printf("%3zu %c %6.3f (%.3f %.3f %.3f) -> %6.3f  %s + %s\n", i + 1,
                  is_corrected ? '*' : ' ', p.before.total(), p.before.crumpled, p.before.twice,
                  p.before.through, p.after.total(), kExpressions[p.a].name,
                  kExpressions[p.b].name);
    }
    if (i >= kWorst) continue;
    EXPECT_TRUE(is_corrected) << kExpressions[p.a].name << " " << kExpressions[p.b].name;
    EXPECT_LT(p.after.total(), p.before.total())
        << kExpressions[p.a].name << " " << kExpressions[p.b].name;
    before += p.before.total();
    after += p.after.total();
  }
  std::printf("the worst %zu of %zu: %.2f -> %.2f\n", kWorst, list.size(), before, after);
  EXPECT_LT(after, 0.5 * before);
}

/// Correctives of several pairs that are active together never turn a motion back.
TEST(Combinations, CorrectivesOfManyPairsDoNotOvershoot) {
  const Pairs& pairs = the_pairs();
  Random random = Random::from_seed(7, 7);
  double farthest = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<double> weights(kExpressionCount);
    for (double& w : weights) w = random.chance(0.12) ? 1 : 0;
    for (uint32_t i = 0; i < pairs.shapes().corrective_count(); ++i) {
      const Corrective& c = pairs.shapes().corrective(i);
      weights.push_back(weights[c.first] * weights[c.second]);
    }
    for (size_t i = 0; i < pairs.motions()[0].size(); ++i) {
      if (!pairs.is_used(i)) continue;
      Vec3 plain, corrected;
      for (size_t s = 0; s < weights.size(); ++s) {
        if (s < kExpressionCount) plain = plain + pairs.motions()[s][i] * weights[s];
        corrected = corrected + pairs.motions()[s][i] * weights[s];
      }
      const double size = length(plain);
      if (size > 0.05) farthest = std::max(farthest, -dot(plain, corrected) / size);
    }
  }
  std::printf("at most %.2f cm back\n", farthest);
  EXPECT_LT(farthest, 0.15);
}

}  // namespace
}  // namespace mien::head
