// SPDX-License-Identifier: MIT
// Eyeballs; functions that all parts share.
#include <algorithm>

#include "author/generate/head/mesh.h"

namespace mien::head {

using author::clamp01;
using author::exact_atan2;
using author::exact_cosine;
using author::exact_pow;
using author::exact_sine;
using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

void join_rows(HalfMesh& out, uint32_t first, uint32_t rows, uint32_t columns) {
  for (uint32_t row = 0; row + 1 < rows; ++row) {
    for (uint32_t column = 0; column + 1 < columns; ++column) {
      const uint32_t at = first + row * columns + column;
      out.quad(at, at + 1, at + columns + 1, at + columns);
    }
  }
}

uint32_t at_lod(uint32_t full, uint32_t least, uint32_t lod) {
  static constexpr double kShare[kLodCount] = {1, 0.7, 0.5, 0.38, 0.27, 0.2, 0.15, 0.1};
  return std::max(least, static_cast<uint32_t>(full * kShare[lod] + 0.5));
}

double scatter(uint32_t i) {
  uint32_t h = i * 2654435761u;
  h = (h ^ h >> 15) * 2246822519u;
  return static_cast<double>((h ^ h >> 13) >> 8) * (2.0 / 16777216) - 1;
}

Vertex plain(Vec3 position, Color color, double u, double v, Carrier carrier) {
  Vertex out;
  out.position = out.closed = out.look = position;
  out.color = color;
  out.u = u;
  out.v = v;
  out.carrier = carrier;
  return out;
}

// Eyes ------------------------------------------------------------------------------------------

/// Distance from the middle of the texture by the angle from the pupil: what lids may uncover takes up most of it.
/// Irises of all sizes are as large there.
static double eye_texture_radius(double angle) {
  constexpr double kSeen = 1.25, kShare = 0.45;
  return angle < kSeen ? kShare * angle / kSeen : mix(kShare, 0.5, (angle - kSeen) / (kPi - kSeen));
}

void add_eyeball(const Form& form, HalfMesh& out) {
  // Angle from the middle of the pupil, on a ball of the size of people's; the iris has that size on the larger ball.
  static constexpr double kAngles[] = {0.08, 0.155, 0.172, 0.25, 0.33, 0.39, 0.425, 0.465,
                                       0.55, 0.65,  0.76,  0.9,  1.1,  1.4,  1.9,   2.6};
  constexpr uint32_t rings = 16, around = 48;
  out.mirrored = false;
  const Color iris = form.person().iris;
  const double light = clamp01((iris.r + iris.g + iris.b) / 300);  // dark ones keep dark
  const Vec3 middle = form.eye();
  const double iris_scale = 0.875 * form.person().iris_size;
  const auto on_ball = [&](double angle) { return angle < 0.6 ? angle * iris_scale : angle; };
  // The upper lid shades what is below its edge.
  const auto shade_at = [&](double angle, uint32_t k) {
    const auto [sk, ck] = exact_sine_cosine(2 * kPi * k / around);
    const double across = kEyeRadius * exact_sine(angle), dx = across * ck, x = kEye.x + dx;
    const double line = form.lid_line(x) - kEye.y;
    const double lid_z = std::sqrt(std::max(0.04, kLidRadius * kLidRadius - dx * dx - line * line));
    const double edge = exact_atan2(line, lid_z) + form.upper_opening(x);
    const double here = exact_atan2(across * sk, kEyeRadius * exact_cosine(angle));
    return smooth_step(0.26, -0.02, edge - here);
  };
  const auto color = [&](double angle, uint32_t k) -> Color {
    const Color pupil = {14, 12, 14}, white = {196, 188, 180};
    if (angle < 0.16) return pupil;
    const double high = 0.5 + 0.5 * exact_sine(2 * kPi * k / around);  // 1 above the pupil
    const double shade = shade_at(on_ball(angle), k);
    if (angle < 0.44) {
      // Darker above, in the shadow of the lid and of the limbus, lighter below, where the cornea gathers light;
      // a ring of another shade around the pupil; streaks.
      const double streak = 0.07 * exact_sine(2.0 * kPi * 13 * k / around) +
                            0.05 * exact_sine(2.0 * kPi * 7 * k / around + 5 * angle);
      Color c = mix(iris, {206, 186, 140}, light * clamp01(0.30 * (1 - high) + streak));
      c = mix(c, {110, 74, 40}, 0.40 * light * smooth_step(0.27, 0.17, angle));
      c = mix(c, {20, 21, 26}, 0.80 * smooth_step(0.32, 0.43, angle));
      return mix(c, {14, 14, 18}, 0.80 * shade);
    }
    // The limbus is soft; the white is shaded by the upper lid, pink towards the corners, and has veins, which
    // end before the iris.
    const double turn = 2 * kPi * k / around;
    Color c = mix(white, mix(iris, {60, 58, 62}, 0.6), 0.60 * smooth_step(0.58, 0.44, angle));
    c = mix(c, {214, 196, 160},
            0.22 * smooth_step(0.6, 0.9, angle) * (0.5 + 0.5 * exact_sine(3 * turn + 2)));
    c = mix(c, {168, 128, 118}, 0.30 * smooth_step(0.40, 0.05, high));
    const double vein = exact_sine(11 * turn + 6 * angle) * exact_sine(5 * turn - 9 * angle);
    c = mix(c, {198, 96, 88}, 0.30 * smooth_step(0.62, 0.9, angle) * smooth_step(0.35, 0.9, vein));
    c = mix(c, {190, 116, 106}, 0.72 * smooth_step(0.62, 1.08, angle));
    return mix(c, {70, 44, 40}, 0.75 * shade);
  };
  // The cornea stands out beyond the ball, from the limbus on, as far as the lids leave room.
  const auto bulge = [](double angle) { return 0.06 * smooth_step(0.50, 0.05, angle); };
  const uint32_t front = out.vertices.add(
      plain(middle + Vec3{0, 0, kEyeRadius + bulge(0)}, {14, 12, 14}, 0.5, 0.5, Carrier::kEyeball));
  uint32_t before = front;
  for (uint32_t r = 0; r < rings; ++r) {
    const double angle = on_ball(kAngles[r]);
    const auto [s, c] = exact_sine_cosine(angle);
    const uint32_t here = out.vertices.count();
    for (uint32_t k = 0; k < around; ++k) {
      const auto [sk, ck] = exact_sine_cosine(2 * kPi * k / around);
      const Vec3 at = middle + Vec3{ck * s, sk * s, c} * (kEyeRadius + bulge(angle));
      const double wide = eye_texture_radius(kAngles[r]);
      out.vertices.add(
          plain(at, color(kAngles[r], k), 0.5 + wide * ck, 0.5 + wide * sk, Carrier::kEyeball));
    }
    for (uint32_t k = 0; k < around; ++k) {
      const uint32_t next = (k + 1) % around;
      if (r == 0) {
        out.triangle(front, here + k, here + next);
      } else {
        out.quad(before + k, here + k, here + next, before + next);
      }
    }
    before = here;
  }
  const uint32_t pole = out.vertices.add(
      plain(middle + Vec3{0, 0, -kEyeRadius}, {214, 150, 140}, 0.5, 0.99, Carrier::kEyeball));
  for (uint32_t k = 0; k < around; ++k) out.triangle(before + (k + 1) % around, before + k, pole);
}

// Together --------------------------------------------------------------------------------------

void set_normals(HalfMesh& mesh) {
  for (const Face& f : mesh.faces.span()) {
    // Area-weighted, from the diagonals of a quad.
    const auto at = [&](int i) { return mesh.vertices[f.corners[i]].position; };
    const Vec3 a = f.count == 4 ? at(2) - at(0) : at(1) - at(0);
    const Vec3 b = f.count == 4 ? at(3) - at(1) : at(2) - at(0);
    const Vec3 n = cross(a, b);
    for (uint32_t i = 0; i < f.count; ++i) {
      Vertex& v = mesh.vertices[f.corners[i]];
      v.normal = v.normal + n;
    }
  }
  for (uint32_t i = 0; i < mesh.vertices.count(); ++i) {
    Vertex& v = mesh.vertices[i];
    if (mesh.on_plane(i)) v.normal.x = 0;
    v.normal = length(v.normal) > 0 ? unit(v.normal) : Vec3{0, 1, 0};
  }
}

namespace {

bool finish(const Form& form, HalfMesh& out) {
  if (out.failed()) return false;
  for (uint32_t i = 0; i < out.vertices.count(); ++i) {
    Vertex& v = out.vertices[i];
    v.above_mouth = v.look.y - form.mouth_line(v.look.x);
    v.number = i;
    if (v.carrier != Carrier::kSkin) continue;
    v.closed = form.spread_eyes(v.closed, v.look);
    v.position = form.spread_eyes(v.position, v.look);
  }
  set_normals(out);
  return true;
}

}  // namespace

bool make_hairs(const Form& form, Part part, uint32_t lod, HalfMesh& out) {
  if (part == Part::kHair) {
    add_hair(form, lod, out);
  } else if (part == Part::kBrows) {
    add_brow(form, lod, out);
  } else {
    add_lashes(form, lod, out);
  }
  return finish(form, out);
}

bool make_part(const Form& form, Part part, HalfMesh& out) {
  switch (part) {
    case Part::kHead: add_skin(form, out); break;
    case Part::kTeeth: add_teeth(form, out); break;
    case Part::kTongue: add_tongue(form, out); break;
    case Part::kEyeLeft:
    case Part::kEyeRight: add_eyeball(form, out); break;
    case Part::kHair:
    case Part::kBrows:
    case Part::kLashes: return make_hairs(form, part, 0, out);
  }
  return finish(form, out);
}

}  // namespace mien::head
