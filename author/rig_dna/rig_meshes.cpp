// SPDX-License-Identifier: MIT
// Geometry of an authored rig: every part at every LOD, part by part within a LOD.
#include <algorithm>

#include "author/base/dna_making.h"
#include "author/rig_dna/rig_model.h"

namespace mien::author {

namespace {

/// Area-weighted normals of the vertices; vertices at one position share a normal.
void find_normals(const AuthorMesh& mesh, Span<Vec3> out) {
  for (Vec3& n : out) n = {};
  for (size_t t = 0; t + 2 < mesh.triangles.count; t += 3) {
    const uint32_t* c = &mesh.triangles[t];
    const Vec3 a = mesh.positions[c[0]];
    const Vec3 n = cross(mesh.positions[c[1]] - a, mesh.positions[c[2]] - a);
    for (int i = 0; i < 3; ++i) out[mesh.welded[c[i]]] = out[mesh.welded[c[i]]] + n;
  }
  for (size_t v = 0; v < out.count; ++v) {
    if (mesh.welded[v] != v) continue;
    out[v] = normalized(out[v]);
    if (is_zero(out[v])) out[v] = {0, 1, 0};
  }
  for (size_t v = 0; v < out.count; ++v) out[v] = out[mesh.welded[v]];
}

/// A coarse surface is shaded like the fine one, except where it has lost a fold.
void take_normals(const FittedLod& lod, Span<const Vec3> finest, Span<Vec3> out) {
  find_normals(lod.mesh, out);
  for (size_t v = 0; v < lod.vertices.count; ++v) {
    const Vec3 n = finest[lod.vertices[v]];
    if (dot(n, out[v]) > 0.7) out[v] = n;
  }
}

class MeshMaker {
 public:
  MeshMaker(const RigModel& rig, size_t part, size_t lod, Arena& arena, Arena& scratch)
      : rig_(rig), mesh_(rig.lods[lod].mesh), part_(mesh_.parts[part]), lod_(lod), arena_(arena),
        scratch_(scratch) {}

  bool make(Span<const Vec3> normals, dna::Mesh& out) {
    return make_points(normals, out) && make_corners(out) && make_weights(out) && make_targets(out);
  }

 private:
  bool make_points(Span<const Vec3> normals, dna::Mesh& out) {
    NewVec3s positions, directions;
    if (!positions.allocate(arena_, part_.vertex_count) ||
        !directions.allocate(arena_, part_.vertex_count)) {
      return false;
    }
    for (uint32_t i = 0; i < part_.vertex_count; ++i) {
      positions.set(i, mesh_.frame.to_file(mesh_.positions[part_.first_vertex + i]));
      directions.set(i, mesh_.frame.to_file(normals[part_.first_vertex + i]));
    }
    out.positions = positions;
    out.normals = directions;
    return true;
  }

