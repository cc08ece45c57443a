// SPDX-License-Identifier: MIT
// JSON written as it comes, without building a document first.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "capi/mien.h"
#include "integrations/cli/output.h"

namespace mien::cli {

/// Numbers have enough digits to read back as the same float. Text that is not UTF-8 is made so.
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
  /// Fixed notation, for times.
  void fixed(double number, int decimals);
  void shortest(double number);

  template <class T>
  void member(std::string_view name, const T& content) {
    key(name);
    value(content);
  }

  /// An array. Returns the index of the first number that is not finite (and not written), or
  /// `count`.
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
