// SPDX-License-Identifier: MIT
#include "author/document/skin.h"

#include <algorithm>
#include <cmath>

#include "author/base/dna_making.h"
#include "author/document/check_view.h"
#include "author/document/pose.h"
#include "author/document/renumber.h"
#include "author/mesh/topology.h"

namespace mien::author {

using dna::NewArray;
using dna::VertexSkinWeights;

namespace {

/// Begins an edit of the weights of a mesh, whose lists are copies then.
Status begin_weights(Document& document, Edit& edit, uint32_t mesh, Error& error) {
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  if (!edit.begin(error)) return error.status;
  if (Status s = check_indices({&mesh, 1}, edit.view.geom.meshes.count, "mesh", error);
      s != Status::kOk)
    return s;
  Arena& arena = edit.arena();
  const bool done = copy_list(arena, edit.view.geom.meshes) &&
                    copy_list(arena, edit.view.geom.meshes[mesh].skin_weights);
  return done ? Status::kOk : no_memory(error, "an edit");
}

void commit_weights(Edit& edit, uint32_t mesh) {
  dna::Mesh& changed = edit.view.geom.meshes[mesh];
  uint32_t most = 0;
  for (const VertexSkinWeights& vertex : changed.skin_weights)
    most = std::max(most, vertex.weights.count);
  changed.maximum_influence_per_vertex = static_cast<uint16_t>(std::min(most, 65535u));
  edit.commit(true);
}

/// Weights of a vertex in native order.
struct SkinInfluence {
  uint32_t joint;
  double weight;
};

bool write_vertex(Arena& arena, const SkinInfluence* from, uint32_t count, VertexSkinWeights& out) {
  NewArray<uint16_t> joints;
  NewArray<float> weights;
  if (!make(arena, count, joints) || !make(arena, count, weights)) return false;
  for (uint32_t i = 0; i < count; ++i) {
    joints.set(i, static_cast<uint16_t>(from[i].joint));
    weights.set(i, static_cast<float>(from[i].weight));
  }
  out.joint_indices = joints;
  out.weights = weights;
  return true;
}

/// Moves the `limit` largest of `list` to its front, in their order, and scales them to `sum`.
uint32_t keep_largest(SkinInfluence* list, uint32_t count, uint32_t limit, double sum) {
  while (count > limit) {
    uint32_t least = count - 1;
    for (uint32_t i = count - 1; i-- > 0;) {
      if (list[i].weight < list[least].weight) least = i;
    }
    std::copy(list + least + 1, list + count, list + least);
    --count;
  }
  double left = 0;
  for (uint32_t i = 0; i < count; ++i) left += list[i].weight;
  if (!(left > 0)) return count;
  for (uint32_t i = 0; i < count; ++i) list[i].weight *= sum / left;
  return count;
}

Status check_limit(uint32_t influences, Error& error) {
  if (influences != 0) return Status::kOk;
  return fail(error, Status::kInvalidArgument, kNoOffset,
              "0 influences: a vertex keeps at least one");
}

}  // namespace

Status set_skin_weights(Document& document, uint32_t mesh, const uint16_t* joints,
                        const float* weights, size_t positions, uint32_t influences, Error& error) {
  Edit edit(document);
  if (Status s = begin_weights(document, edit, mesh, error); s != Status::kOk) return s;
  dna::Mesh& changed = edit.view.geom.meshes[mesh];
  if (positions != changed.positions.xs.count) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "mesh %u has %u positions, not %zu",
                mesh, changed.positions.xs.count, positions);
  }
  if (Status s = check_limit(influences, error); s != Status::kOk) return s;
  Arena& arena = edit.arena();
  Span<SkinInfluence> row;
  if (!make(arena, influences, row) || !make(arena, positions, changed.skin_weights))
    return no_memory(error, "an edit");
  const uint32_t joint_count = edit.view.defn.joint_names.count;
  for (size_t v = 0; v < positions; ++v) {
    uint32_t count = 0;
    for (size_t i = v * influences; i < (v + 1) * influences; ++i) {
      if (weights[i] == 0) continue;
      const char* wrong = nullptr;
      if (!(weights[i] > 0) || !std::isfinite(weights[i]))
        wrong = "a weight that is negative or not finite";
      if (joints[i] >= joint_count) wrong = "a joint that does not exist";
      for (uint32_t k = 0; k < count; ++k) {
        if (row[k].joint == joints[i]) wrong = "a joint twice";
      }
      if (wrong)
        return fail(error, Status::kInvalidArgument, kNoOffset, "position %zu has %s", v, wrong);
      row[count++] = {joints[i], double{weights[i]}};
    }
    if (count == 0)
      return fail(error, Status::kInvalidArgument, kNoOffset, "position %zu has no weight", v);
    if (!write_vertex(arena, row.data, count, changed.skin_weights[v]))
      return no_memory(error, "an edit");
  }
  commit_weights(edit, mesh);
  return Status::kOk;
}

