// SPDX-License-Identifier: MIT
#include "author/document/control_errors.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "author/base/dna_making.h"
#include "author/document/control_poses.h"
#include "author/document/copy.h"
#include "author/document/renumber.h"
#include "author/document/rows.h"

namespace mien::author {

namespace {

/// Meshes of LOD 0 that both rigs have, with the numbers of their positions in one row of all.
struct SharedMeshes {
  struct Pair {
    uint32_t before, after;  // numbers of the mesh in both
    uint32_t first;
  };
  Span<Pair> pairs;
  Span<uint32_t> pair_of;  // [position]
};

bool find_shared_meshes(const dna::DnaView& before, const dna::DnaView& after, Arena& arena,
                        SharedMeshes& out) {
  const dna::Array<uint16_t> meshes = after.defn.lod_meshes.at(0);
  Span<uint32_t> old_mesh;
  if (!find_names(after.defn.mesh_names, before.defn.mesh_names, arena, old_mesh) ||
      !make(arena, meshes.count, out.pairs)) {
    return false;
  }
  uint32_t used = 0, positions = 0;
  for (uint32_t i = 0; i < meshes.count && meshes[i] < after.geom.meshes.count; ++i) {
    const uint32_t old = old_mesh[meshes[i]];
    if (old == kGone || old >= before.geom.meshes.count) continue;
    const uint32_t count = before.geom.meshes[old].positions.xs.count;
    if (count != after.geom.meshes[meshes[i]].positions.xs.count) continue;
    out.pairs[used++] = {old, meshes[i], positions};
    positions += count;
  }
  out.pairs = out.pairs.first(used);
  if (!make(arena, positions, out.pair_of)) return false;
  for (uint32_t i = 0; i < used; ++i) {
    const uint32_t end = i + 1 < used ? out.pairs[i + 1].first : positions;
    for (uint32_t at = out.pairs[i].first; at < end; ++at) out.pair_of[at] = i;
  }
  return true;
}

/// One of the rigs: what it does to the shared positions.
class Mover {
 public:
  Mover(const dna::DnaView& view, const SharedMeshes& meshes, uint32_t SharedMeshes::Pair::*number)
      : view_(view), meshes_(meshes), number_(number) {}

  bool prepare(Span<double> controls, const Allocator& allocator, Arena& arena) {
    const uint32_t joints = view_.defn.joint_names.count;
    const auto visit_positions = [this](const auto& put) {
      for (uint32_t at = 0; at < meshes_.pair_of.count; ++at) {
        const dna::VertexSkinWeights* vertex = weights_of(at);
        for (uint32_t k = 0; vertex && k < vertex->joint_indices.count; ++k)
          put(vertex->joint_indices[k], at);
      }
    };
    const auto visit_targets = [this](const auto& put) {
      uint32_t number = 0;
      for (uint32_t i = 0; i < meshes_.pairs.count; ++i) {
        for (const dna::BlendShapeTarget& target : mesh(i).blend_shape_targets)
          put(target.channel_index, number++);
      }
    };
    uint32_t target_count = 0;
    for (uint32_t i = 0; i < meshes_.pairs.count; ++i)
      target_count += mesh(i).blend_shape_targets.count;
    Arena scratch(allocator);
    if (!poses_.prepare(view_, arena) || !make(arena, joints, skin_) ||
        !make(arena, joints, rest_) || !make(arena, view_.defn.channel_names.count, channels_) ||
        !make(arena, meshes_.pair_of.count, offsets_) || !make(arena, target_count, targets_) ||
        !make_rows(arena, joints, visit_positions, positions_) ||
        !make_rows(arena, channels_.count, visit_targets, targets_of_channel_)) {
      return false;
    }
    uint32_t number = 0;
    for (uint32_t i = 0; i < meshes_.pairs.count; ++i) {
      for (uint32_t t = 0; t < mesh(i).blend_shape_targets.count; ++t) targets_[number++] = {i, t};
    }
    std::fill(controls.begin(), controls.end(), 0.0);
    return poses_.skin(controls, scratch, rest_);
  }

