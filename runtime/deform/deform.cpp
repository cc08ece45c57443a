// SPDX-License-Identifier: MIT
#include "runtime/deform/deform.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace mien {
namespace {

constexpr float kLeastChannelWeight = 1e-5f;
constexpr uint32_t kLeastParallelPositions = 16384;
constexpr uint32_t kTaskPlaces = 2048;  // and faces
constexpr uint32_t kTaskBlocks = kTaskPlaces / kBlockPlaces;
constexpr uint32_t kEnoughTasks = 64;

uint32_t divide_up(size_t a, size_t b) { return static_cast<uint32_t>((a + b - 1) / b); }

/// One mesh of some poses, and how it is cut into tasks.
struct Job {
  const Deformer& deformer;
  const DeformMesh& mesh;
  Span<DeformerInstance* const> poses;
  uint32_t mesh_number;
  Normals normals;
  uint32_t pose_parts = 1;

  const KernelTable& kernels() const { return *deformer.kernels; }
};

// Targets and skin --------------------------------------------------------------------------------

/// Neutral places of a block with its targets added to them, or the neutral ones themselves if no
/// target of the block is active.
const float* move_block(const Job& job, const DeformerInstance& pose, uint32_t block,
                        float* moved) {
  const DeformMesh& mesh = job.mesh;
  const uint32_t first = block * kBlockPlaces;
  const float* neutral = mesh.neutral.data + size_t{first} * 4;
  const float* places = neutral;
  for (uint32_t i = mesh.first_piece[block]; i < mesh.first_piece[block + 1]; ++i) {
    const TargetPiece& piece = mesh.pieces[i];
    const float weight = pose.channels[piece.channel];
    if (std::fabs(weight) < kLeastChannelWeight) continue;
    if (places == neutral) {
      const size_t count = std::min(kBlockPlaces, mesh.position_count - first);
      memcpy(moved, neutral, count * 4 * sizeof(float));
      places = moved;
    }
    TargetArgs args;
    args.deltas = mesh.deltas.data + size_t{piece.first_delta} * 3;
    args.places = mesh.delta_places.data + piece.first_delta;
    args.moved = moved;
    args.weight = weight;
    args.count = piece.count;
    job.kernels().add_target(args);
  }
  return places;
}

/// Places that no joint holds.
void leave_places(const Job& job, const float* places, uint32_t first, uint32_t count,
                  DeformedMesh& out) {
  const DeformMesh& mesh = job.mesh;
  for (uint32_t i = 0; i < count; ++i) {
    float* position = out.positions.data + size_t{mesh.position_at[first + i]} * 3;
    memcpy(position, places + size_t{i} * 4, 3 * sizeof(float));
  }
  if (job.normals != Normals::kSkinned) return;
  for (uint32_t c = mesh.first_corner[first]; c < mesh.first_corner[first + count]; ++c) {
    const size_t at = size_t{mesh.corners[c] & ~kHardCorner} * 3;
    memcpy(out.normals.data + at, mesh.normals.data + at, 3 * sizeof(float));
  }
}

void skin_block(const Job& job, DeformerInstance& pose, uint32_t block) {
  alignas(kBlockAlignment) float moved[kBlockPlaces * 4];
  const DeformMesh& mesh = job.mesh;
  DeformedMesh& out = pose.meshes[job.mesh_number];
  const uint32_t first = block * kBlockPlaces;
  const uint32_t end = std::min(first + kBlockPlaces, mesh.position_count);
  const float* places = move_block(job, pose, block, moved);

  for (const SkinRun* run = run_of(mesh, first); run != mesh.runs.end() && run->first < end;
       ++run) {
    const uint32_t from = std::max(run->first, first);
    const uint32_t to = std::min(run->first + run->count, end);
    if (run->influences == 0) {
      leave_places(job, places + size_t{from - first} * 4, from, to - from, out);
      continue;
    }
    const size_t weight = run->first_weight + size_t{from - run->first} * run->influences;
    SkinArgs args;
    args.places = places + size_t{from - first} * 4;
    args.weights = mesh.weights.data + weight;
    args.joints = mesh.joints.data + weight;
    args.matrices = pose.joints.skin.data;
    args.position_at = mesh.position_at.data + from;
    args.positions = out.positions.data;
    args.first_corner = mesh.first_corner.data + from;
    args.corners = mesh.corners.data;
    args.normals = mesh.normals.data;
    args.out_normals = out.normals.data;
    args.count = to - from;
    args.influences = run->influences;
    args.mode = job.normals != Normals::kSkinned ? SkinNormals::kNone
                : pose.joints.skewed             ? SkinNormals::kCofactors
                                                 : SkinNormals::kMatrix;
    job.kernels().skin_places(args);
  }
}

/// Block by block, all poses of a part: what one block needs of the mesh is fetched once.
void skin_task(void* context, uint32_t index) {
  const Job& job = *static_cast<const Job*>(context);
  const uint32_t first = index / job.pose_parts * kTaskBlocks;
  const uint32_t end = std::min(first + kTaskBlocks, job.mesh.block_count());
  const size_t part = index % job.pose_parts;
  const size_t from = job.poses.count * part / job.pose_parts;
  const size_t to = job.poses.count * (part + 1) / job.pose_parts;
  for (uint32_t block = first; block < end; ++block) {
    for (size_t p = from; p < to; ++p) skin_block(job, *job.poses[p], block);
  }
}

// Recomputed normals ------------------------------------------------------------------------------

void area_task(void* context, uint32_t index) {
  const Job& job = *static_cast<const Job*>(context);
  const uint32_t tasks = divide_up(job.mesh.face_count(), kTaskPlaces);
  DeformerInstance& pose = *job.poses[index / tasks];
  const uint32_t first = index % tasks * kTaskPlaces;
  AreaArgs args;
  args.positions = pose.meshes[job.mesh_number].positions.data;
  args.faces = job.mesh.faces.data + size_t{first} * 4;
  args.areas = pose.areas.data + size_t{first} * 4;
  args.count = std::min(kTaskPlaces, job.mesh.face_count() - first);
  job.kernels().face_areas(args);
}

void normal_task(void* context, uint32_t index) {
  const Job& job = *static_cast<const Job*>(context);
  const DeformMesh& mesh = job.mesh;
  const uint32_t tasks = divide_up(mesh.position_count, kTaskPlaces);
  DeformerInstance& pose = *job.poses[index / tasks];
  const uint32_t first = index % tasks * kTaskPlaces;
  NormalArgs args;
  args.areas = pose.areas.data;
  args.first_touching = mesh.first_touching.data + first;
  args.touching = mesh.touching.data;
  args.first_corner = mesh.first_corner.data + first;
  args.corners = mesh.corners.data;
  args.normals = mesh.normals.data;
  args.neutral_directions = mesh.neutral_directions.data + size_t{first} * 4;
  args.out_normals = pose.meshes[job.mesh_number].normals.data;
  args.count = std::min(kTaskPlaces, mesh.position_count - first);
  job.kernels().sum_normals(args);
}

void run_all(const ParallelFor& parallel, uint32_t count, void (*task)(void*, uint32_t), Job& job) {
  if (parallel.run && count > 1) return parallel.run(parallel.user, count, task, &job);
  for (uint32_t i = 0; i < count; ++i) task(&job, i);
}

}  // namespace

void deform(const Deformer& deformer, Span<DeformerInstance* const> poses, uint32_t mesh_number,
            Normals normals, const ParallelFor& given) {
  const DeformMesh& mesh = deformer.meshes[mesh_number];
  const bool large = size_t{mesh.position_count} * poses.count >= kLeastParallelPositions;
  const ParallelFor parallel = large ? given : ParallelFor{};
  Job job = {deformer, mesh, poses, mesh_number, normals};

  const uint32_t groups = divide_up(mesh.block_count(), kTaskBlocks);
  if (parallel.run && groups != 0) {
    const size_t parts = std::min<size_t>(poses.count, divide_up(kEnoughTasks, groups));
    job.pose_parts = static_cast<uint32_t>(parts);
  }
  run_all(parallel, groups * job.pose_parts, skin_task, job);
  if (normals != Normals::kRecomputed) return;
  const uint32_t pose_count = static_cast<uint32_t>(poses.count);
  run_all(parallel, divide_up(mesh.face_count(), kTaskPlaces) * pose_count, area_task, job);
  run_all(parallel, divide_up(mesh.position_count, kTaskPlaces) * pose_count, normal_task, job);
}

}  // namespace mien
