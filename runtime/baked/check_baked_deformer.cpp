// SPDX-License-Identifier: MIT
// Whether the tables of a deformer that came from outside keep deformation within its arrays. Arrays that
// packing lays out one after another must lie so here, too: then nothing is counted twice, work is bounded
// by the size of the file, and no two tasks write the same vertex.
#include <algorithm>

#include "runtime/baked/baked_objects.h"
#include "runtime/baked/part_check.h"
#include "simd/deform_kernels.h"
#include "simd/pose_kernels.h"

namespace mien {
namespace {

struct DeformerChecker : Checker {
  const Deformer& deformer;
  const Rig& rig;
};

bool all_below(const IndexList& list, uint64_t limit) {
  return list.wide ? below(list.wide_span(), limit) : below(list.narrow_span(), limit);
}

/// Each window lists its own positions, once each.
bool lists_all_positions(const DeformMesh& mesh) {
  for (uint64_t first = 0; first < mesh.position_count; first += kWindowPositions) {
    const size_t count = std::min<uint64_t>(kWindowPositions, mesh.position_count - first);
    uint64_t seen[kWindowPositions / 64] = {};
    for (const uint16_t place : mesh.position_indices.slice(first, count)) {
      if (place >= count) return false;
      const uint64_t bit = uint64_t{1} << place % 64;
      if (seen[place / 64] & bit) return false;
      seen[place / 64] |= bit;
    }
  }
  return true;
}

/// Every joint once, after its parent.
bool is_ordered(const Skeleton& skeleton) {
  uint64_t seen[0x10000 / 64] = {};
  const auto was_seen = [&](uint32_t joint) { return (seen[joint / 64] >> joint % 64 & 1) != 0; };
  for (const uint16_t joint : skeleton.order) {
    const uint16_t parent = skeleton.parents[joint];
    if (was_seen(joint) || (parent != joint && !was_seen(parent))) return false;
    seen[joint / 64] |= uint64_t{1} << joint % 64;
  }
  return true;
}

bool check_skeleton(const DeformerChecker& c, bool full) {
  const Skeleton& skeleton = c.deformer.skeleton;
  const size_t joints = skeleton.joint_count;
  const size_t lanes = size_t{skeleton.block_count()} * kBlockLanes;
  return c.ok(skeleton.order.count == joints && below(skeleton.order, joints) &&
                  skeleton.neutral.count == lanes * kNeutralRows &&
                  skeleton.neutral_angles.count == joints * 3 &&
                  skeleton.bind.count == joints * kMatrixFloats &&
                  skeleton.inverse_bind.count == joints * kMatrixFloats,
              "skeleton") &&
         c.ok(skeleton.compose == Compose::kProduct ||
                  (skeleton.compose == Compose::kEulerAdd && !skeleton.quaternions()),
              "how rotations are composed") &&
         c.ok(!full || is_ordered(skeleton), "order of joints");
}

/// Floats, or integers in 16-bit storage, with their origins and steps.
bool are_coordinates(const DeformMesh& mesh, bool half_storage) {
  const size_t count = size_t{mesh.vertex_count} * 2;
  if (mesh.fixed_coordinates.empty()) return mesh.texture_coordinates.count == count;
  return half_storage && mesh.fixed_coordinates.count == count &&
         mesh.texture_coordinates.count == 4;
}

/// What callers see, in the order of the file.
bool check_mesh_arrays(const DeformerChecker& c, const DeformMesh& mesh) {
  const uint64_t positions = mesh.position_count, vertices = mesh.vertex_count;
  return c.ok(positions < kHardEdge && vertices < kHardEdge &&
                  mesh.positions.count == positions * 3 + 1 &&
                  mesh.normals.count == vertices * 3 + 1 &&
                  mesh.tangents.count == (c.deformer.has_tangents ? vertices * 4 : 0) &&
                  are_coordinates(mesh, c.deformer.half_storage) &&
                  mesh.vertex_position_indices.count == vertices &&
                  below(mesh.vertex_position_indices, positions) &&
                  (mesh.triangles.count == uint64_t{mesh.triangle_count} * 3 ||
                   (c.deformer.half_storage && mesh.triangles.empty())) &&
                  below(mesh.triangles, vertices),
              "vertices of a mesh") &&
         c.ok(mesh.target_channels.count == mesh.target_count &&
                  below(mesh.target_channels, c.rig.channel_count),
              "channels of blend shape targets");
}

/// Runs follow each other, and their rows of weights too.
bool check_skin(const DeformerChecker& c, const DeformMesh& mesh) {
  const uint64_t positions = mesh.position_count;
  const bool half = c.deformer.half_storage;
  const bool fixed = half && mesh.max_influences <= kMaxFixedInfluences;
  if (!c.ok(mesh.position_indices.count == positions &&
                mesh.sorted_positions.count == (half ? 0 : positions * 4) &&
                mesh.weights.count == (fixed ? 0 : mesh.joints.count) &&
                mesh.fixed_weights.count == (fixed ? mesh.joints.count : 0) &&
                below(mesh.joints, c.rig.joint_count),
            "skin weights")) {
    return false;
  }
  uint64_t next = 0, weight = 0;
  uint32_t max_influences = 0;
  for (const SkinRun& run : mesh.skin_runs) {
    const bool good = run.first == next && run.count != 0 && run.first_weight == weight &&
                      run.influences <= 0xFFFF && run.zero == 0;
    next += run.count;
    weight += uint64_t{run.count} * run.influences;
    max_influences = std::max(max_influences, run.influences);
    if (!c.ok(good && next <= positions && weight <= mesh.joints.count, "runs of skin weights")) {
      return false;
    }
  }
  if (!c.ok(
          next == positions && weight == mesh.joints.count && max_influences == mesh.max_influences,
          "runs of skin weights")) {
    return false;
  }
  return c.ok(lists_all_positions(mesh), "order of positions");
}

/// A run of a block of `positions` in 16-bit storage begins at `word`, which moves to its end. Its groups ascend, and
/// have as many bits as the run has deltas, none of positions that the block lacks.
bool check_fixed_run(const DeformMesh& mesh, const TargetRun& run, uint32_t positions,
                     uint64_t& word) {
  const FixedRun& fixed = mesh.fixed_run_of(run);
  const uint64_t first_delta = uint64_t{fixed.first_word()} + fixed.groups;
  const uint64_t end = first_delta + uint64_t{run.count} * fixed.words_per_delta();
  if (fixed.first_word() != word || end + kDeltaPadding > mesh.fixed_deltas.count) return false;
  uint32_t count = 0, next = 0;
  for (; word != first_delta; ++word) {
    const uint32_t group = static_cast<uint16_t>(mesh.fixed_deltas[word]), mask = group & 15;
    if (mask == 0 || group >> 4 < next) return false;
    next = (group >> 4) + 1;
    if ((group >> 4) * kGroupPositions + highest_bit(mask) >= positions) return false;
    count += bit_count(mask);
  }
  word = end;
  return count == run.count;
}

/// In each block, runs of ascending targets, whose deltas follow each other.
bool check_targets(const DeformerChecker& c, const DeformMesh& mesh) {
  const uint32_t blocks = mesh.block_count();
  const bool fixed = c.deformer.half_storage && mesh.deltas.empty();
  if (!c.ok(is_runs(mesh.first_target_run, blocks, mesh.target_runs.count) &&
                mesh.first_target_run.count == size_t{blocks} + 1 &&
                mesh.first_target_run[blocks] == mesh.target_runs.count &&
                mesh.delta_indices.count == (fixed ? 0 : mesh.delta_count) &&
                mesh.deltas.count == (fixed ? 0 : mesh.delta_count * 3 + 1) &&
                (fixed || mesh.fixed_deltas.empty()) &&
                mesh.fixed_runs.count == (fixed ? mesh.target_runs.count : 0),
            "blend shape targets")) {
    return false;
  }
  uint64_t delta = 0, word = 0;
  for (uint32_t b = 0; b < blocks; ++b) {
    const uint32_t count = std::min(kBlockPositions, mesh.position_count - b * kBlockPositions);
    const uint64_t first_delta = delta;
    uint64_t next_target = 0;
    for (uint32_t i = mesh.first_target_run[b]; i < mesh.first_target_run[b + 1]; ++i) {
      const TargetRun& run = mesh.target_runs[i];
      const bool good = run.target >= next_target && run.target < mesh.target_count &&
                        run.channel == mesh.target_channels[run.target] && run.first_delta == delta;
      next_target = uint64_t{run.target} + 1;
      delta += run.count;
      if (!c.ok(good && delta <= mesh.delta_count, "runs of blend shape targets")) return false;
      if (!fixed) continue;
      if (!c.ok(check_fixed_run(mesh, run, count, word), "numbers of blend shape targets")) {
        return false;
      }
    }
    if (!c.ok(fixed || below(mesh.delta_indices.slice(first_delta, delta - first_delta), count),
              "positions of blend shape targets")) {
      return false;
    }
  }
  const uint64_t padded = word == 0 ? 0 : word + kDeltaPadding;
  return c.ok(delta == mesh.delta_count && (!fixed || mesh.fixed_deltas.count == padded),
              "blend shape targets");
}

/// Each position lists its own vertices in ascending order, so each vertex is listed once.
bool check_vertex_lists(const DeformMesh& mesh) {
  for (uint32_t p = 0; p < mesh.position_count; ++p) {
    uint64_t next_vertex = 0;
    for (uint32_t i = mesh.first_vertex[p]; i < mesh.first_vertex[p + 1]; ++i) {
      const uint32_t vertex = mesh.vertices[i] & ~kHardEdge;
      if (vertex < next_vertex || vertex >= mesh.vertex_count ||
          mesh.vertex_position_indices[vertex] != mesh.position_of(p)) {
        return false;
      }
      next_vertex = uint64_t{vertex} + 1;
    }
  }
  return true;
}

/// Positions with vertices on hard edges, in ascending order, and no others.
bool lists_hard_positions(const DeformMesh& mesh) {
  const uint32_t* next = mesh.hard_positions.begin();
  for (uint32_t p = 0; p < mesh.position_count; ++p) {
    uint32_t marks = 0;
    for (uint32_t i = mesh.first_vertex[p]; i < mesh.first_vertex[p + 1]; ++i) {
      marks |= mesh.vertices[i] & kHardEdge;
    }
    if (marks == 0) continue;
    if (next == mesh.hard_positions.end() || *next++ != p) return false;
  }
  return next == mesh.hard_positions.end();
}

/// As many triangles as follow from the faces. Whether `corner_vertices` has one for each corner that reads it is not
/// known here: write_triangles() looks.
bool check_triangles(const DeformMesh& mesh) {
  if (!mesh.triangles_follow()) return mesh.corner_vertices.count == 0;
  uint64_t triangles = 0;
  for (size_t f = 0; f < mesh.face_count(); ++f) {
    uint32_t corners[4];
    triangles += static_cast<uint64_t>(mesh.face_corners(f, corners)) - 2;
  }
  return triangles == mesh.triangle_count && mesh.vertex_count != 0 &&
         mesh.corner_vertices.count <= mesh.faces.count &&
         all_below(mesh.corner_vertices, mesh.vertex_count);
}

bool check_surface(const DeformerChecker& c, const DeformMesh& mesh) {
  const size_t positions = mesh.position_count;
  return c.ok(mesh.faces.count % 4 == 0 && mesh.faces.count / 4 <= ~uint32_t{0} &&
                  all_below(mesh.faces, positions) &&
                  mesh.first_adjacent_face.count == positions + 1 &&
                  is_runs(mesh.first_adjacent_face, positions, mesh.adjacent_faces.count) &&
                  all_below(mesh.adjacent_faces, mesh.face_count()),
              "faces") &&
         c.ok(mesh.vertices.count == mesh.vertex_count &&
                  mesh.first_vertex.count == positions + 1 &&
                  is_runs(mesh.first_vertex, positions, mesh.vertices.count) &&
                  mesh.first_vertex[positions] == mesh.vertex_count && check_vertex_lists(mesh),
              "vertices of positions") &&
         c.ok(check_triangles(mesh), "triangles") &&
         c.ok(mesh.sorted_normals.count ==
                  (c.deformer.half_storage ? 0 : size_t{mesh.vertex_count} * 4),
              "normals of positions") &&
         c.ok(mesh.neutral_directions.count == mesh.hard_positions.count * 4 &&
                  lists_hard_positions(mesh),
              "hard edges");
}

}  // namespace

Status check_deformer(const Deformer& deformer, bool full, Error& error) {
  const DeformerChecker c = {{error}, deformer, *deformer.rig};
  bool good = check_skeleton(c, full) &&
              c.ok(deformer.normals >= Normals::kNone && deformer.normals <= Normals::kRecomputed,
                   "choice of normals");
  for (size_t m = 0; good && m < deformer.meshes.count; ++m) {
    const DeformMesh& mesh = deformer.meshes[m];
    good = check_mesh_arrays(c, mesh) && check_skin(c, mesh) && check_targets(c, mesh) &&
           check_surface(c, mesh);
  }
  return good ? Status::kOk : error.status;
}

}  // namespace mien
