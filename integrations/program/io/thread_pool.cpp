// SPDX-License-Identifier: MIT
#include "integrations/program/io/thread_pool.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace mien::cli {

struct ThreadPool::Shared {
  std::mutex mutex;
  std::condition_variable work, done;
  std::vector<std::thread> threads;
  MienTask task = nullptr;
  void* context = nullptr;
  uint32_t count = 0, next = 0, running = 0;
  bool ends = false;

  /// Takes tasks until none is left. `lock` holds the mutex, before and after.
  void take(std::unique_lock<std::mutex>& lock) {
    while (next < count) {
      const uint32_t index = next++;
      ++running;
      lock.unlock();
      task(context, index);
      lock.lock();
      --running;
    }
    if (running == 0) done.notify_all();
  }

  void serve() {
    std::unique_lock<std::mutex> lock(mutex);
    for (;;) {
      work.wait(lock, [&] { return ends || next < count; });
      if (ends) return;
      take(lock);
    }
  }

  static void MIEN_CALLBACK run(void* user, uint32_t count, MienTask task, void* context) {
    Shared& pool = *static_cast<Shared*>(user);
    std::unique_lock<std::mutex> lock(pool.mutex);
    pool.task = task;
    pool.context = context;
    pool.count = count;
    pool.next = 0;
    pool.work.notify_all();
    pool.take(lock);
    pool.done.wait(lock, [&] { return pool.running == 0 && pool.next >= pool.count; });
    pool.count = pool.next = 0;
  }
};

ThreadPool::ThreadPool(uint32_t threads) : shared_(std::make_unique<Shared>()) {
  if (threads == 0) threads = std::thread::hardware_concurrency();
  for (uint32_t i = 1; i < threads; ++i) {
    shared_->threads.emplace_back([this] { shared_->serve(); });
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard<std::mutex> lock(shared_->mutex);
    shared_->ends = true;
  }
  shared_->work.notify_all();
  for (std::thread& thread : shared_->threads) thread.join();
}

MienParallelFor ThreadPool::parallel_for() { return {shared_.get(), Shared::run}; }

}  // namespace mien::cli