  /// One layout for each distinct pair of position and texture coordinate.
  bool make_corners(dna::Mesh& out) {
    const Span<const uint32_t> starts =
        mesh_.face_starts.slice(part_.first_face, part_.face_count + 1);
    const uint32_t first = starts[0], count = starts[part_.face_count] - first;
    Span<uint64_t> pairs;
    Span<uint32_t> uv_numbers;
    if (!author::make(scratch_, count, pairs) || !author::make(scratch_, count, uv_numbers)) {
      return false;
    }
    const auto pair_of = [&](uint32_t corner) {
      const uint64_t position = mesh_.corners[first + corner] - part_.first_vertex;
      return position << 32 | (mesh_.corner_uvs.empty() ? 0u : mesh_.corner_uvs[first + corner]);
    };
    for (uint32_t i = 0; i < count; ++i) pairs[i] = pair_of(i);
    std::sort(pairs.begin(), pairs.end());
    pairs.count = static_cast<size_t>(std::unique(pairs.begin(), pairs.end()) - pairs.begin());
    // Texture coordinates that the part uses, in ascending order of index.
    for (size_t i = 0; i < pairs.count; ++i) uv_numbers[i] = static_cast<uint32_t>(pairs[i]);
    uv_numbers.count = pairs.count;
    std::sort(uv_numbers.begin(), uv_numbers.end());
    uv_numbers.count =
        static_cast<size_t>(std::unique(uv_numbers.begin(), uv_numbers.end()) - uv_numbers.begin());

    dna::NewArray<uint32_t> positions, coordinates, normals, indices;
    dna::NewArray<float> us, vs;
    if (!author::make(arena_, pairs.count, positions) ||
        !author::make(arena_, pairs.count, coordinates) ||
        !author::make(arena_, pairs.count, normals) ||
        !author::make(arena_, uv_numbers.count, us) ||
        !author::make(arena_, uv_numbers.count, vs) ||
        !author::make(arena_, part_.face_count, out.faces) ||
        !author::make(arena_, count, indices)) {
      return false;
    }
    for (size_t i = 0; i < pairs.count; ++i) {
      const uint32_t position = static_cast<uint32_t>(pairs[i] >> 32);
      const uint32_t* uv =
          std::lower_bound(uv_numbers.begin(), uv_numbers.end(), static_cast<uint32_t>(pairs[i]));
      positions.set(i, position);
      coordinates.set(i, static_cast<uint32_t>(uv - uv_numbers.begin()));
      normals.set(i, position);
    }
    for (size_t i = 0; i < uv_numbers.count; ++i) {
      const Uv uv = mesh_.corner_uvs.empty() ? Uv() : mesh_.uvs[uv_numbers[i]];
      us.set(i, uv.u);
      vs.set(i, uv.v);
    }
    for (uint32_t i = 0; i < count; ++i) {
      const uint64_t* pair = std::lower_bound(pairs.begin(), pairs.end(), pair_of(i));
      indices.set(i, static_cast<uint32_t>(pair - pairs.begin()));
    }
    for (uint32_t f = 0; f < part_.face_count; ++f) {
      out.faces[f].layout_indices = {indices.data + (starts[f] - first) * sizeof(uint32_t),
                                     starts[f + 1] - starts[f]};
    }
    out.texture_coordinates = {us, vs};
    out.layouts = {positions, coordinates, normals};
    return true;
  }

  bool make_weights(dna::Mesh& out) {
    const SkinWeights& w = rig_.lods[lod_].weights;
    if (!author::make(arena_, part_.vertex_count, out.skin_weights)) return false;
    out.maximum_influence_per_vertex = 0;
    for (uint32_t i = 0; i < part_.vertex_count; ++i) {
      const size_t first = size_t{part_.first_vertex + i} * w.m;
      uint16_t count = 0;
      while (count < w.m && w.weights[first + count] > 0) ++count;
      dna::NewArray<float> values;
      dna::NewArray<uint16_t> joints;
      if (!author::make(arena_, count, values) || !author::make(arena_, count, joints)) {
        return false;
      }
      for (uint32_t k = 0; k < count; ++k) {
        values.set(k, w.weights[first + k]);
        joints.set(k, w.joints[first + k]);
      }
      out.skin_weights[i] = {values, joints};
      out.maximum_influence_per_vertex = std::max(out.maximum_influence_per_vertex, count);
    }
    return true;
  }

  /// The range of offsets of a target that belong to this part.
  void range_of(const Target& target, size_t& from, size_t& to) const {
    const auto at = [&](uint32_t vertex) {
      return static_cast<size_t>(
          std::lower_bound(target.vertices.begin(), target.vertices.end(), vertex) -
          target.vertices.begin());
    };
    from = at(part_.first_vertex);
    to = at(part_.first_vertex + part_.vertex_count);
  }

  bool make_targets(dna::Mesh& out) {
    const Span<const Target> targets = rig_.lods[lod_].targets;
    if (targets.empty()) return true;
    const uint32_t channels = rig_.channels_in_lod(lod_);
    uint32_t count = 0, used = 0;
    size_t from = 0, to = 0;
    for (uint32_t c = 0; c < channels; ++c) {
      range_of(targets[rig_.channels[c]], from, to);
      count += to > from;
    }
    if (!author::make(arena_, count, out.blend_shape_targets)) return false;
    for (uint32_t c = 0; c < channels; ++c) {
      const Target& target = targets[rig_.channels[c]];
      range_of(target, from, to);
      if (to == from) continue;
      NewVec3s deltas;
      dna::NewArray<uint32_t> vertices;
      if (!deltas.allocate(arena_, to - from) || !author::make(arena_, to - from, vertices)) {
        return false;
      }
      for (size_t i = from; i < to; ++i) {
        const Vec3f o = target.offsets[i];
        deltas.set(i - from, mesh_.frame.to_file({double{o.x}, double{o.y}, double{o.z}}));
        vertices.set(i - from, target.vertices[i] - part_.first_vertex);
      }
      out.blend_shape_targets[used++] = {deltas, vertices, static_cast<uint16_t>(c)};
    }
    return true;
  }

