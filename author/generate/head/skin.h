// SPDX-License-Identifier: MIT
// The skin. A layout of places on the form (see cage.h) goes around eyes, mouth, nostrils and ears; rings
// continue it from the border of lids and lips (crease of the lids, red of the lips) to the slit between them:
//
//      +--+--+--+--+     k counts the vertices of a ring against the clock as seen from the front,
//      |\  rings  /|     from the inner corner of the eye, or from the middle below the mouth
//      +-  -slit- -+     (whose other half is the mirror image), so that 0 < k < n is below the
//      |/         \|     slit, k = n its outer corner, and what is beyond that above
//      +--+--+--+--+
#pragma once

#include <algorithm>
#include <cmath>

#include "author/generate/head/cage.h"

namespace mien::head {

// The texture: skin by angle and row. The middle of the face has 1.8 times the texels that even steps would give it, the
// nape and the crown about half.
constexpr double kDenseInFront = 0.8, kMiddleRow = -3;

/// -1 ... 1, from even steps to those of the texture, and back.
inline double denser(double even) {
  return even * (1 + kDenseInFront) / (1 + kDenseInFront * std::abs(even));
}
inline double even_again(double dense) {
  return dense / (1 + kDenseInFront - kDenseInFront * std::abs(dense));
}
inline double u_of_angle(double angle) { return 0.5 + 0.5 * denser(angle / author::kPi); }
inline double angle_of_u(double u) { return author::kPi * even_again(2 * u - 1); }
inline double v_of_row(double y) {
  // The ends are not at 0 and 1, where a texture that repeats has its other end.
  constexpr double kBottom = 0.002, kCrown = 0.998;
  const double span = y > kMiddleRow ? kCrownY - kMiddleRow : kMiddleRow - kBottomY;
  const double v =
      (kMiddleRow - kBottomY + span * denser((y - kMiddleRow) / span)) / (kCrownY - kBottomY);
  return std::min(std::max(v, kBottom), kCrown);
}

struct Rings {
  uint32_t outside, inside;  // of the border between
};

constexpr Segments kSkinSegments = {8, 10, 16, 14, 8, 22, 10, 9, 7, 6, 18, 2, 5, 12, 26, 14, 10};
constexpr Rings kMouthRings = {8, 8}, kEyeRings = {7, 8};
constexpr uint32_t kMouthDepth = 9;  // rings into the mouth

class SkinMaker {
 public:
  SkinMaker(const Form& form, HalfMesh& out);

  void make();

 private:
  /// `lid`: the side of the eye's slit; `lip`: that of the mouth's.
  Vertex skin_vertex(Place place, Side lid, Side lip) const;

  uint32_t add_on_plane(Vertex v) {
    v.closed.x = v.look.x = v.position.x = 0;
    return out_.vertices.add(v);
  }
  /// A vertex for each spot of the layout, under the same number.
  void make_vertices();
  void make_faces();

  // Rings ---------------------------------------------------------------------------------------

  /// The plane of the ear, at an angle to the head, and its size.
  struct Ear {
    Vec3 origin, back, up, outward;
    double size = 1;
  };
  void place_ear();

  Place lid_place(uint32_t k, bool inner) const;
  Place lip_place(uint32_t k, bool inner) const;
  Place nostril_place(uint32_t k, bool inner) const;
  Place ear_place(uint32_t k, bool inner) const;

  /// Rings from the border of lids or lips, or of another opening, inwards. `ring_` is the last one then.
  template <class Curve>
  void make_rings(const Ring& border, uint32_t count, Layout::Hole hole, const Curve& curve) {
    ring_size_ = border.count;
    half_ = border.half;
    std::copy(border.at, border.at + ring_size_, ring_);
    const bool slit = hole != Layout::Hole::kOther;
    for (uint32_t r = 1; r <= count; ++r) {
      uint32_t next[kMaxRing];
      for (uint32_t k = 0; k < ring_size_; ++k) {
        // Dense where skin rolls inwards.
        const double left = 1 - static_cast<double>(r) / count;
        const double t = 1 - left * left;
        const Place place = between(curve(k, false), curve(k, true), t);
        const Side side = k > half_ ? Side::kAbove : Side::kBelow;
        Vertex v = skin_vertex(place, hole == Layout::Hole::kLids ? side : Side::kBelow,
                               hole == Layout::Hole::kLips ? side : Side::kAbove);
        v.edge = slit && r == count && k != half_ && !(border.whole && k == 0);
        next[k] = !border.whole && (k == 0 || k + 1 == ring_size_) ? add_on_plane(v)
                                                                   : out_.vertices.add(v);
      }
      for (uint32_t k = 0; k + (border.whole ? 0 : 1) < ring_size_; ++k) {
        const uint32_t other = (k + 1) % ring_size_;
        out_.quad(ring_[k], ring_[other], next[other], next[k]);
      }
      std::copy(next, next + ring_size_, ring_);
    }
  }

  void make_eye();

  /// From the edge of a lid inwards, to the surface of the eyeball or until behind it; in the inner corner over
  /// it to the other lid's edge, which makes the pink flesh there.
  uint32_t lid_edge_vertex(uint32_t from, Color color, bool at_ball);

  void make_lid_edges();

  void make_nostril();
  Place ear_root(double sine, double cosine, double size) const;
  void make_ear();

  /// One ring into the mouth from a vertex of the lips. Above: behind the lip, up in front of the gums, along
  /// the palate and down to the throat; below likewise. `out`: towards the corner, 0 ... 1.
  uint32_t mouth_vertex(uint32_t from, double out, double depth, bool at_back);

  void make_mouth();

  Place on_form(FrontPlace at) const { return {form_.angle_of(at.x, at.y), at.y}; }

  /// The first ring is close to the lips, so that the normals of the lips are those of their outside.
  double depth_of(uint32_t ring) const;

  // Slits are open in the texture, too: between lids is nothing, between lips the inside of the mouth.
  static constexpr double kLidV = 0.012, kLipV = 0.013;
  /// How far a place is moved up or down in the texture by the slit of the mouth.
  double lip_v(Vec3 look, double y, Side side) const;

  const Form& form_;
  HalfMesh& out_;
  Layout layout_;
  Ring eye_, mouth_, nostril_, ear_ring_;
  uint32_t ring_[kMaxRing];  // the last one made
  uint32_t ring_size_ = 0, half_ = 0;
  Ear ear_;
};

}  // namespace mien::head
