// SPDX-License-Identifier: MIT
// The skin: rows of vertices around the head from the shoulders to the crown, slit between the lids
// and between the lips; edges of the lids; the inside of the mouth.
#include <algorithm>

#include "runtime/author/procedural_head_mesh.h"

namespace mien::head {

using author::clamp01;
using author::exact_sine_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

namespace {

// Rows and columns between landmarks, for each LOD.
struct Grid {
  uint32_t columns[5];  // front - inner corner of the eye - corner of the mouth - outer corner of
                        // the eye - side - back
  uint32_t rows[3];     // bottom - mouth - eyes - crown
  uint32_t rings;       // into the mouth
};
constexpr Grid kGrids[kLodCount] = {
    {{10, 14, 24, 24, 16}, {42, 42, 42}, 8}, {{7, 10, 17, 16, 11}, {29, 30, 28}, 6},
    {{5, 7, 12, 12, 8}, {20, 22, 20}, 5},    {{4, 5, 9, 9, 6}, {14, 16, 14}, 4},
    {{3, 4, 6, 6, 5}, {11, 12, 10}, 3},      {{2, 3, 5, 5, 3}, {8, 11, 8}, 3},
    {{2, 3, 4, 4, 3}, {6, 9, 7}, 3},         {{2, 2, 4, 3, 2}, {5, 8, 6}, 2},
};
constexpr uint32_t kMaxColumns = 96, kMaxRows = 136, kMaxRings = 10;

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

class SkinMaker {
 public:
  SkinMaker(const Form& form, uint32_t lod, HalfMesh& out)
      : form_(form), grid_(kGrids[lod]), out_(out) {}

  void make() {
    place_columns();
    place_rows();
    make_vertices();
    if (out_.failed()) return;
    make_faces();
    make_lid_edges();
    make_mouth();
  }

 private:
  void place_columns() {
    const double keys[6] = {0,
                            form_.angle_of(kEye.x - kEyeHalfWidth, kEye.y),
                            form_.angle_of(kMouthHalfWidth, kMouthY),
                            form_.angle_of(kEye.x + kEyeHalfWidth, kEye.y),
                            0.55 * kPi,
                            kPi};
    for (int k = 0; k < 5; ++k) {
      spread(
          keys[k], keys[k + 1], grid_.columns[k], [](double) { return 1.0; }, angles_ + columns_);
      columns_ += grid_.columns[k];
      if (k == 0) eye_inner_ = columns_;
      if (k == 1) mouth_corner_ = columns_;
      if (k == 2) eye_outer_ = columns_;
    }
  }

  void place_rows() {
    const double keys[4] = {kBottomY, kMouthY, kEye.y, kCrownY};
    // Few rows go where they are needed most.
    const bool few = grid_.rows[0] < 10;
    const double lips = few ? 7 : 2.6, spread_of_lips = few ? 0.75 : 1.3, nose = few ? 3.5 : 1.6;
    const auto density = [=](double y) {
      return 1 + lips * bump(0, y, 0, kMouthY, 1, spread_of_lips) +
             2.4 * bump(0, y, 0, kEye.y + 0.1, 1, 1.5) + nose * bump(0, y, 0, -3.2, 1, 0.9) +
             1.2 * bump(0, y, 0, -15.6, 1, 0.6) - 0.35 * smooth_step(-12, -14, y) -
             0.35 * smooth_step(6, 9, y);
    };
    for (int k = 0; k < 3; ++k) {
      spread(keys[k], keys[k + 1], grid_.rows[k], density, heights_ + rows_);
      rows_ += grid_.rows[k];
      if (k == 0) mouth_row_ = rows_;
      if (k == 1) eye_row_ = rows_;
    }
  }

  /// `side`: of the slit, if the vertex is on one.
  Vertex skin_vertex(uint32_t row, uint32_t column, Side side) const {
    const auto side_of = [row, side](uint32_t slit) {
      return row == slit ? side : row > slit ? Side::kAbove : Side::kBelow;
    };
    const Side lid_side = side_of(eye_row_);
    const FacePoint at = form_.face(angles_[column], heights_[row], lid_side);
    Vertex v;
    v.closed = at.closed;
    if (column == 0 || column == columns_) v.closed.x = 0;
    v.look = v.closed;
    v.lid = at.lid;
    v.edge = in_slit(row, column);
    v.side = side_of(mouth_row_);
    v.position = turn_lid(v.closed, v.lid);
    v.u = 0.5 + 0.5 * angles_[column] / kPi;
    v.v = (heights_[row] - kBottomY) / (kCrownY - kBottomY);
    v.color = form_.skin_color(v.closed, heights_[row], v.lid);
    return v;
  }

  bool in_slit(uint32_t row, uint32_t column) const {
    return (row == mouth_row_ && column < mouth_corner_) ||
           (row == eye_row_ && column > eye_inner_ && column < eye_outer_);
  }

