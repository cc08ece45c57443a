// SPDX-License-Identifier: MIT
// Many instances of one rig at once: the joint matrix is fetched once for up to 32 of them.
//
//     instances  ->  by LOD, packets of up to 32  ->  each packet: stages before the correctives
//     one by one, correctives together, columns that many use together, those that few use and all
//     other stages one by one
#pragma once

#include "runtime/base/parallel_for.h"
#include "runtime/eval/instance.h"

namespace mien {

/// Scratch of one task.
struct PacketScratch {
  Span<float> controls;     // [control][32]
  Span<uint32_t> changed;   // [corrective] a bit for each of the 32
  Span<uint8_t> users;      // [column] how many of them use it
  Span<float> sums;         // [32][row of a tile]
  Span<uint32_t> ends;      // [block row] into blocks
  Span<BatchBlock> blocks;  // of active columns: in each block row they begin where those of all do
};

struct Batch {
  uint32_t tag = 0;  // first, for the C API to recognize its handles
  uint32_t capacity = 0;
  const Rig* rig = nullptr;
  Allocator allocator;
  size_t block_size = 0;

  // All blocks of the joint matrix by block row, in order of their columns; kBatchAhead more at the
  // end.
  Span<uint32_t> starts;   // [block row], one more at the end
  Span<uint32_t> middles;  // [block row] where the columns of raw controls end
  Span<BatchBlock> blocks;
  uint32_t raw_columns = 0;  // columns of raw controls

  Span<PacketScratch> tasks;
  Span<Instance*> order;           // by LOD
  Span<uint32_t> lods;             // beside
  Span<uint32_t> first_of_packet;  // into order, one more at the end

  // Of the evaluation that goes on.
  uint32_t packet_count = 0, task_count = 0, stages = 0;
};

size_t batch_size(const Rig& rig, uint32_t capacity, uint32_t tasks);

/// Becomes an owner of the rig. Null if memory ran out.
Batch* create_batch(const Rig& rig, uint32_t capacity, uint32_t tasks, const Allocator& allocator);
void destroy_batch(Batch* batch);

/// Stages of all instances: different ones, of the batch's rig, no more than its capacity.
void evaluate_batch(Batch& batch, Instance* const* instances, const uint32_t* lods, uint32_t count,
                    uint32_t stages, const ParallelFor& parallel);

}  // namespace mien
