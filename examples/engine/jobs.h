// SPDX-License-Identifier: MIT
// A job system: threads that run the tasks of one parallel loop after another. Nothing is allocated per loop.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

class Jobs {
 public:
  // The calling thread takes part, so `threads` - 1 are started.
  explicit Jobs(unsigned threads) {
    for (unsigned i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
  }

  ~Jobs() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_ending_ = true;
    }
    started_.notify_all();
    for (std::thread& worker : workers_) worker.join();
  }

  // Calls task(context, i) for each i < count, on any threads, and returns when all are done.
  // A MienParallelFor can call this, so that the library spreads single large meshes over the threads, too.
  void run(uint32_t count, void (*task)(void*, uint32_t), void* context) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      task_ = task;
      context_ = context;
      count_ = count;
      next_ = 0;
      working_ = workers_.size();
      ++loop_;
    }
    started_.notify_all();
    take_tasks();
    std::unique_lock<std::mutex> lock(mutex_);
    finished_.wait(lock, [this] { return working_ == 0; });
  }

  template <class Body>
  void for_each(uint32_t count, Body&& body) {
    run(
        count, [](void* context, uint32_t i) { (*static_cast<Body*>(context))(i); }, &body);
  }

 private:
  void take_tasks() {
    for (uint32_t i = next_++; i < count_; i = next_++) task_(context_, i);
  }

  void work() {
    for (uint64_t seen = 0;;) {
      {
        std::unique_lock<std::mutex> lock(mutex_);
        started_.wait(lock, [&] { return is_ending_ || loop_ != seen; });
        if (is_ending_) return;
        seen = loop_;
      }
      take_tasks();
      const std::lock_guard<std::mutex> lock(mutex_);
      if (--working_ == 0) finished_.notify_one();
    }
  }

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable started_, finished_;
  std::atomic<uint32_t> next_{0};
  void (*task_)(void*, uint32_t) = nullptr;
  void* context_ = nullptr;
  uint32_t count_ = 0;
  size_t working_ = 0;
  uint64_t loop_ = 0;
  bool is_ending_ = false;
};
