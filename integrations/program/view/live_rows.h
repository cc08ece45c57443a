// SPDX-License-Identifier: MIT
// The newest row of a live source, for which any number of requests wait.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

namespace mien::view {

class LiveRows {
 public:
  /// `heading` is the first line of each answer, with its line break.
  explicit LiveRows(std::string heading) : heading_(std::move(heading)) {}

  const std::string& heading() const { return heading_; }

  /// Any thread. A row that nobody has waited for is left out when the next one comes.
  void publish(std::string line) {
    const std::lock_guard lock(mutex_);
    line_ = std::move(line);
    ++number_;
    changed_.notify_all();
  }

  /// An answer that reads rows begins, or has been written.
  void begin_answer() {
    const std::lock_guard lock(mutex_);
    ++answers_;
  }
  void end_answer() {
    const std::lock_guard lock(mutex_);
    --answers_;
    changed_.notify_all();
  }

  /// Ends all waiting. Gives answers a second to be written to their end.
  void end() {
    std::unique_lock lock(mutex_);
    is_over_ = true;
    changed_.notify_all();
    changed_.wait_for(lock, std::chrono::seconds(1), [&] { return answers_ == 0; });
  }

  enum class Wait { kRow, kNone, kOver };

  /// Waits until there is another row than the one numbered `seen`, at first 0; kNone if none comes until `end`.
  Wait wait_until(std::chrono::steady_clock::time_point end, uint64_t& seen, std::string& line) {
    std::unique_lock lock(mutex_);
    const bool is_new = changed_.wait_until(lock, end, [&] { return is_over_ || number_ != seen; });
    if (is_over_) return Wait::kOver;
    if (!is_new) return Wait::kNone;
    seen = number_;
    line = line_;
    return Wait::kRow;
  }

 private:
  const std::string heading_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string line_;
  uint64_t number_ = 0;
  size_t answers_ = 0;
  bool is_over_ = false;
};

}  // namespace mien::view
