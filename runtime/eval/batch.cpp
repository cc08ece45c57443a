// SPDX-License-Identifier: MIT
#include "runtime/eval/batch.h"

#include <algorithm>
#include <cstring>

#include "runtime/eval/evaluate.h"

namespace mien {
namespace {

// Making, measuring -------------------------------------------------------------------------------

uint32_t block_count(const JointMatrix& joints) {
  return joints.chunks[joints.chunk_count()].first_block;
}

/// Crowds that `capacity` instances fall into at worst: any LOD may leave one that is not full.
size_t most_crowds(const Rig& rig, uint32_t capacity) {
  return std::min<size_t>(capacity, size_t{capacity} / kBatchLanes + rig.lod_count);
}

void place_batch(const Rig& rig, uint32_t capacity, uint32_t tasks, Placer& placer, Batch& batch) {
  const JointMatrix& joints = rig.joints;
  size_t piece_count = kBatchAhead;
  for (size_t k = 0; k < joints.columns.count; ++k) {
    piece_count += joints.pieces_before(k, joints.chunk_count());
  }
  placer.array<Batch>(1);
  batch.starts = placer.array<uint32_t>(size_t{block_count(joints)} + 1);
  batch.middles = placer.array<uint32_t>(block_count(joints));
  batch.pieces = placer.array<BatchPiece>(piece_count);
  batch.order = placer.array<Instance*>(capacity);
  batch.lods = placer.array<uint32_t>(capacity);
  batch.first_of_crowd = placer.array<uint32_t>(most_crowds(rig, capacity) + 1);
  batch.tasks = placer.array<CrowdScratch>(std::min<size_t>(tasks, most_crowds(rig, capacity)));
  const size_t tile_blocks = std::min(block_count(joints), kMostTileBlocks);
  for (size_t i = 0; i < batch.tasks.count; ++i) {
    CrowdScratch scratch;
    scratch.controls =
        placer.array<float>(size_t{rig.control_count} * kBatchLanes, kBlockAlignment);
    scratch.changed = placer.array<uint32_t>(rig.psds.outputs.count);
    scratch.users = placer.array<uint8_t>(joints.columns.count);
    scratch.sums = placer.array<float>(tile_blocks * kPieceRows * kBatchLanes, kBlockAlignment);
    scratch.ends = placer.array<uint32_t>(block_count(joints));
    scratch.pieces = placer.array<BatchPiece>(piece_count);
    if (!placer.measuring()) batch.tasks[i] = scratch;
  }
}

/// All pieces by block; of one block in order of their columns.
void list_pieces(const JointMatrix& joints, Batch& batch) {
  const uint32_t blocks = block_count(joints), chunks = joints.chunk_count();
  uint32_t* starts = batch.starts.data;
  for (size_t k = 0; k < joints.columns.count; ++k) {
    joints.for_each_piece(k, chunks, [&](uint32_t, uint32_t block) { ++starts[block + 1]; });
  }
  for (uint32_t b = 0; b < blocks; ++b) starts[b + 1] += starts[b];
  // Filling moves each start to that of the next block: back again afterwards.
  for (size_t k = 0; k < joints.columns.count; ++k) {
    const uint32_t control = joints.columns[k];
    if (control < batch.rig->raw_count) {
      ++batch.raw_columns;
    } else if (k == batch.raw_columns) {
      std::copy(starts, starts + blocks, batch.middles.data);
    }
    joints.for_each_piece(k, chunks, [&](uint32_t piece, uint32_t block) {
      batch.pieces[starts[block]++] = {piece, control};
    });
  }
  if (batch.raw_columns == joints.columns.count) {
    std::copy(starts, starts + blocks, batch.middles.data);
  }
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
  const float* from[kBatchLanes];
  for (uint32_t i = 0; i < crowd.count; ++i) from[i] = crowd.instances[i]->controls.data;
  float* lanes = crowd.scratch.controls.data;
  for (size_t c = 0; c < crowd.rig.control_count; ++c, lanes += kBatchLanes) {
    for (uint32_t i = 0; i < crowd.count; ++i) lanes[i] = from[i][c];
    for (uint32_t i = crowd.count; i < kBatchLanes; ++i) lanes[i] = 0.0f;
  }
}

/// As evaluate_psds() does for one.
void evaluate_psds(const Crowd& crowd) {
  const PsdTable& psds = crowd.rig.psds;
  const uint32_t count = crowd.rig.psd_count ? psds.count_at_lod[crowd.lod] : 0;
  uint32_t* changed = crowd.scratch.changed.data;
  crowd.rig.kernels->psd_batch({psds.outputs.data, psds.weights.data, psds.first_input.data,
                                psds.inputs.data, crowd.scratch.controls.data, changed, count});
  uint64_t marks[kBatchLanes] = {};
  const uint32_t all = ~uint32_t{0} >> (kBatchLanes - crowd.count);
  uint32_t any = 0;
  for (uint32_t e = 0; e < count; ++e) {
    const size_t output = psds.outputs[e];
    const float* lanes = crowd.scratch.controls.data + output * kBatchLanes;
    any |= changed[e];
    for (uint32_t i = 0, bits = changed[e] & all; bits != 0; ++i, bits >>= 1) {
      if ((bits & 1) == 0) continue;
      crowd.instances[i]->controls[output] = lanes[i];
      marks[i] |= crowd.rig.joints.control_chunks[output];
    }
  }
  for (uint32_t i = 0; i < crowd.count; ++i) {
    note_changed_psds(*crowd.instances[i], marks[i], any >> i & 1);
  }
}

/// Lanes that are not zero.
uint32_t count_users(const float* lanes) {
  uint32_t bits[kBatchLanes], users = 0;
  memcpy(bits, lanes, sizeof(bits));
  for (uint32_t i = 0; i < kBatchLanes; ++i) users += bits[i] << 1 != 0;
  return users;
}

/// The columns before `column_end` are summed for all at once: none, those of raw controls, or all.
/// Those that somebody uses have `pieces` of the `all` pieces there are.
struct Together {
  uint32_t column_end = 0;
  size_t pieces = 0, all = 0;
};

/// Together a piece costs a place in a list, and all lanes whoever uses it; apart it is fetched by
/// everybody who uses it. Columns stay in order, so the ways part once: where controls that many
/// move end, and correctives begin that few reach. Fifths of a cycle, as measured on a production
/// head.
Together find_together(const Crowd& crowd) {
  constexpr int64_t kListed = 12, kPass = 45, kFetched = 12;
  const JointMatrix& joints = crowd.rig.joints;
  const uint32_t chunks = joints.chunks_at_lod[crowd.lod];
  const uint32_t step = crowd.rig.kernels->batch_step;
  const int64_t passes = (crowd.count + step - 1) / step;
  Together together, best;
  int64_t saved = -kPass * passes * joints.chunks[chunks].first_block, most = 0;
  for (uint32_t k = 0; k < joints.columns.count;) {
    const float* lanes = crowd.scratch.controls.data + size_t{joints.columns[k]} * kBatchLanes;
    const int64_t users = count_users(lanes);
    crowd.scratch.users[k] = static_cast<uint8_t>(users);
    const uint32_t pieces = joints.pieces_before(k, chunks);
    together.column_end = ++k;
    together.all += pieces;
    if (users != 0) {
      together.pieces += pieces;
      saved += pieces * (users * kFetched - kListed - kPass * passes);
    }
    if (k != crowd.batch.raw_columns && k != joints.columns.count) continue;
    if (saved <= most) continue;
    most = saved;
    best = together;
  }
  return best;
}

/// Where the pieces of each block end that are summed together.
void list_together(const Crowd& crowd, const Together& together) {
  const JointMatrix& joints = crowd.rig.joints;
  const uint32_t chunks = joints.chunks_at_lod[crowd.lod];
  const Batch& batch = crowd.batch;
  uint32_t* ends = crowd.scratch.ends.data;
  std::copy(batch.starts.data, batch.starts.data + block_count(joints), ends);
  BatchPiece* pieces = crowd.scratch.pieces.data;
  for (uint32_t k = 0; k < together.column_end; ++k) {
    if (crowd.scratch.users[k] == 0) continue;
    const uint32_t control = joints.columns[k];
    joints.for_each_piece(k, chunks, [&](uint32_t piece, uint32_t block) {
      pieces[ends[block]++] = {piece, control};
    });
  }
}

void evaluate_rows(const Crowd& crowd, const Together& together) {
  const JointMatrix& joints = crowd.rig.joints;
  const uint32_t chunk_end = joints.chunks_at_lod[crowd.lod];
  // Pieces that nobody uses are summed as well, unless a list without them is shorter by much.
  const bool listed = together.pieces < together.all / 2;
  if (listed) list_together(crowd, together);
  const BatchPiece* pieces = listed ? crowd.scratch.pieces.data : crowd.batch.pieces.data;
  const uint32_t* ends = crowd.batch.starts.data + 1;
  if (together.column_end == crowd.batch.raw_columns) ends = crowd.batch.middles.data;
  if (listed) ends = crowd.scratch.ends.data;

  const bool fixed = joints.values.empty();
  const auto sum_block =
      fixed ? crowd.rig.kernels->joint_batch_fixed : crowd.rig.kernels->joint_batch;
  JointBatchArgs args;
  args.values = fixed ? static_cast<const void*>(joints.fixed_values.data) : joints.values.data;
  args.inputs = crowd.scratch.controls.data;
  args.lane_count = crowd.count;
  args.portable = crowd.rig.portable;
  for (uint32_t c = 0; c < chunk_end;) {
    const uint32_t tile_end = joints.tile_end(c);
    const uint32_t first = joints.chunks[c].first_block;
    JointTile tile = {first, c, std::min(tile_end, chunk_end), nullptr};
    c = tile.end_chunk;
    const uint32_t end = joints.chunks[c].first_block;
    args.sums = crowd.scratch.sums.data;
    args.stride = size_t{joints.chunks[tile_end].first_block - first} * kPieceRows;
    for (uint32_t b = first; b < end; ++b) {
      const uint32_t start = crowd.batch.starts[b];
      args.pieces = pieces + start;
      args.piece_count = ends[b] - start;
      sum_block(args);
      args.sums += kPieceRows;
    }
    for (uint32_t i = 0; i < crowd.count; ++i) {
      tile.sums = crowd.scratch.sums.data + i * args.stride;
      finish_tile(crowd.rig, *crowd.instances[i], crowd.lod, tile, together.column_end, kAllGroups);
    }
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
    const Together together = find_together(those);
    if (together.column_end != 0) {
      each(those, [&](Instance& i) { begin_joints(crowd.rig, i, crowd.lod); });
      evaluate_rows(those, together);
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

  list_pieces(rig.joints, *batch);
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
