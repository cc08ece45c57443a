// SPDX-License-Identifier: MIT
#include "author/document/elements.h"

#include <algorithm>
#include <cstdio>

#include "author/document/check_view.h"
#include "author/document/field_edit.h"
#include "author/document/pose.h"
#include "author/document/remove_controls.h"
#include "author/document/renumber.h"

namespace mien::author {

using dna::Array;
using dna::NewArray;

namespace {

struct KindInfo {
  const char *word, *path;
};
constexpr KindInfo kKinds[] = {
    {"GUI control", "defn.guiControlNames"},
    {"raw control", "defn.rawControlNames"},
    {"PSD control", "bhvr.controls.psdCount"},
    {"ML control", "mlbh.mlControlNames"},
    {"RBF control", "rbfe.poseControlNames"},
    {"joint", "defn.jointNames"},
    {"blend shape channel", "defn.blendShapeChannelNames"},
    {"animated map", "defn.animatedMapNames"},
    {"mesh", "defn.meshNames"},
};

Status marks_of(Span<const uint32_t> indices, uint32_t count, Arena& arena, Span<uint8_t>& keep,
                Error& error) {
  keep = arena.array<uint8_t>(count);
  if (keep.count != count) return no_memory(error, "an edit");
  std::fill(keep.begin(), keep.end(), uint8_t{1});
  for (uint32_t index : indices) keep[index] = 0;
  return Status::kOk;
}

// Joints --------------------------------------------------------------------------------------------

/// Joints that are removed, and who takes over for them.
class JointRemoval {
 public:
  JointRemoval(Edit& edit, const Span<uint8_t>& keep)
      : view_(edit.view), keep_(keep), arena_(edit.arena()) {}

  Status run(Error& error) {
    const uint32_t count = view_.defn.joint_names.count;
    heirs_ = arena_.array<uint32_t>(count);
    if (heirs_.count != count) return no_memory(error, "an edit");
    uint32_t first = 0;
    while (first < count && !keep_[first]) ++first;
    for (uint32_t j = 0; j < count; ++j) {
      heirs_[j] = kept_ancestor(j);
      if (heirs_[j] == kGone) heirs_[j] = first;  // of a root
    }
    if (first == count && has_weights()) {
      return fail(error, Status::kInvalidArgument, kNoOffset,
                  "every joint would be removed, but vertices need one: keep a joint, or remove "
                  "the meshes");
    }
    Renumbering numbers;
    const bool done = reparent() && hand_over_weights() && number_kept(keep_, arena_, numbers) &&
                      renumber_joints(view_, numbers, arena_);
    return done ? Status::kOk : no_memory(error, "an edit");
  }

 private:
  uint32_t parent(uint32_t joint) const { return view_.defn.joint_hierarchy[joint]; }

  /// Itself if it is kept; kGone if no ancestor is.
  uint32_t kept_ancestor(uint32_t joint) const {
    while (!keep_[joint]) {
      if (parent(joint) == joint) return kGone;
      joint = parent(joint);
    }
    return joint;
  }

  bool has_weights() const {
    for (const dna::Mesh& mesh : view_.geom.meshes) {
      for (const dna::VertexSkinWeights& vertex : mesh.skin_weights) {
        if (vertex.joint_indices.count != 0) return true;
      }
    }
    return false;
  }

