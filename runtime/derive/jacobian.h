// SPDX-License-Identifier: MIT
// The pattern of a matrix of derivatives, and a coloring of its columns: those of one color have no row in common
// and share a direction (docs/derivatives.md, 9).
//
//     | Jacobian | rows | columns | first_entry | places | by_color | first_of_color |
#pragma once

#include "runtime/derive/derivatives.h"

namespace mien {

struct Jacobian : Object {
  static constexpr uint32_t kTag = 0x6D4A'4143;

  const Rig* rig = nullptr;
  const Deformer* deformer = nullptr;  // or null
  ~Jacobian() {
    release(deformer);
    release(rig);
  }

  Point from = Point::kGui, to = Point::kGui;
  uint32_t mesh = 0, lod = 0;
  Span<uint32_t> rows, columns;              // [entry] by column, then by row
  Span<uint64_t> first_entry;                // [column], one more at the end
  Span<uint32_t> row_places, column_places;  // in the buffers of Derivatives
  Span<uint32_t> by_color;                   // columns with entries
  Span<uint32_t> first_of_color;             // [color] into by_color, one more at the end
  uint32_t color_count() const { return static_cast<uint32_t>(first_of_color.count - 1); }
};

struct JacobianArgs {
  Point from, to;
  uint32_t mesh, lod;
  Span<const uint32_t> inputs, outputs;  // numbers at the points; null data: all
};
/// Null if memory ran out. It becomes an owner of the rig and of the deformer.
Jacobian* create_jacobian(const Derivatives& derivatives, const JacobianArgs& args,
                          const Allocator& allocator);

}  // namespace mien
