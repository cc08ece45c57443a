// SPDX-License-Identifier: MIT
#include "integrations/program/tests/speech/spoken_head.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "integrations/program/io/rig_file.h"

namespace mien::speech {

namespace {

constexpr double kMillimeters = 10;  // the head is in centimeters

template <class Point>
double distance(const Point& a, const Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

/// From a point to a triangle.
template <class Point>
double distance(const Point& p, const Point& a, const Point& b, const Point& c) {
  const auto minus = [](const Point& u, const Point& v) {
    return Point{u.x - v.x, u.y - v.y, u.z - v.z};
  };
  const auto dot = [](const Point& u, const Point& v) { return u.x * v.x + u.y * v.y + u.z * v.z; };
  const auto along = [](const Point& from, const Point& way, double share) {
    return Point{from.x + way.x * share, from.y + way.y * share, from.z + way.z * share};
  };
  const Point ab = minus(b, a), ac = minus(c, a), ap = minus(p, a);
  const double bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), area = bb * cc - bc * bc;
  if (area > 0) {
    const double v = (cc * dot(ab, ap) - bc * dot(ac, ap)) / area;
    const double w = (bb * dot(ac, ap) - bc * dot(ab, ap)) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) return distance(p, along(along(a, ab, v), ac, w));
  }
  const auto to_edge = [&](const Point& from, const Point& to) {
    const Point way = minus(to, from);
    const double length = dot(way, way);
    const double share = length > 0 ? dot(minus(p, from), way) / length : 0;
    return distance(p, along(from, way, std::clamp(share, 0.0, 1.0)));
  };
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

void expect_ok(MienStatus status) { ASSERT_EQ(status, MIEN_OK); }

}  // namespace

SpokenHead::SpokenHead(uint64_t seed) {
  auto desc = cli::sized<MienGenerateDesc>();
  desc.preset = MIEN_PRESET_HEAD;
  desc.seed = seed;
  MienDna* dna = nullptr;
  MienRig* rig = nullptr;
  MienDeformer* deformer = nullptr;
  MienInstance* instance = nullptr;
  MienDeformerInstance* body = nullptr;
  expect_ok(mien_dna_generate(&desc, &dna, nullptr));
  dna_.reset(dna);
  expect_ok(mien_rig_create(dna, nullptr, &rig, nullptr));
  rig_.reset(rig);
  expect_ok(mien_deformer_create(dna, rig, nullptr, &deformer, nullptr));
  deformer_.reset(deformer);
  expect_ok(mien_instance_create(rig, nullptr, &instance, nullptr));
  instance_.reset(instance);
  expect_ok(mien_deformer_instance_create(deformer, nullptr, &body, nullptr));
  body_.reset(body);

  for (uint32_t c = 0; c < cli::rig_count(rig, MIEN_KIND_RAW_CONTROL); ++c) {
    controls_[cli::rig_name(rig, MIEN_KIND_RAW_CONTROL, c)] = c;
  }
  skin_ = mesh_named("head_lod0");
  teeth_ = mesh_named("teeth_lod0");
  tongue_ = mesh_named("tongue_lod0");
  pose({}, {skin_, teeth_});
  const std::vector<Point> skin = positions(skin_), teeth = positions(teeth_);
  pose({{"jawOpen", 1}}, {skin_, teeth_});
  const std::vector<Point> open = positions(skin_), open_teeth = positions(teeth_);

  // Lips touch in the neutral pose and part when the jaw opens.
  std::vector<uint32_t> near;
  for (uint32_t i = 0; i < skin.size(); ++i) {
    if (std::abs(skin[i].x) < 0.8) near.push_back(i);
  }
  std::sort(near.begin(), near.end(),
            [&](uint32_t a, uint32_t b) { return skin[a].y < skin[b].y; });
  std::set<uint32_t> upper, lower;
  for (size_t a = 0; a < near.size(); ++a) {
    for (size_t b = a + 1; b < near.size() && skin[near[b]].y - skin[near[a]].y < 0.05; ++b) {
      if (distance(skin[near[a]], skin[near[b]]) > 0.05) continue;
      const double apart = distance(open[near[a]], open[near[b]]);
      if (apart < 0.8) continue;
      const bool a_is_upper = open[near[a]].y > open[near[b]].y;
      upper.insert(near[a_is_upper ? a : b]);
      lower.insert(near[a_is_upper ? b : a]);
    }
  }
  upper_contact_.assign(upper.begin(), upper.end());
  lower_contact_.assign(lower.begin(), lower.end());
  // The lower lip: what goes with the jaw within a centimeter of where the lips touch.
  std::vector<bool> is_lip(skin.size());
  for (const uint32_t i : near) {
    if (distance(skin[i], open[i]) < 1 || std::abs(skin[i].x) > 0.6) continue;
    is_lip[i] = std::any_of(lower.begin(), lower.end(),
                            [&](uint32_t contact) { return distance(skin[i], skin[contact]) < 1; });
  }
  for (const auto& corners : triangles_of(skin_)) {
    if (is_lip[corners[0]] && is_lip[corners[1]] && is_lip[corners[2]])
      lower_lip_.push_back(corners);
  }
  double front = -1e9;
  for (const Point& tooth : teeth) front = std::max(front, tooth.z);
  for (uint32_t i = 0; i < teeth.size(); ++i) {
    if (std::abs(teeth[i].x) > 0.8 || teeth[i].z < front - 0.5) continue;
    const bool moves = distance(teeth[i], open_teeth[i]) > 0.5;
    (moves ? lower_teeth_ : upper_teeth_).push_back(i);
    if (moves) lower_teeth_at_rest_.push_back(teeth[i]);
  }
  // Incisors with the gum behind them.
  for (const auto& corners : triangles_of(teeth_)) {
    const bool is_front = std::all_of(corners.begin(), corners.end(), [&](uint32_t i) {
      return std::abs(teeth[i].x) < 1.2 && teeth[i].z > front - 1.1;
    });
    const bool moves = distance(teeth[corners[0]], open_teeth[corners[0]]) > 0.5;
    if (is_front) (moves ? lower_incisors_ : upper_incisors_).push_back(corners);
  }
  tongue_surface_ = triangles_of(tongue_);
}

std::vector<std::array<uint32_t, 3>> SpokenHead::triangles_of(uint32_t mesh) const {
  auto found = cli::sized<MienMesh>();
  expect_ok(mien_deformer_mesh(deformer_.get(), mesh, &found));
  std::vector<std::array<uint32_t, 3>> triangles(found.triangles.count / 3);
  for (size_t t = 0; t < triangles.size(); ++t) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = found.triangles.data[3 * t + k];
      triangles[t][k] = found.vertex_position_indices.data[vertex];
    }
  }
  return triangles;
}

