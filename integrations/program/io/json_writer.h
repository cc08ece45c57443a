// SPDX-License-Identifier: MIT
// JSON, written piece by piece without a document in memory.
#pragma once

#include <mien.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "integrations/program/io/output.h"

namespace mien::cli {

/// Numbers have enough digits to read back as the same float. Bytes that are not UTF-8 become U+FFFD.
class JsonWriter {
 public:
  /// kLines: each member on a line of its own; kRows: twelve on a line, all on one if they fit.
  enum class Layout { kInline, kLines, kRows };
  static constexpr size_t kRow = 12;

  explicit JsonWriter(Output& output) : output_(output) {}

  void begin_object(Layout layout = Layout::kInline) { begin('{', layout); }
  void begin_array(Layout layout = Layout::kInline) { begin('[', layout); }
  /// An array of `count` numbers.
  void begin_numbers(size_t count) { begin('[', count > kRow ? Layout::kRows : Layout::kInline); }
  void end_object() { end('}'); }
  void end_array() { end(']'); }

  void key(std::string_view name);
  void value(std::string_view text);
  void value(const char* text) { value(std::string_view(text)); }
  void value(bool truth);
  void value(uint64_t number);
  void value(int64_t number);
  void value(uint32_t number) { value(uint64_t{number}); }
  void value(int32_t number) { value(int64_t{number}); }
  void null();
  /// In fixed notation.
  void fixed(double number, int decimals);
  /// With the fewest digits that give the number back, as a double or as a float.
  void shortest(double number);
  void shortest_float(float number);

  template <class T>
  void member(std::string_view name, const T& content) {
    key(name);
    value(content);
  }

  /// An array. Stops at the first number that is not finite and returns its index, else `count`.
  size_t floats(const float* numbers, size_t count);

  /// Ends the text and hands it to the output.
  void finish();

 private:
  struct Level {
    Layout layout;
    size_t count;  // members so far
  };

  void begin(char bracket, Layout layout);
  void end(char bracket);
  void separate();
  void new_line(size_t depth) { text_.append("\n").append(2 * depth, ' '); }
  template <class Number>
  void digits_of(Number number);
  void string(std::string_view text);
  void flush_if_full();

  Output& output_;
  std::string text_;
  std::vector<Level> levels_;
  bool after_key_ = false;
};

}  // namespace mien::cli
