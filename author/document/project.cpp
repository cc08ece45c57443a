// SPDX-License-Identifier: MIT
#include "author/document/project.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/document/check_view.h"
#include "author/document/renumber.h"
#include "author/document/rows.h"

namespace mien::author {

using dna::NewArray;

namespace {

struct Influence {
  uint32_t joint;
  double weight;
};

}  // namespace

bool project_weights(const dna::Mesh& source, const SurfaceMatch& match, Span<const uint32_t> heirs,
                     uint32_t joint_count, uint32_t influences, Arena& arena,
                     dna::List<dna::VertexSkinWeights>& out) {
  Span<double> sums;
  Span<Influence> row;
  if (!make(arena, match.places.count, out) || !make(arena, joint_count, sums) ||
      !make(arena, joint_count, row)) {
    return false;
  }
  for (uint32_t v = 0; v < out.count; ++v) {
    const SurfaceMatch::Place& place = match.places[v];
    uint32_t count = 0;
    for (int k = 0; k < 3; ++k) {
      if (place.weights[k] == 0) continue;
      const dna::VertexSkinWeights& vertex = source.skin_weights[place.positions[k]];
      for (uint32_t i = 0; i < vertex.weights.count; ++i) {
        const uint32_t joint = heirs[vertex.joint_indices[i]];
        const double weight = place.weights[k] * double{vertex.weights[i]};
        if (joint == kGone || weight == 0) continue;
        if (sums[joint] == 0) row[count++].joint = joint;
        sums[joint] += weight;
      }
    }
    for (uint32_t i = 0; i < count; ++i) {
      row[i].weight = sums[row[i].joint];
      sums[row[i].joint] = 0;
    }
    std::sort(row.data, row.data + count, [](const Influence& a, const Influence& b) {
      return a.weight != b.weight ? a.weight > b.weight : a.joint < b.joint;
    });
    const uint32_t kept = std::min(count, influences);
    double left = 0;
    for (uint32_t i = 0; i < kept; ++i) left += row[i].weight;
    NewArray<uint16_t> joints;
    NewArray<float> weights;
    if (!make(arena, kept, joints) || !make(arena, kept, weights)) return false;
    for (uint32_t i = 0; i < kept; ++i) {
      joints.set(i, static_cast<uint16_t>(row[i].joint));
      weights.set(i, static_cast<float>(left > 0 ? row[i].weight / left : row[i].weight));
    }
    out[v] = {weights, joints};
  }
  return true;
}

namespace {

/// Targets where positions correspond by number: the same positions with turned deltas.
bool turn_targets(const dna::Mesh& source, Span<const uint32_t> new_channels,
                  Span<const Similarity> turns, Arena& arena,
                  dna::List<dna::BlendShapeTarget>& out) {
  if (!make(arena, source.blend_shape_targets.count, out)) return false;
  uint32_t kept = 0;
  for (const dna::BlendShapeTarget& target : source.blend_shape_targets) {
    const uint32_t channel = new_channels[target.channel_index];
    if (channel == kGone) continue;
    NewVec3s deltas;
    NewArray<uint32_t> vertices;
    const uint32_t count = target.vertex_indices.count;
    if (!copy_array(arena, target.vertex_indices, vertices) || !deltas.allocate(arena, count))
      return false;
    for (uint32_t i = 0; i < count; ++i) {
      const Vec3 delta = vector_of(target.deltas, i);
      const uint32_t v = target.vertex_indices[i];
      // A product with 1 and 0 would lose the sign of a 0.
      const bool stays = turns.empty() || turns[v].is_identity();
      deltas.set(i, stays ? delta : turns[v].direction(delta));
    }
    out[kept].deltas = deltas;
    out[kept].vertex_indices = vertices;
    out[kept++].channel_index = static_cast<uint16_t>(channel);
  }
  out.count = kept;
  return true;
}

}  // namespace

bool project_targets(const dna::Mesh& source, const SurfaceMatch& match,
                     Span<const uint32_t> new_channels, Span<const Similarity> turns,
                     const Allocator& allocator, Arena& arena,
                     dna::List<dna::BlendShapeTarget>& out) {
  if (match.by_number) return turn_targets(source, new_channels, turns, arena, out);
  const uint32_t old_positions = source.positions.xs.count;
  Span<Vec3> dense;
  // The positions whose place is on a triangle with a position of the source.
  Rows followers;
  struct Moved {
    uint32_t position;
    Vec3 delta;
    bool operator<(const Moved& other) const { return position < other.position; }
  };
  Span<Moved> moved;    // by the target
  Span<uint32_t> seen;  // [position] the last target that may move it
  const auto visit = [&](const auto& put) {
    for (uint32_t v = 0; v < match.places.count; ++v) {
      for (int k = 0; k < 3; ++k) {
        if (match.places[v].weights[k] != 0) put(match.places[v].positions[k], v);
      }
    }
  };
  Arena scratch(allocator);
  if (!make(scratch, old_positions, dense) || !make(scratch, match.places.count, moved) ||
      !make(scratch, match.places.count, seen) ||
      !make_rows(scratch, old_positions, visit, followers) ||
      !make(arena, source.blend_shape_targets.count, out)) {
    return false;
  }
  uint32_t kept = 0, number = 0;
  for (const dna::BlendShapeTarget& target : source.blend_shape_targets) {
    const uint32_t channel = new_channels[target.channel_index];
    if (channel == kGone) continue;
    ++number;
    for (uint32_t i = 0; i < target.vertex_indices.count; ++i)
      dense[target.vertex_indices[i]] = vector_of(target.deltas, i);
    size_t count = 0;
    for (uint32_t i = 0; i < target.vertex_indices.count; ++i) {
      for (uint32_t v : followers[target.vertex_indices[i]]) {
        if (seen[v] == number) continue;
        seen[v] = number;
        const Vec3 delta = match.at(v, dense);
        if (!is_zero(delta)) moved[count++] = {v, delta};
      }
    }
    for (uint32_t i = 0; i < target.vertex_indices.count; ++i) dense[target.vertex_indices[i]] = {};
    if (count == 0) continue;
    std::sort(moved.data, moved.data + count);
    NewVec3s deltas;
    NewArray<uint32_t> vertices;
    if (!deltas.allocate(arena, count) || !make(arena, count, vertices)) return false;
    for (size_t i = 0; i < count; ++i) {
      const Moved& found = moved[i];
      deltas.set(i, turns.empty() ? found.delta : turns[found.position].direction(found.delta));
      vertices.set(i, found.position);
    }
    out[kept].deltas = deltas;
    out[kept].vertex_indices = vertices;
    out[kept++].channel_index = static_cast<uint16_t>(channel);
  }
  out.count = kept;
  return true;
}

namespace {

/// Elements that a LOD which shows the mesh lists: 1 in `listed`. Returns whether there is any.
bool list_of_mesh(const dna::Definition& defn, uint32_t mesh, const dna::LodMap& map,
                  Span<uint8_t> listed) {
  bool any = false;
  for (uint32_t lod = 0; lod < defn.lod_meshes.lods.count; ++lod) {
    const dna::Array<uint16_t> meshes = defn.lod_meshes.at(lod), elements = map.at(lod);
    bool shows = false;
    for (uint32_t i = 0; i < meshes.count; ++i) shows |= meshes[i] == mesh;
    if (!shows) continue;
    for (uint32_t i = 0; i < elements.count; ++i) listed[elements[i]] = 1;
    any |= elements.count != 0;
  }
  return any;
}

/// project_mesh() within an edit. Adds to `out`.
Status project_in(Edit& edit, uint32_t mesh, uint32_t source, const Projection& how,
                  const Allocator& allocator, ProjectionResult& out, Error& error) {
  dna::DnaView& view = edit.view;
  const uint32_t both[] = {mesh, source};
  if (Status s = check_indices({both, 2}, view.geom.meshes.count, "mesh", error); s != Status::kOk)
    return s;
  if (mesh == source || how.influences == 0) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                mesh == source ? "mesh %u is projected from itself"
                               : "mesh %u: 0 influences, a position keeps at least one",
                mesh);
  }
  if (!copy_list(edit.arena(), view.geom.meshes)) return no_memory(error, "an edit");
  dna::Mesh& changed = view.geom.meshes[mesh];
  const dna::Mesh& from = view.geom.meshes[source];
  if (!can_match(from, how.match) || (how.match == Match::kUv && !can_match(changed, how.match))) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "mesh %u has no triangles%s",
                can_match(from, how.match) ? mesh : source,
                how.match == Match::kUv ? " with texture coordinates: match by surface" : "");
  }
  if (how.weights && from.skin_weights.count == 0) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "mesh %u has no skin weights to project", source);
  }

  Arena scratch(allocator);
  const uint32_t joints = view.defn.joint_names.count, channels = view.defn.channel_names.count;
  Span<Vec3> positions, source_positions;
  Span<uint8_t> listed_joints, listed_channels;
  Span<uint32_t> heirs, kept_channels;
  SurfaceMatch match;
  if (!positions_of(changed, scratch, positions) ||
      !positions_of(from, scratch, source_positions) || !make(scratch, joints, listed_joints) ||
      !make(scratch, channels, listed_channels) || !make(scratch, joints, heirs) ||
      !make(scratch, channels, kept_channels) ||
      !match_surfaces(positions, changed, source_positions, from, how.match, scratch, match)) {
    return no_memory(error, "matching surfaces");
  }
  const bool some_joints = list_of_mesh(view.defn, mesh, view.defn.lod_joints, listed_joints);
  for (uint32_t j = 0; j < joints; ++j) {
    uint32_t heir = j;
    while (some_joints && !listed_joints[heir] && view.defn.joint_hierarchy[heir] != heir) {
      heir = view.defn.joint_hierarchy[heir];
    }
    heirs[j] = heir;
  }
  const bool some_channels = list_of_mesh(view.defn, mesh, view.defn.lod_channels, listed_channels);
  for (uint32_t c = 0; c < channels; ++c)
    kept_channels[c] = !some_channels || listed_channels[c] ? c : kGone;
  for (uint32_t v = 0; v < match.places.count; ++v) {
    if (match.places[v].distance > out.farthest) out = {match.places[v].distance, v};
  }

  Arena& arena = edit.arena();
  if (how.weights) {
    if (!project_weights(from, match, heirs, joints, how.influences, arena, changed.skin_weights)) {
      return no_memory(error, "skin weights");
    }
    uint32_t most = 0;
    for (const dna::VertexSkinWeights& vertex : changed.skin_weights)
      most = std::max(most, vertex.weights.count);
    changed.maximum_influence_per_vertex = static_cast<uint16_t>(most);
  }
  if (how.targets) {
    if (!project_targets(from, match, kept_channels, {}, allocator, arena,
                         changed.blend_shape_targets) ||
        !pair_channels(view, mesh, arena)) {
      return no_memory(error, "targets");
    }
  }
  return Status::kOk;
}

