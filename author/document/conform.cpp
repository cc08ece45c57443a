// SPDX-License-Identifier: MIT
#include "author/document/conform.h"

#include <cmath>

#include "author/base/dna_making.h"
#include "author/document/check_view.h"
#include "author/document/control_poses.h"
#include "author/document/renumber.h"
#include "author/document/surface_match.h"
#include "author/document/warp.h"

namespace mien::author {

using dna::NewArray;

bool place_joints(dna::DnaView& view, Span<const Vec3> places, Arena& arena) {
  ControlPoses poses;
  NewVec3s out;
  const dna::Vec3Array& old = view.defn.neutral_translations;
  if (!poses.prepare(view, arena) || !out.allocate(arena, places.count)) return false;
  for (uint32_t j = 0; j < places.count; ++j) {
    const uint32_t parent = view.defn.joint_hierarchy[j];
    const auto stays = [&](uint32_t joint) {
      return is_zero(places[joint] - poses.bind(joint).place);
    };
    if (stays(j) && stays(parent)) {
      out.xs.set(j, old.xs[j]);
      out.ys.set(j, old.ys[j]);
      out.zs.set(j, old.zs[j]);
      continue;
    }
    // The parent's orientation stays, its place is the new one.
    out.set(j, parent == j
                   ? places[j]
                   : turned(places[j] - places[parent], transposed(poses.bind(parent).turn)));
  }
  view.defn.neutral_translations = out;
  return true;
}

bool scale_translations(dna::DnaView& view, Span<const double> scales, Arena& arena) {
  if (!copy_list(arena, view.bhvr.joints.groups)) return false;
  for (dna::JointGroup& group : view.bhvr.joints.groups) {
    const uint32_t columns = group.input_indices.count;
    NewArray<float> values;
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      const uint32_t output = group.output_indices[r];
      if (output % 9 >= 3 || scales[output / 9] == 1) continue;
      if (!values.data && !copy_array(arena, group.values, values)) return false;
      for (uint32_t c = 0; c < columns; ++c) {
        const size_t at = size_t{r} * columns + c;
        values.set(at, static_cast<float>(double{group.values[at]} * scales[output / 9]));
      }
    }
    if (values.data) group.values = values;
  }
  return true;
}

namespace {

/// What moves with the surface.
class Follower {
 public:
  Follower(dna::DnaView& view, const Warp& warp, Arena& arena, const Allocator& allocator)
      : view_(view), warp_(warp), arena_(arena), allocator_(allocator) {}

  bool joints(ConformResult& out) {
    const uint32_t count = view_.defn.joint_names.count;
    ControlPoses poses;
    Span<Vec3> places;
    Span<double> scales;
    if (!poses.prepare(view_, arena_) || !make(arena_, count, places) ||
        !make(arena_, count, scales))
      return false;
    bool any = false;
    for (uint32_t j = 0; j < count; ++j) {
      const Vec3 old = poses.bind(j).place;
      const Similarity motion = motion_at(old);
      places[j] = motion(old);
      scales[j] = std::abs(motion.scale - 1) < 1e-9 ? 1 : motion.scale;
      any |= !motion.is_identity();
      const double moved = length(places[j] - old);
      if (moved > out.farthest_joint) out = {moved, j};
    }
    if (!any) return true;
    return place_joints(view_, places, arena_) && scale_translations(view_, scales, arena_);
  }

