// SPDX-License-Identifier: MIT
#include "integrations/program/io/take.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/io/controls.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

std::string Take::row_name(size_t row) const {
  if (lines.empty()) return shown + ", frames[" + std::to_string(row) + "]";
  return shown + ", row " + std::to_string(lines[row]);
}

Take parse_take(std::string_view text, const std::string& shown) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // of UTF-8
  if (text.substr(0, kMark.size()) == kMark) text.remove_prefix(kMark.size());
  const size_t first = text.find_first_not_of(" \t\r\n");
  const bool is_json =
      first != std::string_view::npos && (text[first] == '{' || text[first] == '[');
  return is_json ? parse_json_take(text, shown) : parse_csv_take(text, shown);
}

void keep_channels(Take& take, const std::string& patterns) {
  for (size_t begin = 0; begin <= patterns.size();) {
    const size_t comma = std::min(patterns.find(',', begin), patterns.size());
    const std::string one = patterns.substr(begin, comma - begin);
    if (one.empty()) fail_usage("--channels " + patterns, "a name is empty", "remove a comma");
    bool matches = false;
    for (const std::string& name : take.names) matches = matches || matches_pattern(one, name);
    if (!matches) {
      fail(kInvalid, "cannot build clip", take.shown, "no channel is named \"" + one + "\"",
           nearest_question(one, take.names, "the header of the file has the names"));
    }
    begin = comma + 1;
  }
  std::vector<size_t> kept;
  std::vector<std::string> names;
  for (size_t c = 0; c < take.names.size(); ++c) {
    if (!matches_pattern(patterns, take.names[c])) continue;
    kept.push_back(c);
    names.push_back(take.names[c]);
  }
  std::vector<float> values;
  values.reserve(take.row_count * kept.size());
  for (size_t r = 0; r < take.row_count; ++r) {
    for (size_t c : kept) values.push_back(take.values[r * take.names.size() + c]);
  }
  take.names = std::move(names);
  take.values = std::move(values);
}

size_t add_closures(Take& take, const std::string& option) {
  const std::vector<std::string> known = {"lips", "lip-to-teeth", "teeth"};
  const size_t equals = option.rfind('=');
  const std::string what = equals == std::string::npos ? "" : option.substr(equals + 1);
  if (equals == 0 || std::find(known.begin(), known.end(), what) == known.end()) {
    fail_usage("--close \"" + one_line(option) + "\"", "this is not NAMES=WHAT",
               "write m,b,p=lips, or f,v=lip-to-teeth, or s,z=teeth");
  }
  const auto lower = [](std::string text) {
    for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return text;
  };
  const std::string names = "," + lower(option.substr(0, equals)) + ",";
  const size_t count = take.events.size();
  for (size_t i = 0; i < count; ++i) {
    const TakeEvent event = take.events[i];
    if (names.find("," + lower(event.name) + ",") == std::string::npos) continue;
    if (!(event.value > 0)) {
      fail(kInvalid, "cannot build clip", take.shown + ", event \"" + one_line(event.name) + "\"",
           "its value, the seconds for which it closes, is not above 0",
           "give it one, such as 0.08");
    }
    take.events.push_back({event.tick, "close:" + what, event.value});
  }
  return take.events.size() - count;
}

void resample(Take& take, const Rate& rate) {
  const std::vector<double>& seconds = take.times.seconds;
  const size_t channels = take.names.size();
  const double span = seconds.back() - seconds.front();
  // A value has two bytes or more.
  const size_t most = most_values(2 * take.values.size());
  if (span * rate.hertz() * static_cast<double>(channels + 1) > static_cast<double>(most)) {
    fail(kInvalid, "cannot build clip", take.shown,
         "its times are so far apart that there would be over " + std::to_string(most) + " values",
         "check the times, or give a lower --rate");
  }
  // The last row counts if it is at a frame, but for the rounding of times.
  const auto frames = static_cast<size_t>(std::floor(span * rate.hertz() + 1e-6)) + 1;
  std::vector<float> values;
  values.reserve(frames * channels);
  size_t before = 0;
  for (size_t f = 0; f < frames; ++f) {
    const double time = seconds.front() + static_cast<double>(f) / rate.hertz();
    while (before + 2 < seconds.size() && seconds[before + 1] <= time) ++before;
    const size_t after = before + 1 < seconds.size() ? before + 1 : before;
    const double interval = seconds[after] - seconds[before];
    const double part = interval > 0 ? (time - seconds[before]) / interval : 0;
    const double t = part < 0 ? 0 : part > 1 ? 1 : part;
    for (size_t c = 0; c < channels; ++c) {
      const double a = static_cast<double>(take.values[before * channels + c]);
      const double b = static_cast<double>(take.values[after * channels + c]);
      // A row that is hit keeps its bits.
      values.push_back(t == 0   ? take.values[before * channels + c]
                       : t == 1 ? take.values[after * channels + c]
                                : static_cast<float>(a + (b - a) * t));
    }
  }
  take.values = std::move(values);
  take.row_count = frames;
  take.times = {};
}

}  // namespace mien::cli
