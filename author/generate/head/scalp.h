// SPDX-License-Identifier: MIT
// Where hair grows: the hair line, places above the skull by angle and by the way from the line to the crown, and how
// thick and dense hair is there.
#pragma once

#include "author/generate/head/cards.h"

namespace mien::head {

/// What a style is made of.
struct HairShape {
  double low, high;                  // thickness at the line and above, cm
  double wave;                       // how much higher it is over the forehead
  double raise_front, raise_temple;  // of the line
  double hang;                       // height that the sides hang down to; 0: they do not hang
  double sides, top;                 // lengths of hairs, cm
  double swept;                      // hairs of the forehead lie to the side (0) or back (1)
  double parting;                    // its depth: 0 none ... 1
  double thin;                       // share of the hairs that the crown lacks
  uint32_t shells, locks;            // at LOD 0
  bool curls;
};

class Scalp {
 public:
  explicit Scalp(const Form& form);

  struct Root {
    Vec3 skin, normal;
    double row;    // height on the form
    double below;  // how far hair hangs there
  };
  /// Above the skull at an angle, `t` of the way from the border of the hair to the crown; `t` below 0 is outside.
  Root root(double around, double t) const;
  /// Height of such a place on the form, and the other way around.
  double row_of(double around, double t) const;
  double share_of(double around, double row) const;
  /// Height of the line where hairs grow; that of hanging hair is lower.
  double line(double around) const;
  /// Thickness of the hair.
  double body(double around, double t, const Root& root) const;
  /// Share of the hairs that grow at a height, 0 ... 1.
  double density(double row) const;
  /// A vertex that moves with the skull. Its normal leans to that of the skull, so that cards are lit as one body.
  Vertex above(const Root& root, double height, Color color) const;

  const HairShape& shape() const { return shape_; }
  const Person& person() const { return form_.person(); }

 private:
  const Form& form_;
  const HairShape shape_;
};

constexpr double kParting = 0.42;  // its angle; it ends at the crown

/// A place on the scalp as seen from above, with the crown in the middle and the border of the hair at distance 1.
struct MapPlace {
  double x, z;  // to the left and to the front
  double far() const { return std::sqrt(x * x + z * z); }
  double around() const { return author::exact_atan2(x, z); }
};

/// The way in which hairs are combed there, of length 1, turned by an angle.
MapPlace combed(const Scalp& scalp, MapPlace at, double turn);

/// Shells over the skull with a texture of short hairs, under everything else.
void add_shells(const Scalp& scalp, uint32_t lod, HalfMesh& out);
/// Locks or curls, and thin hairs at the line.
void add_locks(const Scalp& scalp, uint32_t lod, HalfMesh& out);
/// Hair that hangs down.
void add_sheet(const Scalp& scalp, uint32_t lod, HalfMesh& out);

}  // namespace mien::head
