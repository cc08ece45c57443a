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
#include <algorithm>

#include "runtime/author/procedural_head_mesh.h"

namespace mien::head {

using author::clamp01;
using author::exact_cosine;
using author::exact_sine;
using author::kPi;
using author::mix;
using author::smooth_step;

namespace {

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
constexpr Grid kGrids[kLodCount] = {
    {{8, 13, 12, 15, 11}, {31, 10, 20, 9, 26}, {8, 8}, {7, 8}, 9, true},
    {{6, 8, 8, 11, 8}, {22, 7, 14, 6, 19}, {6, 5}, {5, 5}, 7, true},
    {{4, 6, 6, 8, 6}, {16, 5, 10, 5, 14}, {5, 4}, {4, 4}, 6, true},
    {{2, 6, 5, 6, 5}, {12, 4, 7, 4, 12}, {4, 3}, {3, 4}, 5, false},
    {{2, 4, 4, 5, 4}, {9, 3, 6, 3, 9}, {3, 3}, {3, 3}, 4, false},
    {{1, 4, 3, 4, 3}, {7, 2, 5, 2, 7}, {3, 2}, {2, 3}, 4, false},
    {{1, 3, 3, 3, 3}, {6, 2, 4, 2, 5}, {2, 2}, {2, 2}, 4, false},
    {{1, 3, 2, 3, 2}, {5, 1, 3, 1, 4}, {2, 2}, {2, 2}, 3, false},
};
constexpr uint32_t kMaxColumns = 64, kMaxRows = 124, kMaxRing = 96, kMaxDepth = 9;

// Blocks that rings fill, in the front view.
constexpr double kMouthBlockX = 3.6, kMouthBlockLow = -8.0, kMouthBlockHigh = -4.72;
constexpr double kEyeBlockInner = 0.95, kEyeBlockOuter = 5.75;
constexpr double kEyeBlockLow = kEye.y - 1.75, kEyeBlockHigh = kEye.y + 2.2;

/// `count` steps from `from` to `to`, closer where `density` is high.
template <class Density>
void spread(double from, double to, uint32_t count, const Density& density, double* out) {
  constexpr int kSteps = 256;
  double sums[kSteps + 1] = {0};
  for (int i = 0; i < kSteps; ++i) {
    sums[i + 1] = sums[i] + density(mix(from, to, (i + 0.5) / kSteps));
  }
  int i = 0;
  for (uint32_t k = 0; k <= count; ++k) {
    const double wanted = sums[kSteps] * k / count;
    while (i < kSteps - 1 && sums[i + 1] < wanted) ++i;
    out[k] = mix(from, to, (i + clamp01((wanted - sums[i]) / (sums[i + 1] - sums[i]))) / kSteps);
  }
  out[0] = from;
  out[count] = to;
}

/// A place of the form: see Form::face().
struct Place {
  double angle, y;
};

Place between(Place a, Place b, double t) { return {mix(a.angle, b.angle, t), mix(a.y, b.y, t)}; }

class SkinMaker {
 public:
  SkinMaker(const Form& form, uint32_t lod, HalfMesh& out)
      : form_(form), grid_(kGrids[lod]), out_(out) {}

  void make() {
    place_columns();
    place_rows();
    if (grid_.nostril) place_nostril();
    make_vertices();
    if (out_.failed()) return;
    make_faces();
    make_eye();
    if (grid_.nostril && !out_.failed()) make_nostril();
    make_mouth();
  }

 private:
  void place_columns() {
    const double keys[6] = {0,
                            form_.angle_of(kEyeBlockInner, kEye.y),
                            form_.angle_of(kMouthBlockX, kMouthY),
                            form_.angle_of(kEyeBlockOuter, kEye.y),
                            0.55 * kPi,
                            kPi};
    for (int k = 0; k < 5; ++k) {
      spread(
          keys[k], keys[k + 1], grid_.columns[k], [](double) { return 1.0; }, angles_ + columns_);
      columns_ += grid_.columns[k];
      if (k == 0) eye_.left = columns_;
      if (k == 1) mouth_.right = columns_;
      if (k == 2) eye_.right = columns_;
    }
  }

