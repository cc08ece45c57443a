// SPDX-License-Identifier: MIT
#include "integrations/program/render/eye_texture.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/render/noise.h"

namespace mien::render {

using namespace math;

namespace {

// Angles from the middle of the pupil.
constexpr float kSeen = 1.25f, kSeenShare = 0.45f;  // what lids may uncover, and its radius in u
constexpr float kPupil = 0.155f, kLimbus = 0.44f;

/// A place of the texture: the angle from the pupil and the direction.
struct Gaze {
  float angle;
  float x, y;  // of length 1
};

Gaze gaze_at(float u, float v) {
  const float x = u - 0.5f, y = v - 0.5f, r = std::sqrt(x * x + y * y);
  const float flat = r > 0 ? 1 / r : 0;
  return {std::min(r * (kSeen / kSeenShare), 1.6f), x * flat, y * flat};
}

/// Fibers that run outwards from the pupil: noise that hardly changes along them.
float fibers(const Gaze& at, float count, float seed) {
  return noise({at.x * count + seed, at.y * count, at.angle * 7});
}

Vec3 iris_color(const Gaze& at, Vec3 iris) {
  const float a = at.angle;
  const float light = saturate((iris.x + iris.y + iris.z) / 330);  // dark ones keep dark
  const float coarse = fibers(at, 6, 3), fine = fibers(at, 15, 11), hair = fibers(at, 34, 29);
  // The collarette, a wavy ring, parts a zone around the pupil, often browner, from the fibers outside.
  const float collarette = 0.245f + 0.022f * fibers(at, 4, 50);
  const float inner = eased(collarette + 0.02f, collarette - 0.03f, a);
  float shade = 1 + 0.13f * coarse + 0.17f * fine + 0.12f * hair;
  shade += 0.22f * eased(0.035f, 0, std::fabs(a - collarette)) * (0.7f + 0.6f * fine);
  // Crypts are gaps between fibers, outside of it.
  const float crypt = noise({at.x * 9 + 70, at.y * 9, a * 13});
  shade -= 0.20f * eased(0.35f, 0.80f, crypt) * (1 - inner);
  Vec3 c = mix(iris, Vec3{124, 84, 44} * (0.35f + 0.65f * light), 0.50f * inner);
  c = mix(c, {196, 190, 168}, light * 0.16f * saturate(fine + 0.5f * hair) * (1 - inner));
  // The cornea gathers light from above in the lower half, for programs that do not refract it; the upper lid shades the
  // other.
  shade *= 1 + 0.12f * -at.y * eased(kPupil, 0.36f, a);
  shade *= 1 - 0.45f * eased(0.06f, 0.34f, at.y * a);
  c = c * shade;
  c = mix(c, iris * 0.22f + Vec3{8, 9, 12}, 0.82f * eased(0.355f, 0.435f, a));
  const Vec3 pupil = {9, 8, 9};
  return mix(c, pupil, eased(kPupil + 0.012f, kPupil - 0.008f, a + 0.006f * fine));
}

/// A branching vein where noise that is stretched away from the iris passes through zero.
float vein(const Gaze& at, float count, float thin, float seed) {
  const Vec3 p = {at.x * count + seed, at.y * count, at.angle * 2.2f};
  const float bent = noise(p * 2 + Vec3{5, 1, 0}) * 0.5f;
  return eased(thin, 0, std::fabs(noise({p.x + bent, p.y + 0.7f * bent, p.z})));
}

Vec3 white_color(const Gaze& at, Vec3 iris) {
  const float a = at.angle, side = at.x * at.x;
  const float soft = noise({at.x * 2, at.y * 2, a * 3});
  Vec3 c = Vec3{208, 196, 185} + Vec3{3, 5, 6} * soft;
  // Yellowish towards the sides, pink and with more blood towards the corners and behind the lids.
  c = mix(c, {216, 198, 166}, 0.24f * side * eased(0.55f, 0.75f, a) * eased(1.0f, 0.8f, a));
  const float back = eased(0.60f, 1.10f, a);
  c = mix(c, {204, 138, 124}, 0.60f * back);
  const float veins = 0.50f * vein(at, 2.6f, 0.055f, 4) + 0.34f * vein(at, 5.5f, 0.06f, 31);
  c = mix(c, {176, 62, 54}, veins * eased(0.52f, 0.85f, a) * (0.30f + 0.70f * side));
  // Lashes and the lid shade what is above.
  c = c * (1 - 0.40f * eased(0.04f, 0.32f, at.y * a));
  // The border of the cornea is bluish and has no sharp edge.
  return mix(c, mix(iris * 0.30f, {92, 96, 102}, 0.45f), 0.85f * eased(0.520f, 0.425f, a));
}

/// How much farther outwards the surface leans than the ball, in radians: a cornea has 0.65 of its radius. The mesh has
/// a part of that.
float lean_at(float angle) {
  const float cornea = 0.60f * angle * eased(0.50f, 0.40f, angle);
  const float t = saturate((0.50f - angle) / 0.45f);
  return std::max(cornea - 0.125f * 4 * t * (1 - t), 0.0f);
}

}  // namespace

EyeMaps make_eye_maps(Color color, int size) {
  EyeMaps maps = {Image(size, size, {}), Image(size / 2, size / 2, {})};
  const Vec3 iris = {float(color.r), float(color.g), float(color.b)};
  const auto byte = [](float value) {
    return uint8_t(std::lround(std::min(std::max(value, 0.0f), 255.0f)));
  };
  const auto each = [&](Image& image, auto value_of) {
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const Gaze at = gaze_at((float(x) + 0.5f) / float(image.width),
                                1 - (float(y) + 0.5f) / float(image.height));
        const Vec3 c = value_of(at);
        image.set(x, y, {byte(c.x), byte(c.y), byte(c.z)});
      }
    }
  };
  each(maps.base_color, [&](const Gaze& at) {
    if (at.angle > kSeen) return Vec3{196, 140, 128};  // and beyond that it costs nothing
    return mix(iris_color(at, iris), white_color(at, iris),
               eased(kLimbus - 0.015f, kLimbus + 0.015f, at.angle));
  });
  each(maps.normal, [](const Gaze& at) {
    const float lean = lean_at(at.angle);
    const Vec3 n = normalized(Vec3{at.x * lean, at.y * lean, 1}, {0, 0, 1});
    return (n + Vec3{1, 1, 1}) * 127.5f;
  });
  return maps;
}

}  // namespace mien::render
