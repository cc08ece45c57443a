// SPDX-License-Identifier: MIT
#include "author/document/transplant.h"

#include <algorithm>
#include <cmath>

#include "author/base/dna_making.h"
#include "author/document/check_view.h"
#include "author/document/conform.h"
#include "author/document/control_poses.h"
#include "author/document/copy.h"
#include "author/document/deep_copy.h"
#include "author/document/project.h"
#include "author/document/renumber.h"

namespace mien::author {

namespace {

bool same_bytes(const uint8_t* a, const uint8_t* b, size_t count) {
  return count == 0 || memcmp(a, b, count) == 0;
}

/// The same faces of the same positions.
bool same_topology(const dna::Mesh& a, const dna::Mesh& b) {
  if (a.positions.xs.count != b.positions.xs.count || a.faces.count != b.faces.count ||
      a.layouts.positions.count != b.layouts.positions.count ||
      !same_bytes(a.layouts.positions.data, b.layouts.positions.data,
                  a.layouts.positions.byte_count())) {
    return false;
  }
  for (uint32_t f = 0; f < a.faces.count; ++f) {
    const dna::Array<uint32_t>& x = a.faces[f].layout_indices;
    const dna::Array<uint32_t>& y = b.faces[f].layout_indices;
    if (x.count != y.count || !same_bytes(x.data, y.data, x.byte_count())) return false;
  }
  return true;
}

/// Positions of the same number, or the nearest places: surfaces that touch, as lips do, are told apart by the former
/// only.
bool match_meshes(Span<const Vec3> of_positions, const dna::Mesh& of, Span<const Vec3> on_positions,
                  const dna::Mesh& on, Match match, Arena& arena, SurfaceMatch& out) {
  if (!same_topology(of, on))
    return match_surfaces(of_positions, of, on_positions, on, match, arena, out);
  return match_by_number(of_positions.count, arena, out);
}

class Transplanter {
 public:
  Transplanter(const dna::DnaView& character, const dna::DnaView& rig, const Transplant& how,
               Edit& edit, const Allocator& allocator)
      : character_(character), rig_(rig), how_(how), view_(edit.view), arena_(edit.arena()),
        allocator_(allocator), scratch_(allocator) {}

  Status run(Error& error) {
    if (!take_rig() ||
        !find_names(rig_.defn.mesh_names, character_.defn.mesh_names, scratch_, own_mesh_)) {
      return no_memory(error, "a transplant");
    }
    if (Status s = collect_pairs(error); s != Status::kOk) return s;
    Warp warp;
    if (!warp.build(before_, after_, scratch_)) return no_memory(error, "a transplant");
    const bool done = move_joints(warp) && move_meshes(warp);
    return done ? Status::kOk : no_memory(error, "a transplant");
  }

 private:
  /// All layers of the template; name, metadata and so on stay the character's. move_meshes() copies what the meshes
  /// need.
  bool take_rig() {
    dna::DnaView taken = rig_;
    if (!copy_list(arena_, taken.geom.meshes)) return false;
    for (const dna::LayerKind& kind : dna::kLayerKinds) {
      if (kind.id == dna::LayerId::kGeom) continue;
      const bool copied = dna::with_layer(
          taken, kind.id, [this](auto& record) { return copy_deeply(arena_, record); });
      if (!copied) return false;
    }
    const dna::Descriptor own = view_.desc;
    view_.desc = taken.desc;
    view_.desc.name = own.name;
    view_.desc.archetype = own.archetype;
    view_.desc.gender = own.gender;
    view_.desc.age = own.age;
    view_.desc.metadata = own.metadata;
    view_.defn = taken.defn;
    view_.bhvr = taken.bhvr;
    view_.geom = taken.geom;
    view_.mlbh = taken.mlbh;
    view_.mlbe = taken.mlbe;
    view_.rbfb = taken.rbfb;
    view_.rbfe = taken.rbfe;
    view_.jbmd = taken.jbmd;
    view_.twsw = taken.twsw;
    view_.ml_control_count = taken.mlbh.control_names.count;
    view_.version = std::max(view_.version, rig_.version);
    return add_layers();
  }