  /// Columns below the eyes are bent: one runs along the wing of the nose, one from there past the
  /// corner of the mouth to the chin.
  Place place_at(uint32_t row, uint32_t column) const {
    const double y = heights_[row], angle = angles_[column];
    if (column == 0 || column >= eye_.right || y <= kMouthBlockLow || y >= kEye.y)
      return {angle, y};
    const double wing = mix(kEyeBlockInner, 1.25 * form_.person().nose_width,
                            smooth_step(-1.4, -3.2, y) * smooth_step(-5.6, -4.4, y));
    const double from[4] = {0, form_.x_of(angles_[eye_.left], y),
                            form_.x_of(angles_[mouth_.right], y),
                            form_.x_of(angles_[eye_.right], y)};
    const double to[4] = {0, from[1] + wing - kEyeBlockInner,
                          from[2] + form_.fold_x(y) - kMouthBlockX, from[3]};
    const int part = column < eye_.left ? 0 : column < mouth_.right ? 1 : 2;
    const double x = form_.x_of(angle, y);
    const double t = (x - from[part]) / (from[part + 1] - from[part]);
    return {form_.angle_of(mix(to[part], to[part + 1], t), y), y};
  }

  void place_rows() {
    const double keys[8] = {kBottomY,     kMouthBlockLow, kMouthY,       kMouthBlockHigh,
                            kEyeBlockLow, kEye.y,         kEyeBlockHigh, kCrownY};
    const uint32_t counts[7] = {grid_.rows[0], grid_.rows[1], grid_.rows[1], grid_.rows[2],
                                grid_.rows[3], grid_.rows[3], grid_.rows[4]};
    const auto density = [](double y) {
      return 1 + 1.0 * bump(0, y, 0, kMouthBlockLow, 1, 1.6) +
             3.2 * bump(0, y, 0, kNostril.y, 1, 0.45) + 0.8 * bump(0, y, 0, kEyeBlockHigh, 1, 1.2) +
             0.9 * bump(0, y, 0, -16.6, 1, 1.3) - 0.35 * smooth_step(-12, -14, y) -
             0.35 * smooth_step(6, 9, y);
    };
    for (int k = 0; k < 7; ++k) {
      spread(keys[k], keys[k + 1], counts[k], density, heights_ + rows_);
      rows_ += counts[k];
      if (k == 0) mouth_.low = rows_;
      if (k == 1) mouth_.middle = rows_;
      if (k == 2) mouth_.high = rows_;
      if (k == 3) eye_.low = rows_;
      if (k == 4) eye_.middle = rows_;
      if (k == 5) eye_.high = rows_;
    }
  }

  /// The rows and columns around the nostril.
  void place_nostril() {
    const double wide = form_.person().nose_width;
    const auto x_at = [&](uint32_t column) {
      const Place at = place_at(nostril_.middle, column);
      return form_.x_of(at.angle, at.y);
    };
    for (uint32_t r = mouth_.high; r < eye_.low; ++r) {
      if (heights_[r] < kNostril.y - 0.34) nostril_.low = r;
      if (heights_[r] < kNostril.y) nostril_.middle = r;
      if (heights_[r] < kNostril.y + 0.26) nostril_.high = r + 1;
    }
    nostril_.low = std::max(nostril_.low, mouth_.high);
    nostril_.left = 1;
    while (x_at(nostril_.left + 1) < 0.34 * wide) ++nostril_.left;
    nostril_.right = nostril_.left + 2;
    while (x_at(nostril_.right) < 1.22 * wide) ++nostril_.right;
  }

  /// `lid`: the side of the eye's slit; `lip`: that of the mouth's.
  Vertex skin_vertex(Place place, Side lid, Side lip) const {
    const FacePoint at = form_.face(place.angle, place.y, lid);
    Vertex v;
    v.closed = at.closed;
    v.look = v.closed;
    v.lid = at.lid;
    v.side = lip;
    v.position = turn_lid(v.closed, v.lid);
    v.u = 0.5 + 0.5 * place.angle / kPi;
    v.v = (place.y - kBottomY) / (kCrownY - kBottomY);
    v.color = form_.skin_color(v.closed, place.y, v.lid);
    if (!grid_.nostril) {
      v.color = mix(v.color, {58, 24, 22},
                    0.85 * bump(std::abs(v.closed.x), v.closed.y,
                                kNostril.x * form_.person().nose_width, kNostril.y, 0.28, 0.14));
    }
    return v;
  }

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