namespace {

/// Calls change(list, count), which returns the new count, for each vertex that `concerns`.
template <class Concerns, class Change>
Status change_weights(Document& document, uint32_t mesh, const Concerns& concerns,
                      const Change& change, Error& error) {
  Edit edit(document);
  if (Status s = begin_weights(document, edit, mesh, error); s != Status::kOk) return s;
  dna::Mesh& changed = edit.view.geom.meshes[mesh];
  uint32_t most = 0;
  for (const VertexSkinWeights& vertex : changed.skin_weights)
    most = std::max(most, vertex.weights.count);
  Arena scratch(document.allocator());
  const Span<SkinInfluence> row = scratch.array<SkinInfluence>(most);
  if (row.count != most) return no_memory(error, "an edit");
  for (VertexSkinWeights& vertex : changed.skin_weights) {
    double sum = 0;
    uint32_t count = vertex.weights.count;
    for (uint32_t i = 0; i < count; ++i) {
      row[i] = {vertex.joint_indices[i], double{vertex.weights[i]}};
      sum += row[i].weight;
    }
    if (!concerns(count, sum)) continue;
    count = change(row.data, count, sum);
    if (!write_vertex(edit.arena(), row.data, count, vertex)) return no_memory(error, "an edit");
  }
  commit_weights(edit, mesh);
  return Status::kOk;
}

}  // namespace

Status normalize_skin_weights(Document& document, uint32_t mesh, Error& error) {
  return change_weights(
      document, mesh, [](uint32_t, double sum) { return sum > 0 && std::abs(sum - 1) > 1e-6; },
      [](SkinInfluence* list, uint32_t count, double) {
        return keep_largest(list, count, count, 1);
      },
      error);
}

Status limit_influences(Document& document, uint32_t mesh, uint32_t influences, Error& error) {
  if (Status s = check_limit(influences, error); s != Status::kOk) return s;
  return change_weights(
      document, mesh, [&](uint32_t count, double) { return count > influences; },
      [&](SkinInfluence* list, uint32_t count, double sum) {
        return keep_largest(list, count, influences, sum);
      },
      error);
}

// Smoothing -----------------------------------------------------------------------------------------

namespace {

/// Neighbors of each place along edges: the first vertices at other places.
struct Neighbors {
  Span<uint32_t> starts, items;
};

bool find_neighbors(const dna::Mesh& mesh, Span<const uint32_t> welded, Arena& arena,
                    Neighbors& out) {
  const size_t count = welded.count;
  if (!make(arena, count + 1, out.starts)) return false;
  const auto for_each_edge = [&](auto&& f) {
    for (const dna::Face& face : mesh.faces) {
      const uint32_t corners = face.layout_indices.count;
      for (uint32_t c = 0; c < corners; ++c) {
        const uint32_t a = welded[mesh.layouts.positions[face.layout_indices[c]]];
        const uint32_t b = welded[mesh.layouts.positions[face.layout_indices[(c + 1) % corners]]];
        if (a == b) continue;
        f(a, b);
        f(b, a);
      }
    }
  };
  for_each_edge([&](uint32_t a, uint32_t) { ++out.starts[a + 1]; });
  for (size_t v = 0; v < count; ++v) out.starts[v + 1] += out.starts[v];
  Span<uint32_t> next;
  if (!make(arena, out.starts[count], out.items) || !make(arena, count, next)) return false;
  for_each_edge([&](uint32_t a, uint32_t b) { out.items[out.starts[a] + next[a]++] = b; });
  // Each once: an edge belongs to two faces.
  uint32_t kept = 0;
  for (size_t v = 0; v < count; ++v) {
    uint32_t* const first = out.items.data + out.starts[v];
    uint32_t* const last = out.items.data + out.starts[v + 1];
    std::sort(first, last);
    const auto unique = static_cast<uint32_t>(std::unique(first, last) - first);
    std::copy(first, first + unique, out.items.data + kept);
    out.starts[v] = kept;
    kept += unique;
  }
  out.starts[count] = kept;
  return true;
}

}  // namespace

