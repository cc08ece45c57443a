// SPDX-License-Identifier: MIT
// Threads of the caller: this library starts none.
#pragma once

#include <cstdint>

namespace mien {

/// `run` calls task(context, i) for each i < count, on threads of its choice, and returns when all
/// are done. Null: the calling thread does it.
struct ParallelFor {
  void* user = nullptr;
  void (*run)(void* user, uint32_t count, void (*task)(void* context, uint32_t index),
              void* context) = nullptr;
};

inline void run_tasks(const ParallelFor& parallel, uint32_t count,
                      void (*task)(void* context, uint32_t index), void* context) {
  if (parallel.run) return parallel.run(parallel.user, count, task, context);
  for (uint32_t i = 0; i < count; ++i) task(context, i);
}

}  // namespace mien