  void make_vertices() {
    for (uint32_t row = 0; row <= rows_; ++row) {
      row_start_[row] = out_.vertices.count();
      for (uint32_t column = 0; column <= columns_; ++column) {
        if (mouth_.has_inside(row, column) || eye_.has_inside(row, column) ||
            nostril_.has_inside(row, column)) {
          continue;
        }
        if (column == 0 || column == columns_) {
          add_on_plane(grid_vertex(row, column));
        } else {
          out_.vertices.add(grid_vertex(row, column));
        }
      }
    }
    // The crown and the bottom are closed with one vertex each.
    Vertex crown = grid_vertex(rows_, 0);
    crown.closed = crown.position = crown.look = {0, form_.raised(kCrownY + 0.02), -0.9};
    crown_ = out_.vertices.add(crown);
    Vertex bottom = grid_vertex(0, 0);
    bottom.closed = bottom.position = bottom.look = {0, kBottomY, -1.5};
    bottom_ = out_.vertices.add(bottom);
  }

  uint32_t at(uint32_t row, uint32_t column) const {
    uint32_t missing = 0;
    for (const Block& block : {mouth_, eye_, nostril_}) {
      if (row <= block.low || row >= block.high || column < block.right) continue;
      missing += block.left == 0 ? block.right : block.right - block.left - 1;
    }
    return row_start_[row] + column - missing;
  }

  void make_faces() {
    for (uint32_t row = 0; row < rows_; ++row) {
      for (uint32_t column = 0; column < columns_; ++column) {
        if (mouth_.has_face(row, column) || eye_.has_face(row, column) ||
            nostril_.has_face(row, column)) {
          continue;
        }
        out_.quad(at(row, column), at(row, column + 1), at(row + 1, column + 1),
                  at(row + 1, column));
      }
    }
    for (uint32_t column = 0; column < columns_; ++column) {
      out_.triangle(at(rows_, column), at(rows_, column + 1), crown_);
      out_.triangle(at(0, column + 1), at(0, column), bottom_);
    }
  }

  // Rings ---------------------------------------------------------------------------------------

  struct Corner {
    uint32_t row, column;
  };

  /// The vertices of a block's border, in the order of rings.
  uint32_t border_of(const Block& block, Corner* out) const {
    uint32_t n = 0;
    const bool whole = block.left > 0;
    if (whole) {
      for (uint32_t r = block.middle; r > block.low; --r) out[n++] = {r, block.left};
    }
    for (uint32_t c = block.left; c < block.right; ++c) out[n++] = {block.low, c};
    for (uint32_t r = block.low; r < block.high; ++r) out[n++] = {r, block.right};
    for (uint32_t c = block.right; c > block.left; --c) out[n++] = {block.high, c};
    if (whole) {
      for (uint32_t r = block.high; r > block.middle; --r) out[n++] = {r, block.left};
    } else {
      out[n++] = {block.high, 0};
    }
    return n;
  }

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
          // The last step before the border is short: what happens there happens at every LOD.
          const double steps = rings.outside - 1;
          const double t = r == rings.outside ? 1 : steps > 0 ? last * r / steps : last;
          place = between(from, curve(k, false), t);
        } else {
          // Close together where skin rolls inwards.
          const double left = 1 - static_cast<double>(r - rings.outside) / rings.inside;
          const double t = 1 - left * left;
          place = between(curve(k, false), curve(k, true), t);
        }
        const Side side = k > half_ ? Side::kAbove : Side::kBelow;
        const bool on_lids = &block == &eye_;
        Vertex v = skin_vertex(place, on_lids ? side : Side::kBelow,
                               &block == &mouth_ ? side : Side::kAbove);
        v.edge = &block != &nostril_ && r == count && k != half_ && !(whole && k == 0);
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

  void make_eye() {
    make_rings(eye_, grid_.eye, 0.86, [this](uint32_t k, bool inner) {
      const bool above = k > half_;
      const double along = static_cast<double>(above ? ring_size_ - k : k) / half_;
      return on_form(
          form_.lid_curve(mix(2 * along - 1, -exact_cosine(kPi * along), 0.45), inner   ? 0
                                                                                : above ? 1
                                                                                        : -1));
    });
    if (!out_.failed()) make_lid_edges();
  }

