// SPDX-License-Identifier: MIT
// Rows as they arrive over a network: out of order, twice, in bunches, or not at all. Sorts them by the
// time that their sender gives them, and hands them on just before they are played.
//
// A row is played `delay` after its time in the local clock. The offset of the sender's clock is unknown;
// the packets that took the least time give the best estimate. So the offset between the clocks follows the
// earliest packets at once, and later ones slowly, as clocks drift. Between two rows the mixer
// interpolates; where one is lost, over the gap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

namespace mien::live {

class PlayOut {
 public:
  /// Ticks are those of mien.h (MIEN_TICKS_PER_SECOND).
  PlayOut(int64_t delay, int64_t ticks_per_second);

  enum class Arrival {
    kKept,
    kTwice,    // a row of this time is there already
    kLate,     // later rows have been handed on
    kStrange,  // more than a second off, while others are not: a stray packet
    kNoRoom,
  };

  /// A row of `time` in the sender's clock that arrives at `now` in the local one.
  Arrival add(int64_t time, int64_t now, const float* values, size_t count);

  /// Hands on the next row if one is needed for playing at `now`: rows come by time, each once.
  bool take(int64_t now, int64_t& time, std::vector<float>& values);

 private:
  struct Row {
    int64_t sent;  // time in the sender's clock
    std::vector<float> values;
  };

  /// False if the packet does not count.
  bool follow_clock(int64_t lag, int64_t now);

  int64_t delay_, second_;
  std::deque<Row> rows_;  // by time
  int64_t offset_ = 0;    // local time less that of the sender
  int64_t last_arrival_ = 0;
  int64_t last_taken_ = 0;  // local time of the last row handed on, and that of its sender
  int64_t last_sent_ = 0;
  bool started_ = false;
  bool has_last_ = false;  // a row was handed on
  bool taken_ = false;     // and that was of the clock that counts now
};

}  // namespace mien::live
