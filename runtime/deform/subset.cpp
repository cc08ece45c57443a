// SPDX-License-Identifier: MIT
// A deformer of some positions of a mesh. Each position keeps its influences and the order of its targets, so results
// have the same bits. Numbers of 16-bit storage become floats.
#include <algorithm>
#include <new>

#include "runtime/deform/deformer.h"

namespace mien {
namespace {

constexpr uint32_t kNotChosen = ~uint32_t{0};

/// A delta of the whole mesh, and where it goes.
struct ChosenDelta {
  uint32_t block, target, channel;
  uint32_t run, place;  // run of targets, place in it
  uint16_t index;       // in the block
  float delta[3];
};

struct SubsetPlan {
  Span<uint32_t> order;      // [sorted index] of the whole mesh
  Span<uint32_t> places;     // [sorted index of the whole mesh] sorted index, or kNotChosen
  Span<uint32_t> numbers;    // [sorted index] place in the list of positions
  Span<ChosenDelta> deltas;  // by block, then by target
  size_t weight_count = 0, skin_run_count = 0, target_run_count = 0;
};

template <class F>
void for_each_chosen(const DeformMesh& mesh, const SubsetPlan& plan, F&& f) {
  for (uint32_t block = 0; block < mesh.block_count(); ++block) {
    for (uint32_t r = mesh.first_target_run[block]; r < mesh.first_target_run[block + 1]; ++r) {
      const TargetRun& run = mesh.target_runs[r];
      uint32_t place = 0;
      for_each_delta(mesh, run, [&](uint32_t index, const float* delta) {
        const uint32_t at = plan.places[size_t{block} * kBlockPositions + index];
        ++place;
        if (at == kNotChosen) return;
        f(ChosenDelta{at / kBlockPositions,
                      run.target,
                      run.channel,
                      r,
                      place,
                      static_cast<uint16_t>(at % kBlockPositions),
                      {delta[0], delta[1], delta[2]}});
      });
    }
  }
}

/// Where a run of targets begins.
bool begins_run(const Span<ChosenDelta>& deltas, size_t i) {
  return i == 0 || deltas[i].block != deltas[i - 1].block ||
         deltas[i].target != deltas[i - 1].target;
}

/// False if memory ran out.
bool plan_subset(const DeformMesh& mesh, Span<const uint32_t> positions, Arena& scratch,
                 SubsetPlan& plan) {
  const size_t count = positions.count;
  const Span<uint64_t> keys = scratch.array<uint64_t>(count + 1);
  plan.order = scratch.array<uint32_t>(count + 1);
  plan.numbers = scratch.array<uint32_t>(count + 1);
  plan.places = scratch.array<uint32_t>(size_t{mesh.position_count} + 1);
  const Span<uint32_t> number_of = scratch.array<uint32_t>(size_t{mesh.position_count} + 1);
  if (!keys.data || !plan.order.data || !plan.numbers.data || !plan.places.data ||
      !number_of.data) {
    return false;
  }
  std::fill(number_of.begin(), number_of.end(), kNotChosen);
  for (size_t i = 0; i < count; ++i) number_of[positions[i]] = static_cast<uint32_t>(i);
  size_t chosen = 0;
  for (uint32_t old = 0; old < mesh.position_count; ++old) {
    const uint32_t number = number_of[mesh.position_of(old)];
    if (number != kNotChosen) keys[chosen++] = uint64_t{window_of(number)} << 32 | old;
  }
  std::sort(keys.data, keys.data + count);
  std::fill(plan.places.begin(), plan.places.end(), kNotChosen);
  uint32_t influences = kNotChosen;
  for (size_t i = 0; i < count; ++i) {
    plan.order[i] = static_cast<uint32_t>(keys[i]);
    plan.numbers[i] = number_of[mesh.position_of(plan.order[i])];
    plan.places[plan.order[i]] = static_cast<uint32_t>(i);
    const SkinRun& run = *skin_run_of(mesh, plan.order[i]);
    plan.weight_count += run.influences;
    plan.skin_run_count += run.influences != influences;
    influences = run.influences;
  }
  size_t deltas = 0;
  if (mesh.target_count != 0) for_each_chosen(mesh, plan, [&](const ChosenDelta&) { ++deltas; });
  plan.deltas = scratch.array<ChosenDelta>(deltas + 1);
  if (!plan.deltas.data) return false;
  plan.deltas = plan.deltas.first(deltas);
  deltas = 0;
  if (mesh.target_count != 0) {
    for_each_chosen(mesh, plan, [&](const ChosenDelta& d) { plan.deltas[deltas++] = d; });
  }
  std::sort(plan.deltas.begin(), plan.deltas.end(), [](const ChosenDelta& a, const ChosenDelta& b) {
    return a.block != b.block     ? a.block < b.block
           : a.target != b.target ? a.target < b.target
           : a.run != b.run       ? a.run < b.run
                                  : a.place < b.place;
  });
  for (size_t i = 0; i < deltas; ++i) plan.target_run_count += begins_run(plan.deltas, i);
  return true;
}

void place_subset(const DeformMesh& from, const SubsetPlan& plan, size_t count, Placer& placer,
                  DeformMesh& mesh) {
  mesh.position_count = static_cast<uint32_t>(count);
  mesh.max_influences = from.max_influences;
  mesh.target_count = from.target_count;
  mesh.delta_count = plan.deltas.count;
  mesh.positions = placer.array<float>(count * 3 + 1, kBlockAlignment);
  mesh.target_channels = placer.array<uint16_t>(from.target_count);
  mesh.sorted_positions = placer.array<float>(count * 4, kBlockAlignment);
  mesh.weights = placer.array<float>(plan.weight_count, kBlockAlignment);
  mesh.joints = placer.array<uint16_t>(plan.weight_count, kBlockAlignment);
  mesh.position_indices = placer.array<uint16_t>(count, kBlockAlignment);
  mesh.skin_runs = placer.array<SkinRun>(plan.skin_run_count);
  mesh.first_target_run = placer.array<uint32_t>(size_t{mesh.block_count()} + 1);
  mesh.target_runs = placer.array<TargetRun>(plan.target_run_count);
  mesh.deltas = placer.array<float>(plan.deltas.count * 3 + 1, kBlockAlignment);
  mesh.delta_indices = placer.array<uint16_t>(plan.deltas.count, kBlockAlignment);
  mesh.first_adjacent_face = placer.array<uint32_t>(count + 1);
  mesh.first_vertex = placer.array<uint32_t>(count + 1);
}

void fill_subset_skin(const DeformMesh& from, const SubsetPlan& plan, DeformMesh& mesh) {
  size_t run = 0, weight = 0;
  for (uint32_t i = 0; i < mesh.position_count; ++i) {
    const uint32_t old = plan.order[i], number = plan.numbers[i];
    mesh.position_indices[i] = static_cast<uint16_t>(number - window_of(i));
    const float* position = from.positions.data + size_t{from.position_of(old)} * 3;
    std::copy(position, position + 3, mesh.positions.data + size_t{number} * 3);
    std::copy(position, position + 3, mesh.sorted_positions.data + size_t{i} * 4);
    const SkinRun& source = *skin_run_of(from, old);
    if (run == 0 || mesh.skin_runs[run - 1].influences != source.influences) {
      mesh.skin_runs[run++] = {weight, i, 0, source.influences, 0};
    }
    ++mesh.skin_runs[run - 1].count;
    const size_t first = source.first_weight + size_t{old - source.first} * source.influences;
    for (uint32_t k = 0; k < source.influences; ++k, ++weight) {
      mesh.weights[weight] = from.fixed_weights.empty()
                                 ? from.weights[first + k]
                                 : float(from.fixed_weights[first + k]) * from.weight_scale;
      mesh.joints[weight] = from.joints[first + k];
    }
  }
}

void fill_subset_targets(const DeformMesh& from, const SubsetPlan& plan, DeformMesh& mesh) {
  std::copy(from.target_channels.begin(), from.target_channels.end(), mesh.target_channels.begin());
  uint32_t runs = 0, block = 0;
  for (uint32_t d = 0; d < plan.deltas.count; ++d) {
    const ChosenDelta& source = plan.deltas[d];
    for (; block < source.block; ++block) mesh.first_target_run[block + 1] = runs;
    if (begins_run(plan.deltas, d)) {
      mesh.target_runs[runs++] = {source.target, source.channel, d, 0};
    }
    ++mesh.target_runs[runs - 1].count;
    mesh.delta_indices[d] = source.index;
    std::copy(source.delta, source.delta + 3, mesh.deltas.data + size_t{d} * 3);
  }
  for (; block < mesh.block_count(); ++block) mesh.first_target_run[block + 1] = runs;
}

}  // namespace

Deformer* create_subset(const Deformer& whole, uint32_t mesh_index, Span<const uint32_t> positions,
                        const Allocator& allocator) {
  const DeformMesh& from = whole.meshes[mesh_index];
  Arena scratch(allocator);
  SubsetPlan plan;
  if (!plan_subset(from, positions, scratch, plan)) return nullptr;
  auto* const made = create_object<Deformer>(allocator, [&](Placer& placer, Deformer& placed) {
    placed.meshes = placer.unwritten_array<DeformMesh>(whole.meshes.count);
    DeformMesh chosen;
    if (positions.count != 0) place_subset(from, plan, positions.count, placer, chosen);
    if (placer.measuring()) return;
    for (DeformMesh& mesh : placed.meshes) new (&mesh) DeformMesh;
    placed.meshes[mesh_index] = chosen;
  });
  if (!made) return nullptr;
  made->kernels = whole.kernels;
  made->rig = share(*whole.rig);
  made->whole = share(whole);
  made->normals = whole.normals;
  made->fix_weights = whole.fix_weights;
  made->skeleton = whole.skeleton;
  for (size_t m = 0; m < whole.meshes.count; ++m) made->meshes[m].lods = whole.meshes[m].lods;
  if (positions.count == 0) return made;
  fill_subset_skin(from, plan, made->meshes[mesh_index]);
  fill_subset_targets(from, plan, made->meshes[mesh_index]);
  return made;
}

}  // namespace mien