/// The bytes of a name in front of the number of its LOD, and behind it: "head_lod0_mesh" is "head_lod" and "_mesh".
struct LodName {
  dna::String before, behind;
};
LodName split_name(const dna::String& name) {
  for (uint32_t i = 0; i + 3 < name.count; ++i) {
    const uint8_t* at = name.data + i;
    if ((at[0] | 32) != 'l' || (at[1] | 32) != 'o' || (at[2] | 32) != 'd') continue;
    uint32_t end = i + 3;
    while (end < name.count && name.data[end] >= '0' && name.data[end] <= '9') ++end;
    if (end != i + 3) return {{name.data, i + 3}, {name.data + end, name.count - end}};
  }
  return {name, {}};
}
bool same(const dna::String& a, const dna::String& b) {
  return a.count == b.count && (a.count == 0 || memcmp(a.data, b.data, a.count) == 0);
}

/// LOD `lod` lists what `source` does, if it lists nothing.
bool inherit_list(dna::LodMap& map, uint32_t lod, uint32_t source, Arena& arena) {
  if (map.at(lod).count != 0 || lod >= map.lods.count || source >= map.lods.count) return true;
  NewArray<uint16_t> rows;
  if (!copy_array(arena, map.lods, rows)) return false;
  rows.set(lod, map.lods[source]);
  map.lods = rows;
  return true;
}

}  // namespace

