// SPDX-License-Identifier: MIT
// Threads for benchmarks, as a host has them: they exist before the clock starts, take work without a
// lock, and look for more for a while before they sleep.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "capi/include/mien.h"

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

  /// Returns when all helpers look for work, as they do in the middle of a frame.
  void rouse() {
    std::atomic<uint32_t> here{0};
    struct Meeting {
      std::atomic<uint32_t>* here;
      uint32_t all;
    } meeting = {&here, static_cast<uint32_t>(threads_.size()) + 1};
    run(
        this, meeting.all,
        [](void* context, uint32_t) {
          const Meeting& m = *static_cast<Meeting*>(context);
          m.here->fetch_add(1);
          while (m.here->load() != m.all) std::this_thread::yield();
        },
        &meeting);
  }

  void wait_until_asleep() const {
    while (sleepers_.load() != threads_.size()) std::this_thread::yield();
  }

 private:
  static void run(void* user, uint32_t count, void (*task)(void*, uint32_t), void* context) {
    ThreadPool& pool = *static_cast<ThreadPool*>(user);
    if (count == 0) return;
    // Nobody reads these now: all tasks of the last work are done, and none of this one is offered.
    pool.count_ = count;
    pool.task_ = task;
    pool.context_ = context;
    pool.done_.store(0, std::memory_order_relaxed);
    const uint64_t work = (pool.offer_.load(std::memory_order_relaxed) >> 32) + 1;
    pool.offer_.store(work << 32 | count);
    if (pool.sleepers_.load() != 0) {
      { const std::lock_guard<std::mutex> lock(pool.mutex_); }
      pool.wake_.notify_all();
    }
    pool.take();
    for (uint32_t i = 0; pool.done_.load(std::memory_order_acquire) != count; ++i) {
      i < kSpins ? pause() : std::this_thread::yield();
    }
  }
  /// Does tasks until none is left to begin.
  void take() {
    uint64_t offer = offer_.load(std::memory_order_acquire);
    while ((offer & 0xFFFF'FFFF) != 0) {
      if (!offer_.compare_exchange_weak(offer, offer - 1, std::memory_order_acq_rel)) continue;
      // This work cannot end before this task does, so these are its own.
      task_(context_, count_ - static_cast<uint32_t>(offer & 0xFFFF'FFFF));
      done_.fetch_add(1, std::memory_order_release);
      offer = offer_.load(std::memory_order_acquire);
    }
  }
  void help() {
    uint64_t seen = 0;
    const auto is_new = [&] { return offer_.load() >> 32 != seen; };
    for (;;) {
      for (uint32_t i = 0; i < kSpins && !is_new(); ++i) pause();
      if (!is_new()) {
        std::unique_lock<std::mutex> lock(mutex_);
        sleepers_.fetch_add(1);
        wake_.wait(lock, [&] { return over_ || is_new(); });
        sleepers_.fetch_sub(1);
        if (over_) return;
      }
      seen = offer_.load() >> 32;
      take();
    }
  }
  static void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }

  static constexpr uint32_t kSpins = 2000;  // some tens of microseconds
  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<std::thread> threads_;
  uint32_t count_ = 0;
  void (*task_)(void*, uint32_t) = nullptr;
  void* context_ = nullptr;
  // Which work it is, and how many of its tasks are not begun: one number, so that no thread takes a
  // task of one work for one of the next.
  alignas(64) std::atomic<uint64_t> offer_{0};
  alignas(64) std::atomic<uint32_t> done_{0};
  std::atomic<uint32_t> sleepers_{0};
  bool over_ = false;
};

/// Times work(threads) on two threads. Counters: `speedup` is its time on one thread by that,
/// `speedup_asleep` with a thread that must be woken first: medians of calls that take turns. They tell
/// something only while nothing else runs. The clock is set by hand: ->UseManualTime().
template <class Work>
void compare_two_threads(benchmark::State& state, Work&& work) {
  // The first call of a turn finds results in the cache of the other processor, where the turn before
  // left them.
  constexpr int kTurn = 4;
  ThreadPool pool(1);
  const MienParallelFor parallel = pool.interface();
  const auto time_of = [&work](const MienParallelFor* threads) {
    const auto start = std::chrono::steady_clock::now();
    work(threads);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  std::vector<double> one, two, asleep;
  while (state.KeepRunningBatch(kTurn)) {
    for (int i = 0; i < kTurn; ++i) {
      const double seconds = time_of(nullptr);
      if (i != 0) one.push_back(seconds);
    }
    pool.wait_until_asleep();
    asleep.push_back(time_of(&parallel));
    pool.rouse();
    double turn = 0;
    for (int i = 0; i < kTurn; ++i) {
      const double seconds = time_of(&parallel);
      if (i != 0) two.push_back(seconds);
      turn += seconds;
    }
    state.SetIterationTime(turn);
  }
  const auto median = [](std::vector<double>& times) {
    std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
    return times[times.size() / 2];
  };
  state.counters["speedup"] = median(one) / median(two);
  state.counters["speedup_asleep"] = median(one) / median(asleep);
}

}  // namespace mien::bench