  /// The index lists the layers of the template: for old versions, a writer would leave out the others.
  bool add_layers() {
    const Span<dna::IndexEntry> entries =
        arena_.array<dna::IndexEntry>(view_.index.count + dna::kLayerIdCount);
    if (!entries.data) return false;
    uint32_t count = 0;
    for (const dna::IndexEntry& entry : view_.index) entries[count++] = entry;
    for (const dna::IndexEntry& entry : rig_.index) {
      const dna::LayerKind* kind = dna::find_layer_kind(entry.code, entry.layer_version);
      bool there = !kind;
      for (uint32_t i = 0; i < count; ++i) {
        there |= entries[i].code == entry.code && entries[i].layer_version == entry.layer_version;
      }
      if (there) continue;
      entries[count] = {};
      entries[count].code = entry.code;
      entries[count++].layer_version = entry.layer_version;
    }
    view_.index = {entries.data, count};
    return true;
  }

  const dna::Mesh* own_mesh(uint32_t mesh) const {
    const uint32_t own = own_mesh_[mesh];
    return own < character_.geom.meshes.count ? &character_.geom.meshes[own] : nullptr;
  }

  /// Places of the template, and where they are on the character: positions of meshes of LOD 0, and joints.
  Status collect_pairs(Error& error) {
    const dna::Array<uint16_t> meshes = rig_.defn.lod_meshes.at(0);
    size_t count = 0, meshes_found = 0;
    for (uint32_t i = 0; i < meshes.count && meshes[i] < rig_.geom.meshes.count; ++i) {
      const dna::Mesh* own = own_mesh(meshes[i]);
      if (!own) continue;
      const dna::Mesh& of_rig = rig_.geom.meshes[meshes[i]];
      if (!can_match(*own, how_.match) || !can_match(of_rig, how_.match)) {
        const dna::String& name = rig_.defn.mesh_names[meshes[i]];
        return fail(error, Status::kInvalidArgument, kNoOffset,
                    "mesh \"%.*s\" cannot be matched: it lacks triangles%s",
                    static_cast<int>(std::min(name.count, 80u)), name.chars(),
                    how_.match == Match::kUv ? " or texture coordinates" : "");
      }
      count += own->positions.xs.count;
      ++meshes_found;
    }
    if (meshes_found == 0) {
      return fail(error, Status::kInvalidArgument, kNoOffset,
                  "no mesh of LOD 0 has the name of one of the template: rename the meshes that "
                  "correspond");
    }
    ControlPoses own_poses, rig_poses;
    const uint32_t joints = rig_.defn.joint_names.count;
    if (!own_poses.prepare(character_, scratch_) || !rig_poses.prepare(rig_, scratch_) ||
        !find_names(rig_.defn.joint_names, character_.defn.joint_names, scratch_, own_joint_) ||
        !make(scratch_, joints, own_places_) || !make(scratch_, joints, rig_places_) ||
        !make(scratch_, count, before_) || !make(scratch_, count, after_)) {
      return no_memory(error, "a transplant");
    }
    for (uint32_t j = 0; j < joints; ++j) {
      rig_places_[j] = rig_poses.bind(j).place;
      if (own_joint_[j] != kGone) own_places_[j] = own_poses.bind(own_joint_[j]).place;
    }
    size_t next = 0;
    for (uint32_t i = 0; i < meshes.count && meshes[i] < rig_.geom.meshes.count; ++i) {
      const dna::Mesh* own = own_mesh(meshes[i]);
      if (!own) continue;
      const dna::Mesh& of_rig = rig_.geom.meshes[meshes[i]];
      Arena scratch(allocator_);
      SurfaceMatch match;
      Span<Vec3> own_positions, rig_positions;
      if (!positions_of(*own, scratch, own_positions) ||
          !positions_of(of_rig, scratch, rig_positions) ||
          !match_meshes(own_positions, *own, rig_positions, of_rig, how_.match, scratch, match)) {
        return no_memory(error, "a transplant");
      }
      for (size_t v = 0; v < own_positions.count; ++v) {
        before_[next] = match.at(v, rig_positions);
        after_[next++] = own_positions[v];
      }
    }
    return Status::kOk;
  }

  bool move_joints(const Warp& warp) {
    const size_t joints = rig_places_.count;
    Span<Vec3> places;
    Span<double> scales;
    if (!make(scratch_, joints, places) || !make(scratch_, joints, scales)) return false;
    for (size_t j = 0; j < joints; ++j) {
      const Similarity motion = warp.at(rig_places_[j]);
      places[j] = own_joint_[j] != kGone ? own_places_[j] : motion(rig_places_[j]);
      scales[j] = std::abs(motion.scale - 1) < 1e-9 ? 1 : motion.scale;
    }
    return place_joints(view_, places, arena_) && scale_translations(view_, scales, arena_);
  }

