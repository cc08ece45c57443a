// SPDX-License-Identifier: MIT
#include "integrations/program/render/render.h"

#include "integrations/program/render/light.h"
#include "integrations/program/render/occlusion.h"
#include "integrations/program/render/scene.h"
#include "integrations/program/render/visibility.h"

namespace mien::render {

using namespace math;

namespace {

constexpr int kShadowSize = 1024, kRimShadowSize = 512;
constexpr float kKeySoftness = 0.17f, kRimSoftness = 0.1f;
// As shares of the subject: how far hollows reach, and what is at about one depth.
constexpr float kHollow = 0.09f, kSameDepth = 0.01f;
constexpr Vec3 kWire = {0.02f, 0.022f, 0.026f};

/// Samples of a pixel that show one surface at about one depth: shaded once.
struct Patch {
  uint32_t number;  // of the triangle that has most of them
  uint32_t samples;
  float depth;
  float x, y;  // middle of those of that triangle, within the pixel
};

class PixelPatches {
 public:
  PixelPatches(const Scene& scene, const Visibility& seen, bool each_triangle)
      : scene_(scene), seen_(seen), pattern_(sample_pattern(seen.samples)),
        each_triangle_(each_triangle) {}

  /// Patches of a pixel, largest first. Returns the number of samples that show none.
  int find(size_t pixel) {
    count_ = 0;
    const size_t n = size_t(seen_.samples);
    const Seen* seen = &seen_.seen[pixel * n];
    uint32_t any = 0;
    for (size_t s = 0; s < n; ++s) any |= seen[s].triangle;
    if (any == 0) return seen_.samples;
    int empty = 0;
    for (size_t s = 0; s < n; ++s) {
      if (seen[s].triangle == 0) {
        ++empty;
      } else {
        add(seen, s);
      }
    }
    for (int p = 1; p < count_; ++p) {
      if (patches_[p].samples > patches_[0].samples) std::swap(patches_[0], patches_[p]);
    }
    return empty;
  }

  const Patch* begin() const { return patches_; }
  const Patch* end() const { return patches_ + count_; }

 private:
  void add(const Seen* seen, size_t s) {
    const uint32_t number = seen[s].triangle;
    for (int p = 0; p < count_; ++p) {
      if (joins(patches_[p], number, seen[s].depth)) {
        ++patches_[p].samples;
        return;
      }
    }
    Patch& patch = patches_[count_++];
    patch = {number, 1, seen[s].depth, 0, 0};
    float x = 0, y = 0, same = 0;
    for (size_t i = s; i < size_t(seen_.samples); ++i) {
      if (seen[i].triangle != number) continue;
      x += pattern_.places[i][0];
      y += pattern_.places[i][1];
      ++same;
    }
    patch.x = x / (same * 256);
    patch.y = y / (same * 256);
  }

  bool joins(const Patch& patch, uint32_t number, float depth) const {
    if (patch.number == number) return true;
    if (each_triangle_) return false;
    // Neighbors on a smooth surface; depths are inverse distances, so the tolerance is a share.
    return std::fabs(depth - patch.depth) < 0.002f * patch.depth &&
           &scene_.surface_of(number) == &scene_.surface_of(patch.number);
  }

  const Scene& scene_;
  const Visibility& seen_;
  SamplePattern pattern_;
  bool each_triangle_;
  int count_ = 0;
  Patch patches_[16];
};

/// From the middle of the image outwards.
class BackdropLight {
 public:
  BackdropLight(const Backdrop& backdrop, int width, int height)
      : center_(to_linear(backdrop.center)), edge_(to_linear(backdrop.edge)), width_(width),
        height_(height) {}

  Vec3 at(int x, int y) const {
    const float u = (float(x) + 0.5f) / float(width_) - 0.5f;
    const float v = (float(y) + 0.5f) / float(height_) - 0.44f;
    const float t = saturate((u * u + v * v) * 2.1f);
    return mix(center_, edge_, t * (2 - t));
  }

 private:
  Vec3 center_, edge_;
  int width_, height_;
};

/// How much of a line of the wireframe a fragment shows, 0..1.
float wire_cover(const Fragment& f, const Lens& lens, float px, float py) {
  Vec3 p[3];
  f.on->triangles().corner_positions(f.triangle, p);
  const uint8_t inner = f.on->surface.inner_edges ? f.on->surface.inner_edges[f.triangle] : 0;
  float x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    if (p[k].z > -lens.near) return 0;
    x[k] = lens.center_x + p[k].x / -p[k].z * lens.focal;
    y[k] = lens.center_y - p[k].y / -p[k].z * lens.focal;
  }
  float nearest = 1e9f;
  for (int k = 0; k < 3; ++k) {
    if (inner >> k & 1) continue;
    const int next = (k + 1) % 3;
    const float dx = x[next] - x[k], dy = y[next] - y[k];
    const float along = std::sqrt(dx * dx + dy * dy);
    if (along > 0)
      nearest = std::min(nearest, std::fabs(dx * (py - y[k]) - dy * (px - x[k])) / along);
  }
  return saturate(1.05f - nearest) * 0.7f;
}

/// What stands before the lamps.
struct Shadows {
  ShadowMap key;
  ShadowMap rims[kRimCount];

