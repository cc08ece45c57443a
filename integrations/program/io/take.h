// SPDX-License-Identifier: MIT
// Rows of values with names, as recorded or exported: what clips are made of.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "integrations/program/io/frame_rate.h"

namespace mien::cli {

/// A named moment, such as a phoneme.
struct TakeEvent {
  int64_t tick;
  std::string name;
  float value;
};

struct Take {
  std::string shown;  // the file, for messages
  std::vector<std::string> names;
  std::vector<float> values;  // row after row
  size_t row_count = 0;
  Times times;                // empty if the file has none
  std::vector<size_t> lines;  // of rows, in the file, if it has lines
  Rate rate;                  // if the file says so
  bool is_live_link = false;  // of the Live Link Face app, whose clock drifts
  std::vector<TakeEvent> events;

  /// "take.csv, row 7", as a table shows its rows, or "take.json, frames[5]".
  std::string row_name(size_t row) const;
};

/// CSV or JSON, told by the content. Exit code 2 with the row and the column of what is wrong.
Take parse_take(std::string_view text, const std::string& shown);

/// Values that a take may have if its file has so many bytes: frames may leave names out, and rows may be far
/// apart, so a few bytes could ask for any number.
inline size_t most_values(size_t bytes) { return (size_t{1} << 22) + 8 * bytes; }

/// Names of what turns the head, for which faces have no controls: head.left, head.turn and head.up
/// (docs/mixing.md). Clips have them as channels, JSON has them in "variables".
inline bool turns_head(const std::string& name) { return name.compare(0, 5, "head.") == 0; }

// The two, which parse_take() chooses from. `gaps`: empty cells are NaN; otherwise they are refused.
Take parse_csv_take(std::string_view text, const std::string& shown, bool gaps = false);
Take parse_json_take(std::string_view text, const std::string& shown);

/// Keeps the channels that match one of the patterns, which have commas between and may contain *.
void keep_channels(Take& take, const std::string& patterns);

/// Adds an event "close:WHAT" to each event of some names: "m,b,p=lips". Guards know these (docs/mixing.md,
/// 4 "Guards"). Without regard to case. Returns how many it added. Exit code 1 for another form, 2 for an
/// event without a time.
size_t add_closures(Take& take, const std::string& option);

/// Rows at a constant rate, interpolated linearly between those that are there.
void resample(Take& take, const Rate& rate);

}  // namespace mien::cli
