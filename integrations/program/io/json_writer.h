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
  enum class Layout { kInline, kLines };  // kLines: each member on a line of its own

  explicit JsonWriter(Output& output) : output_(output) {}

  void begin_object(Layout layout = Layout::kInline) { begin('{', layout); }
  void begin_array(Layout layout = Layout::kInline) { begin('[', layout); }
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
  /// With the fewest digits that give the number back.
  void shortest(double number);

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
    bool empty;
  };

  void begin(char bracket, Layout layout);
  void end(char bracket);
  void separate();
  void string(std::string_view text);
  void flush_if_full();

  Output& output_;
  std::string text_;
  std::vector<Level> levels_;
  bool after_key_ = false;
};

}  // namespace mien::cli
