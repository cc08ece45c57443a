// SPDX-License-Identifier: MIT
// Where hair grows: the hair line, and places above the skull, by angle and by the way from the line to the crown.
#pragma once

#include "author/generate/head/cards.h"

namespace mien::head {

struct HairShape {
  double low, high;  // thickness at the line and above
  double sweep;      // of 1: how high the hair beside the parting rises above the forehead
  double raise_front, raise_temple;
  double hang;  // height that the sides hang down to; 0: they do not hang
};

class Scalp {
 public:
  explicit Scalp(const Form& form);

  struct Root {
    Vec3 skin, normal;
    double below;  // how far hair hangs there
  };
  /// Above the skull at an angle, `t` of the way from the hair line to the crown; `t` below 0 is in front of the line.
  Root root(double around, double t) const;
  /// A vertex that moves with the skull. Its normal leans to that of the skull, so that cards are lit as one body.
  Vertex above(const Root& root, double height, Color color) const;

  const HairShape& shape() const { return shape_; }
  const Person& person() const { return form_.person(); }
  const Form& form() const { return form_; }

 private:
  const Form& form_;
  const HairShape shape_;
};

/// Styles. The first vertex has the plain color of the hair.
void add_long_hair(const Scalp& scalp, uint32_t lod, HalfMesh& out);
void add_short_hair(const Scalp& scalp, uint32_t lod, HalfMesh& out);
void add_curls(const Scalp& scalp, uint32_t lod, HalfMesh& out);

}  // namespace mien::head
