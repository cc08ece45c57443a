// SPDX-License-Identifier: MIT
#include "integrations/program/render/teeth_texture.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "integrations/program/render/noise.h"

namespace mien::render {

using namespace math;

namespace {

// Where the gum ends and where necks and edges of teeth are, in v of one jaw.
constexpr float kGumEnd = 0.17f, kNeck = 0.20f, kEdge = 0.48f, kRidge = 0.135f;
constexpr int kToothCount = 7;
// Centimeters along the arch, from the middle.
constexpr float kBreadths[2][kToothCount] = {{0.86f, 0.68f, 0.76f, 0.70f, 0.68f, 0.98f, 0.80f},
                                             {0.54f, 0.60f, 0.68f, 0.70f, 0.72f, 1.05f, 0.86f}};

struct Enamel {
  Vec3 color;
  float height, roughness;  // height in centimeters
};

/// A place on a jaw.
struct JawPlace {
  int jaw, tooth;
  float side;   // across the tooth, -1 to 1, larger away from the middle of the face
  float along;  // centimeters from the middle, less than 0 on one side
  float share;  // of the arch, 0 in the middle
  float v;      // within the jaw, 0 to 1/2
  float own;    // a number of the tooth's own, -1 to 1
};

JawPlace jaw_place(float u, float v) {
  JawPlace at{};
  at.jaw = v < 0.5f ? 0 : 1;
  at.v = v - 0.5f * float(at.jaw);
  float total = 0;
  for (const float breadth : kBreadths[at.jaw]) total += breadth;
  at.along = 2 * (u - 0.5f) * total;
  at.share = 2 * std::fabs(u - 0.5f);
  float left = std::fabs(at.along);
  while (at.tooth + 1 < kToothCount && left > kBreadths[at.jaw][at.tooth]) {
    left -= kBreadths[at.jaw][at.tooth++];
  }
  at.side = std::min(2 * left / kBreadths[at.jaw][at.tooth] - 1, 1.0f);
  at.own = noise({float(at.tooth) * 3.7f + (u < 0.5f ? 40.5f : 0.5f), float(at.jaw) * 5.3f, 0.5f});
  return at;
}

/// Cheeks shade what is far back.
Vec3 in_shadow(Vec3 color, float share) {
  return mix(color, {104, 54, 46}, 0.78f * eased(0.42f, 1, share));
}

/// Dentin shows at the neck, where enamel is thin; at the edge there is none below, and the dark of the mouth shows.
Enamel tooth_at(const JawPlace& at) {
  const float up =
      1.2f * saturate((kEdge - at.v) / (kEdge - kNeck));  // 1 at the gum, 0 at the edge
  const bool front = at.tooth < 3;
  const float broad = noise({at.along * 2.2f, up * 1.5f, 3}),
              fine = noise({at.along * 7, up * 3, 9});
  // Striae run up and down, lines of growth across.
  const float striae = noise({at.along * 34, up * 1.8f, 20});
  const float growth = noise({at.along * 3, up * 26, 31});
  Vec3 c = Vec3{239, 230, 212} + Vec3{5, 5, 6} * at.own + Vec3{3, 4, 6} * broad;
  if (at.tooth == 2) c = c * Vec3{0.99f, 0.972f, 0.938f};  // canines have most dentin
  if (at.tooth > 2) c = c * Vec3{0.99f, 0.982f, 0.962f};
  const float neck = eased(0.42f, 1.0f, up + 0.05f * fine);
  c = mix(c, Vec3{226, 200, 160} + Vec3{6, 6, 6} * at.own, 0.65f * neck);
  c = mix(c, {206, 150, 124}, 0.40f * eased(0.86f, 1.05f, up));
  c = mix(c, {219, 198, 164}, 0.55f * eased(0.68f, 1.0f, std::fabs(at.side)));
  // Three lobes of dentin reach down into the clear edge.
  const float lobes =
      0.05f * (0.5f + 0.5f * noise({at.side * 1.6f + 9 * at.own, 4, 50})) + 0.02f * fine;
  const float clear = eased(0.22f, 0.04f, up + lobes);
  if (front) {
    c = mix(c, {182, 190, 198}, 0.55f * clear);
    c = mix(c, {226, 222, 212}, 0.60f * eased(0.055f, 0.0f, up));  // the edge itself is a pale line
  } else {
    c = mix(c, {178, 146, 106}, 0.38f * eased(0.10f, 0.0f, up) * (0.6f + 0.4f * fine));  // fissures
  }
  c = c * (1 + 0.020f * striae + 0.008f * growth * eased(0.2f, 0.8f, up));
  // A few are flecked with white.
  c = mix(c, {246, 243, 236}, 0.22f * eased(0.45f, 0.9f, noise({at.along * 5, up * 4, 61})));
  c = mix(c, {128, 84, 66}, 0.50f * eased(0.95f, 1.0f, std::fabs(at.side)));
  Enamel t{in_shadow(c, at.share), 0, 0.17f};
  // Two shallow grooves in the face of a front tooth.
  const float groove = eased(0.25f, 0, std::fabs(std::fabs(at.side) - 0.36f));
  t.height = 0.0011f * striae + 0.0016f * growth + 0.006f * broad -
             (front ? 0.012f * groove * eased(0.0f, 0.3f, up) : 0);
  t.roughness += 0.03f * striae + 0.03f * fine + 0.08f * neck;
  return t;
}

/// Attached gum is pale and stippled up to the line from which it is loose, red and smooth.
Enamel gum_at(const JawPlace& at) {
  const float from_tooth = kRidge - at.v;  // 0 where the gum meets the teeth
  const float loose = eased(0.068f, 0.100f, from_tooth + 0.006f * noise({at.along * 2, 1, 5}));
  const float margin = eased(0.022f, 0.0f, std::fabs(from_tooth));
  const Vec3 p = {at.along, at.v * 11, 2};
  const float blotch = noise(p * 1.7f), fine = noise(p * 6);
  Vec3 c = mix(Vec3{202, 122, 114}, {182, 78, 76}, loose);
  c = c + Vec3{9, 10, 9} * blotch + Vec3{5, 5, 5} * fine;
  c = mix(c, {208, 132, 124}, 0.45f * margin);
  // Between two teeth it is redder.
  c = mix(c, {186, 84, 84}, 0.45f * eased(0.70f, 1.0f, std::fabs(at.side)) * (1 - loose));
  // Vessels show through where it is loose.
  const float bent = noise(p * 3 + Vec3{8, 0, 0}) * 0.5f;
  const float vessel = eased(0.10f, 0, std::fabs(noise({at.along * 2.6f + bent, at.v * 18, 40})));
  c = mix(c, {146, 42, 50}, 0.40f * vessel * loose);
  // Behind the teeth it is in their shadow.
  c = mix(c, {120, 54, 56}, 0.6f * eased(kRidge, kRidge + 0.02f, at.v));
  const float stippled = (1 - loose) * (1 - margin);
  const float dimple = spots(p * 8, 0.5f, 0.85f);
  Enamel t{in_shadow(c * (1 - 0.06f * dimple * stippled), at.share), 0, 0.20f};
  t.height = 0.010f * blotch - 0.011f * dimple * stippled;
  t.roughness += 0.06f * fine + 0.10f * dimple * stippled;
  return t;
}

Enamel enamel_at(float u, float v) {
  const JawPlace at = jaw_place(u, v);
  return at.v < 0.5f * (kGumEnd + kNeck) ? gum_at(at) : tooth_at(at);
}

}  // namespace

TeethMaps make_teeth_maps(int width, int height) {
  TeethMaps maps = {Image(width, height, {}), Image(width / 2, height / 2, {}),
                    Image(width / 2, height / 2, {})};
  std::vector<float> heights(size_t(width) * size_t(height));
  const auto byte = [](float value) {
    return uint8_t(std::lround(std::min(std::max(value, 0.0f), 255.0f)));
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Enamel t =
          enamel_at((float(x) + 0.5f) / float(width), 1 - (float(y) + 0.5f) / float(height));
      heights[size_t(y) * size_t(width) + size_t(x)] = t.height;
      maps.base_color.set(x, y, {byte(t.color.x), byte(t.color.y), byte(t.color.z)});
      const uint8_t rough = byte(255 * t.roughness);
      if (x % 2 == 0 && y % 2 == 0) maps.roughness.set(x / 2, y / 2, {rough, rough, rough});
    }
  }
  // Both arches are 11 cm long. Of v, 0.28 are a tooth of 1 cm; gums are spread about as much.
  const float across = 4 * 11.0f / float(width), along = 4 * 4.0f / float(height);
  for (int y = 0; y < height / 2; ++y) {
    for (int x = 0; x < width / 2; ++x) {
      const auto mean_at = [&](int dx, int dy) {  // of the four texels of the height
        const int px = 2 * std::min(std::max(x + dx, 0), width / 2 - 1);
        const int py = 2 * std::min(std::max(y + dy, 0), height / 2 - 1);
        const float* here = &heights[size_t(py) * size_t(width) + size_t(px)];
        return 0.25f * (here[0] + here[1] + here[width] + here[width + 1]);
      };
      const Vec3 slope = {(mean_at(1, 0) - mean_at(-1, 0)) / across,
                          (mean_at(0, -1) - mean_at(0, 1)) / along, 0};
      const Vec3 n = normalized(Vec3{-slope.x, -slope.y, 1}, {0, 0, 1}) + Vec3{1, 1, 1};
      maps.normal.set(x, y, {byte(127.5f * n.x), byte(127.5f * n.y), byte(127.5f * n.z)});
    }
  }
  return maps;
}

}  // namespace mien::render