  /// Calls put(position) for each position that a raw control may move, some of them more than once. False if memory
  /// ran out.
  template <class Put>
  bool pose(uint32_t control, Span<double> controls, const Allocator& allocator, const Put& put) {
    Arena scratch(allocator);
    poses_.controls(control, controls);
    poses_.channels(controls, channels_);
    if (!poses_.skin(controls, scratch, skin_)) return false;
    for (uint32_t j = 0; j < skin_.count; ++j) {
      if (memcmp(&skin_[j], &rest_[j], sizeof(Rigid)) == 0) continue;
      for (uint32_t at : positions_[j]) put(at);
    }
    for (uint32_t c = 0; c < channels_.count; ++c) {
      if (channels_[c] == 0) continue;
      for (uint32_t number : targets_of_channel_[c]) {
        const TargetPlace& place = targets_[number];
        const dna::BlendShapeTarget& target = mesh(place.pair).blend_shape_targets[place.target];
        for (uint32_t i = 0; i < target.vertex_indices.count; ++i) {
          const uint32_t at = meshes_.pairs[place.pair].first + target.vertex_indices[i];
          offsets_[at] = offsets_[at] + vector_of(target.deltas, i) * channels_[c];
          put(at);
        }
      }
    }
    return true;
  }

  Vec3 rest(uint32_t at) const {
    const uint32_t pair = meshes_.pair_of[at];
    return vector_of(mesh(pair).positions, at - meshes_.pairs[pair].first);
  }

  /// Where the pose puts a position. Forgets its offset.
  Vec3 take(uint32_t at) {
    const Vec3 shaped = rest(at) + offsets_[at];
    offsets_[at] = {};
    const dna::VertexSkinWeights* vertex = weights_of(at);
    return vertex ? ControlPoses::skinned(*vertex, skin_, shaped) : shaped;
  }

 private:
  const dna::Mesh& mesh(uint32_t pair) const {
    return view_.geom.meshes[meshes_.pairs[pair].*number_];
  }
  const dna::VertexSkinWeights* weights_of(uint32_t at) const {
    const uint32_t pair = meshes_.pair_of[at], v = at - meshes_.pairs[pair].first;
    return v < mesh(pair).skin_weights.count ? &mesh(pair).skin_weights[v] : nullptr;
  }

  struct TargetPlace {
    uint32_t pair, target;
  };

  const dna::DnaView& view_;
  const SharedMeshes& meshes_;
  uint32_t SharedMeshes::Pair::*number_;
  ControlPoses poses_;
  Span<Rigid> skin_, rest_;  // [joint] in the pose, and without one
  Span<double> channels_;    // weights in the pose
  Span<Vec3> offsets_;       // [position] by targets
  Span<TargetPlace> targets_;
  Rows positions_, targets_of_channel_;  // of joints; of channels
};

}  // namespace

Status measure_controls(const dna::DnaView& before, const dna::DnaView& after,
                        const Allocator& allocator, Span<ControlError> out, uint32_t& out_count,
                        Error& error) {
  out_count = 0;
  if (out.count == 0) return Status::kOk;
  Arena arena(allocator);
  SharedMeshes meshes;
  if (!find_shared_meshes(before, after, arena, meshes)) return no_memory(error, "measuring");
  Mover old_rig(before, meshes, &SharedMeshes::Pair::before),
      new_rig(after, meshes, &SharedMeshes::Pair::after);
  const size_t positions = meshes.pair_of.count;
  Span<uint32_t> old_control, moved,
      seen;  // positions that move; [position] the last control that may move it
  Span<double> controls;
  if (!find_names(after.defn.raw_control_names, before.defn.raw_control_names, arena,
                  old_control) ||
      !make(arena, kMaxControls, controls) || !make(arena, positions, moved) ||
      !make(arena, positions, seen) || !old_rig.prepare(controls, allocator, arena) ||
      !new_rig.prepare(controls, allocator, arena)) {
    return no_memory(error, "measuring");
  }
  for (uint32_t control = 0; control < old_control.count && out_count < out.count; ++control) {
    if (old_control[control] == kGone) continue;
    size_t count = 0;
    const auto put = [&](uint32_t at) {
      if (seen[at] == control + 1) return;
      seen[at] = control + 1;
      moved[count++] = at;
    };
    if (!old_rig.pose(old_control[control], controls, allocator, put) ||
        !new_rig.pose(control, controls, allocator, put)) {
      return no_memory(error, "measuring");
    }
    ControlError& found = out[out_count++] = {};
    found.control = control;
    double squares = 0;
    std::sort(moved.data, moved.data + count);  // sums in one order, and memory, too
    for (uint32_t at : moved.first(count)) {
      const Vec3 rest = old_rig.rest(at), old_place = old_rig.take(at);
      const double distance = length(old_place - new_rig.take(at));
      found.worst = std::max(found.worst, distance);
      found.moved = std::max(found.moved, length(old_place - rest));
      squares += distance * distance;
    }
    if (positions != 0) found.rms = std::sqrt(squares / static_cast<double>(positions));
  }
  return Status::kOk;
}

}  // namespace mien::author
