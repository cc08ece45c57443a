// SPDX-License-Identifier: MIT
#include "author/base/dna_making.h"
#include "author/weights/carriers.h"

namespace mien::author {

bool connect_supports(const AuthorMesh& mesh, const SurfaceGraph& graph, const Placement& placement,
                      uint32_t head, Arena& scratch, SkinWeights& out) {
  const size_t n = mesh.positions.count;
  const uint32_t m = out.m;
  Span<uint32_t> starts, members, stack;
  Span<uint32_t> seen;  // by which bone and piece
  if (!make(scratch, placement.bones.count + 2, starts) || !make(scratch, n * m, members) ||
      !make(scratch, n, stack) || !make(scratch, n, seen)) {
    return false;
  }
  const auto is_place = [&](uint32_t v) { return mesh.is_skin[v] && mesh.welded[v] == v; };
  const auto slot_of = [&](uint32_t v, uint32_t bone) -> uint32_t {
    for (uint32_t i = 0; i < m; ++i) {
      if (out.joints[size_t{v} * m + i] == bone && out.weights[size_t{v} * m + i] > 0) return i;
    }
    return kNone;
  };
  for (int fill = 0; fill < 2; ++fill) {
    for (uint32_t v = 0; v < n; ++v) {
      for (uint32_t i = 0; i < m && is_place(v); ++i) {
        if (!(out.weights[size_t{v} * m + i] > 0)) continue;
        const uint32_t bone = out.joints[size_t{v} * m + i];
        if (fill) {
          members[starts[bone + 1]++] = v;
        } else {
          ++starts[bone + 2];
        }
      }
    }
    for (size_t b = 0; b + 1 < starts.count && !fill; ++b) starts[b + 1] += starts[b];
  }
  uint32_t piece = 0;
  for (uint32_t b = placement.first_facial; b < placement.first_facial + placement.facial_count;
       ++b) {
    const uint32_t first_piece = piece + 1;
    uint32_t best_piece = 0;
    float best = 0;
    for (uint32_t i = starts[b]; i < starts[b + 1]; ++i) {
      if (seen[members[i]] >= first_piece) continue;
      ++piece;
      uint32_t count = 0;
      stack[count++] = members[i];
      seen[members[i]] = piece;
      while (count > 0) {
        const uint32_t v = stack[--count];
        const float weight = out.weights[size_t{v} * m + slot_of(v, b)];
        if (weight > best) {
          best = weight;
          best_piece = piece;
        }
        for (uint32_t e = graph.starts[v]; e < graph.starts[v + 1]; ++e) {
          const uint32_t to = graph.neighbors[e];
          if (seen[to] >= first_piece || slot_of(to, b) == kNone) continue;
          seen[to] = piece;
          stack[count++] = to;
        }
      }
    }
    if (piece <= first_piece) continue;
    for (uint32_t i = starts[b]; i < starts[b + 1]; ++i) {
      const uint32_t v = members[i];
      if (seen[v] == best_piece) continue;
      InfluenceList list = load(v, out);
      for (uint32_t k = 0; k < list.count; ++k) {
        if (list.joints[k] == b) list.values[k] = 0;
      }
      if (list.sum() <= 0) list.add(head, 1);
      store(list, v, out);
    }
  }
  for (uint32_t v = 0; v < n; ++v) {
    const size_t place = mesh.welded[v];
    if (!mesh.is_skin[v] || place == v) continue;
    for (uint32_t i = 0; i < m; ++i) {
      out.joints[size_t{v} * m + i] = out.joints[place * m + i];
      out.weights[size_t{v} * m + i] = out.weights[place * m + i];
    }
  }
  return true;
}

}  // namespace mien::author
