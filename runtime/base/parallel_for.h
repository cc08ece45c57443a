// SPDX-License-Identifier: MIT
// The caller's threads: the library starts none.
#pragma once

#include <cstdint>

namespace mien {

/// `run` calls task(context, i) for each i < count, on any threads, and returns when all are done.
/// Null: the calling thread runs them.
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
