// SPDX-License-Identifier: MIT
#include "author/mesh/own_lods.h"

#include <algorithm>
#include <limits>

#include "author/base/dna_making.h"

namespace mien::author {

namespace {

template <class... T>
Status bad_lod(Error& error, const char* format, T... values) {
  return fail(error, Status::kAuthorMesh, kNoOffset, format, values...);
}

Status no_memory_for_lods(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory for the meshes of LODs");
}

/// Lists of numbers, one for each key, in the order in which they come.
struct Lists {
  Span<uint32_t> starts;  // keys + 1
  Span<uint32_t> items;

  Span<const uint32_t> of(uint32_t key) const {
    return items.slice(starts[key], starts[key + 1] - starts[key]);
  }
  /// Item i belongs to the key `keys[i]`.
  bool make(size_t key_count, Span<const uint32_t> keys, Arena& arena) {
    if (!author::make(arena, key_count + 2, starts) || !author::make(arena, keys.count, items)) {
      return false;
    }
    for (const uint32_t key : keys) ++starts[key + 2];
    for (size_t k = 2; k < starts.count; ++k) starts[k] += starts[k - 1];
    for (uint32_t i = 0; i < keys.count; ++i) items[starts[keys[i] + 1]++] = i;
    --starts.count;
    return true;
  }
};

class LodTaker {
 public:
  LodTaker(const MeshSource& source, const ReadMesh& read, Arena& scratch)
      : source_(source), read_(read), mesh_(read.mesh), scratch_(scratch) {}

  bool make() {
    if (!author::make(scratch_, mesh_.positions.count, part_of_) ||
        !copies_.make(source_.positions.count / 3, read_.source_vertices, scratch_) ||
        (!mesh_.corner_uvs.empty() &&
         !corners_of_.make(mesh_.positions.count, mesh_.corners, scratch_))) {
      return false;
    }
    for (uint32_t p = 0; p < mesh_.parts.count; ++p) {
      const Part& part = mesh_.parts[p];
      for (uint32_t i = 0; i < part.vertex_count; ++i) part_of_[part.first_vertex + i] = p;
    }
    return true;
  }

  /// Checks LOD `l`; its triangles lie in `scratch`, sorted by part.
  Status take(const LodSource& lod, size_t l, Arena& scratch, LodTriangles& out, Error& error) {
    const size_t count = lod.corners.count / 3;
    Span<uint32_t> parts, corners, uvs, starts;
    if (count == 0 || lod.corners.count % 3 != 0) {
      return bad_lod(error,
                     "LOD %zu has %zu corners: 3 for each triangle are needed, and a triangle", l,
                     lod.corners.count);
    }
    if (lod.corners.count > std::numeric_limits<uint32_t>::max()) {
      return bad_lod(error, "LOD %zu has %zu corners: %u are allowed", l, lod.corners.count,
                     std::numeric_limits<uint32_t>::max());
    }
    if (!author::make(scratch, count, parts) || !author::make(scratch, 3 * count, corners) ||
        !author::make(scratch, mesh_.corner_uvs.empty() ? 0 : 3 * count, uvs) ||
        !author::make(scratch, mesh_.parts.count + 1, starts)) {
      return no_memory_for_lods(error);
    }
    Status status = check_uvs(lod, l, error);
    for (size_t t = 0; t < count && status == Status::kOk; ++t) {
      status = find_part(lod, l, t, parts[t], error);
      if (status == Status::kOk) ++starts[parts[t] + 1];
    }
    if (status != Status::kOk) return status;
    for (size_t p = 0; p + 1 < starts.count; ++p) starts[p + 1] += starts[p];
    Span<uint32_t> next;
    if (!author::make(scratch, mesh_.parts.count, next)) return no_memory_for_lods(error);
    for (size_t p = 0; p < next.count; ++p) next[p] = starts[p];
    for (size_t t = 0; t < count; ++t) {
      const size_t to = 3 * size_t{next[parts[t]]++};
      for (size_t k = 0; k < 3; ++k) corners[to + k] = copy_in(lod.corners[3 * t + k], parts[t]);
      if (uvs.empty()) continue;
      if (lod.corner_uvs.empty()) {
        find_uvs(&corners[to], &uvs[to]);
      } else {
        for (size_t k = 0; k < 3; ++k) uvs[to + k] = lod.corner_uvs[3 * t + k];
      }
    }
    for (uint32_t& start : starts) start *= 3;
    out.corners = corners;
    out.corner_uvs = uvs;
    out.starts = starts;
    return Status::kOk;
  }

