// SPDX-License-Identifier: MIT
// Threads for long calls of the library.
#pragma once

#include <mien.h>

#include <cstdint>
#include <memory>

namespace mien::cli {

class ThreadPool {
 public:
  /// 0: as many as the machine runs at once. The calling thread is one of them.
  explicit ThreadPool(uint32_t threads);
  ~ThreadPool();

  MienParallelFor parallel_for();

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace mien::cli