uint32_t SpokenHead::mesh_named(const std::string& part) const {
  for (uint32_t m = 0; m < cli::rig_count(rig_.get(), MIEN_KIND_MESH); ++m) {
    if (cli::rig_name(rig_.get(), MIEN_KIND_MESH, m).rfind(part, 0) == 0) return m;
  }
  ADD_FAILURE() << "no mesh " << part;
  return 0;
}

void SpokenHead::pose(const std::vector<std::pair<std::string, float>>& values,
                      std::initializer_list<uint32_t> meshes) {
  MienMutableFloatView raw{};
  expect_ok(mien_instance_raw_controls(instance_.get(), &raw));
  std::fill(raw.data, raw.data + raw.count, 0.0f);
  for (const auto& [name, value] : values) {
    ASSERT_EQ(controls_.count(name), 1u) << name;
    raw.data[controls_[name]] = value;
  }
  expect_ok(mien_rig_evaluate(rig_.get(), instance_.get(), 0));
  expect_ok(mien_deformer_instance_update(body_.get(), instance_.get()));
  for (const uint32_t mesh : meshes) {
    expect_ok(mien_deformer_instance_deform(body_.get(), mesh, MIEN_NORMALS_NONE, nullptr));
  }
}

std::vector<SpokenHead::Point> SpokenHead::positions(uint32_t mesh) {
  MienFloatView view{};
  expect_ok(mien_deformer_instance_positions(body_.get(), mesh, &view));
  std::vector<Point> points;
  for (size_t i = 0; i + 2 < view.count; i += 3) {
    points.push_back({static_cast<double>(view.data[i]), static_cast<double>(view.data[i + 1]),
                      static_cast<double>(view.data[i + 2])});
  }
  return points;
}

MouthShape SpokenHead::shape(const std::vector<std::pair<std::string, float>>& values) {
  pose(values, {skin_, teeth_});
  const std::vector<Point> skin = positions(skin_), teeth = positions(teeth_);
  MouthShape shape{};
  // In strips from left to right: how far apart the lips are where they are nearest to each other.
  constexpr int kStrips = 7;
  double gaps[kStrips];
  std::fill(std::begin(gaps), std::end(gaps), 1e9);
  for (const uint32_t upper : upper_contact_) {
    for (const uint32_t lower : lower_contact_) {
      const Point &u = skin[upper], &l = skin[lower];
      if (std::abs(u.x - l.x) > 0.12) continue;
      const auto strip = static_cast<int>(std::floor((u.x + 0.7) / 0.2));
      if (strip < 0 || strip >= kStrips) continue;
      // Parts at different depths cannot touch.
      const double apart = std::abs(u.z - l.z) > 0.4 ? std::abs(u.z - l.z) : 0;
      gaps[strip] = std::min(gaps[strip], std::max(u.y - l.y, apart));
    }
  }
  shape.lip_gap = kMillimeters * *std::max_element(std::begin(gaps), std::end(gaps));
  shape.lip_to_teeth = 1e9;
  for (const auto& [a, b, c] : lower_lip_) {
    for (const uint32_t tooth : upper_teeth_) {
      const double apart = distance(teeth[tooth], skin[a], skin[b], skin[c]);
      shape.lip_to_teeth = std::min(shape.lip_to_teeth, kMillimeters * apart);
    }
  }
  shape.jaw = jaw_of(teeth);
  return shape;
}

