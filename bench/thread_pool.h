// SPDX-License-Identifier: MIT
// Threads for benchmarks, as a host has them: they exist before the clock starts, and look for more work
// for a while before they sleep.
#pragma once

#include <atomic>
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
    pool.next_ = 0;
    pool.done_ = 0;
    ++pool.posted_;
    pool.wake_.notify_all();
    pool.take(lock);
    lock.unlock();
    spin_until([&] { return pool.done_ == count; });
    lock.lock();
    pool.finished_.wait(lock, [&] { return pool.done_ == count; });
    pool.work_ = {};
  }
  /// Up to some tens of microseconds: to sleep and to be woken takes longer than a batch.
  template <class Condition>
  static void spin_until(Condition&& is_met) {
    for (int i = 0; i < 2000 && !is_met(); ++i) {
#if defined(__x86_64__)
      __builtin_ia32_pause();
#endif
    }
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
    uint32_t seen = 0;
    for (;;) {
      spin_until([&] { return posted_ != seen; });
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait(lock, [&] { return over_ || posted_ != seen; });
      if (over_) return;
      seen = posted_;
      take(lock);
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, finished_;
  std::vector<std::thread> threads_;
  Work work_;
  uint32_t next_ = 0;
  std::atomic<uint32_t> done_{0}, posted_{0};  // tasks of the work; works so far
  bool over_ = false;
};

}  // namespace mien::bench