  /// Kept joints whose parent goes.
  bool reparent() {
    dna::Definition& defn = view_.defn;
    const RotationConvention convention = convention_of(view_);
    NewArray<uint16_t> parents;
    NewArray<float> fields[6];
    Array<float>* const arrays[6] = {&defn.neutral_translations.xs, &defn.neutral_translations.ys,
                                     &defn.neutral_translations.zs, &defn.neutral_rotations.xs,
                                     &defn.neutral_rotations.ys,    &defn.neutral_rotations.zs};
    bool copied = false;
    for (uint32_t j = 0; j < defn.joint_names.count; ++j) {
      if (!keep_[j] || parent(j) == j || keep_[parent(j)]) continue;
      if (!copied && !copy_array(arena_, defn.joint_hierarchy, parents)) return false;
      for (int k = 0; k < 6 && !copied; ++k) {
        if (!copy_array(arena_, *arrays[k], fields[k])) return false;
      }
      copied = true;
      const uint32_t heir = kept_ancestor(parent(j));
      Rigid local = neutral_of(view_, convention, j);
      for (uint32_t up = parent(j); up != heir; up = parent(up)) {
        local = local * neutral_of(view_, convention, up);
        if (parent(up) == up) break;
      }
      parents.set(j, static_cast<uint16_t>(heir == kGone ? j : heir));
      float angles[3];
      euler_from_matrix(convention, local.turn, angles);
      const double places[3] = {local.place.x, local.place.y, local.place.z};
      for (int k = 0; k < 3; ++k) {
        fields[k].set(j, static_cast<float>(places[k]));
        fields[3 + k].set(j, angles[k]);
      }
    }
    if (!copied) return true;
    defn.joint_hierarchy = parents;
    for (int k = 0; k < 6; ++k) *arrays[k] = fields[k];
    return true;
  }

  /// Copies the lists of those meshes only whose weights change.
  bool hand_over_weights() {
    if (!copy_list(arena_, view_.geom.meshes)) return false;
    for (dna::Mesh& mesh : view_.geom.meshes) {
      bool copied = false;
      for (uint32_t v = 0; v < mesh.skin_weights.count; ++v) {
        if (stays(mesh.skin_weights[v])) continue;
        if (!copied && !copy_list(arena_, mesh.skin_weights)) return false;
        copied = true;
        if (!hand_over(mesh.skin_weights[v])) return false;
      }
    }
    return true;
  }

  bool stays(const dna::VertexSkinWeights& vertex) const {
    bool same = true;
    for (uint32_t i = 0; i < vertex.joint_indices.count; ++i)
      same = same && keep_[vertex.joint_indices[i]];
    return same;
  }

  bool hand_over(dna::VertexSkinWeights& vertex) {
    const uint32_t count = vertex.joint_indices.count;
    const NewArray<uint16_t> joints = dna::new_array<uint16_t>(arena_, count);
    const NewArray<float> weights = dna::new_array<float>(arena_, count);
    if (!joints.data || !weights.data) return false;
    const Array<uint16_t> made = joints;
    const Array<float> sums = weights;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t heir = heirs_[vertex.joint_indices[i]];
      uint32_t at = 0;
      while (at < kept && made[at] != heir) ++at;
      joints.set(at, static_cast<uint16_t>(heir));
      weights.set(at, at < kept ? sums[at] + vertex.weights[i] : vertex.weights[i]);
      kept += at == kept;
    }
    vertex.joint_indices = made.first(kept);
    vertex.weights = sums.first(kept);
    return true;
  }

  dna::DnaView& view_;
  const Span<uint8_t>& keep_;
  Arena& arena_;
  Span<uint32_t> heirs_;  // [joint] itself, or who gets its influence
};

}  // namespace

// Names ---------------------------------------------------------------------------------------------

const dna::List<dna::String>& names_of(const dna::DnaView& view, Kind kind) {
  switch (kind) {
    case Kind::kGuiControl: return view.defn.gui_control_names;
    case Kind::kRawControl: return view.defn.raw_control_names;
    case Kind::kMlControl: return view.mlbh.control_names;
    case Kind::kRbfControl: return view.rbfe.pose_control_names;
    case Kind::kJoint: return view.defn.joint_names;
    case Kind::kChannel: return view.defn.channel_names;
    case Kind::kMap: return view.defn.map_names;
    case Kind::kPsdControl:
    case Kind::kMesh: break;
  }
  return view.defn.mesh_names;
}

uint32_t count_of(const dna::DnaView& view, Kind kind) {
  return kind == Kind::kPsdControl ? view.bhvr.controls.psd_count : names_of(view, kind).count;
}

const char* path_of(Kind kind) { return kKinds[static_cast<size_t>(kind)].path; }
const char* word_of(Kind kind) { return kKinds[static_cast<size_t>(kind)].word; }

