// SPDX-License-Identifier: MIT
// Evaluates many instances of one rig at once.
//
//     instances -> sorted by LOD -> instance packets of up to 32 -> tasks, each with its own scratch
#pragma once

#include "runtime/base/parallel_for.h"
#include "runtime/eval/instance_packet.h"

namespace mien {

struct Batch : Object {
  static constexpr uint32_t kTag = 0x6D42'4154;

  uint32_t capacity = 0;
  const Rig* rig = nullptr;
  ~Batch() { release(rig); }

  BatchTables tables;
  Span<PacketScratch> tasks;

  // Of the current evaluation.
  Span<Instance*> order;           // by LOD
  Span<uint32_t> lods;             // LOD of each instance in `order`
  Span<uint32_t> first_of_packet;  // into order, one more at the end
  uint32_t packet_count = 0, task_count = 0, stages = 0;
};

size_t batch_size(const Rig& rig, uint32_t capacity, uint32_t tasks);

/// The batch becomes an owner of the rig. Null if memory ran out.
Batch* create_batch(const Rig& rig, uint32_t capacity, uint32_t tasks, const Allocator& allocator);

/// Evaluates stages of all instances; each gets the bits that evaluate() gives. They must be distinct
/// instances of the batch's rig, and at most its capacity.
void evaluate_batch(Batch& batch, Instance* const* instances, const uint32_t* lods, uint32_t count,
                    uint32_t stages, const ParallelFor& parallel);

}  // namespace mien