 private:
  Status check_uvs(const LodSource& lod, size_t l, Error& error) const {
    if (lod.corner_uvs.empty()) return Status::kOk;
    if (mesh_.corner_uvs.empty()) {
      return bad_lod(error, "LOD %zu has UVs, but the mesh has none", l);
    }
    if (lod.corner_uvs.count != lod.corners.count) {
      return bad_lod(error, "LOD %zu has %zu corners, but UVs for %zu", l, lod.corners.count,
                     lod.corner_uvs.count);
    }
    for (size_t c = 0; c < lod.corner_uvs.count; ++c) {
      if (lod.corner_uvs[c] < mesh_.uvs.count) continue;
      return bad_lod(error, "corner %zu of LOD %zu names UV %u, but there are %zu", c, l,
                     lod.corner_uvs[c], mesh_.uvs.count);
    }
    return Status::kOk;
  }

  /// The vertex of a position in a part, or kNone.
  uint32_t copy_in(uint32_t position, uint32_t part) const {
    const Span<const uint32_t> copies = copies_.of(position);
    // Vertices are numbered part after part.
    const uint32_t first = mesh_.parts[part].first_vertex;
    const uint32_t* found = std::lower_bound(copies.begin(), copies.end(), first);
    return found != copies.end() && part_of_[*found] == part ? *found : kNone;
  }

  Status find_part(const LodSource& lod, size_t l, size_t t, uint32_t& out, Error& error) const {
    const uint32_t* c = &lod.corners[3 * t];
    const size_t n = source_.positions.count / 3;
    for (size_t k = 0; k < 3; ++k) {
      if (c[k] >= n) {
        return bad_lod(error, "corner %zu of LOD %zu names position %u, but there are %zu",
                       3 * t + k, l, c[k], n);
      }
      if (copies_.of(c[k]).empty()) {
        return bad_lod(error, "corner %zu of LOD %zu names position %u, which is in no face",
                       3 * t + k, l, c[k]);
      }
      if (c[k] != c[(k + 1) % 3]) continue;
      return bad_lod(error, "triangle %zu of LOD %zu has position %u twice", t, l, c[k]);
    }
    for (const uint32_t copy : copies_.of(c[0])) {
      out = part_of_[copy];
      if (copy_in(c[1], out) != kNone && copy_in(c[2], out) != kNone) return Status::kOk;
    }
    return bad_lod(error,
                   "triangle %zu of LOD %zu has positions %u, %u and %u: no object has all three",
                   t, l, c[0], c[1], c[2]);
  }

  /// Where charts meet, a vertex has several coordinates: the nearest ones most likely belong to
  /// one chart.
  void find_uvs(const uint32_t* vertices, uint32_t* out) const {
    constexpr size_t kMost = 64;  // corners of a vertex that are looked at
    const auto distance = [this](uint32_t a, uint32_t b) {
      const Uv p = mesh_.uvs[a], q = mesh_.uvs[b];
      const double u = double{p.u} - double{q.u}, v = double{p.v} - double{q.v};
      return u * u + v * v;
    };
    Span<const uint32_t> choices[3];
    for (size_t k = 0; k < 3; ++k) {
      choices[k] = corners_of_.of(vertices[k]);
      choices[k].count = std::min(choices[k].count, kMost);
    }
    double least = std::numeric_limits<double>::infinity();
    for (const uint32_t first : choices[0]) {
      const uint32_t uv = mesh_.corner_uvs[first];
      uint32_t near[3] = {uv, 0, 0};
      double sum = 0;
      for (size_t k = 1; k < 3; ++k) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const uint32_t corner : choices[k]) {
          const double d = distance(uv, mesh_.corner_uvs[corner]);
          if (!(d < nearest)) continue;
          nearest = d;
          near[k] = mesh_.corner_uvs[corner];
        }
        sum += nearest;
      }
      if (!(sum < least)) continue;
      least = sum;
      for (size_t k = 0; k < 3; ++k) out[k] = near[k];
    }
  }

  const MeshSource& source_;
  const ReadMesh& read_;
  const AuthorMesh& mesh_;
  Arena& scratch_;
  Span<uint32_t> part_of_;  // per vertex
  Lists copies_;            // vertices of each position of the source
  Lists corners_of_;        // of each vertex; with UVs
};

}  // namespace

Status take_lod_meshes(const MeshSource& source, const ReadMesh& read, Span<const LodSource> lods,
                       Arena& arena, const Allocator& allocator, Span<LodMesh>& out, Error& error) {
  Arena scratch(allocator);
  LodTaker taker(source, read, scratch);
  if (!make(arena, lods.count + 1, out) || !taker.make()) return no_memory_for_lods(error);
  out[0].mesh = read.mesh;
  for (size_t l = 1; l < out.count; ++l) {
    Arena for_lod(allocator);
    LodTriangles triangles;
    const Status status = taker.take(lods[l - 1], l, for_lod, triangles, error);
    if (status != Status::kOk) return status;
    if (!make_lod_mesh(read.mesh, triangles, arena, allocator, out[l]))
      return no_memory_for_lods(error);
  }
  return Status::kOk;
}

}  // namespace mien::author
