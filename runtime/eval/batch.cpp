// SPDX-License-Identifier: MIT
#include "runtime/eval/batch.h"

#include <algorithm>

#include "runtime/eval/evaluate.h"

namespace mien {
namespace {

// Making, measuring -------------------------------------------------------------------------------

/// Lists of active pieces are made as long as those are fewer than this share; else all are taken.
constexpr size_t kListedShare = 2;

uint32_t block_count(const JointMatrix& joints) {
  return joints.chunks[joints.chunk_count()].first_block;
}

/// Crowds that `capacity` instances fall into at worst: any LOD may leave one that is not full.
size_t most_crowds(const Rig& rig, uint32_t capacity) {
  return std::min<size_t>(capacity, size_t{capacity} / kBatchLanes + rig.lod_count);
}

void place_batch(const Rig& rig, uint32_t capacity, uint32_t tasks, Placer& placer, Batch& batch) {
  const JointMatrix& joints = rig.joints;
  placer.array<Batch>(1);
  batch.starts = placer.array<uint32_t>(size_t{block_count(joints)} + 1);
  batch.pieces = placer.array<BatchPiece>(joints.blocks.count);
  batch.order = placer.array<Instance*>(capacity);
  batch.lods = placer.array<uint32_t>(capacity);
  batch.first_of_crowd = placer.array<uint32_t>(most_crowds(rig, capacity) + 1);
  batch.tasks = placer.array<CrowdScratch>(std::min<size_t>(tasks, most_crowds(rig, capacity)));
  uint32_t chunk_blocks = 0;
  for (uint32_t c = 0; c < joints.chunk_count(); ++c) {
    const uint32_t blocks = joints.chunks[c + 1].first_block - joints.chunks[c].first_block;
    chunk_blocks = std::max(chunk_blocks, blocks);
  }
  for (size_t i = 0; i < batch.tasks.count; ++i) {
    CrowdScratch scratch;
    scratch.controls =
        placer.array<float>(size_t{rig.control_count} * kBatchLanes, kBlockAlignment);
    scratch.sums =
        placer.array<float>(size_t{chunk_blocks} * kPieceRows * kBatchLanes, kBlockAlignment);
    scratch.starts = placer.array<uint32_t>(size_t{block_count(joints)} + 1);
    scratch.pieces = placer.array<BatchPiece>(joints.blocks.count / kListedShare);
    scratch.active = placer.array<uint16_t>(joints.columns.count);
    if (!placer.measuring()) batch.tasks[i] = scratch;
  }
}

/// Sorts the pieces of columns by block; of one block they stay in order of their columns.
template <class ForEachColumn>
void list_pieces(const JointMatrix& joints, ForEachColumn&& for_each_column, uint32_t blocks,
                 uint32_t* starts, BatchPiece* pieces) {
  std::fill(starts, starts + blocks + 1, 0u);
  for_each_column([&](uint32_t, uint32_t first, uint32_t end) {
    for (uint32_t p = first; p < end; ++p) ++starts[joints.blocks[p] / kBlockUnit + 1];
  });
  for (uint32_t b = 0; b < blocks; ++b) starts[b + 1] += starts[b];
  // Filling moves each start to that of the next block: back again afterwards.
  for_each_column([&](uint32_t column, uint32_t first, uint32_t end) {
    const uint32_t control = joints.columns[column];
    for (uint32_t p = first; p < end; ++p) {
      pieces[starts[joints.blocks[p] / kBlockUnit]++] = {p, control};
    }
  });
  for (uint32_t b = blocks; b > 0; --b) starts[b] = starts[b - 1];
  starts[0] = 0;
}

// A crowd -----------------------------------------------------------------------------------------

/// Up to 32 instances at one LOD.
struct Crowd {
  const Batch& batch;
  const Rig& rig;
  const CrowdScratch& scratch;
  Instance* const* instances;
  uint32_t count;
  uint32_t lod;
};

/// Controls side by side, 0 in the lanes of nobody.
void gather_controls(const Crowd& crowd) {
  float* controls = crowd.scratch.controls.data;
  std::fill(controls, controls + crowd.scratch.controls.count, 0.0f);
  for (uint32_t i = 0; i < crowd.count; ++i) {
    const float* from = crowd.instances[i]->controls.data;
    for (size_t c = 0; c < crowd.rig.control_count; ++c) controls[c * kBatchLanes + i] = from[c];
  }
}

/// As evaluate_psds() does for one.
void evaluate_psds(const Crowd& crowd) {
  const PsdTable& psds = crowd.rig.psds;
  const uint32_t count = crowd.rig.psd_count ? psds.count_at_lod[crowd.lod] : 0;
  float* controls = crowd.scratch.controls.data;
  crowd.rig.kernels->psd_batch({psds.outputs.data, psds.weights.data, psds.first_input.data,
                                psds.inputs.data, controls, count});
  for (uint32_t i = 0; i < crowd.count; ++i) {
    Instance& instance = *crowd.instances[i];
    uint64_t chunks = 0;
    bool changed = false;
    for (uint32_t e = 0; e < count; ++e) {
      const size_t output = psds.outputs[e];
      const float value = controls[output * kBatchLanes + i];
      if (same_bits(value, instance.controls[output])) continue;
      instance.controls[output] = value;
      chunks |= crowd.rig.joints.control_chunks[output];
      changed = true;
    }
    note_changed_psds(instance, chunks, changed);
  }
}

/// Pieces of the columns that any of the crowd uses, and how many the instances would read one by
/// one.
struct Work {
  uint32_t column_count = 0;
  uint64_t together = 0, apart = 0;
};

Work find_active(const Crowd& crowd) {
  const JointMatrix& joints = crowd.rig.joints;
  const uint32_t chunks = joints.chunks_at_lod[crowd.lod];
  Work work;
  for (uint32_t k = 0; k < joints.columns.count; ++k) {
    const float* lanes = crowd.scratch.controls.data + size_t{joints.columns[k]} * kBatchLanes;
    int users = 0;
    for (uint32_t i = 0; i < kBatchLanes; ++i) users += lanes[i] != 0.0f;
    if (users == 0) continue;
    const uint32_t pieces = joints.chunk_pieces[size_t{k} * joints.chunks.count + chunks];
    work.together += pieces;
    work.apart += uint64_t{pieces} * static_cast<uint32_t>(users);
    crowd.scratch.active[work.column_count++] = static_cast<uint16_t>(k);
  }
  return work;
}

/// Together each piece costs a place in a list, and all lanes whoever uses it; apart it is fetched
/// by everybody who uses it. Fifths of a cycle, as measured on a production head.
bool together_pays(const Crowd& crowd, const Work& work) {
  const uint32_t step = crowd.rig.kernels->batch_step;
  const uint64_t passes = (crowd.count + step - 1) / step;
  return work.together * (15 + 45 * passes) < work.apart * 18;
}

void write_chunk(const Crowd& crowd, uint32_t chunk) {
  for (uint32_t i = 0; i < crowd.count; ++i) {
    const float* sums = crowd.scratch.sums.data + i;
    float* out = crowd.instances[i]->joints_and_angles.data;
    for_each_target(crowd.rig, crowd.lod, chunk, [&](const JointTarget& target, int rows) {
      const float* sum = sums + size_t{target.slot} * kBatchLanes;
      out[target.output] = sum[0];
      if (rows == 1) return;
      out[target.output + 1] = sum[kBatchLanes];
      out[target.output + 2] = sum[2 * kBatchLanes];
    });
  }
}

void evaluate_rows(const Crowd& crowd, const Work& work) {
  const JointMatrix& joints = crowd.rig.joints;
  const uint32_t chunks = joints.chunks_at_lod[crowd.lod];
  const uint32_t* starts = crowd.batch.starts.data;
  const BatchPiece* pieces = crowd.batch.pieces.data;
  if (work.together < joints.blocks.count / kListedShare) {
    const auto for_each_active = [&](auto&& f) {
      for (uint32_t a = 0; a < work.column_count; ++a) {
        const uint32_t k = crowd.scratch.active[a], first = joints.first_piece[k];
        f(k, first, first + joints.chunk_pieces[size_t{k} * joints.chunks.count + chunks]);
      }
    };
    list_pieces(joints, for_each_active, joints.chunks[chunks].first_block,
                crowd.scratch.starts.data, crowd.scratch.pieces.data);
    starts = crowd.scratch.starts.data;
    pieces = crowd.scratch.pieces.data;
  }

  const bool fixed = joints.values.empty();
  const auto sum_block =
      fixed ? crowd.rig.kernels->joint_batch_fixed : crowd.rig.kernels->joint_batch;
  JointBatchArgs args;
  args.values = fixed ? static_cast<const void*>(joints.fixed_values.data) : joints.values.data;
  args.inputs = crowd.scratch.controls.data;
  args.lane_count = crowd.count;
  args.portable = crowd.rig.portable;
  for (uint32_t c = 0; c < chunks; ++c) {
    args.sums = crowd.scratch.sums.data;
    for (uint32_t b = joints.chunks[c].first_block; b < joints.chunks[c + 1].first_block; ++b) {
      args.pieces = pieces + starts[b];
      args.piece_count = starts[b + 1] - starts[b];
      args.scales = fixed ? joints.scales.data + size_t{b} * kPieceRows : nullptr;
      sum_block(args);
      args.sums += kPieceRows * kBatchLanes;
    }
    write_chunk(crowd, c);
  }
}

void evaluate_crowd(const Crowd& crowd, uint32_t stages) {
  const auto each = [](const Crowd& those, auto&& f) {
    for (uint32_t i = 0; i < those.count; ++i) f(*those.instances[i]);
  };
  each(crowd, [&](Instance& instance) {
    begin_evaluation(crowd.rig, instance, crowd.lod);
    evaluate_stages(crowd.rig, instance, crowd.lod, stages & (kStageMl | kStageRbf));
  });

  // Those that do not change have nothing to do with the others. Whoever is to have new correctives
  // may turn out to need new joints.
  Instance* changed[kBatchLanes];
  Crowd those = {crowd.batch, crowd.rig, crowd.scratch, changed, 0, crowd.lod};
  each(crowd, [&](Instance& instance) {
    const bool stale = (instance.stale_stages & (kStagePsd | kStageJoints)) != 0;
    if (stale && (stages & kStageJoints)) changed[those.count++] = &instance;
  });
  if (those.count > 1) {
    gather_controls(those);
    if (stages & kStagePsd) evaluate_psds(those);
    const Work work = find_active(those);
    if (together_pays(those, work)) {
      each(those, [&](Instance& i) { begin_joints(crowd.rig, i, crowd.lod); });
      evaluate_rows(those, work);
      each(those, [&](Instance& i) { finish_joints(crowd.rig, i, crowd.lod); });
    }
  }
  each(crowd, [&](Instance& i) { evaluate_stages(crowd.rig, i, crowd.lod, stages); });
}

}  // namespace

// Batches -----------------------------------------------------------------------------------------

size_t batch_size(const Rig& rig, uint32_t capacity, uint32_t tasks) {
  Batch batch;
  Placer placer(nullptr);
  place_batch(rig, capacity, tasks, placer, batch);
  return placer.size();
}

Batch* create_batch(const Rig& rig, uint32_t capacity, uint32_t tasks, const Allocator& allocator) {
  const size_t size = batch_size(rig, capacity, tasks);
  void* block = allocator.get(size, kBlockAlignment);
  if (!block) return nullptr;
  Batch placed;
  Placer placer(block);
  place_batch(rig, capacity, tasks, placer, placed);
  Batch* batch = new (block) Batch(placed);
  batch->capacity = capacity;
  batch->rig = &rig;
  batch->allocator = allocator;
  batch->block_size = size;
  rig.owners.fetch_add(1, std::memory_order_relaxed);

  const JointMatrix& joints = rig.joints;
  const auto for_each_column = [&](auto&& f) {
    for (uint32_t k = 0; k < joints.columns.count; ++k) {
      f(k, joints.first_piece[k], joints.first_piece[k + 1]);
    }
  };
  list_pieces(joints, for_each_column, block_count(joints), batch->starts.data, batch->pieces.data);
  return batch;
}

void destroy_batch(Batch* batch) {
  const Rig* rig = batch->rig;
  const Allocator allocator = batch->allocator;
  const size_t size = batch->block_size;
  batch->tag = 0;
  allocator.put(batch, size, kBlockAlignment);
  release_rig(rig);
}

void evaluate_batch(Batch& batch, Instance* const* instances, const uint32_t* lods, uint32_t count,
                    uint32_t stages, const ParallelFor& parallel) {
  // By LOD, in the order given, in crowds.
  uint32_t begin[kMaxLods + 1] = {};
  for (uint32_t i = 0; i < count; ++i) ++begin[lods[i] + 1];
  batch.crowd_count = 0;
  for (uint32_t l = 0; l < batch.rig->lod_count; ++l) {
    const uint32_t of_lod = begin[l + 1];
    for (uint32_t i = 0; i < of_lod; i += kBatchLanes) {
      batch.first_of_crowd[batch.crowd_count++] = begin[l] + i;
    }
    begin[l + 1] += begin[l];
  }
  batch.first_of_crowd[batch.crowd_count] = count;
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t at = begin[lods[i]]++;
    batch.order[at] = instances[i];
    batch.lods[at] = lods[i];
  }
  batch.stages = stages;
  batch.task_count = std::min(batch.crowd_count, static_cast<uint32_t>(batch.tasks.count));

  // Each task takes every so manieth crowd: nobody has to ask who is free.
  const auto task = [](void* context, uint32_t index) {
    const Batch& b = *static_cast<const Batch*>(context);
    for (uint32_t c = index; c < b.crowd_count; c += b.task_count) {
      const uint32_t first = b.first_of_crowd[c], end = b.first_of_crowd[c + 1];
      evaluate_crowd({b, *b.rig, b.tasks[index], b.order.data + first, end - first, b.lods[first]},
                     b.stages);
    }
  };
  run_tasks(parallel, batch.task_count, task, &batch);
}

}  // namespace mien
