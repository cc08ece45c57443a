// SPDX-License-Identifier: MIT
#include "integrations/program/render/light.h"

namespace mien::render {

using namespace math;

namespace {

struct Lamp {
  Vec3 direction, color;
};

const Lamp kKey = {normalized(Vec3{-0.52f, 0.58f, 0.74f}, {}), {1.10f, 1.02f, 0.93f}};
const Lamp kFill = {normalized(Vec3{0.85f, 0.05f, 0.62f}, {}), {0.285f, 0.265f, 0.255f}};
const Lamp kRims[kRimCount] = {
    {normalized(Vec3{0.82f, 0.42f, -0.62f}, {}), {0.82f, 0.93f, 1.08f}},
    {normalized(Vec3{-0.80f, 0.30f, -0.75f}, {}), {0.42f, 0.46f, 0.52f}}};
constexpr Vec3 kSkyAbove = {0.365f, 0.350f, 0.355f};
constexpr Vec3 kSkyBelow = {0.260f, 0.168f, 0.130f};

// Of skin, in 1 / mm, and times its own curvature.
constexpr float kLeastBend = 0.25f, kMoreBend = 6;

float smooth_step(float from, float to, float x) {
  const float t = saturate((x - from) / (to - from));
  return t * t * (3 - 2 * t);
}

/// Lambert's cosine, reaching `around` past the terminator, with the same light in all.
float wrap(float cosine, float around) {
  const float t = saturate((cosine + around) / (1 + around));
  return t * t * (1 - around) + t * around * 0.9f + (1 - around) * std::max(cosine, 0.0f) * (1 - t);
}

/// Diffuse light of a large lamp on skin, by the cosine towards it and by the curvature of the skin: what arrives
/// before the terminator goes on under the skin, red farthest (Penner 2011, "Pre-integrated skin shading"), by the six
/// Gaussians that d'Eon and Luebke fitted to measurements (GPU Gems 3, 2007, chapter 14).
class SkinFalloff {
 public:
  SkinFalloff() {
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const float angle = std::acos(2 * float(column) / (kColumns - 1) - 1);
        table_[row][column] = blurred(angle, kMostBend * float(row) / (kRows - 1));
      }
    }
  }

  /// `bend` is a curvature in 1 / mm.
  Vec3 at(float cosine, float bend) const {
    const float x = saturate(0.5f + 0.5f * cosine) * (kColumns - 1);
    const float y = saturate(bend / kMostBend) * (kRows - 1);
    const int column = std::min(int(x), kColumns - 2), row = std::min(int(y), kRows - 2);
    const float u = x - float(column), v = y - float(row);
    return mix(mix(table_[row][column], table_[row][column + 1], u),
               mix(table_[row + 1][column], table_[row + 1][column + 1], u), v);
  }

 private:
  static constexpr int kRows = 12, kColumns = 64;
  static constexpr float kMostBend = 0.25f;

  /// Lambert's cosine, as a mean over the width of the lamp.
  static float of_lamp(float angle) {
    constexpr float kHalf = 0.5f, kPi = 3.14159265f;
    angle = std::fabs(angle);
    if (angle > kPi) angle = 2 * kPi - angle;
    const auto sum = [](float to) { return std::sin(std::min(std::max(to, -kPi / 2), kPi / 2)); };
    return (sum(angle + kHalf) - sum(angle - kHalf)) / (2 * kHalf);
  }

  static Vec3 blurred(float angle, float bend) {
    struct Gauss {
      float deviation;  // mm
      Vec3 weight;
    };
    static constexpr Gauss kSum[] = {
        {0.080f, {0.233f, 0.455f, 0.649f}}, {0.220f, {0.100f, 0.336f, 0.344f}},
        {0.432f, {0.118f, 0.198f, 0.0f}},   {0.753f, {0.113f, 0.007f, 0.007f}},
        {1.411f, {0.358f, 0.004f, 0.0f}},   {2.722f, {0.078f, 0.0f, 0.0f}}};
    constexpr int kSteps = 8;
    Vec3 light;
    for (const Gauss& g : kSum) {
      float sum = 0, weights = 0;
      for (int i = -kSteps; i <= kSteps; ++i) {
        const float x = 2.5f * float(i) / kSteps, weight = std::exp(-0.5f * x * x);
        sum += weight * of_lamp(angle + std::min(std::max(x * g.deviation * bend, -1.5f), 1.5f));
        weights += weight;
      }
      light += g.weight * (sum / weights);
    }
    return light;
  }

  Vec3 table_[kRows][kColumns];
};

float fresnel(float cosine) {
  const float x = 1 - saturate(cosine), squared = x * x;
  return squared * squared * x;
}

/// GGX distribution over four times its visibility, in the form with the half vector only.
float glint(Vec3 normal, Vec3 half, float light_half, float roughness) {
  const float a = roughness * roughness, nh = saturate(dot(normal, half));
  const float d = nh * nh * (a * a - 1) + 1;
  return a * a / (d * d * std::max(0.1f, light_half * light_half) * (4 * roughness + 2));
}