Status smooth_skin_weights(Document& document, uint32_t mesh, uint32_t iterations, float strength,
                           uint32_t influences, Error& error) {
  if (Status s = check_limit(influences, error); s != Status::kOk) return s;
  if (!(strength >= 0 && strength <= 1) || iterations > 1000) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "strength %g, %u iterations: strength is 0 to 1, iterations are at most 1000",
                static_cast<double>(strength), iterations);
  }
  Edit edit(document);
  if (Status s = begin_weights(document, edit, mesh, error); s != Status::kOk) return s;
  dna::Mesh& changed = edit.view.geom.meshes[mesh];
  const uint32_t vertices = changed.skin_weights.count;
  if (vertices == 0 || iterations == 0) return Status::kOk;

  Arena scratch(document.allocator()), temporary(document.allocator());
  const uint32_t joints = edit.view.defn.joint_names.count;
  Span<Vec3> positions;
  Span<uint32_t> welded;
  Neighbors neighbors;
  if (!make(scratch, vertices, positions)) return no_memory(error, "smoothing");
  for (uint32_t v = 0; v < vertices; ++v) positions[v] = vector_of(changed.positions, v);
  if (!weld(positions, {}, scratch, temporary, welded) ||
      !find_neighbors(changed, welded, scratch, neighbors)) {
    return no_memory(error, "smoothing");
  }

  // Rows of up to `influences` weights per place; sums of a vertex in an array over all joints.
  Span<SkinInfluence> now, then, row;
  Span<uint32_t> now_counts, then_counts;
  Span<double> sums;
  uint32_t widest = influences;
  for (const VertexSkinWeights& vertex : changed.skin_weights)
    widest = std::max(widest, vertex.weights.count);
  if (!make(scratch, size_t{vertices} * widest, now) ||
      !make(scratch, size_t{vertices} * widest, then) || !make(scratch, vertices, now_counts) ||
      !make(scratch, vertices, then_counts) || !make(scratch, joints, sums) ||
      !make(scratch, joints, row)) {
    return no_memory(error, "smoothing");
  }
  for (uint32_t v = 0; v < vertices; ++v) {
    const VertexSkinWeights& vertex = changed.skin_weights[welded[v]];
    now_counts[v] = vertex.weights.count;
    for (uint32_t i = 0; i < vertex.weights.count; ++i) {
      now[size_t{v} * widest + i] = {vertex.joint_indices[i], double{vertex.weights[i]}};
    }
  }
  for (uint32_t iteration = 0; iteration < iterations; ++iteration) {
    for (uint32_t v = 0; v < vertices; ++v) {
      if (welded[v] != v) continue;
      uint32_t count = 0;
      const auto add = [&](uint32_t from, double share) {
        for (uint32_t i = 0; i < now_counts[from]; ++i) {
          const SkinInfluence& influence = now[size_t{from} * widest + i];
          if (sums[influence.joint] == 0 && influence.weight * share != 0)
            row[count++].joint = influence.joint;
          sums[influence.joint] += influence.weight * share;
        }
      };
      const uint32_t first = neighbors.starts[v], last = neighbors.starts[v + 1];
      add(v, first == last ? 1 : 1 - double{strength});
      for (uint32_t n = first; n < last; ++n)
        add(neighbors.items[n], double{strength} / (last - first));
      double sum = 0;
      for (uint32_t i = 0; i < count; ++i) {
        row[i].weight = sums[row[i].joint];
        sum += row[i].weight;
        sums[row[i].joint] = 0;
      }
      // As many as it keeps, heaviest last to fall.
      if (count > influences) {
        std::sort(row.data, row.data + count, [](const SkinInfluence& a, const SkinInfluence& b) {
          return a.weight != b.weight ? a.weight > b.weight : a.joint < b.joint;
        });
      }
      count = keep_largest(row.data, std::min(count, influences), influences, sum > 0 ? 1 : 0);
      then_counts[v] = count;
      std::copy(row.data, row.data + count, then.data + size_t{v} * widest);
    }
    std::swap(now, then);
    std::swap(now_counts, then_counts);
  }
  for (uint32_t v = 0; v < vertices; ++v) {
    const uint32_t from = welded[v];
    if (!write_vertex(edit.arena(), now.data + size_t{from} * widest, now_counts[from],
                      changed.skin_weights[v])) {
      return no_memory(error, "an edit");
    }
  }
  commit_weights(edit, mesh);
  return Status::kOk;
}

}  // namespace mien::author
