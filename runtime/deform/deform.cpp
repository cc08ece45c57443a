// SPDX-License-Identifier: MIT
#include "runtime/deform/deform.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "simd/deform_kernels.h"
#include "simd/kernels.h"

namespace mien {
namespace {

constexpr uint32_t kMinParallelPositions = 16384;
constexpr uint32_t kTaskPositions = 1024;  // or faces, or vertices
constexpr uint32_t kTaskBlocks = kTaskPositions / kBlockPositions;
constexpr uint32_t kMinTasks = 64;  // of skinning, if there are enough instances

uint32_t divide_up(size_t a, size_t b) { return static_cast<uint32_t>((a + b - 1) / b); }

/// One mesh of some instances.
struct Job {
  const Deformer& deformer;
  const DeformMesh& mesh;
  Span<DeformerInstance* const> instances;
  uint32_t mesh_index;
  Normals normals;
  bool tangents;
  ParallelFor parallel;
  uint32_t instance_groups = 1;  // that skinning splits the instances into

  const KernelTable& kernels() const { return *deformer.kernels; }
};

void run_all(Job& job, uint32_t count, void (*task)(void*, uint32_t)) {
  if (job.parallel.run && count > 1) return run_tasks(job.parallel, count, task, &job);
  for (uint32_t i = 0; i < count; ++i) task(&job, i);
}

// Targets and skin --------------------------------------------------------------------------------

/// The neutral positions of a block plus its active targets, in `scratch`. Without active targets those of the mesh, or
/// null if it does not store them in order.
const float* add_targets(const Job& job, const DeformerInstance& instance, uint32_t block,
                         float* scratch) {
  const DeformMesh& mesh = job.mesh;
  const uint32_t first = block * kBlockPositions;
  const float* positions = nullptr;
  if (!mesh.sorted_positions.empty()) positions = mesh.sorted_positions.data + size_t{first} * 4;
  for (uint32_t i = mesh.first_target_run[block]; i < mesh.first_target_run[block + 1]; ++i) {
    const TargetRun& run = mesh.target_runs[i];
    const float weight = instance.channels[run.channel];
    if (std::fabs(weight) < kMinChannelWeight) continue;
    if (positions != scratch) {
      const size_t count = std::min(kBlockPositions, mesh.position_count - first);
      const float* neutral = neutral_positions(mesh, block, scratch);
      if (neutral != scratch) std::copy(neutral, neutral + count * 4, scratch);
      positions = scratch;
    }
    add_target_run(job.kernels(), mesh, run, weight, scratch);
  }
  return positions;
}

/// Positions without influences. `positions` are those of the block, as add_targets() returns them.
void copy_unskinned(const Job& job, const float* positions, uint32_t first, uint32_t count,
                    DeformerInstance& instance) {
  const DeformMesh& mesh = job.mesh;
  DeformedMesh& out = instance.meshes[job.mesh_index];
  for (uint32_t i = 0; i < count; ++i) {
    const size_t at = size_t{mesh.position_of(first + i)} * 3;
    const float* from = positions ? positions + size_t{(first + i) % kBlockPositions} * 4
                                  : mesh.positions.data + at;
    memcpy(out.positions.data + at, from, 3 * sizeof(float));
  }
  for (uint32_t i = mesh.first_vertex[first]; i < mesh.first_vertex[first + count]; ++i) {
    const size_t vertex = mesh.vertices[i] & ~kHardEdge;
    if (job.normals == Normals::kSkinned) {
      memcpy(out.normals.data + vertex * 3, mesh.normals.data + vertex * 3, 3 * sizeof(float));
    }
    if (job.tangents) {
      memcpy(instance.tangents.data + vertex * 4, mesh.tangents.data + vertex * 4,
             4 * sizeof(float));
    }
  }
}

void skin_block(const Job& job, DeformerInstance& instance, uint32_t block) {
  alignas(kBlockAlignment) float scratch[kBlockPositions * 4];
  const DeformMesh& mesh = job.mesh;
  DeformedMesh& out = instance.meshes[job.mesh_index];
  const uint32_t first = block * kBlockPositions;
  const uint32_t end = std::min(first + kBlockPositions, mesh.position_count);
  const float* positions = add_targets(job, instance, block, scratch);

  for (const SkinRun* run = skin_run_of(mesh, first);
       run != mesh.skin_runs.end() && run->first < end; ++run) {
    const uint32_t from = std::max(run->first, first);
    const uint32_t to = std::min(run->first + run->count, end);
    if (run->influences == 0) {
      copy_unskinned(job, positions, from, to - from, instance);
      continue;
    }
    SkinArgs args;
    args.matrices = instance.joints.skin.data;
    args.neutral = mesh.positions.data + size_t{window_of(first)} * 3;
    args.out_positions = out.positions.data + size_t{window_of(first)} * 3;
    args.vertices = mesh.vertices.data;
    args.normals = mesh.normals.data;
    args.sorted_normals = mesh.sorted_normals.empty() ? nullptr : mesh.sorted_normals.data;
    args.out_normals = out.normals.data;
    args.tangents = mesh.tangents.data;
    args.out_tangents = job.tangents ? instance.tangents.data : nullptr;
    args.influences = run->influences;
    args.mode = job.normals != Normals::kSkinned    ? SkinNormals::kNone
                : instance.joints.non_uniform_scale ? SkinNormals::kCofactors
                                                    : SkinNormals::kMatrix;
    for_each_weights(job.kernels(), mesh, *run, from, to - from,
                     [&](uint32_t at, uint32_t count, const float* weights) {
                       const size_t row =
                           run->first_weight + size_t{at - run->first} * run->influences;
                       args.positions = positions ? positions + size_t{at - first} * 4 : nullptr;
                       args.weights = weights;
                       args.joints = mesh.joints.data + row;
                       args.position_indices = mesh.position_indices.data + at;
                       args.first_vertex = mesh.first_vertex.data + at;
                       args.count = count;
                       job.kernels().skin_positions(args);
                     });
  }
}

/// Some blocks of a group of instances. Block by block, so that the mesh data of a block is loaded
/// once for all of them.
void skin_task(void* context, uint32_t index) {
  const Job& job = *static_cast<const Job*>(context);
  const uint32_t first = index / job.instance_groups * kTaskBlocks;
  const uint32_t end = std::min(first + kTaskBlocks, job.mesh.block_count());
  const size_t group = index % job.instance_groups;
  const size_t from = job.instances.count * group / job.instance_groups;
  const size_t to = job.instances.count * (group + 1) / job.instance_groups;
  for (uint32_t block = first; block < end; ++block) {
    for (size_t i = from; i < to; ++i) skin_block(job, *job.instances[i], block);
  }
}

// Recomputed normals ------------------------------------------------------------------------------

void area_task(void* context, uint32_t index) {
  const Job& job = *static_cast<const Job*>(context);
  const uint32_t tasks = divide_up(job.mesh.face_count(), kTaskPositions);
  DeformerInstance& instance = *job.instances[index / tasks];
  const uint32_t first = index % tasks * kTaskPositions;
  AreaArgs args;
  args.positions = instance.meshes[job.mesh_index].positions.data;
  args.faces = job.mesh.faces.from(size_t{first} * 4);
  args.narrow = !job.mesh.faces.wide;
  args.areas = instance.face_areas.data + size_t{first} * 4;
  args.count = std::min(kTaskPositions, job.mesh.face_count() - first);
  job.kernels().face_areas(args);
}

void normal_task(void* context, uint32_t index) {
  const Job& job = *static_cast<const Job*>(context);
  const DeformMesh& mesh = job.mesh;
  const uint32_t tasks = divide_up(mesh.position_count, kTaskPositions);
  DeformerInstance& instance = *job.instances[index / tasks];
  const uint32_t first = index % tasks * kTaskPositions;
  NormalArgs args;
  args.areas = instance.face_areas.data;
  args.first_adjacent_face = mesh.first_adjacent_face.data + first;
  args.adjacent_faces = mesh.adjacent_faces.from(0);
  args.narrow = !mesh.adjacent_faces.wide;
  args.first_vertex = mesh.first_vertex.data + first;
  args.vertices = mesh.vertices.data;
  args.normals = mesh.normals.data;
  const uint32_t* hard =
      std::lower_bound(mesh.hard_positions.begin(), mesh.hard_positions.end(), first);
  args.first_position = first;
  args.hard_positions = hard;
  args.hard_count = static_cast<uint32_t>(mesh.hard_positions.end() - hard);
  args.neutral_directions =
      mesh.neutral_directions.data + static_cast<size_t>(hard - mesh.hard_positions.begin()) * 4;
  args.out_normals = instance.meshes[job.mesh_index].normals.data;
  args.count = std::min(kTaskPositions, mesh.position_count - first);
  job.kernels().sum_normals(args);
}

// Vertex output -----------------------------------------------------------------------------------

VertexStream from_vertex(const VertexStream& stream, uint32_t first) {
  if (!stream.data) return stream;
  return {stream.data + size_t{first} * stream.stride, stream.stride, stream.format};
}

void vertex_task(void* context, uint32_t index) {
  const Job& job = *static_cast<const Job*>(context);
  const DeformMesh& mesh = job.mesh;
  const uint32_t tasks = divide_up(mesh.vertex_count, kTaskPositions);
  DeformerInstance& instance = *job.instances[index / tasks];
  const DeformedMesh& deformed = instance.meshes[job.mesh_index];
  const uint32_t first = index % tasks * kTaskPositions;
  VertexArgs args;
  args.positions = deformed.positions.data;
  args.position_indices = mesh.vertex_position_indices.data + first;
  args.normals = deformed.normals.data + size_t{first} * 3;
  args.tangents = job.tangents ? instance.tangents.data + size_t{first} * 4 : nullptr;
  args.position_stream = from_vertex(instance.output.positions, first);
  args.normal_stream = from_vertex(instance.output.normals, first);
  args.tangent_stream = from_vertex(instance.output.tangents, first);
  args.count = std::min(kTaskPositions, mesh.vertex_count - first);
  job.kernels().write_vertices(args);
}

void run(Job& job) {
  const DeformMesh& mesh = job.mesh;
  const uint32_t block_tasks = divide_up(mesh.block_count(), kTaskBlocks);
  if (job.parallel.run && block_tasks != 0) {
    const size_t groups = std::min<size_t>(job.instances.count, divide_up(kMinTasks, block_tasks));
    job.instance_groups = static_cast<uint32_t>(groups);
  }
  run_all(job, block_tasks * job.instance_groups, skin_task);
  if (job.normals != Normals::kRecomputed) return;
  const uint32_t count = static_cast<uint32_t>(job.instances.count);
  run_all(job, divide_up(mesh.face_count(), kTaskPositions) * count, area_task);
  run_all(job, divide_up(mesh.position_count, kTaskPositions) * count, normal_task);
}

Job job_for(const Deformer& deformer, Span<DeformerInstance* const> instances, uint32_t mesh_index,
            Normals normals, bool tangents, const ParallelFor& parallel) {
  const DeformMesh& mesh = deformer.meshes[mesh_index];
  const bool large = size_t{mesh.position_count} * instances.count >= kMinParallelPositions;
  return {
      deformer, mesh, instances, mesh_index, normals, tangents, large ? parallel : ParallelFor{}};
}

}  // namespace

void deform(const Deformer& deformer, Span<DeformerInstance* const> instances, uint32_t mesh,
            Normals normals, const ParallelFor& parallel) {
  if (instances.count == 0 || instances[0]->meshes[mesh].empty) return;
  Job job = job_for(deformer, instances, mesh, normals, false, parallel);
  run(job);
}

bool outputs_overlap(Span<DeformerInstance* const> instances, uint32_t vertex_count) {
  uintptr_t end = 0;
  for (size_t i = 0; i < instances.count; ++i) {
    // Outputs at ascending addresses cannot overlap; only others are compared in pairs.
    const VertexOutput& output = instances[i]->output;
    const VertexOutputRange range = range_of(output, vertex_count);
    for (size_t k = 0; k < i && range.begin < end; ++k) {
      if (overlap(output, instances[k]->output, vertex_count)) return true;
    }
    end = std::max(end, range.end);
  }
  return false;
}

void write_vertices(const Deformer& deformer, Span<DeformerInstance* const> instances,
                    uint32_t mesh, Normals normals, const ParallelFor& parallel) {
  bool tangents = false;
  for (const DeformerInstance* instance : instances) {
    tangents = tangents || instance->output.tangents.data;
  }
  Job job = job_for(deformer, instances, mesh, normals, tangents, parallel);
  run(job);
  const uint32_t count = static_cast<uint32_t>(instances.count);
  run_all(job, divide_up(job.mesh.vertex_count, kTaskPositions) * count, vertex_task);
}

}  // namespace mien