float highlight(const Fragment& f, const Lamp& lamp, const Material& material) {
  const float cosine = dot(f.normal, lamp.direction);
  if (cosine <= 0) return 0;
  const Vec3 half = normalized(lamp.direction + f.to_eye, f.normal);
  const float light_half = saturate(dot(lamp.direction, half));
  const float strength = material.reflectance + (1 - material.reflectance) * fresnel(light_half);
  // Two lobes: a sharp one on a soft one, as films on skin and eyes give.
  const float sharp = glint(f.normal, half, light_half, f.roughness);
  const float soft = glint(f.normal, half, light_half, std::min(1.0f, f.roughness * 2 + 0.1f));
  return strength * (0.55f * sharp + 0.45f * soft) * cosine;
}

/// Light that comes back from the walls of a hollow takes on their color (Jimenez et al. 2016,
/// "Practical realtime strategies for accurate indirect occlusion", the cubic fit there).
Vec3 bounced(float openness, Vec3 color) {
  const auto one = [&](float albedo) {
    const float a = 2.0404f * albedo - 0.3324f, b = -4.7951f * albedo + 0.6417f;
    const float c = 2.7552f * albedo + 0.6903f;
    return std::max(openness, ((openness * a + b) * openness + c) * openness);
  };
  return {one(color.x), one(color.y), one(color.z)};
}

/// Light from behind shows on edges; not in folds, where the other side stands before it.
float rim_strength(const Fragment& f, float openness, const Lamp& rim) {
  const float facing_eye = dot(f.normal, f.to_eye), edge = 1 - saturate(facing_eye);
  const float facing = std::max(dot(f.normal, rim.direction) + 0.15f, 0.0f);
  return edge * edge * edge * facing * smooth_step(-0.4f, 0.0f, facing_eye) *
         smooth_step(0.35f, 0.85f, openness);
}

}  // namespace

Vec3 key_direction() { return kKey.direction; }
Vec3 rim_direction(int rim) { return kRims[rim].direction; }

bool has_rim(const Fragment& f, int rim) { return rim_strength(f, 1, kRims[rim]) > 1e-3f; }

Vec3 light(const Fragment& f, float openness, const Arriving& arriving) {
  static const SkinFalloff falloff;
  const Material& m = f.on->surface.material;
  const Vec3 open = bounced(openness, f.color);
  const float soft = m.softness, facing_eye = dot(f.normal, f.to_eye), nv = saturate(facing_eye);
  // A normal that is turned away belongs to a fold whose other side hides what it would mirror.
  const float shown = smooth_step(-0.4f, 0.0f, facing_eye);

  // Red light sees least of small bumps: each color has a normal of its own (Ma et al. 2007, "Rapid acquisition of
  // specular and diffuse normal maps from polarized spherical gradient illumination").
  const float cosine = dot(f.normal, kKey.direction), smooth = dot(f.smooth, kKey.direction);
  const auto spread = [&](float share) {
    return cosine + (smooth - cosine) * saturate(share * soft);
  };
  // Pictures show less than the eye: skin is as translucent as if it were bent more.
  const float bend = (kLeastBend + kMoreBend * f.bend) * soft;
  // Where a surface turns away it shades itself; there the cosine decides, not the map.
  const float seen = std::max(arriving.key, 1 - smooth_step(-0.25f, 0.25f, smooth));
  // Light goes under the border of a shadow, too.
  const float under = soft * seen * (1 - seen);
  const Vec3 around = {falloff.at(spread(2.4f), bend).x * (seen + 1.5f * under),
                       falloff.at(spread(1.6f), bend).y * (seen + 0.3f * under),
                       falloff.at(spread(1.2f), bend).z * (seen + 0.1f * under)};
  Vec3 diffuse = kKey.color * around * mix(open, {1, 1, 1}, 0.6f);
  diffuse += kFill.color * open * wrap(dot(f.normal, kFill.direction), 0.5f);
  diffuse += mix(kSkyBelow, kSkyAbove, 0.5f + 0.5f * f.normal.y) * open;

  const float gloss_open = saturate(openness * 1.2f) * shown;
  Vec3 shine = kKey.color * (highlight(f, kKey, m) * seen * gloss_open * 1.5f);
  shine += kFill.color * (highlight(f, kFill, m) * gloss_open * 1.5f);
  for (int i = 0; i < kRimCount; ++i) {
    const Lamp& rim = kRims[i];
    const float turned = 1 - smooth_step(-0.15f, 0.25f, dot(f.normal, rim.direction));
    const float strength = rim_strength(f, openness, rim) * std::max(arriving.rims[i], turned);
    diffuse += rim.color * (strength * 0.75f);
    shine += rim.color * (strength * (1 - nv) * 0.10f);
  }
  // The sky in a wet surface; what the key light does not reach, such as molars, sees little of it.
  shine +=
      kSkyAbove * ((m.reflectance + (1 - m.reflectance) * fresnel(nv)) * (1 - f.roughness) *
                   gloss_open * (0.25f + 0.75f * seen) * (0.35f + 0.65f * saturate(f.normal.y)));
  return f.color * diffuse + shine;
}

Vec3 tone(Vec3 linear) {
  constexpr float kStart = 0.6f;
  const auto one = [](float x) {
    if (!(x > kStart)) return x;
    const float over = (x - kStart) / (1 - kStart);
    return kStart + (1 - kStart) * over / (1 + over);
  };
  return {one(linear.x), one(linear.y), one(linear.z)};
}

}  // namespace mien::render
