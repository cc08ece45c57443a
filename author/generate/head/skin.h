// SPDX-License-Identifier: MIT
// The skin. Rows and columns of vertices go around the head from the chest to the crown; around each
// eye and around the mouth a block of them gives way to rings, which run from the block's border over
// a border of its own (crease of the lids, red of the lips) to the slit between lids or lips:
//
//      +--+--+--+--+     k counts the vertices of a ring against the clock as seen from the front,
//      |\  rings  /|     from the inner corner of the eye, or from the middle below the mouth
//      +-  -slit- -+     (whose other half is the mirror image), so that 0 < k < n is below the
//      |/         \|     slit, k = n its outer corner, and what is beyond that above
//      +--+--+--+--+
#pragma once

#include <algorithm>

#include "author/generate/head/mesh.h"

namespace mien::head {

struct Rings {
  uint32_t outside, inside;  // of the border between
};

// Rows and columns between landmarks, for each LOD.
struct Grid {
  uint32_t columns[5];  // front - inner side of the eye's block - outer side of the mouth's -
                        // outer side of the eye's - side - back
  uint32_t rows[5];     // bottom - mouth's block, half of it - nose - eye's block, half - crown
  Rings mouth, eye;
  uint32_t depth;  // rings into the mouth
  bool nostril;
};
constexpr uint32_t kMaxColumns = 64, kMaxRows = 124, kMaxRing = 96, kMaxDepth = 9;

// Blocks that rings fill, in the front view.
constexpr double kMouthBlockX = 3.6, kMouthBlockLow = -8.0, kMouthBlockHigh = -4.72;
constexpr double kEyeBlockInner = 0.95, kEyeBlockOuter = 5.75;
constexpr double kEyeBlockLow = kEye.y - 1.75, kEyeBlockHigh = kEye.y + 2.2;

/// A place of the form: see Form::face().
struct Place {
  double angle, y;
};

inline Place between(Place a, Place b, double t) {
  return {author::mix(a.angle, b.angle, t), author::mix(a.y, b.y, t)};
}
class SkinMaker {
 public:
  SkinMaker(const Form& form, uint32_t lod, HalfMesh& out);

  void make() {
    place_columns();
    place_rows();
    if (grid_.nostril) place_nostril();
    place_ear();
    make_vertices();
    if (out_.failed()) return;
    make_faces();
    make_eye();
    if (grid_.nostril && !out_.failed()) make_nostril();
    make_mouth();
    if (!out_.failed()) make_ear();
  }

 private:
  void place_columns();

  /// Columns below the eyes are bent: one runs along the wing of the nose, one from the wing past the corner
  /// of the mouth to the chin.
  Place place_at(uint32_t row, uint32_t column) const;

  void place_rows();

  /// The rows and columns around the nostril.
  void place_nostril();
  void place_ear();

  /// `lid`: the side of the eye's slit; `lip`: that of the mouth's.
  Vertex skin_vertex(Place place, Side lid, Side lip) const;

  uint32_t add_on_plane(Vertex v) {
    v.closed.x = v.look.x = v.position.x = 0;
    return out_.vertices.add(v);
  }

  Vertex grid_vertex(uint32_t row, uint32_t column) const {
    const auto side_of = [row](uint32_t slit) { return row > slit ? Side::kAbove : Side::kBelow; };
    return skin_vertex(place_at(row, column), side_of(eye_.middle), side_of(mouth_.middle));
  }

  struct Block {
    uint32_t low = 0, middle = 0, high = 0;  // rows
    uint32_t left = 0, right = 0;            // columns
    bool has_inside(uint32_t row, uint32_t column) const {
      return row > low && row < high && column < right && (column > left || left == 0);
    }
    bool has_face(uint32_t row, uint32_t column) const {
      return row >= low && row < high && column >= left && column < right;
    }
  };

  void make_vertices();

  uint32_t at(uint32_t row, uint32_t column) const;

  void make_faces();

  // Rings ---------------------------------------------------------------------------------------

  struct Corner {
    uint32_t row, column;
  };
  /// The plane of the ear, at an angle to the head, and its size.
  struct Ear {
    Vec3 origin, back, up, outward;
    double size = 1;
  };

  /// The vertices of a block's border, in the order of rings.
  uint32_t border_of(const Block& block, Corner* out) const;

  /// Fills a block up to the slit, whose vertices are `ring_` then. `curve(k, inner)` gives the place
  /// of a vertex on the border (false) and on the slit (true).
  template <class Curve>
  void make_rings(const Block& block, Rings rings, double last, const Curve& curve) {
    Corner corners[kMaxRing];
    const bool whole = block.left > 0;
    ring_size_ = border_of(block, corners);
    half_ = whole ? ring_size_ / 2 : (ring_size_ - 1) / 2;
    for (uint32_t k = 0; k < ring_size_; ++k) ring_[k] = at(corners[k].row, corners[k].column);
    const uint32_t count = rings.outside + rings.inside;
    for (uint32_t r = 1; r <= count; ++r) {
      uint32_t next[kMaxRing];
      for (uint32_t k = 0; k < ring_size_; ++k) {
        const Place from = place_at(corners[k].row, corners[k].column);
        Place place;
        if (r <= rings.outside) {
          // The last step before the border is short, so that the border is the same at every LOD.
          const double steps = rings.outside - 1;
          const double t = r == rings.outside ? 1 : steps > 0 ? last * r / steps : last;
          place = between(from, curve(k, false), t);
        } else {
          // Dense where skin rolls inwards.
          const double left = 1 - static_cast<double>(r - rings.outside) / rings.inside;
          const double t = 1 - left * left;
          place = between(curve(k, false), curve(k, true), t);
        }
        const Side side = k > half_ ? Side::kAbove : Side::kBelow;
        const bool on_lids = &block == &eye_;
        Vertex v = skin_vertex(place, on_lids ? side : Side::kBelow,
                               &block == &mouth_ ? side : Side::kAbove);
        v.edge = (&block == &mouth_ || &block == &eye_) && r == count && k != half_ &&
                 !(whole && k == 0);
        next[k] =
            !whole && (k == 0 || k + 1 == ring_size_) ? add_on_plane(v) : out_.vertices.add(v);
      }
      for (uint32_t k = 0; k + (whole ? 0 : 1) < ring_size_; ++k) {
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

  // The texture: skin above kInnerV, by angle and row; the inside of the mouth below.
  static constexpr double kInnerV = 0.06, kLidV = 0.008;
  static double row_v(double y) { return mix_v((y - kBottomY) / (kCrownY - kBottomY)); }
  static double mix_v(double share) { return kInnerV + (1 - kInnerV) * share; }

  const Form& form_;
  const Grid grid_;
  const uint32_t lod_;
  HalfMesh& out_;
  double angles_[kMaxColumns + 1], heights_[kMaxRows + 1];
  uint32_t row_start_[kMaxRows + 1];
  uint32_t ring_[kMaxRing];  // the last one made
  uint32_t ring_size_ = 0, half_ = 0;
  uint32_t columns_ = 0, rows_ = 0, crown_ = 0, bottom_ = 0;
  Block mouth_, eye_, nostril_, ear_block_;
  Ear ear_;
};

}  // namespace mien::head
