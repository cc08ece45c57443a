// SPDX-License-Identifier: MIT
// Threads for benchmarks, as a host has them: they exist before the clock starts.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "capi/mien.h"

namespace mien::bench {

/// Threads that wait for work; the caller works too.
class ThreadPool {
 public:
  explicit ThreadPool(unsigned helpers) {
    for (unsigned i = 0; i < helpers; ++i) threads_.emplace_back([this] { help(); });
  }
  ~ThreadPool() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      over_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  MienParallelFor interface() { return {this, run}; }

 private:
  struct Work {
    uint32_t count = 0;
    void (*task)(void*, uint32_t) = nullptr;
    void* context = nullptr;
  };
  static void run(void* user, uint32_t count, void (*task)(void*, uint32_t), void* context) {
    ThreadPool& pool = *static_cast<ThreadPool*>(user);
    std::unique_lock<std::mutex> lock(pool.mutex_);
    pool.work_ = {count, task, context};
    pool.next_ = pool.done_ = 0;
    pool.wake_.notify_all();
    pool.take(lock);
    pool.finished_.wait(lock, [&] { return pool.done_ == count; });
    pool.work_ = {};
  }
  void take(std::unique_lock<std::mutex>& lock) {
    while (next_ < work_.count) {
      const uint32_t index = next_++;
      const Work work = work_;
      lock.unlock();
      work.task(work.context, index);
      lock.lock();
      if (++done_ == work.count) finished_.notify_all();
    }
  }
  void help() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!over_) {
      wake_.wait(lock, [&] { return over_ || next_ < work_.count; });
      take(lock);
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, finished_;
  std::vector<std::thread> threads_;
  Work work_;
  uint32_t next_ = 0, done_ = 0;
  bool over_ = false;
};

}  // namespace mien::bench