  bool move_meshes(const Warp& warp) {
    WarpHint hint;
    const auto motion_at = [&](Vec3 place) {
      return warp.stays(place, hint) ? Similarity() : warp.at(place, hint);
    };
    Span<uint32_t> joints, channels;
    const uint32_t joint_count = view_.defn.joint_names.count,
                   channel_count = view_.defn.channel_names.count;
    if (!make(scratch_, joint_count, joints) || !make(scratch_, channel_count, channels))
      return false;
    for (uint32_t j = 0; j < joint_count; ++j) joints[j] = j;
    for (uint32_t c = 0; c < channel_count; ++c) channels[c] = c;
    for (uint32_t m = 0; m < view_.geom.meshes.count; ++m) {
      dna::Mesh& mesh = view_.geom.meshes[m];
      Arena scratch(allocator_);
      Span<Vec3> rig_positions;
      if (!positions_of(mesh, scratch, rig_positions)) return false;
      const dna::Mesh* own = own_mesh(m);
      if (!own || !can_match(*own, how_.match) || !can_match(mesh, how_.match)) {
        NewVec3s moved;
        mesh.positions = {};
        if (!copy_deeply(arena_, mesh) || !moved.allocate(arena_, rig_positions.count))
          return false;
        for (size_t v = 0; v < rig_positions.count; ++v)
          moved.set(v, motion_at(rig_positions[v])(rig_positions[v]));
        mesh.positions = moved;
        continue;
      }
      SurfaceMatch match;
      Span<Vec3> own_positions;
      Span<Similarity> turns;
      dna::Mesh made = *own;  // the same document's arrays, which stay where they are
      if (!positions_of(*own, scratch, own_positions) ||
          !make(scratch, own_positions.count, turns) ||
          !match_meshes(own_positions, *own, rig_positions, mesh, how_.match, scratch, match)) {
        return false;
      }
      for (size_t v = 0; v < own_positions.count; ++v)
        turns[v] = motion_at(match.at(v, rig_positions));
      if (!take_weights(mesh, match, joints, made)) return false;
      if (!project_targets(mesh, match, channels, turns, allocator_, arena_,
                           made.blend_shape_targets))
        return false;
      mesh = made;
      if (!pair_channels(view_, m, arena_)) return false;
    }
    return true;
  }

  /// The weights of the template's mesh: the same ones where positions correspond by number.
  bool take_weights(const dna::Mesh& of_rig, const SurfaceMatch& match, Span<const uint32_t> joints,
                    dna::Mesh& out) {
    uint32_t most = 0;
    for (const dna::VertexSkinWeights& vertex : of_rig.skin_weights)
      most = std::max(most, vertex.weights.count);
    out.skin_weights = of_rig.skin_weights;
    out.maximum_influence_per_vertex = of_rig.maximum_influence_per_vertex;
    if (of_rig.skin_weights.count == 0) return true;
    if (match.by_number && most <= how_.influences) return copy_deeply(arena_, out.skin_weights);
    if (!project_weights(of_rig, match, joints, static_cast<uint32_t>(joints.count),
                         how_.influences, arena_, out.skin_weights)) {
      return false;
    }
    most = 0;
    for (const dna::VertexSkinWeights& vertex : out.skin_weights)
      most = std::max(most, vertex.weights.count);
    out.maximum_influence_per_vertex = static_cast<uint16_t>(most);
    return true;
  }

  const dna::DnaView& character_;
  const dna::DnaView& rig_;
  const Transplant& how_;
  dna::DnaView& view_;
  Arena& arena_;
  const Allocator& allocator_;
  Arena scratch_;
  Span<uint32_t> own_mesh_, own_joint_;  // [of the template] kGone, or the character's
  Span<Vec3> own_places_, rig_places_;   // of joints, in the model
  Span<Vec3> before_, after_;
};

}  // namespace

Status transplant(Document& document, const Document& rig, const Transplant& how,
                  Span<ControlError> out_errors, uint32_t& out_count, Error& error) {
  out_count = 0;
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  if (Status s = check_document(rig, error); s != Status::kOk) return s;
  if (Status s = check_same_system(document.view(), rig.view(), error); s != Status::kOk) return s;
  if (how.influences == 0) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "0 influences: a position keeps at least one");
  }
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  const dna::DnaView before = document.view();
  document.forget_pages();
  Transplanter work(before, rig.view(), how, edit, document.allocator());
  if (Status s = work.run(error); s != Status::kOk) return s;
  rig.forget_pages();
  if (Status s = check_view(edit.view, error); s != Status::kOk) return s;
  if (Status s =
          measure_controls(before, edit.view, document.allocator(), out_errors, out_count, error);
      s != Status::kOk) {
    return s;
  }
  edit.commit(true);
  return Status::kOk;
}

}  // namespace mien::author
