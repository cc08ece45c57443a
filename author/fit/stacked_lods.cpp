// SPDX-License-Identifier: MIT
#include "author/fit/stacked_lods.h"

#include <algorithm>
#include <cmath>

#include "author/base/dna_making.h"
#include "author/base/random.h"

namespace mien::author {

namespace {

// Weight of all vertices of another LOD, relative to those of LOD 0. Between 0.02 and 0.1, less
// leaves larger errors at coarse LODs, and more leaves larger errors at LOD 0.
constexpr double kLodShare = 0.06;

/// One of this many vertices becomes a row.
uint32_t stride_of(size_t count, size_t finest) {
  return static_cast<uint32_t>(std::max<size_t>(1, 4 * count / std::max<size_t>(1, finest)));
}

}  // namespace

bool stack_lods(Span<const FittedLod> lods, Arena& arena, StackedLods& out) {
  const size_t finest = lods[0].mesh.positions.count;
  size_t count = 0;
  if (!make(arena, lods.count + 1, out.starts)) return false;
  for (size_t l = 0; l < lods.count; ++l) {
    const size_t vertices = lods[l].mesh.positions.count;
    const uint32_t stride = l == 0 ? 1 : stride_of(vertices, finest);
    count += (vertices + stride - 1) / stride;
    out.starts[l + 1] = static_cast<uint32_t>(count);
  }
  out.weights.m = lods[0].weights.m;
  if (!make(arena, count, out.rows) || !make(arena, count, out.positions) ||
      !make(arena, count, out.vertices) || !make(arena, count, out.scales) ||
      !make(arena, count * out.weights.m, out.weights.joints) ||
      !make(arena, count * out.weights.m, out.weights.weights)) {
    return false;
  }
  for (size_t l = 0; l < lods.count; ++l) {
    const FittedLod& lod = lods[l];
    const uint32_t vertices = static_cast<uint32_t>(lod.mesh.positions.count);
    const uint32_t stride = l == 0 ? 1 : stride_of(vertices, finest);
    const uint32_t first = out.starts[l], end = out.starts[l + 1];
    const double share = l == 0 ? 1 : kLodShare;
    const double scale = std::sqrt(share * static_cast<double>(finest) / (end - first));
    // A random one of each run, because vertices may be ordered by rows or by halves of the face.
    Random random = Random::from_seed(1, l);
    for (uint32_t row = first; row < end; ++row) {
      const uint32_t run = (row - first) * stride;
      const uint32_t v = run + random.below(std::min(stride, vertices - run));
      out.rows[row] = v;
      out.positions[row] = lod.mesh.positions[v];
      out.vertices[row] = lod.vertices.empty() ? v : lod.vertices[v];
      out.scales[row] = scale;
    }
  }
  return true;
}

void fill_weights(Span<const FittedLod> lods, const StackedLods& out) {
  const size_t m = out.weights.m;
  for (size_t l = 0; l < lods.count; ++l) {
    const SkinWeights& from = lods[l].weights;
    for (uint32_t row = out.starts[l]; row < out.starts[l + 1]; ++row) {
      for (size_t i = 0; i < m; ++i) {
        const size_t slot = out.rows[row] * m + i;
        out.weights.joints[row * m + i] = from.joints[slot];
        out.weights.weights[row * m + i] =
            static_cast<float>(out.scales[row] * double{from.weights[slot]});
      }
    }
  }
}

}  // namespace mien::author