  void make_vertices() {
    first_ = out_.vertices.count();
    for (uint32_t row = 0; row <= rows_; ++row) {
      for (uint32_t column = 0; column <= columns_; ++column) {
        out_.vertices.add(skin_vertex(row, column, Side::kBelow));
      }
    }
    upper_lip_ = out_.vertices.count();
    for (uint32_t column = 0; column < mouth_corner_; ++column) {
      out_.vertices.add(skin_vertex(mouth_row_, column, Side::kAbove));
    }
    upper_lid_ = out_.vertices.count();
    for (uint32_t column = eye_inner_ + 1; column < eye_outer_; ++column) {
      out_.vertices.add(skin_vertex(eye_row_, column, Side::kAbove));
    }
    // The crown and the bottom are closed with one vertex each.
    Vertex crown = skin_vertex(rows_, 0, Side::kAbove);
    crown.closed = {0, kCrownY + 0.02, -0.9};
    crown.position = crown.look = crown.closed;
    crown_ = out_.vertices.add(crown);
    Vertex bottom = skin_vertex(0, 0, Side::kBelow);
    bottom.closed = {0, kBottomY, -1.5};
    bottom.position = bottom.look = bottom.closed;
    bottom_ = out_.vertices.add(bottom);
  }

  /// The vertex of a row as faces below or above it see it.
  uint32_t at(uint32_t row, uint32_t column, Side side) const {
    if (side == Side::kAbove && in_slit(row, column)) {
      return row == mouth_row_ ? upper_lip_ + column : upper_lid_ + column - eye_inner_ - 1;
    }
    return first_ + row * (columns_ + 1) + column;
  }

  void make_faces() {
    for (uint32_t row = 0; row < rows_; ++row) {
      for (uint32_t column = 0; column < columns_; ++column) {
        out_.quad(at(row, column, Side::kAbove), at(row, column + 1, Side::kAbove),
                  at(row + 1, column + 1, Side::kBelow), at(row + 1, column, Side::kBelow));
      }
    }
    for (uint32_t column = 0; column < columns_; ++column) {
      out_.triangle(at(rows_, column, Side::kAbove), at(rows_, column + 1, Side::kAbove), crown_);
      out_.triangle(at(0, column + 1, Side::kAbove), at(0, column, Side::kAbove), bottom_);
    }
  }

  /// From the edge of a lid inwards, until behind the surface of the eyeball.
  uint32_t lid_edge_vertex(uint32_t from, Color color) {
    Vertex v = out_.vertices[from];
    const Vec3 out = v.closed - kEye;
    v.closed = kEye + out * ((kEyeRadius - 0.12) / std::max(length(out), kEyeRadius));
    v.position = turn_lid(v.closed, v.lid);
    v.color = color;
    v.v += v.lid < 0 ? 0.004 : -0.004;
    return out_.vertices.add(v);
  }

  void make_lid_edges() {
    const Color pink = mix(form_.person().skin, {196, 96, 92}, 0.5);
    const Color dark = mix(form_.person().skin, {50, 26, 24}, 0.75);
    const uint32_t inner = at(eye_row_, eye_inner_, Side::kBelow);
    const uint32_t outer = at(eye_row_, eye_outer_, Side::kBelow);
    const uint32_t inner_deep = lid_edge_vertex(inner, pink);
    const uint32_t outer_deep = lid_edge_vertex(outer, pink);
    for (Side side : {Side::kBelow, Side::kAbove}) {
      uint32_t before = inner, before_deep = inner_deep;
      for (uint32_t column = eye_inner_ + 1; column <= eye_outer_; ++column) {
        const bool last = column == eye_outer_;
        const uint32_t here = at(eye_row_, column, side);
        const uint32_t deep =
            last ? outer_deep
                 : lid_edge_vertex(
                       here, side == Side::kBelow
                                 ? pink
                                 : mix(pink, dark,
                                       smooth_step(-0.9, -0.3,
                                                   Form::along_eye(out_.vertices[here].closed.x))));
        if (side == Side::kBelow) {
          out_.quad(before, here, deep, before_deep);
        } else {
          out_.quad(here, before, before_deep, deep);
        }
        before = here;
        before_deep = deep;
      }
    }
  }