  explicit Shadows(const Scene& scene)
      : key(scene, key_direction(), kShadowSize, kKeySoftness),
        rims{{scene, rim_direction(0), kRimShadowSize, kRimSoftness},
             {scene, rim_direction(1), kRimShadowSize, kRimSoftness}} {}

  Arriving on(const Fragment& f, int turn) const {
    // Where a rim light does not show, there is none to be evened out with that of neighbors.
    Arriving arriving = {key.light_at(f.place, f.smooth, turn), {}};
    for (int i = 0; i < kRimCount; ++i) {
      if (has_rim(f, i)) arriving.rims[i] = rims[i].light_at(f.place, f.smooth, turn);
    }
    return arriving;
  }
};

/// The fragment that the layer was made of.
Fragment layer_fragment(const Scene& scene, const PixelLayer& layer, size_t pixel, uint32_t number,
                        Vec3 ray) {
  const PlacedSurface& on = scene.surface_of(number);
  const Vec3 place = ray * layer.distance[pixel];
  return {&on,
          number - on.first_number,
          place,
          layer.normal[pixel],
          normalized(-place, {0, 0, 1}),
          layer.color[pixel],
          layer.roughness[pixel],
          layer.smooth[pixel],
          layer.bend[pixel]};
}

}  // namespace

Image render_image(const std::vector<Surface>& surfaces, const Camera& camera,
                   const RenderOptions& options) {
  const Lens lens = make_lens(camera, options.width, options.height);
  const Scene scene(surfaces, camera, 1 / lens.focal, options.scale);
  const float scale = scene.scale();
  const auto ray_at = [&](float x, float y) {
    return Vec3{(x - lens.center_x) / lens.focal, (lens.center_y - y) / lens.focal, -1};
  };

  Visibility seen;
  seen.reset(options.width, options.height, options.samples);
  const Coverage coverage = [&](uint32_t number, float x, float y) {
    return scene.alpha(number, {}, ray_at(x, y));
  };
  for (const PlacedSurface& surface : scene.surfaces()) {
    draw(surface.triangles(), lens, seen, surface.hides_all() ? Coverage() : coverage);
  }
  const Shadows shadows(scene);

  PixelLayer layer{options.width, options.height, {}, {}, {}, {}, {}, {}};
  layer.distance.resize(size_t(options.width) * size_t(options.height));
  layer.normal.resize(layer.distance.size());
  layer.smooth.resize(layer.distance.size());
  layer.color.resize(layer.distance.size());
  layer.roughness.resize(layer.distance.size());
  layer.bend.resize(layer.distance.size());
  std::vector<float> lit[1 + kRimCount];
  for (std::vector<float>& of_lamp : lit) of_lamp.assign(layer.distance.size(), 1.0f);
  PixelPatches patches(scene, seen, options.wireframe);
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x) {
      const size_t pixel = layer.index(x, y);
      if (patches.find(pixel) == seen.samples) continue;
      const Patch& patch = *patches.begin();
      const Fragment f =
          scene.fragment(patch.number, ray_at(float(x) + patch.x, float(y) + patch.y));
      layer.distance[pixel] = -f.place.z;
      layer.normal[pixel] = f.normal;
      layer.smooth[pixel] = f.smooth;
      layer.color[pixel] = f.color;
      layer.roughness[pixel] = f.roughness;
      layer.bend[pixel] = f.bend;
      const Arriving arriving = shadows.on(f, turn_of(x, y));
      lit[0][pixel] = arriving.key;
      for (int i = 0; i < kRimCount; ++i) lit[1 + i][pixel] = arriving.rims[i];
    }
  }
  const std::vector<float> openness = find_openness(layer, lens, scale * kHollow);
  for (std::vector<float>& of_lamp : lit) even_out(layer, of_lamp, scale * kSameDepth);

  Image image(options.width, options.height, {});
  const BackdropLight backdrop(options.backdrop, options.width, options.height);
  for (int y = 0; y < options.height; ++y) {
    if (options.progress) options.progress(float(y) / float(options.height));
    for (int x = 0; x < options.width; ++x) {
      const size_t pixel = layer.index(x, y);
      const int empty = patches.find(pixel);
      if (empty == seen.samples) {
        image.set(x, y, to_srgb(backdrop.at(x, y)));
        continue;
      }
      Vec3 sum;
      if (empty > 0) sum = backdrop.at(x, y) * float(empty);
      for (const Patch& patch : patches) {
        const float px = float(x) + patch.x, py = float(y) + patch.y;
        const Vec3 ray = ray_at(px, py);
        const bool known = &patch == patches.begin();
        const Fragment f = known ? layer_fragment(scene, layer, pixel, patch.number, ray)
                                 : scene.fragment(patch.number, ray);
        Arriving arriving;
        if (known) {
          arriving.key = lit[0][pixel];
          for (int i = 0; i < kRimCount; ++i) arriving.rims[i] = lit[1 + i][pixel];
        } else {
          arriving = shadows.on(f, turn_of(x, y));
        }
        Vec3 color = tone(light(f, openness[pixel], arriving));
        if (options.wireframe) color = mix(color, kWire, wire_cover(f, lens, px, py));
        sum += color * float(patch.samples);
      }
      image.set(x, y, to_srgb(sum * (1 / float(seen.samples))));
    }
  }
  return image;
}

}  // namespace mien::render
