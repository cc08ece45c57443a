// SPDX-License-Identifier: MIT
// Batches of instances, in the section "Evaluation" of mien/rig.h.
#include "capi/handles.h"
#include "runtime/eval/batch.h"
#include "runtime/eval/evaluate.h"

using namespace mien;
using namespace mien::capi;

namespace {

constexpr uint32_t kDefaultCapacity = 32;
constexpr uint32_t kMaxCapacity = 1u << 20;

MienStatus read_batch_desc(const MienBatchDesc* desc, MienBatchDesc& out, MienError* error) {
  if (MienStatus status = read_desc(desc, out, "MienBatchDesc", error)) return status;
  if (out.capacity == 0) out.capacity = kDefaultCapacity;
  if (out.tasks == 0) out.tasks = 1;
  if (out.capacity > kMaxCapacity) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienBatchDesc.capacity is %u, a batch takes %u instances at most",
                      out.capacity, kMaxCapacity);
  }
  return MIEN_OK;
}

}  // namespace

MienStatus mien_batch_create(const MienRig* rig, const MienBatchDesc* desc, MienBatch** out_batch,
                             MienError* error) {
  if (MienStatus status = clear_output(out_batch, error)) return status;
  if (MienStatus status = check(rig, "rig", error)) return status;
  MienBatchDesc known;
  if (MienStatus status = read_batch_desc(desc, known, error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  Batch* batch = create_batch(*object(rig), known.capacity, known.tasks, allocator);
  if (!batch) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a batch of %zu bytes",
                      batch_size(*object(rig), known.capacity, known.tasks));
  }
  *out_batch = reinterpret_cast<MienBatch*>(batch);
  return succeed(error);
}

void mien_batch_destroy(MienBatch* batch) { destroy(batch); }

MienStatus mien_batch_bytes(const MienRig* rig, const MienBatchDesc* desc, uint64_t* out_bytes) {
  if (!out_bytes) return MIEN_ERROR_NULL_ARGUMENT;
  *out_bytes = 0;
  if (MienStatus status = check(rig)) return status;
  MienBatchDesc known;
  if (MienStatus status = read_batch_desc(desc, known, nullptr)) return status;
  *out_bytes = batch_size(*object(rig), known.capacity, known.tasks);
  return MIEN_OK;
}

MienStatus mien_rig_evaluate_batch(const MienRig* rig, MienBatch* batch,
                                   MienInstance* const* instances, const uint32_t* lods,
                                   uint32_t count, uint32_t stages,
                                   const MienParallelFor* parallel) {
  if (MienStatus status = check(rig)) return status;
  if (MienStatus status = check(batch)) return status;
  const Rig& of = *object(rig);
  if (object(batch)->rig != &of) return MIEN_ERROR_MISMATCH;
  if (stages & ~uint32_t{kStagesAll}) return MIEN_ERROR_INVALID_ARGUMENT;
  if (parallel && !parallel->run) return MIEN_ERROR_INVALID_ARGUMENT;
  if (count == 0) return MIEN_OK;
  if (!instances || !lods) return MIEN_ERROR_NULL_ARGUMENT;
  if (count > object(batch)->capacity) return MIEN_ERROR_INVALID_ARGUMENT;

  MienStatus status = MIEN_OK;
  uint32_t marked = 0;
  for (uint32_t i = 0; i < count && status == MIEN_OK; ++i) {
    status = check(instances[i]);
    if (status != MIEN_OK) break;
    Instance& instance = *object(instances[i]);
    if (instance.rig != &of) {
      status = MIEN_ERROR_MISMATCH;
    } else if (lods[i] >= of.lod_count) {
      status = MIEN_ERROR_LOD;
    } else if (instance.in_batch) {
      status = MIEN_ERROR_INVALID_ARGUMENT;
    } else {
      instance.in_batch = true;
      ++marked;
    }
  }
  for (uint32_t i = 0; i < marked; ++i) object(instances[i])->in_batch = false;
  if (status != MIEN_OK) return status;

  ParallelFor run;
  if (parallel) run = {parallel->user, parallel->run};
  evaluate_batch(*object(batch), reinterpret_cast<Instance* const*>(instances), lods, count, stages,
                 run);
  return MIEN_OK;
}
