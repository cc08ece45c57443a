// SPDX-License-Identifier: MIT
// The skin outside of its openings, and the lids.
#include "author/generate/head/skin.h"

namespace mien::head {

using author::clamp01;
using author::exact_cosine;
using author::kPi;
using author::mix;
using author::smooth_step;

SkinMaker::SkinMaker(const Form& form, HalfMesh& out)
    : form_(form), out_(out), layout_(form, kSkinSegments, out.vertices.arena()) {}

void SkinMaker::make() {
  place_ear();
  layout_.make();
  if (layout_.failed()) return out_.vertices.fail();
  eye_ = layout_.eye();
  mouth_ = layout_.mouth();
  ear_ring_ = layout_.ear();
  using Hole = Layout::Hole;
  half_ = eye_.half, ring_size_ = eye_.count;
  layout_.fill(eye_, kEyeRings.outside, 0.86, Hole::kLids,
               [this](uint32_t k) { return lid_place(k, false); });
  half_ = mouth_.half, ring_size_ = mouth_.count;
  layout_.fill(mouth_, kMouthRings.outside, 0.90, Hole::kLips,
               [this](uint32_t k) { return lip_place(k, false); });
  ring_size_ = ear_ring_.count;
  layout_.fill(ear_ring_, 3, 0.72, Hole::kOther,
               [this](uint32_t k) { return ear_place(k, false); });
  nostril_ = layout_.nostril();
  ring_size_ = nostril_.count;
  layout_.fill(nostril_, 4, 0.76, Hole::kOther,
               [this](uint32_t k) { return nostril_place(k, false); });
  layout_.even_out(48);
  if (layout_.failed()) return out_.vertices.fail();
  make_vertices();
  if (out_.failed()) return;
  make_faces();
  make_eye();
  if (!out_.failed()) make_nostril();
  if (!out_.failed()) make_mouth();
  if (!out_.failed()) make_ear();
}

Vertex SkinMaker::skin_vertex(Place place, Side lid, Side lip) const {
  const FacePoint at = form_.face(place.angle, place.y, lid);
  Vertex v;
  v.closed = at.closed;
  v.look = at.look;
  v.lid = at.lid;
  v.side = lip;
  v.position = turn_lid(v.closed, v.lid);
  v.u = u_of_angle(place.angle);
  v.v = v_of_row(place.y) + kLidV * std::min(std::max(v.lid / 0.5, -1.0), 1.0) +
        lip_v(v.look, place.y, lip);
  v.color = form_.skin_color(v.look, place.y, v.lid);
  v.color = mix(v.color, form_.person().hair, 0.6 * scalp(form_, place.angle, place.y));
  return v;
}

double SkinMaker::lip_v(Vec3 look, double y, Side side) const {
  const double x = look.x / kMouthHalfWidth, above = y - kMouthY;
  if (look.z < 4 || std::abs(x) >= 1) return 0;
  const bool is_above = std::abs(above) < 1e-6 ? side == Side::kAbove : above > 0;
  const double open = kLipV * (1 - x * x) * smooth_step(1.2, 0, std::abs(above));
  return is_above ? open : -open;
}

void SkinMaker::make_vertices() {
  for (const Spot& spot : layout_.spots.span()) {
    const Vertex v = skin_vertex(spot.place, spot.lid, spot.lip);
    if (spot.place.angle == 0 || spot.place.angle == kPi) {
      add_on_plane(v);
    } else {
      out_.vertices.add(v);
    }
  }
}

void SkinMaker::make_faces() {
  for (const Face& quad : layout_.quads.span()) out_.faces.add(quad);
  // The crown and the bottom are closed with one vertex each.
  Vertex crown = out_.vertices[layout_.crown_ends[0]];
  crown.closed = crown.position = crown.look = {0, form_.raised(kCrownY + 0.02), -0.9};
  const uint32_t top = out_.vertices.add(crown);
  Vertex bottom = out_.vertices[layout_.bottom_ends[0]];
  bottom.closed = bottom.position = bottom.look = {0, kBottomY, -1.5};
  const uint32_t low = out_.vertices.add(bottom);
  for (uint32_t c = 0; c + 1 < layout_.crown_count; ++c) {
    out_.triangle(layout_.crown_ends[c], layout_.crown_ends[c + 1], top);
  }
  for (uint32_t c = 0; c + 1 < layout_.bottom_count; ++c) {
    out_.triangle(layout_.bottom_ends[c + 1], layout_.bottom_ends[c], low);
  }
}

Place SkinMaker::lid_place(uint32_t k, bool inner) const {
  const bool above = k > half_;
  const double along = static_cast<double>(above ? ring_size_ - k : k) / half_;
  return on_form(form_.lid_curve(mix(2 * along - 1, -exact_cosine(kPi * along), 0.45), inner ? 0
                                                                                       : above
                                                                                           ? 1
                                                                                           : -1));
}

void SkinMaker::make_eye() {
  make_rings(eye_, kEyeRings.inside, Layout::Hole::kLids,
             [this](uint32_t k, bool inner) { return lid_place(k, inner); });
  if (!out_.failed()) make_lid_edges();
}

uint32_t SkinMaker::lid_edge_vertex(uint32_t from, Color color, bool at_ball) {
  Vertex v = out_.vertices[from];
  const Vec3 out = v.closed - kEye;
  // The caruncle fills the inner corner between the lids.
  const double along = form_.along_eye(v.closed.x), flesh = smooth_step(-0.72, -0.88, along);
  const double radius = kEyeRadius + (at_ball ? mix(0.045, 0.13, flesh) : mix(-0.12, 0.05, flesh));
  // Towards the middle of the eye; first more straight back at the corner, where skin dips in on the way there.
  const double far = length(out), inwards = radius / std::max(far, kEyeRadius) - 1;
  const Vec3 way = at_ball ? out + (Vec3{0, 0, far} - out) * (0.7 * flesh) : out;
  v.closed = v.closed + way * inwards;
  const double middle = 0.5 * (form_.upper_opening(v.closed.x) + form_.lower_opening(v.closed.x));
  v.lid = mix(v.lid, middle, flesh);
  v.position = turn_lid(v.closed, v.lid);
  v.color = mix(color, mix({204, 120, 112}, form_.person().skin, 0.35), flesh);
  // In the texture, edges go towards the middle of the slit, which closes at its corners.
  v.v = mix(v.v, v_of_row(kEye.y) + kLidV * middle / 0.5, at_ball ? 0.45 : 0.8);
  return out_.vertices.add(v);
}

void SkinMaker::make_lid_edges() {
  // The rim of the lid is pink; where it meets the ball, tears shine. Roots of lashes darken the upper one.
  const Color skin = form_.person().skin, rim = mix(skin, {206, 126, 118}, 0.50),
              tears = mix(rim, {228, 196, 190}, 0.30), dark = mix(skin, {50, 26, 24}, 0.65);
  uint32_t ball[kMaxRing], deep[kMaxRing];
  for (uint32_t k = 0; k < ring_size_; ++k) {
    const double roots =
        k > half_ ? smooth_step(-0.9, -0.3, form_.along_eye(out_.vertices[ring_[k]].closed.x)) : 0;
    ball[k] = lid_edge_vertex(ring_[k], mix(k > half_ ? rim : tears, dark, 0.8 * roots), true);
    deep[k] = lid_edge_vertex(ring_[k], mix(rim, dark, roots), false);
  }
  for (uint32_t k = 0; k < ring_size_; ++k) {
    const uint32_t other = (k + 1) % ring_size_;
    out_.quad(ring_[k], ring_[other], ball[other], ball[k]);
    out_.quad(ball[k], ball[other], deep[other], deep[k]);
  }
}

void add_skin(const Form& form, HalfMesh& out) { SkinMaker(form, out).make(); }

}  // namespace mien::head