  /// From the edge of a lid inwards, until behind the surface of the eyeball; in the inner corner over
  /// it to the other lid's, which gives the pink flesh that is there.
  uint32_t lid_edge_vertex(uint32_t from, Color color) {
    Vertex v = out_.vertices[from];
    const Vec3 out = v.closed - kEye;
    const double flesh = smooth_step(-0.74, -0.90, Form::along_eye(v.closed.x));
    const double radius = mix(kEyeRadius - 0.12, kEyeRadius + 0.04, flesh);
    v.closed = kEye + out * (radius / std::max(length(out), kEyeRadius));
    const double middle = 0.5 * (form_.upper_opening(v.closed.x) + form_.lower_opening(v.closed.x));
    v.lid = mix(v.lid, middle, flesh);
    v.position = turn_lid(v.closed, v.lid);
    v.color = mix(color, {198, 112, 104}, flesh);
    v.v += v.lid < 0 ? 0.004 : -0.004;
    return out_.vertices.add(v);
  }

  void make_lid_edges() {
    const Color pink = mix(form_.person().skin, {196, 96, 92}, 0.5),
                dark = mix(form_.person().skin, {50, 26, 24}, 0.75);
    uint32_t deep[kMaxRing];
    for (uint32_t k = 0; k < ring_size_; ++k) {
      Color c = pink;
      if (k > half_) {
        c = mix(pink, dark,
                smooth_step(-0.9, -0.3, Form::along_eye(out_.vertices[ring_[k]].closed.x)));
      }
      deep[k] = lid_edge_vertex(ring_[k], c);
    }
    for (uint32_t k = 0; k < ring_size_; ++k) {
      const uint32_t other = (k + 1) % ring_size_;
      out_.quad(ring_[k], ring_[other], deep[other], deep[k]);
    }
  }

  void make_nostril() {
    const double wide = form_.person().nose_width;
    make_rings(nostril_, {2, 1}, 0.5, [&](uint32_t k, bool inner) {
      const auto [s, c] = author::exact_sine_cosine(kPi + 2 * kPi * k / ring_size_);
      const double size = inner ? 1 : 1.22;
      return on_form({wide * (kNostril.x + size * (0.34 * c + 0.04 * s)),
                      kNostril.y + size * (0.165 * s + 0.03 * c)});
    });
    if (out_.failed()) return;
    // In there it goes up and back.
    static constexpr double kPath[][4] = {// size, up, back, darkness
                                          {0.97, 0.05, 0.02, 0.45},
                                          {0.85, 0.22, 0.10, 0.85},
                                          {0.50, 0.48, 0.24, 1.0}};
    Vec3 middle;
    for (uint32_t k = 0; k < ring_size_; ++k) {
      middle = middle + out_.vertices[ring_[k]].closed * (1.0 / ring_size_);
    }
    const Color dark = mix(redder(form_.person().skin, 0.9), {34, 10, 10}, 0.86);
    const auto inside = [&](uint32_t from, const double(&step)[4]) {
      Vertex v = out_.vertices[from];
      v.closed = middle + (v.closed - middle) * step[0] + Vec3{0, step[1], -step[2]};
      v.position = v.closed;
      v.color = mix(form_.skin_color(v.look, v.look.y, 0), dark, step[3]);
      return out_.vertices.add(v);
    };
    uint32_t rim[kMaxRing], next[kMaxRing];
    std::copy(ring_, ring_ + ring_size_, rim);
    for (const auto& step : kPath) {
      for (uint32_t k = 0; k < ring_size_; ++k) next[k] = inside(rim[k], step);
      for (uint32_t k = 0; k < ring_size_; ++k) {
        const uint32_t other = (k + 1) % ring_size_;
        out_.quad(ring_[k], ring_[other], next[other], next[k]);
      }
      std::copy(next, next + ring_size_, ring_);
    }
    const uint32_t end = inside(rim[0], {0, 0.50, 0.26, 1.0});
    for (uint32_t k = 0; k < ring_size_; ++k) {
      out_.triangle(ring_[k], ring_[(k + 1) % ring_size_], end);
    }
  }

