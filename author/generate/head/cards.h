// SPDX-License-Identifier: MIT
// Cards of hair: strips of quads with a texture of hairs, narrower towards both ends, so that they look like locks where
// there is no texture. Coordinates are those of the image that integrations/program/render/hair_texture.h draws.
#pragma once

#include "author/generate/head/mesh.h"

namespace mien::head {

/// A part of the texture with hairs from root to tip.
struct HairLane {
  double left, right, root, tip;
};

/// Without the outermost texels, which blend with those of the neighbor. Below, `number` is any: lanes repeat. Those of
/// brows and lashes are in the right half, for the left half of the face.
inline HairLane hair_lane(double left, double width, double root, double tip) {
  constexpr double kTexel = 1.0 / 512;
  return {left + kTexel, left + width - kTexel, root + kTexel, tip - kTexel};
}
inline HairLane lock_lane(uint32_t number) { return hair_lane(number % 5 / 8.0, 0.125, 0.6, 1); }
inline HairLane line_lane() { return hair_lane(5 / 8.0, 0.125, 0.6, 1); }
inline HairLane thin_lane() { return hair_lane(6 / 8.0, 0.125, 0.6, 1); }
inline HairLane loose_lane() { return hair_lane(7 / 8.0, 0.125, 0.6, 1); }
inline HairLane curl_lane(uint32_t number) {
  return hair_lane(0.5 + number % 4 / 8.0, 0.125, 0.2, 0.6);
}
inline HairLane brow_lane(uint32_t number) {
  return hair_lane(0.5 + number % 4 / 16.0, 0.0625, 0, 0.2);
}
inline HairLane lash_lane(uint32_t number) {
  return hair_lane(0.75 + number % 4 / 16.0, 0.0625, 0, 0.2);
}

/// A row of a card: its middle, which has color and motion, and the way from there to the right edge.
struct CardRow {
  Vertex middle;
  Vec3 half;
};

constexpr uint32_t kMaxCardRows = 14;

/// At most kMaxCardRows rows from root to tip; counter-clockwise if `half` points to the right as seen from outside
/// with the tip above. `round`: how far the normals of its sides lean apart, as those of a lock do.
inline void add_card(const CardRow* rows, uint32_t count, const HairLane& lane, HalfMesh& out,
                     double round = 0) {
  const uint32_t first = out.vertices.count();
  for (uint32_t i = 0; i < count; ++i) {
    for (const double side : {-1.0, 1.0}) {
      Vertex v = rows[i].middle;
      const Vec3 step = rows[i].half * side;
      v.position = v.position + step;
      v.closed = v.closed + step;
      if (round > 0) v.normal = v.normal + unit(step) * round;
      v.u = side < 0 ? lane.left : lane.right;
      v.v = author::mix(lane.root, lane.tip, static_cast<double>(i) / (count - 1));
      out.vertices.add(v);
    }
  }
  join_rows(out, first, count, 2);
}

}  // namespace mien::head