  /// One ring into the mouth from a vertex of the lips. Above: behind the lip, up in front of the
  /// gums, along the palate and down to the throat; below likewise. `out`: towards the corner,
  /// 0..1.
  uint32_t mouth_vertex(uint32_t from, double out, double depth, bool at_back) {
    static constexpr double kPath[][3] = {
        {0.00, 0.00, 0.00},  {0.10, 0.16, -0.28}, {0.30, 0.95, -0.52}, {0.48, 1.62, -1.05},
        {0.66, 1.75, -2.20}, {0.85, 1.25, -4.20}, {1.00, 0.00, -5.40}};
    int i = 0;
    while (i < 5 && depth > kPath[i + 1][0]) ++i;
    const double t = (depth - kPath[i][0]) / (kPath[i + 1][0] - kPath[i][0]);
    const double rise = mix(kPath[i][1], kPath[i + 1][1], t);
    const double back = mix(kPath[i][2], kPath[i + 1][2], t);
    Vertex v = out_.vertices[from];
    const double up = at_back ? 0 : v.side == Side::kAbove ? 1.0 : -0.85;
    const double open = std::sqrt(std::max(0.0, 1 - out * out));
    v.closed.y += up * rise * open - 0.5 * smooth_step(0.6, 1, depth);
    // Cheeks curve away beside the corners: straight in there first.
    v.closed.z += back - 0.75 * smooth_step(0, 0.35, depth) * out * out;
    v.closed.x *= 1 + 0.22 * smooth_step(0.25, 0.7, depth);
    v.position = v.closed;
    v.edge = false;
    v.depth = depth;
    v.v = kMouthV + (v.side == Side::kAbove ? 1 : -1) * 0.012 * depth;
    const Color lip = v.color, wet = {124, 38, 42}, dark = {46, 12, 16};
    v.color =
        mix(mix(lip, wet, smooth_step(0.05, 0.25, depth)), dark, smooth_step(0.35, 0.9, depth));
    return out_.vertices.add(v);
  }

  void make_mouth() {
    const uint32_t rings = grid_.rings;
    const uint32_t corner = at(mouth_row_, mouth_corner_, Side::kBelow);
    uint32_t corner_chain[kMaxRings + 1], back[kMaxColumns + 1];
    corner_chain[0] = corner;
    for (uint32_t k = 1; k <= rings; ++k) {
      corner_chain[k] = mouth_vertex(corner, 1, depth_of(k), k == rings);
    }
    back[mouth_corner_] = corner_chain[rings];
    for (Side side : {Side::kBelow, Side::kAbove}) {
      uint32_t before[kMaxRings + 1];
      for (uint32_t column = 0; column <= mouth_corner_; ++column) {
        const double out = static_cast<double>(column) / mouth_corner_;
        uint32_t chain[kMaxRings + 1];
        chain[0] = at(mouth_row_, column, side);
        for (uint32_t k = 1; k <= rings; ++k) {
          if (column == mouth_corner_) {
            chain[k] = corner_chain[k];
          } else if (k == rings && side == Side::kAbove) {
            chain[k] = back[column];
          } else {
            chain[k] = mouth_vertex(chain[0], out, depth_of(k), k == rings);
          }
          if (column == 0) continue;
          if (side == Side::kBelow) {
            out_.quad(before[k - 1], chain[k - 1], chain[k], before[k]);
          } else {
            out_.quad(chain[k - 1], before[k - 1], before[k], chain[k]);
          }
        }
        back[column] = chain[rings];
        std::copy(chain, chain + rings + 1, before);
      }
    }
  }

  /// Rings are closest at the lips.
  double depth_of(uint32_t ring) const {
    const double t = static_cast<double>(ring) / grid_.rings;
    return grid_.rings >= 6 ? t * mix(0.8, 1, t) : t;
  }

  static constexpr double kMouthV = (kMouthY - kBottomY) / (kCrownY - kBottomY);

  const Form& form_;
  const Grid grid_;
  HalfMesh& out_;
  double angles_[kMaxColumns + 1], heights_[kMaxRows + 1];
  uint32_t columns_ = 0, rows_ = 0;
  uint32_t eye_inner_ = 0, mouth_corner_ = 0, eye_outer_ = 0, mouth_row_ = 0, eye_row_ = 0;
  uint32_t first_ = 0, upper_lip_ = 0, upper_lid_ = 0, crown_ = 0, bottom_ = 0;
};

}  // namespace

void add_skin(const Form& form, uint32_t lod, HalfMesh& out) { SkinMaker(form, lod, out).make(); }

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

bool make_part(const Form& form, Part part, uint32_t lod, HalfMesh& out) {
  switch (part) {
    case Part::kHead:
      add_skin(form, lod, out);
      if (!out.failed()) add_ear(form, lod, out);
      break;
    case Part::kTeeth: add_teeth(form, lod, out); break;
    case Part::kTongue: add_tongue(form, lod, out); break;
    case Part::kEyeLeft:
    case Part::kEyeRight: add_eyeball(form, lod, out); break;
    case Part::kHair: add_hair(form, lod, out); break;
    case Part::kBrows: add_brow(form, lod, out); break;
    case Part::kLashes: add_lashes(form, lod, out); break;
  }
  if (out.failed()) return false;
  set_normals(out);
  return true;
}

}  // namespace mien::head