  /// One ring into the mouth from a vertex of the lips. Above: behind the lip, up in front of the
  /// gums, along the palate and down to the throat; below likewise. `out`: towards the corner,
  /// 0..1.
  uint32_t mouth_vertex(uint32_t from, double out, double depth, bool at_back) {
    static constexpr double kPath[][3] = {
        {0.00, 0.00, 0.00},  {0.02, 0.00, -0.02}, {0.12, 0.12, -0.40}, {0.30, 0.85, -0.80},
        {0.48, 1.62, -1.05}, {0.66, 1.75, -2.20}, {0.85, 1.25, -4.20}, {1.00, 0.00, -5.40}};
    int i = 0;
    while (i < 6 && depth > kPath[i + 1][0]) ++i;
    const double t = (depth - kPath[i][0]) / (kPath[i + 1][0] - kPath[i][0]);
    const double rise = mix(kPath[i][1], kPath[i + 1][1], t);
    const double back = mix(kPath[i][2], kPath[i + 1][2], t);
    Vertex v = out_.vertices[from];
    const double up = at_back ? 0 : v.side == Side::kAbove ? 1.0 : -0.85;
    const double open = std::sqrt(std::max(0.0, 1 - out * out));
    v.closed.y += up * rise * open - 0.5 * smooth_step(0.6, 1, depth);
    // Cheeks curve away beside the corners: straight in there first.
    v.closed.z += back - 0.75 * smooth_step(0, 0.35, depth) * out * out;
    v.closed.x *= 1 + 0.30 * smooth_step(0.20, 0.7, depth);
    v.position = v.closed;
    v.edge = false;
    v.depth = depth;
    v.v = kMouthV + (v.side == Side::kAbove ? 1 : -1) * 0.012 * depth;
    const Color lip = v.color, wet = {168, 78, 76}, dark = {58, 16, 20};
    v.color =
        mix(mix(lip, wet, smooth_step(0.02, 0.20, depth)), dark, smooth_step(0.30, 0.85, depth));
    return out_.vertices.add(v);
  }

  void make_mouth() {
    make_rings(mouth_, grid_.mouth, 0.90, [this](uint32_t k, bool inner) {
      const bool above = k > half_;
      const double out = static_cast<double>(above ? ring_size_ - 1 - k : k) / half_;
      return on_form(form_.lip_curve(mix(out, exact_sine(kPi / 2 * out), 0.5), inner   ? 0
                                                                               : above ? 1
                                                                                       : -1));
    });
    if (out_.failed()) return;
    // Both halves of the ring meet in the back.
    const uint32_t rings = grid_.depth;
    uint32_t corner[kMaxDepth + 1], back[kMaxRing];
    corner[0] = ring_[half_];
    for (uint32_t d = 1; d <= rings; ++d)
      corner[d] = mouth_vertex(ring_[half_], 1, depth_of(d), d == rings);
    uint32_t before[kMaxDepth + 1];
    for (uint32_t k = 0; k < ring_size_; ++k) {
      const uint32_t twin = ring_size_ - 1 - k;
      const double out = static_cast<double>(std::min(k, twin)) / half_;
      uint32_t chain[kMaxDepth + 1];
      chain[0] = ring_[k];
      for (uint32_t d = 1; d <= rings; ++d) {
        if (k == half_) {
          chain[d] = corner[d];
        } else if (d == rings && k > half_) {
          chain[d] = back[twin];
        } else {
          chain[d] = mouth_vertex(ring_[k], out, depth_of(d), d == rings);
        }
        if (k > 0) out_.quad(before[d - 1], chain[d - 1], chain[d], before[d]);
      }
      back[k] = chain[rings];
      std::copy(chain, chain + rings + 1, before);
    }
  }

  Place on_form(FrontPlace at) const { return {form_.angle_of(at.x, at.y), at.y}; }

  /// The first ring is close to the lips, so that their normals are those of their outside.
  double depth_of(uint32_t ring) const {
    const double t = (ring - 1.0) / (grid_.depth - 1);
    return mix(0.02, 1, grid_.depth >= 6 ? t * mix(0.75, 1, t) : t);
  }

  static constexpr double kMouthV = (kMouthY - kBottomY) / (kCrownY - kBottomY);

  const Form& form_;
  const Grid grid_;
  HalfMesh& out_;
  double angles_[kMaxColumns + 1], heights_[kMaxRows + 1];
  uint32_t row_start_[kMaxRows + 1];
  uint32_t ring_[kMaxRing];  // the last one made
  uint32_t ring_size_ = 0, half_ = 0;
  uint32_t columns_ = 0, rows_ = 0, crown_ = 0, bottom_ = 0;
  Block mouth_, eye_, nostril_;
};

}  // namespace

void add_skin(const Form& form, uint32_t lod, HalfMesh& out) { SkinMaker(form, lod, out).make(); }

}  // namespace mien::head