Status find_element(const Document& document, Kind kind, const char* name, size_t count,
                    uint32_t& out_index, Error& error) {
  const uint32_t elements = count_of(document.view(), kind);
  for (uint32_t i = 0; kind == Kind::kPsdControl && i < elements; ++i) {
    char psd[16];
    snprintf(psd, sizeof(psd), "psd%u", i);
    if (strlen(psd) != count || memcmp(psd, name, count) != 0) continue;
    out_index = i;
    return Status::kOk;
  }
  const dna::List<dna::String>& names = names_of(document.view(), kind);
  for (uint32_t i = 0; kind != Kind::kPsdControl && i < names.count; ++i) {
    if (names[i].count != count || (count != 0 && memcmp(names[i].data, name, count) != 0))
      continue;
    out_index = i;
    return Status::kOk;
  }
  return fail(error, Status::kName, kNoOffset, "there is no %s \"%.*s\" among %u", word_of(kind),
              static_cast<int>(std::min<size_t>(count, 80)), name, elements);
}

Status rename_element(Document& document, Kind kind, uint32_t index, const char* name, size_t count,
                      Error& error) {
  if (kind == Kind::kPsdControl) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "PSD controls have no names to change");
  }
  const uint32_t elements = count_of(document.view(), kind);
  if (Status s = check_indices({&index, 1}, elements, word_of(kind), error); s != Status::kOk)
    return s;
  char path[80];
  snprintf(path, sizeof(path), "%s[%u]", path_of(kind), index);
  return write_string(document, path, name, count, error);
}

// Removing ------------------------------------------------------------------------------------------

Status remove_elements(Document& document, Kind kind, Span<const uint32_t> indices, Error& error) {
  const uint32_t count = count_of(document.view(), kind);
  if (Status s = check_indices(indices, count, word_of(kind), error); s != Status::kOk) return s;
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  if (kind < Kind::kJoint) return remove_controls(document, kind, indices, error);
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  Span<uint8_t> keep;
  if (Status s = marks_of(indices, count, edit.arena(), keep, error); s != Status::kOk) return s;
  if (kind == Kind::kJoint) {
    if (Status s = JointRemoval(edit, keep).run(error); s != Status::kOk) return s;
    edit.commit();
    return Status::kOk;
  }
  Renumbering numbers;
  bool done = number_kept(keep, edit.arena(), numbers);
  if (done) {
    switch (kind) {
      case Kind::kChannel: done = renumber_channels(edit.view, numbers, edit.arena()); break;
      case Kind::kMap: done = renumber_maps(edit.view, numbers, edit.arena()); break;
      default: done = renumber_meshes(edit.view, numbers, edit.arena()); break;
    }
  }
  if (!done) return no_memory(error, "an edit");
  edit.commit();
  return Status::kOk;
}

Status clear_joint_animation(Document& document, Span<const uint32_t> joints, Error& error) {
  const uint32_t count = document.view().defn.joint_names.count;
  if (Status s = check_indices(joints, count, "joint", error); s != Status::kOk) return s;
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  Span<uint8_t> keep;
  if (Status s = marks_of(joints, count, edit.arena(), keep, error); s != Status::kOk) return s;
  if (!drop_joint_rows(edit.view, keep, edit.arena())) return no_memory(error, "an edit");
  edit.commit();
  return Status::kOk;
}

Status clear_all(Document& document, Kind kind, Error& error) {
  if (kind != Kind::kChannel && kind != Kind::kMap && kind != Kind::kJoint) {
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "a %s has nothing to clear: blend shape channels, animated maps and the animation "
                "of joints are "
                "cleared",
                word_of(kind));
  }
  const uint32_t count = names_of(document.view(), kind).count;
  Arena scratch(document.allocator());
  const Span<uint32_t> all = scratch.array<uint32_t>(count);
  if (all.count != count) return no_memory(error, "an edit");
  for (uint32_t i = 0; i < count; ++i) all[i] = i;
  return kind == Kind::kJoint ? clear_joint_animation(document, all, error)
                              : remove_elements(document, kind, all, error);
}

}  // namespace mien::author