  const RigModel& rig_;
  const AuthorMesh& mesh_;
  const Part& part_;
  const size_t lod_;
  Arena& arena_;
  Arena& scratch_;
};

bool fill_channels(const RigModel& rig, Arena& arena, dna::DnaView& out) {
  const size_t count = rig.channels.count;
  dna::NewArray<uint16_t> lods, inputs, outputs;
  if (!make(arena, count, out.defn.channel_names) || !make(arena, rig.lod_count(), lods) ||
      !make(arena, count, inputs) || !make(arena, count, outputs)) {
    return false;
  }
  for (uint32_t c = 0; c < count; ++c) {
    if (!join_text(arena, {rig.control_name(rig.channels[c])}, out.defn.channel_names[c])) {
      return false;
    }
    inputs.set(c, static_cast<uint16_t>(rig.channels[c]));
    outputs.set(c, static_cast<uint16_t>(c));
  }
  for (uint32_t lod = 0; lod < rig.lod_count(); ++lod) {
    lods.set(lod, static_cast<uint16_t>(rig.channels_in_lod(lod)));
  }
  out.bhvr.channels = {lods, inputs, outputs};
  const auto in_lod = [&rig](size_t lod, size_t c) { return c < rig.channels_in_lod(lod); };
  if (!make_lod_map(arena, rig.lod_count(), count, in_lod, out.defn.lod_channels)) return false;

  const dna::List<dna::Mesh>& meshes = out.geom.meshes;
  uint32_t pairs = 0, pair = 0;
  for (const dna::Mesh& mesh : meshes) pairs += mesh.blend_shape_targets.count;
  dna::NewArray<uint16_t> from, to;
  if (!make(arena, pairs, from) || !make(arena, pairs, to)) return false;
  for (uint32_t m = 0; m < meshes.count; ++m) {
    for (const dna::BlendShapeTarget& target : meshes[m].blend_shape_targets) {
      from.set(pair, static_cast<uint16_t>(m));
      to.set(pair++, target.channel_index);
    }
  }
  out.defn.mesh_channels = {from, to};
  return true;
}

}  // namespace

bool fill_meshes(const RigModel& rig, Arena& arena, const Allocator& allocator, dna::DnaView& out) {
  Arena scratch(allocator);
  const size_t parts = rig.mesh.parts.count;
  Span<Vec3> finest, own;
  Span<uint32_t> lods;  // of each mesh
  if (!make(scratch, parts * rig.lod_count(), lods)) return false;
  size_t count = 0;
  for (uint32_t lod = 0; lod < rig.lod_count(); ++lod) {
    for (const Part& part : rig.lods[lod].mesh.parts) {
      if (part.face_count > 0) lods[count++] = lod;
    }
  }
  if (!make(arena, count, out.geom.meshes) || !make(arena, count, out.defn.mesh_names) ||
      !make(scratch, rig.mesh.positions.count, finest) ||
      !make(scratch, rig.mesh.positions.count, own)) {
    return false;
  }
  find_normals(rig.mesh, finest);
  size_t m = 0;
  for (size_t lod = 0; lod < rig.lod_count(); ++lod) {
    const AuthorMesh& mesh = rig.lods[lod].mesh;
    const Span<Vec3> normals = own.first(mesh.positions.count);
    take_normals(rig.lods[lod], finest, normals);
    Text suffix;
    suffix.add("_lod").add(uint64_t{lod}).add("_mesh");
    for (size_t part = 0; part < parts; ++part) {
      if (mesh.parts[part].face_count == 0) continue;
      Arena for_mesh(allocator);
      MeshMaker maker(rig, part, lod, arena, for_mesh);
      if (!join_text(arena, {mesh.parts[part].name, {suffix.chars, suffix.count}},
                     out.defn.mesh_names[m]) ||
          !maker.make(normals, out.geom.meshes[m])) {
        return false;
      }
      ++m;
    }
  }
  const auto in_lod = [&lods](size_t lod, size_t mesh) { return lods[mesh] == lod; };
  return make_lod_map(arena, rig.lod_count(), count, in_lod, out.defn.lod_meshes) &&
         fill_channels(rig, arena, out);
}

}  // namespace mien::author