namespace {

std::vector<std::pair<std::string, float>> values_of(const SpokenTake& take, size_t frame) {
  std::vector<std::pair<std::string, float>> values;
  const Curves& curves = take.curves;
  for (size_t c = 0; c < curves.controls.size(); ++c) {
    values.emplace_back(curves.controls[c], curves.values[frame * curves.controls.size() + c]);
  }
  return values;
}

}  // namespace

MouthShape SpokenHead::shape(const SpokenTake& take, size_t frame) {
  return shape(values_of(take, frame));
}

double SpokenHead::jaw(const SpokenTake& take, size_t frame) {
  pose(values_of(take, frame), {teeth_});
  return jaw_of(positions(teeth_));
}

/// The deepest of the corners and middles of these triangles within the tongue, which is closed.
double SpokenHead::depth_in_tongue(const std::vector<Point>& tongue,
                                   const std::vector<Point>& teeth,
                                   const std::vector<std::array<uint32_t, 3>>& of_teeth) const {
  double back = 1e9, front = -1e9;
  for (const auto& corners : of_teeth) {
    for (const uint32_t i : corners) back = std::min(back, teeth[i].z);
  }
  for (const Point& p : tongue) front = std::max(front, p.z);
  std::vector<std::array<uint32_t, 3>> surface;  // what can be near
  for (const auto& [a, b, c] : tongue_surface_) {
    if (std::max({tongue[a].z, tongue[b].z, tongue[c].z}) > back - 0.5)
      surface.push_back({a, b, c});
  }
  double deepest = 0;
  const auto test = [&](const Point& p) {
    if (p.z > front) return;
    // Upwards from a point inside, the surface is crossed an odd number of times.
    bool is_inside = false;
    double nearest = 1e9;
    for (const auto& [a, b, c] : surface) {
      const Point &u = tongue[a], &v = tongue[b], &w = tongue[c];
      const auto side = [](const Point& from, const Point& to, double x, double z) {
        return (to.x - from.x) * (z - from.z) - (to.z - from.z) * (x - from.x);
      };
      // Beside the plane of symmetry, on which edges lie.
      const double x = p.x + 1e-5, in_u = side(v, w, x, p.z), in_v = side(w, u, x, p.z),
                   in_w = side(u, v, x, p.z), sum = in_u + in_v + in_w;
      const bool covers = (in_u > 0 && in_v > 0 && in_w > 0) || (in_u < 0 && in_v < 0 && in_w < 0);
      if (covers && (in_u * u.y + in_v * v.y + in_w * w.y) / sum > p.y) is_inside = !is_inside;
    }
    if (!is_inside) return;
    for (const auto& [a, b, c] : surface) {
      nearest = std::min(nearest, distance(p, tongue[a], tongue[b], tongue[c]));
    }
    deepest = std::max(deepest, kMillimeters * nearest);
  };
  for (const auto& [a, b, c] : of_teeth) {
    const Point &u = teeth[a], &v = teeth[b], &w = teeth[c];
    test(u);
    test({(u.x + v.x + w.x) / 3, (u.y + v.y + w.y) / 3, (u.z + v.z + w.z) / 3});
  }
  return deepest;
}

PiercedTongue SpokenHead::pierced(const std::vector<std::pair<std::string, float>>& values) {
  pose(values, {teeth_, tongue_});
  const std::vector<Point> teeth = positions(teeth_), tongue = positions(tongue_);
  return {depth_in_tongue(tongue, teeth, lower_incisors_),
          depth_in_tongue(tongue, teeth, upper_incisors_)};
}

PiercedTongue SpokenHead::pierced(const SpokenTake& take, size_t frame) {
  return pierced(values_of(take, frame));
}

double SpokenHead::tongue_over_teeth(const std::vector<std::pair<std::string, float>>& values) {
  pose(values, {teeth_, tongue_});
  const std::vector<Point> teeth = positions(teeth_), tongue = positions(tongue_);
  double tip = -1e9, edge = -1e9, high = -1e9;
  for (const Point& p : tongue) tip = std::max(tip, p.z);
  for (const uint32_t i : lower_teeth_) {
    if (teeth[i].y > high) high = teeth[i].y, edge = teeth[i].z;
  }
  return kMillimeters * (tip - edge);
}

double SpokenHead::tongue_over_teeth(const SpokenTake& take, size_t frame) {
  return tongue_over_teeth(values_of(take, frame));
}

double SpokenHead::jaw_of(const std::vector<Point>& teeth) const {
  double sum = 0;
  for (size_t i = 0; i < lower_teeth_.size(); ++i) {
    sum += kMillimeters * distance(teeth[lower_teeth_[i]], lower_teeth_at_rest_[i]);
  }
  return sum / static_cast<double>(lower_teeth_.size());
}

SpokenHead& spoken_head() {
  static SpokenHead head;
  return head;
}

}  // namespace mien::speech
