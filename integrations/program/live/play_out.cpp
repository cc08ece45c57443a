// SPDX-License-Identifier: MIT
#include "integrations/program/live/play_out.h"

#include <algorithm>

namespace mien::live {

namespace {

constexpr size_t kMaxRows = 256;
// Quartz clocks drift by 0.1 ms a second at most; this is ten times as fast.
constexpr int64_t kDrift = 1000;

}  // namespace

PlayOut::PlayOut(int64_t delay, int64_t ticks_per_second)
    : delay_(delay), second_(ticks_per_second) {}

bool PlayOut::follow_clock(int64_t lag, int64_t now) {
  const int64_t since = now - last_arrival_;
  const bool jumps = lag - offset_ > second_ || offset_ - lag > second_;
  if (!started_ || (jumps && since > second_)) {
    // The first packet, or one of a sender that began anew.
    started_ = true;
    offset_ = lag;
    rows_.clear();
    taken_ = false;
  } else if (jumps) {
    return false;
  } else if (lag < offset_) {
    offset_ = lag;
  } else {
    offset_ += std::min(lag - offset_, since / kDrift);
  }
  last_arrival_ = now;
  return true;
}

PlayOut::Arrival PlayOut::add(int64_t time, int64_t now, const float* values, size_t count) {
  if (!follow_clock(now - time, now)) return Arrival::kStrange;
  if (taken_ && time <= last_sent_) return time == last_sent_ ? Arrival::kTwice : Arrival::kLate;
  const auto place = std::lower_bound(rows_.begin(), rows_.end(), time,
                                      [](const Row& row, int64_t t) { return row.sent < t; });
  if (place != rows_.end() && place->sent == time) return Arrival::kTwice;
  if (rows_.size() == kMaxRows) return Arrival::kNoRoom;
  rows_.insert(place, Row{time, std::vector<float>(values, values + count)});
  return Arrival::kKept;
}

bool PlayOut::take(int64_t now, int64_t& time, std::vector<float>& values) {
  // One row past the time that is played is enough to interpolate; the others wait for those between.
  if (has_last_ && last_taken_ > now - delay_) return false;
  while (!rows_.empty()) {
    Row row = std::move(rows_.front());
    rows_.pop_front();
    const int64_t local = row.sent + offset_;
    // A clock that was set back, by a packet that was faster than all before.
    if (has_last_ && local <= last_taken_) continue;
    time = last_taken_ = local;
    last_sent_ = row.sent;
    values = std::move(row.values);
    return has_last_ = taken_ = true;
  }
  return false;
}

}  // namespace mien::live
