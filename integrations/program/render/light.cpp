// SPDX-License-Identifier: MIT
#include "integrations/program/render/light.h"

namespace mien::render {

using namespace math;

namespace {

struct Lamp {
  Vec3 direction, color;
};

const Lamp kKey = {normalized(Vec3{-0.52f, 0.58f, 0.74f}, {}), {1.16f, 1.07f, 0.97f}};
const Lamp kFill = {normalized(Vec3{0.85f, 0.05f, 0.62f}, {}), {0.20f, 0.205f, 0.21f}};
const Lamp kRims[kRimCount] = {
    {normalized(Vec3{0.82f, 0.42f, -0.62f}, {}), {0.82f, 0.93f, 1.08f}},
    {normalized(Vec3{-0.80f, 0.30f, -0.75f}, {}), {0.42f, 0.46f, 0.52f}}};
constexpr Vec3 kSkyAbove = {0.27f, 0.30f, 0.345f};
constexpr Vec3 kSkyBelow = {0.13f, 0.105f, 0.092f};

float smooth_step(float from, float to, float x) {
  const float t = saturate((x - from) / (to - from));
  return t * t * (3 - 2 * t);
}

/// Lambert's cosine, reaching `around` past the terminator, with the same light in all.
float wrap(float cosine, float around) {
  const float t = saturate((cosine + around) / (1 + around));
  return t * t * (1 - around) + t * around * 0.9f + (1 - around) * std::max(cosine, 0.0f) * (1 - t);
}

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

bool has_rim(const Fragment& f, float openness, int rim) {
  return rim_strength(f, openness, kRims[rim]) > 1e-3f;
}

Vec3 light(const Fragment& f, float openness, const Arriving& arriving) {
  const Material& m = f.on->surface.material;
  const Vec3 open = bounced(openness, f.color);
  const float soft = m.softness, facing_eye = dot(f.normal, f.to_eye), nv = saturate(facing_eye);
  // A normal that is turned away belongs to a fold whose other side hides what it would mirror.
  const float shown = smooth_step(-0.4f, 0.0f, facing_eye);

  // Red light goes furthest through skin: it reaches around more, colors the terminator, and sees least of small bumps,
  // for which each color has a normal of its own (Ma et al. 2007, "Rapid acquisition of specular and diffuse normal
  // maps from polarized spherical gradient illumination").
  const float cosine = dot(f.normal, kKey.direction), smooth = dot(f.smooth, kKey.direction);
  const auto spread = [&](float share) {
    return cosine + (smooth - cosine) * saturate(share * soft);
  };
  // Where a surface turns away it shades itself; there the cosine decides, not the map.
  const float seen = std::max(arriving.key, 1 - smooth_step(-soft, 0.2f, cosine));
  const float bleed = 0.5f * soft * seen * (1 - seen);
  const Vec3 around = {wrap(spread(2.4f), soft) * (seen + bleed),
                       wrap(spread(1.6f), soft * 0.55f) * seen,
                       wrap(spread(1.2f), soft * 0.42f) * (seen - 0.3f * bleed)};
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
