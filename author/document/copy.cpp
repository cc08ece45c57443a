// SPDX-License-Identifier: MIT
#include "author/document/copy.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/document/check_view.h"
#include "author/document/control_poses.h"
#include "author/document/deep_copy.h"
#include "author/document/elements.h"
#include "author/document/project.h"
#include "author/document/renumber.h"

namespace mien::author {

namespace {

int compare(const dna::String& a, const dna::String& b) {
  const uint32_t shorter = std::min(a.count, b.count);
  const int order = shorter ? memcmp(a.data, b.data, shorter) : 0;
  return order != 0 ? order : a.count < b.count ? -1 : a.count > b.count;
}

}  // namespace

bool find_names(const dna::List<dna::String>& from, const dna::List<dna::String>& to, Arena& arena,
                Span<uint32_t>& out) {
  Span<uint32_t> sorted;
  if (!make(arena, from.count, out) || !make(arena, to.count, sorted)) return false;
  for (uint32_t i = 0; i < to.count; ++i) sorted[i] = i;
  std::sort(sorted.begin(), sorted.end(), [&](uint32_t a, uint32_t b) {
    const int order = compare(to[a], to[b]);
    return order != 0 ? order < 0 : a < b;
  });
  for (uint32_t i = 0; i < from.count; ++i) {
    const uint32_t* found = std::lower_bound(
        sorted.begin(), sorted.end(), from[i],
        [&](uint32_t n, const dna::String& name) { return compare(to[n], name) < 0; });
    out[i] = found != sorted.end() && compare(to[*found], from[i]) == 0 ? *found : kGone;
  }
  return true;
}

Status check_same_system(const dna::DnaView& a, const dna::DnaView& b, Error& error) {
  const auto& x = a.desc.coordinate_system;
  const auto& y = b.desc.coordinate_system;
  const auto& s = a.dsce.rotation_sign;
  const auto& t = b.dsce.rotation_sign;
  if (x.x_axis == y.x_axis && x.y_axis == y.y_axis && x.z_axis == y.z_axis &&
      a.desc.translation_unit == b.desc.translation_unit &&
      a.desc.rotation_unit == b.desc.rotation_unit &&
      a.dsce.rotation_sequence == b.dsce.rotation_sequence && s.x == t.x && s.y == t.y &&
      s.z == t.z) {
    return Status::kOk;
  }
  return fail(
      error, Status::kMismatch, kNoOffset,
      "the two documents have different axes, units or rotations: convert one of them first");
}

Status copy_layers(Document& document, const Document& from, uint32_t layers, Error& error) {
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  document.forget_pages();
  for (const dna::LayerKind& kind : dna::kLayerKinds) {
    if ((layers & kind.loaded_by) == 0) continue;
    dna::DnaView source = from.view();
    const bool done = dna::with_layer(
        source, kind.id, [&](auto& record) { return copy_deeply(edit.arena(), record); });
    if (!done) return no_memory(error, "layers of another document");
    switch (kind.id) {
      case dna::LayerId::kDesc: edit.view.desc = source.desc; break;
      case dna::LayerId::kDefn: edit.view.defn = source.defn; break;
      case dna::LayerId::kBhvr: edit.view.bhvr = source.bhvr; break;
      case dna::LayerId::kGeom: edit.view.geom = source.geom; break;
      case dna::LayerId::kMlbh: edit.view.mlbh = source.mlbh; break;
      case dna::LayerId::kRbfb: edit.view.rbfb = source.rbfb; break;
      case dna::LayerId::kRbfe: edit.view.rbfe = source.rbfe; break;
      case dna::LayerId::kJbmd: edit.view.jbmd = source.jbmd; break;
      case dna::LayerId::kTwsw: edit.view.twsw = source.twsw; break;
      case dna::LayerId::kMlbe: edit.view.mlbe = source.mlbe; break;
      case dna::LayerId::kDsce: edit.view.dsce = source.dsce; break;
    }
  }
  edit.view.ml_control_count = edit.view.mlbh.control_names.count;
  if (Status s = check_view(edit.view, error); s != Status::kOk) return s;
  edit.commit(true);
  return Status::kOk;
}

// Meshes --------------------------------------------------------------------------------------------

Status copy_mesh(Document& document, const Document& from, uint32_t mesh, uint32_t& out_mesh,
                 Error& error) {
  out_mesh = 0;
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  if (Status s = check_document(from, error); s != Status::kOk) return s;
  const dna::DnaView& other = from.view();
  if (Status s =
          check_indices({&mesh, 1}, std::min(other.geom.meshes.count, other.defn.mesh_names.count),
                        "mesh", error);
      s != Status::kOk) {
    return s;
  }
  if (Status s = check_same_system(document.view(), other, error); s != Status::kOk) return s;
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  Arena& arena = edit.arena();
  dna::DnaView& view = edit.view;

  dna::Mesh copy = other.geom.meshes[mesh];
  Span<uint32_t> joints, channels;
  document.forget_pages();
  if (!copy_deeply(arena, copy) ||
      !find_names(other.defn.joint_names, view.defn.joint_names, arena, joints) ||
      !find_names(other.defn.channel_names, view.defn.channel_names, arena, channels)) {
    return no_memory(error, "a mesh of another document");
  }
  Span<uint32_t> heirs;
  if (!make(arena, joints.count, heirs)) return no_memory(error, "a mesh of another document");
  for (uint32_t j = 0; j < joints.count; ++j) {
    uint32_t up = j;
    while (joints[up] == kGone && other.defn.joint_hierarchy[up] != up)
      up = other.defn.joint_hierarchy[up];
    heirs[j] = joints[up];
  }
  // Each position is found at itself.
  SurfaceMatch itself;
  Arena scratch(document.allocator());
  if (!match_by_number(copy.skin_weights.count, scratch, itself))
    return no_memory(error, "a mesh of another document");
  for (uint32_t v = 0; v < copy.skin_weights.count; ++v) {
    const dna::VertexSkinWeights& vertex = copy.skin_weights[v];
    bool some = vertex.weights.count == 0, all = true;
    for (uint32_t i = 0; i < vertex.joint_indices.count; ++i) {
      some |= heirs[vertex.joint_indices[i]] != kGone;
      all &= joints[vertex.joint_indices[i]] != kGone;
    }
    if (!some) {
      const dna::String& name = other.defn.joint_names[vertex.joint_indices[0]];
      return fail(error, Status::kMismatch, kNoOffset,
                  "position %u: neither joint \"%.*s\" nor an ancestor of it is in this document: "
                  "merge the joints first",
                  v, static_cast<int>(std::min(name.count, 80u)), name.chars());
    }
    if (all) {  // the same weights, renumbered
      const dna::NewArray<uint16_t> numbers =
          dna::new_array<uint16_t>(arena, vertex.joint_indices.count);
      if (numbers.count != 0 && !numbers.data)
        return no_memory(error, "a mesh of another document");
      for (uint32_t i = 0; i < numbers.count; ++i)
        numbers.set(i, static_cast<uint16_t>(joints[vertex.joint_indices[i]]));
      copy.skin_weights[v].joint_indices = numbers;
      continue;
    }
    dna::List<dna::VertexSkinWeights> one;
    const SurfaceMatch here{itself.places.slice(v, 1)};
    if (!project_weights(copy, here, heirs, view.defn.joint_names.count, ~0u, arena, one)) {
      return no_memory(error, "a mesh of another document");
    }
    copy.skin_weights[v] = one[0];
  }
  uint32_t kept = 0;
  for (dna::BlendShapeTarget& target : copy.blend_shape_targets) {
    const uint32_t channel = channels[target.channel_index];
    if (channel == kGone) continue;
    target.channel_index = static_cast<uint16_t>(channel);
    copy.blend_shape_targets[kept++] = target;
  }
  copy.blend_shape_targets.count = kept;

  // Over the mesh of the same name, or behind the others.
  const dna::String name = other.defn.mesh_names[mesh];
  const uint32_t count = view.defn.mesh_names.count;
  uint32_t at = 0;
  while (at < count && compare(view.defn.mesh_names[at], name) != 0) ++at;
  if (at == count) {
    Renumbering numbers;
    if (!make(arena, count, numbers.new_of) || !make(arena, size_t{count} + 1, numbers.old_of)) {
      return no_memory(error, "a mesh of another document");
    }
    for (uint32_t m = 0; m < count; ++m) numbers.new_of[m] = numbers.old_of[m] = m;
    numbers.old_of[count] = kGone;
    uint64_t lods = 0;
    for (uint32_t lod = 0; lod < other.defn.lod_meshes.lods.count && lod < 64; ++lod) {
      const dna::Array<uint16_t> list = other.defn.lod_meshes.at(lod);
      for (uint32_t i = 0; i < list.count; ++i) lods |= uint64_t{list[i] == mesh} << lod;
    }
    dna::String own = name;
    if (!renumber_meshes(view, numbers, arena) ||
        !list_at_lods(view.defn.lod_meshes, count, lods, arena) || !copy_deeply(arena, own)) {
      return no_memory(error, "a mesh of another document");
    }
    view.defn.mesh_names[count] = own;
  } else if (!copy_list(arena, view.geom.meshes)) {
    return no_memory(error, "a mesh of another document");
  }
  view.geom.meshes[at] = copy;
  if (!pair_channels(view, at, arena)) return no_memory(error, "a mesh of another document");
  out_mesh = at;
  edit.commit();
  return Status::kOk;
}

// Joints --------------------------------------------------------------------------------------------

Status merge_joints(Document& document, const Document& from, double tolerance, Error& error) {
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  if (Status s = check_document(from, error); s != Status::kOk) return s;
  if (Status s = check_same_system(document.view(), from.view(), error); s != Status::kOk) return s;
  const dna::DnaView& other = from.view();
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  Arena& arena = edit.arena();
  dna::DnaView& view = edit.view;
  const uint32_t own = view.defn.joint_names.count, others = other.defn.joint_names.count;

  Span<uint32_t> numbers_here;  // of the other's joints
  ControlPoses here, there;
  if (!find_names(other.defn.joint_names, view.defn.joint_names, arena, numbers_here) ||
      !here.prepare(view, arena) || !there.prepare(other, arena)) {
    return no_memory(error, "joints of another document");
  }
  uint32_t count = own;
  for (uint32_t i = 0; i < others; ++i) {
    const uint32_t joint = there.ordered(i);  // parents first
    if (numbers_here[joint] == kGone) {
      numbers_here[joint] = count++;
      continue;
    }
    const double distance = length(here.bind(numbers_here[joint]).place - there.bind(joint).place);
    if (!(distance <= tolerance)) {
      const dna::String& name = other.defn.joint_names[joint];
      return fail(error, Status::kMismatch, kNoOffset,
                  "joint \"%.*s\" stands %g away from its place in the other document: move one of "
                  "the characters first",
                  static_cast<int>(std::min(name.count, 80u)), name.chars(), distance);
    }
  }
  if (count > 7281) {
    return fail(error, Status::kDnaLimit, kNoOffset,
                "there would be %u joints; a file has at most 7281", count);
  }
  Renumbering numbers;
  if (!make(arena, own, numbers.new_of) || !make(arena, count, numbers.old_of))
    return no_memory(error, "joints of another document");
  for (uint32_t j = 0; j < count; ++j) numbers.old_of[j] = j < own ? j : kGone;
  for (uint32_t j = 0; j < own; ++j) numbers.new_of[j] = j;
  if (!renumber_joints(view, numbers, arena)) return no_memory(error, "joints of another document");

  dna::Definition& defn = view.defn;
  dna::NewArray<uint16_t> parents;
  dna::NewArray<float> fields[6];
  dna::Array<float>* const arrays[6] = {
      &defn.neutral_translations.xs, &defn.neutral_translations.ys, &defn.neutral_translations.zs,
      &defn.neutral_rotations.xs,    &defn.neutral_rotations.ys,    &defn.neutral_rotations.zs};
  const dna::Array<float> sources[6] = {
      other.defn.neutral_translations.xs, other.defn.neutral_translations.ys,
      other.defn.neutral_translations.zs, other.defn.neutral_rotations.xs,
      other.defn.neutral_rotations.ys,    other.defn.neutral_rotations.zs};
  bool done =
      copy_array(arena, defn.joint_hierarchy, parents) && copy_list(arena, defn.joint_names);
  for (int k = 0; k < 6; ++k) done = done && copy_array(arena, *arrays[k], fields[k]);
  if (!done) return no_memory(error, "joints of another document");
  for (uint32_t joint = 0; joint < others; ++joint) {
    const uint32_t j = numbers_here[joint];
    const bool root_there = other.defn.joint_hierarchy[joint] == joint;
    const bool is_new = j >= own;
    if (!is_new && (root_there || parents.data == nullptr || dna::Array<uint16_t>(parents)[j] != j))
      continue;
    if (is_new) {
      dna::String name = other.defn.joint_names[joint];
      if (!copy_deeply(arena, name)) return no_memory(error, "joints of another document");
      defn.joint_names[j] = name;
    }
    parents.set(j, static_cast<uint16_t>(numbers_here[other.defn.joint_hierarchy[joint]]));
    for (int k = 0; k < 6; ++k) fields[k].set(j, sources[k][joint]);
  }
  defn.joint_hierarchy = parents;
  for (int k = 0; k < 6; ++k) *arrays[k] = fields[k];

  for (uint32_t joint = 0; joint < others; ++joint) {
    if (numbers_here[joint] < own) continue;
    uint64_t lods = 0;
    for (uint32_t lod = 0; lod < other.defn.lod_joints.lods.count && lod < 64; ++lod) {
      const dna::Array<uint16_t> list = other.defn.lod_joints.at(lod);
      for (uint32_t i = 0; i < list.count; ++i) lods |= uint64_t{list[i] == joint} << lod;
    }
    if (!list_at_lods(defn.lod_joints, numbers_here[joint], lods, arena)) {
      return no_memory(error, "joints of another document");
    }
  }
  // How the new ones rotate.
  if (other.jbmd.joints.count != 0 && view.jbmd.joints.count >= own) {
    const Span<dna::JointRepresentation> all = arena.array<dna::JointRepresentation>(count);
    if (!all.data) return no_memory(error, "joints of another document");
    for (uint32_t j = 0; j < own; ++j) all[j] = view.jbmd.joints[j];
    for (uint32_t joint = 0; joint < others && joint < other.jbmd.joints.count; ++joint) {
      if (numbers_here[joint] >= own) all[numbers_here[joint]] = other.jbmd.joints[joint];
    }
    view.jbmd.joints = {all.data, count};
  }
  if (Status s = check_view(view, error); s != Status::kOk) return s;
  edit.commit(true);
  return Status::kOk;
}

Status split_joints(Document& document, const Document& from, Error& error) {
  Arena arena(document.allocator());
  Span<uint32_t> found, gone;
  const dna::List<dna::String>& names = document.view().defn.joint_names;
  if (!find_names(names, from.view().defn.joint_names, arena, found) ||
      !make(arena, names.count, gone)) {
    return no_memory(error, "an edit");
  }
  uint32_t count = 0;
  for (uint32_t j = 0; j < names.count; ++j) {
    if (found[j] == kGone) gone[count++] = j;
  }
  return remove_elements(document, Kind::kJoint, gone.first(count), error);
}

}  // namespace mien::author