Status project_mesh(Document& document, uint32_t mesh, uint32_t source, const Projection& how,
                    ProjectionResult& out, Error& error) {
  out = {};
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  if (Status s = project_in(edit, mesh, source, how, document.allocator(), out, error);
      s != Status::kOk)
    return s;
  edit.commit();
  return Status::kOk;
}

Status make_lod(Document& document, uint32_t lod, uint32_t source_lod, const Projection& how,
                ProjectionResult& out, Error& error) {
  out = {};
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  dna::Definition& defn = edit.view.defn;
  const uint32_t lods = std::min<uint32_t>(edit.view.desc.lod_count, defn.lod_meshes.lods.count);
  if (lod >= lods || source_lod >= lods) {
    return fail(error, Status::kLod, kNoOffset, "LOD %u is not there: the document has %u",
                lod >= lods ? lod : source_lod, lods);
  }
  if (lod == source_lod) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "LOD %u is made from itself", lod);
  }
  if (!inherit_list(defn.lod_joints, lod, source_lod, edit.arena()) ||
      !inherit_list(defn.lod_channels, lod, source_lod, edit.arena())) {
    return no_memory(error, "an edit");
  }
  const dna::Array<uint16_t> meshes = defn.lod_meshes.at(lod),
                             sources = defn.lod_meshes.at(source_lod);
  for (uint32_t i = 0; i < meshes.count; ++i) {
    const LodName wanted = split_name(defn.mesh_names[meshes[i]]);
    uint32_t source = kGone;
    bool shared = false;  // one mesh at both LODs has its weights already
    for (uint32_t k = 0; k < sources.count && source == kGone; ++k) {
      shared |= sources[k] == meshes[i];
      const LodName found = split_name(defn.mesh_names[sources[k]]);
      if (same(found.before, wanted.before) && same(found.behind, wanted.behind))
        source = sources[k];
    }
    if (shared || source == meshes[i]) continue;
    if (source == kGone) {
      const dna::String& name = defn.mesh_names[meshes[i]];
      return fail(error, Status::kName, kNoOffset,
                  "mesh \"%.*s\" has no counterpart in LOD %u: a name that differs only in the "
                  "number of the LOD",
                  static_cast<int>(std::min(name.count, 80u)), name.chars(), source_lod);
    }
    const Status s = project_in(edit, meshes[i], source, how, document.allocator(), out, error);
    if (s != Status::kOk) return s;
  }
  edit.commit();
  return Status::kOk;
}

}  // namespace mien::author
