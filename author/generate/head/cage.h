// SPDX-License-Identifier: MIT
// The cage of the skin: a table of curves on the form, in which patches of quads lie. It is laid out as
// animators expect it: loops around eye and mouth, a loop from the wing of the nose along the nasolabial fold
// to the chin, loops around the jaw from the temple to the throat.
//
// Each curve has a number of segments, equal on opposite sides of a patch. The layout is made in the plane of
// Form::face(), evened out on the form, and then has a place for each vertex outside of lids, lips, nostrils
// and ears. Holes are left for those; their borders are filled with rings.
#pragma once

#include "author/generate/head/mesh.h"

namespace mien::head {

/// A place of the form: see Form::face().
struct Place {
  double angle, y;
};

inline Place between(Place a, Place b, double t) {
  return {author::mix(a.angle, b.angle, t), author::mix(a.y, b.y, t)};
}

/// Segments of the cage. Around the eye, inner + low + outer are equal below and above; the ring of
/// the mouth has as many segments below its corner as above it.
struct Segments {
  uint32_t nose;                              // columns from its ridge to its side
  uint32_t inner_low, eye_low, outer_low;     // below the eye, from its inner to its outer corner
  uint32_t inner_high, eye_high, outer_high;  // above it
  uint32_t cheek;                             // rows between eye and nasolabial fold
  uint32_t wing;                              // rows of the wing of the nose
  uint32_t corner;                            // from the outer cheek to the corner of the mouth
  uint32_t side;                         // columns from the eye to the ear, loops around the jaw
  uint32_t before_ear, ear, behind_ear;  // columns
  uint32_t forehead, neck, chest;        // rows
};

constexpr uint32_t kMaxRing = 128;

/// A place of the layout.
struct Spot {
  Place place;
  Place home = {0, 0};  // where the design has it
  double hold = 0;      // how much it stays there
  Side lid = Side::kAbove, lip = Side::kAbove;
  bool keep_angle = false, keep_y = false;
  bool on_plane() const { return keep_angle && !keep_y; }
};

/// The border of a hole, later the last ring in it: against the clock as seen from the front.
struct Ring {
  uint32_t at[kMaxRing];
  uint32_t count = 0;
  uint32_t half = 0;   // the outer corner; beyond it spots are above the slit
  bool whole = false;  // closed; otherwise its first and last are on the plane of symmetry
};

class Layout {
 public:
  Layout(const Form& form, const Segments& segments, Arena& arena)
      : spots(arena), quads(arena), form_(form), segments_(segments), arena_(arena) {}

  /// Places all patches.
  void make();

  /// `whole` rings start in the middle of a side, others at the plane of symmetry.
  Ring eye() const;
  Ring mouth() const;
  Ring nostril() const;
  Ring ear() const;

  enum class Hole { kLids, kLips, kOther };
  /// Fills `border` up to a curve, whose spots it is then. `curve(k)` gives their places. `last`: where the
  /// last ring before the curve is: close to it, so that what the curve separates has a sharp border.
  template <class Curve>
  void fill(Ring& border, uint32_t count, double last, Hole hole, const Curve& curve) {
    const Ring from = border;
    for (uint32_t r = 1; r <= count; ++r) {
      Ring next = border;
      for (uint32_t k = 0; k < border.count; ++k) {
        const double t = r == count ? 1 : last * r / (count - 1);
        Spot spot;
        spot.place = between(spots[from.at[k]].place, curve(k), t);
        const Side side = k > border.half ? Side::kAbove : Side::kBelow;
        spot.lid = hole == Hole::kLids ? side : Side::kBelow;
        spot.lip = hole == Hole::kLips ? side : Side::kAbove;
        spot.home = spot.place;
        const double inwards = static_cast<double>(r) / count;
        spot.hold = inwards * inwards * inwards;
        spot.keep_y = r + 1 >= count;
        spot.keep_angle = spot.keep_y;
        if (!border.whole && (k == 0 || k + 1 == border.count)) {
          spot.place.angle = 0;
          spot.keep_angle = true;
        }
        next.at[k] = spots.add(spot);
      }
      for (uint32_t k = 0; k + (border.whole ? 0 : 1) < border.count; ++k) {
        const uint32_t other = (k + 1) % border.count;
        quads.add({{border.at[k], border.at[other], next.at[other], next.at[k]}, 4});
      }
      border = next;
    }
  }

  /// Moves spots until edges are of similar length on the form.
  void even_out(uint32_t rounds);

  bool failed() const { return failed_ || spots.failed() || quads.failed(); }

  Growing<Spot> spots;
  Growing<Face> quads;
  /// Columns that end at the crown and at the bottom, from front to back.
  uint32_t crown_ends[kMaxRing], bottom_ends[kMaxRing];
  uint32_t crown_count = 0, bottom_count = 0;

 private:
  struct Line {
    Span<uint32_t> spots;
  };
  uint32_t side_of(const uint8_t* nodes, uint32_t* out) const;
  Ring ring_of(const uint8_t* nodes, bool whole) const;
  void make_curves();
  void make_patch(const uint8_t (&sides)[4][5]);

  const Form& form_;
  const Segments& segments_;
  Arena& arena_;
  bool failed_ = false;
  static constexpr uint32_t kMaxCurves = 96, kMaxNodes = 64;
  uint32_t nodes_[kMaxNodes];
  Line lines_[kMaxCurves];
};

}  // namespace mien::head
