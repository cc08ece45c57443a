// SPDX-License-Identifier: MIT
// The grid of the skin and the rings around the eyes.
#include "author/generate/head/skin.h"

namespace mien::head {

using author::clamp01;
using author::exact_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

namespace {

constexpr Grid kGrids[kLodCount] = {
    {{8, 13, 12, 15, 11}, {31, 10, 20, 9, 26}, {8, 8}, {7, 8}, 9, true},
    {{6, 8, 8, 11, 8}, {22, 7, 14, 6, 19}, {6, 5}, {5, 5}, 7, true},
    {{4, 6, 6, 8, 6}, {16, 5, 10, 5, 14}, {5, 4}, {4, 4}, 6, true},
    {{2, 6, 5, 6, 5}, {12, 4, 7, 4, 12}, {4, 3}, {3, 4}, 5, false},
    {{2, 4, 4, 5, 4}, {9, 3, 6, 3, 9}, {3, 3}, {3, 3}, 4, false},
    {{1, 4, 3, 4, 3}, {9, 2, 5, 2, 7}, {3, 2}, {2, 3}, 4, false},
    {{1, 3, 3, 3, 3}, {8, 2, 4, 2, 5}, {2, 2}, {2, 2}, 4, false},
    {{1, 3, 2, 3, 2}, {7, 1, 3, 1, 4}, {2, 2}, {2, 2}, 3, false},
};
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

}  // namespace

SkinMaker::SkinMaker(const Form& form, uint32_t lod, HalfMesh& out)
    : form_(form), grid_(kGrids[lod]), lod_(lod), out_(out) {}

void SkinMaker::place_columns() {
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

Place SkinMaker::place_at(uint32_t row, uint32_t column) const {
  const double y = heights_[row], angle = angles_[column];
  if (column == 0 || column >= eye_.right || y <= kMouthBlockLow || y >= kEye.y) return {angle, y};
  const double wing = mix(kEyeBlockInner, 1.25 * form_.person().nose_width,
                          smooth_step(-1.4, -3.2, y) * smooth_step(-5.6, -4.4, y));
  const double from[4] = {0, form_.x_of(angles_[eye_.left], y),
                          form_.x_of(angles_[mouth_.right], y), form_.x_of(angles_[eye_.right], y)};
  const double to[4] = {0, from[1] + wing - kEyeBlockInner,
                        from[2] + form_.fold_x(y) - kMouthBlockX, from[3]};
  const int part = column < eye_.left ? 0 : column < mouth_.right ? 1 : 2;
  const double x = form_.x_of(angle, y);
  double t = (x - from[part]) / (from[part + 1] - from[part]);
  // With few columns, leaves room for the nostril.
  if (part == 0 && grid_.columns[0] < 6)
    t = mix(t, t * std::sqrt(t), bump(0, y, 0, kNostril.y, 1, 0.6));
  return {form_.angle_of(mix(to[part], to[part + 1], t), y), y};
}

void SkinMaker::place_rows() {
  const double keys[8] = {kBottomY,     kMouthBlockLow, kMouthY,       kMouthBlockHigh,
                          kEyeBlockLow, kEye.y,         kEyeBlockHigh, kCrownY};
  const uint32_t counts[7] = {grid_.rows[0], grid_.rows[1], grid_.rows[1], grid_.rows[2],
                              grid_.rows[3], grid_.rows[3], grid_.rows[4]};
  const auto density = [](double y) {
    return 1 + 1.0 * bump(0, y, 0, kMouthBlockLow, 1, 1.6) +
           3.2 * bump(0, y, 0, kNostril.y, 1, 0.45) + 0.8 * bump(0, y, 0, kEyeBlockHigh, 1, 1.2) +
           0.9 * bump(0, y, 0, -17.0, 1, 1.5) - 0.35 * smooth_step(-12, -14, y) -
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

void SkinMaker::place_nostril() {
  for (uint32_t r = mouth_.high; r < eye_.low; ++r) {
    if (heights_[r] < kNostril.y - 0.34) nostril_.low = r;
    if (heights_[r] < kNostril.y) nostril_.middle = r;
    if (heights_[r] < kNostril.y + 0.26) nostril_.high = r + 1;
  }
  nostril_.low = std::max(nostril_.low, mouth_.high);
  nostril_.left = std::max(1u, grid_.columns[0] / 6);
  nostril_.right = grid_.columns[0] + 2 + grid_.columns[1] / 6;
}

Vertex SkinMaker::skin_vertex(Place place, Side lid, Side lip) const {
  const FacePoint at = form_.face(place.angle, place.y, lid);
  Vertex v;
  v.closed = at.closed;
  v.look = at.look;
  v.lid = at.lid;
  v.side = lip;
  v.position = turn_lid(v.closed, v.lid);
  v.u = 0.5 + 0.5 * place.angle / kPi;
  // The slit between the lids is open in the texture, too: their edges are there.
  v.v = row_v(place.y) + kLidV * std::min(std::max(v.lid / 0.5, -1.0), 1.0);
  v.color = form_.skin_color(v.look, place.y, v.lid);
  v.color = mix(v.color, form_.person().hair, 0.6 * scalp(form_, place.angle, place.y));
  if (!grid_.nostril) {
    v.color = mix(v.color, {58, 24, 22},
                  0.85 * bump(std::abs(v.closed.x), v.closed.y,
                              kNostril.x * form_.person().nose_width, kNostril.y, 0.28, 0.14));
  }
  return v;
}

void SkinMaker::make_vertices() {
  for (uint32_t row = 0; row <= rows_; ++row) {
    row_start_[row] = out_.vertices.count();
    for (uint32_t column = 0; column <= columns_; ++column) {
      if (mouth_.has_inside(row, column) || eye_.has_inside(row, column) ||
          nostril_.has_inside(row, column) || ear_block_.has_inside(row, column)) {
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

uint32_t SkinMaker::at(uint32_t row, uint32_t column) const {
  uint32_t missing = 0;
  for (const Block& block : {mouth_, eye_, nostril_, ear_block_}) {
    if (row <= block.low || row >= block.high || column < block.right) continue;
    missing += block.left == 0 ? block.right : block.right - block.left - 1;
  }
  return row_start_[row] + column - missing;
}

void SkinMaker::make_faces() {
  for (uint32_t row = 0; row < rows_; ++row) {
    for (uint32_t column = 0; column < columns_; ++column) {
      if (mouth_.has_face(row, column) || eye_.has_face(row, column) ||
          nostril_.has_face(row, column) || ear_block_.has_face(row, column)) {
        continue;
      }
      out_.quad(at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column));
    }
  }
  for (uint32_t column = 0; column < columns_; ++column) {
    out_.triangle(at(rows_, column), at(rows_, column + 1), crown_);
    out_.triangle(at(0, column + 1), at(0, column), bottom_);
  }
}

uint32_t SkinMaker::border_of(const Block& block, Corner* out) const {
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

void SkinMaker::make_eye() {
  make_rings(eye_, grid_.eye, 0.86, [this](uint32_t k, bool inner) {
    const bool above = k > half_;
    const double along = static_cast<double>(above ? ring_size_ - k : k) / half_;
    return on_form(form_.lid_curve(mix(2 * along - 1, -exact_cosine(kPi * along), 0.45), inner ? 0
                                                                                         : above
                                                                                             ? 1
                                                                                             : -1));
  });
  if (!out_.failed()) make_lid_edges();
}

uint32_t SkinMaker::lid_edge_vertex(uint32_t from, Color color, bool at_ball) {
  Vertex v = out_.vertices[from];
  const Vec3 out = v.closed - kEye;
  const double flesh = smooth_step(-0.72, -0.88, Form::along_eye(v.closed.x));
  const double radius =
      at_ball ? kEyeRadius + mix(0.045, 0.13, flesh) : kEyeRadius + mix(-0.12, 0.04, flesh);
  v.closed = kEye + out * (radius / std::max(length(out), kEyeRadius));
  const double middle = 0.5 * (form_.upper_opening(v.closed.x) + form_.lower_opening(v.closed.x));
  v.lid = mix(v.lid, middle, flesh);
  v.position = turn_lid(v.closed, v.lid);
  v.color = mix(color, {206, 132, 122}, flesh);
  const double deep = at_ball ? 0.002 : 0.004;
  v.v += v.lid < 0 ? deep : -deep;
  return out_.vertices.add(v);
}

void SkinMaker::make_lid_edges() {
  // The rim of the lid is pink; where it meets the ball, tears shine. Roots of lashes darken the upper one.
  const Color skin = form_.person().skin, rim = mix(skin, {206, 126, 118}, 0.50),
              tears = mix(rim, {244, 226, 222}, 0.60), dark = mix(skin, {50, 26, 24}, 0.65);
  uint32_t ball[kMaxRing], deep[kMaxRing];
  for (uint32_t k = 0; k < ring_size_; ++k) {
    const double roots =
        k > half_ ? smooth_step(-0.9, -0.3, Form::along_eye(out_.vertices[ring_[k]].closed.x)) : 0;
    ball[k] = lid_edge_vertex(ring_[k], mix(k > half_ ? rim : tears, dark, 0.8 * roots), true);
    deep[k] = lid_edge_vertex(ring_[k], mix(rim, dark, roots), false);
  }
  for (uint32_t k = 0; k < ring_size_; ++k) {
    const uint32_t other = (k + 1) % ring_size_;
    out_.quad(ring_[k], ring_[other], ball[other], ball[k]);
    out_.quad(ball[k], ball[other], deep[other], deep[k]);
  }
}

void add_skin(const Form& form, uint32_t lod, HalfMesh& out) { SkinMaker(form, lod, out).make(); }

}  // namespace mien::head
