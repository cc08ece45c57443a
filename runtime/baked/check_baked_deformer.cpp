// SPDX-License-Identifier: MIT
// Whether the tables of a deformer that came from outside keep deformation within its arrays. What
// packing lays out one behind the other has to lie so here: then nothing is counted twice, work is
// bounded by the size of the file, and no two tasks write the same vertex.
#include <algorithm>

#include "runtime/baked/baked_objects.h"
#include "runtime/baked/part_check.h"

namespace mien {
namespace {

struct DeformerChecker : Checker {
  const Deformer& deformer;
  const Rig& rig;
};

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
                  skeleton.added_angles.count == joints * 3 &&
                  skeleton.bind.count == joints * kMatrixFloats &&
                  skeleton.inverse_bind.count == joints * kMatrixFloats,
              "skeleton") &&
         c.ok(skeleton.compose == Compose::kProduct ||
                  (skeleton.compose == Compose::kEulerAdd && !skeleton.quaternions()),
              "how rotations are composed") &&
         c.ok(!full || is_ordered(skeleton), "order of joints");
}

/// What callers see, in the order of the file.
bool check_mesh_arrays(const DeformerChecker& c, const DeformMesh& mesh) {
  const uint64_t positions = mesh.position_count, vertices = mesh.vertex_count;
  return c.ok(positions < kHardCorner && vertices < kHardCorner &&
                  mesh.positions.count == positions * 3 + 1 &&
                  mesh.normals.count == vertices * 3 + 1 &&
                  mesh.texture_coordinates.count == vertices * 2 &&
                  mesh.vertex_position_indices.count == vertices &&
                  below(mesh.vertex_position_indices, positions) &&
                  mesh.triangles.count == uint64_t{mesh.triangle_count} * 3 &&
                  below(mesh.triangles, vertices) && (mesh.lods >> c.rig.lod_count) == 0,
              "vertices of a mesh") &&
         c.ok(mesh.target_channels.count == mesh.target_count &&
                  below(mesh.target_channels, c.rig.channel_count),
              "channels of blend shape targets");
}

/// Runs follow each other, and their rows of weights too.
bool check_skin(const DeformerChecker& c, const DeformMesh& mesh) {
  const uint64_t positions = mesh.position_count;
  if (!c.ok(mesh.position_at.count == positions && mesh.place_of.count == positions &&
                mesh.neutral.count == positions * 4 &&
                mesh.neutral_directions.count == positions * 4 &&
                mesh.joints.count == mesh.weights.count && below(mesh.joints, c.rig.joint_count),
            "skin weights")) {
    return false;
  }
  uint64_t place = 0, weight = 0;
  uint32_t max_influences = 0;
  for (const SkinRun& run : mesh.runs) {
    const bool good = run.first == place && run.count != 0 && run.first_weight == weight &&
                      run.influences <= 0xFFFF && run.zero == 0;
    place += run.count;
    weight += uint64_t{run.count} * run.influences;
    max_influences = std::max(max_influences, run.influences);
    if (!c.ok(good && place <= positions && weight <= mesh.weights.count, "runs of skin weights")) {
      return false;
    }
  }
  if (!c.ok(place == positions && weight == mesh.weights.count &&
                max_influences == mesh.max_influences,
            "runs of skin weights")) {
    return false;
  }
  // Each undoes the other: so each position has one place.
  bool good = true;
  for (uint32_t p = 0; good && p < mesh.position_count; ++p) {
    const uint32_t position = mesh.position_at[p];
    good = position < positions && mesh.place_of[position] == p;
  }
  return c.ok(good, "order of positions");
}

/// Block by block, pieces of ascending targets, with deltas one behind the other.
bool check_targets(const DeformerChecker& c, const DeformMesh& mesh) {
  const uint32_t blocks = mesh.block_count();
  if (!c.ok(is_runs(mesh.first_piece, blocks, mesh.pieces.count) &&
                mesh.first_piece.count == size_t{blocks} + 1 &&
                mesh.first_piece[blocks] == mesh.pieces.count &&
                mesh.delta_places.count == mesh.delta_count &&
                mesh.deltas.count == mesh.delta_count * 3 + 1,
            "blend shape targets")) {
    return false;
  }
  uint64_t delta = 0;
  for (uint32_t b = 0; b < blocks; ++b) {
    const uint64_t first_delta = delta;
    uint64_t next_target = 0;
    for (uint32_t i = mesh.first_piece[b]; i < mesh.first_piece[b + 1]; ++i) {
      const TargetPiece& piece = mesh.pieces[i];
      const bool good = piece.target >= next_target && piece.target < mesh.target_count &&
                        piece.channel == mesh.target_channels[piece.target] &&
                        piece.first_delta == delta;
      next_target = uint64_t{piece.target} + 1;
      delta += piece.count;
      if (!c.ok(good && delta <= mesh.delta_count, "pieces of blend shape targets")) return false;
    }
    const uint32_t places = std::min(kBlockPlaces, mesh.position_count - b * kBlockPlaces);
    if (!c.ok(below(mesh.delta_places.slice(first_delta, delta - first_delta), places),
              "positions of blend shape targets")) {
      return false;
    }
  }
  return c.ok(delta == mesh.delta_count, "blend shape targets");
}

/// Corners of a place are vertices at its position, ascending: so each vertex is one corner.
bool check_corners(const DeformMesh& mesh) {
  for (uint32_t p = 0; p < mesh.position_count; ++p) {
    uint64_t next_vertex = 0;
    for (uint32_t i = mesh.first_corner[p]; i < mesh.first_corner[p + 1]; ++i) {
      const uint32_t vertex = mesh.corners[i] & ~kHardCorner;
      if (vertex < next_vertex || vertex >= mesh.vertex_count ||
          mesh.vertex_position_indices[vertex] != mesh.position_at[p]) {
        return false;
      }
      next_vertex = uint64_t{vertex} + 1;
    }
  }
  return true;
}

bool check_surface(const DeformerChecker& c, const DeformMesh& mesh) {
  const size_t positions = mesh.position_count;
  return c.ok(mesh.faces.count % 4 == 0 && mesh.faces.count / 4 <= ~uint32_t{0} &&
                  below(mesh.faces, positions) && mesh.first_touching.count == positions + 1 &&
                  is_runs(mesh.first_touching, positions, mesh.touching.count) &&
                  below(mesh.touching, mesh.face_count()),
              "faces") &&
         c.ok(mesh.corners.count == mesh.vertex_count && mesh.first_corner.count == positions + 1 &&
                  is_runs(mesh.first_corner, positions, mesh.corners.count) &&
                  mesh.first_corner[positions] == mesh.vertex_count && check_corners(mesh),
              "corners");
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