  /// Targets and normals of a mesh; its positions, too, unless they have been set.
  bool mesh(dna::Mesh& mesh, bool positions, Span<const Vec3> old) {
    Arena scratch(allocator_);
    Span<Similarity> motions;
    Span<uint8_t> moves;  // [position]
    if (!make(scratch, old.count, motions) || !make(scratch, old.count, moves)) return false;
    bool any = false;
    for (size_t v = 0; v < old.count; ++v) {
      motions[v] = motion_at(old[v]);
      moves[v] = !motions[v].is_identity();
      any |= moves[v] != 0;
    }
    if (!any) return true;
    if (positions) {
      NewVec3s moved;
      if (!moved.allocate(arena_, old.count)) return false;
      for (size_t v = 0; v < old.count; ++v) moved.set(v, moves[v] ? motions[v](old[v]) : old[v]);
      mesh.positions = moved;
    }
    NewVec3s normals;
    const uint32_t normal_count = mesh.normals.xs.count;
    if (!normals.allocate(arena_, normal_count)) return false;
    for (uint32_t n = 0; n < normal_count; ++n) normals.set(n, vector_of(mesh.normals, n));
    for (uint32_t k = 0; k < mesh.layouts.normals.count; ++k) {
      if (!moves[mesh.layouts.positions[k]]) continue;
      const uint32_t n = mesh.layouts.normals[k];
      normals.set(n, turned(vector_of(mesh.normals, n), motions[mesh.layouts.positions[k]].turn));
    }
    mesh.normals = normals;
    if (!copy_list(arena_, mesh.blend_shape_targets)) return false;
    for (dna::BlendShapeTarget& target : mesh.blend_shape_targets) {
      NewVec3s deltas;
      const uint32_t count = target.vertex_indices.count;
      bool moving = false;
      for (uint32_t i = 0; i < count && !moving; ++i) moving = moves[target.vertex_indices[i]] != 0;
      if (!moving) continue;
      if (!deltas.allocate(arena_, count)) return false;
      for (uint32_t i = 0; i < count; ++i) {
        deltas.set(i, motions[target.vertex_indices[i]].direction(vector_of(target.deltas, i)));
      }
      target.deltas = deltas;
    }
    return true;
  }

 private:
  Similarity motion_at(Vec3 place) {
    return warp_.stays(place, hint_) ? Similarity() : warp_.at(place, hint_);
  }

  dna::DnaView& view_;
  const Warp& warp_;
  Arena& arena_;
  const Allocator& allocator_;
  WarpHint hint_;
};

}  // namespace

Status conform(Document& document, uint32_t mesh, const float* positions, size_t count, bool others,
               ConformResult& out, Error& error) {
  out = {};
  if (Status s = check_document(document, error); s != Status::kOk) return s;
  Edit edit(document);
  if (!edit.begin(error)) return error.status;
  dna::DnaView& view = edit.view;
  Arena& arena = edit.arena();
  if (Status s = check_indices({&mesh, 1}, view.geom.meshes.count, "mesh", error); s != Status::kOk)
    return s;
  if (count == 0 || count != view.geom.meshes[mesh].positions.xs.count) {
    return fail(error, Status::kInvalidArgument, kNoOffset, "mesh %u has %u positions, not %zu",
                mesh, view.geom.meshes[mesh].positions.xs.count, count);
  }
  for (size_t i = 0; i < count * 3; ++i) {
    if (std::isfinite(positions[i])) continue;
    return fail(error, Status::kInvalidArgument, kNoOffset,
                "number %zu of the positions is not finite", i);
  }
  Span<Vec3> before, after;
  NewVec3s given;
  Warp warp;
  Arena scratch(document.allocator());
  if (!copy_list(arena, view.geom.meshes) ||
      !positions_of(view.geom.meshes[mesh], scratch, before) || !make(scratch, count, after) ||
      !given.allocate(arena, count)) {
    return no_memory(error, "an edit");
  }
  for (size_t v = 0; v < count; ++v) {
    after[v] = {double{positions[3 * v]}, double{positions[3 * v + 1]},
                double{positions[3 * v + 2]}};
    given.set(v, after[v]);
  }
  if (!warp.build(before, after, scratch)) return no_memory(error, "an edit");
  Follower follower(view, warp, arena, document.allocator());
  if (!follower.joints(out)) return no_memory(error, "an edit");
  view.geom.meshes[mesh].positions = given;
  for (uint32_t m = 0; m < view.geom.meshes.count; ++m) {
    if (m != mesh && !others) continue;
    Arena positions_scratch(document.allocator());
    Span<Vec3> old = before;
    if (m != mesh && !positions_of(view.geom.meshes[m], positions_scratch, old))
      return no_memory(error, "an edit");
    if (!follower.mesh(view.geom.meshes[m], m != mesh, old)) return no_memory(error, "an edit");
  }
  edit.commit();
  return Status::kOk;
}

}  // namespace mien::author
