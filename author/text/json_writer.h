// SPDX-License-Identifier: MIT
// JSON, written piece by piece without a document in memory: the reports of libmien-author, whose memory is the
// caller's, and what the program writes. Needs nothing but the standard library.
#pragma once

#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string_view>
#include <type_traits>

#include "author/text/utf8.h"

namespace mien {

/// Where members of an object or array stand. kLines: each on a line of its own; kRows: twelve on a line, all on
/// one if they fit. What is within a kInline is kInline, too.
enum class JsonLayout { kInline, kLines, kRows };

/// Appends to a `Text`, which has append(std::string_view). Bytes that are not UTF-8 become U+FFFD. Allocates
/// nothing, throws nothing but what `Text` throws. At most kDepth objects and arrays are open at once.
template <class Text>
class JsonWriter {
 public:
  using Layout = JsonLayout;
  static constexpr size_t kRow = 12;
  static constexpr size_t kDepth = 16;

  explicit JsonWriter(Text& text) : text_(text) {}

  void begin_object(Layout layout = Layout::kInline) { begin('{', layout); }
  void begin_array(Layout layout = Layout::kInline) { begin('[', layout); }
  /// An array of `count` numbers.
  void begin_numbers(size_t count) { begin('[', count > kRow ? Layout::kRows : Layout::kInline); }
  void end_object() { end('}'); }
  void end_array() { end(']'); }

  void key(std::string_view name) {
    separate();
    string(name);
    text_.append(": ");
    after_key_ = true;
  }
  void value(std::string_view text) {
    separate();
    string(text);
  }
  void value(const char* text) { value(std::string_view(text)); }
  void value(bool truth) { word(truth ? "true" : "false"); }
  template <class Whole, class = std::enable_if_t<std::is_integral_v<Whole>>>
  void value(Whole number) {
    separate();
    char digits[24];
    finish_digits(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
  }
  void null() { word("null"); }

  /// With nine significant digits at most.
  void rounded(double number) {
    separate();
    char digits[40];
#if defined(__EMSCRIPTEN__)  // it has one locale only
    finish_digits(digits, digits + snprintf(digits, sizeof(digits), "%.9g", number));
#else
    finish_digits(
        digits,
        std::to_chars(digits, digits + sizeof(digits), number, std::chars_format::general, 9).ptr);
#endif
  }

  template <class T>
  void member(std::string_view name, const T& content) {
    key(name);
    value(content);
  }

#if !defined(__EMSCRIPTEN__)  // its library has no std::to_chars() of floats
  /// In fixed notation.
  void fixed(double number, int decimals) {
    separate();
    char digits[400];
    finish_digits(digits, std::to_chars(digits, digits + sizeof(digits), number,
                                        std::chars_format::fixed, decimals)
                              .ptr);
  }
  /// With the fewest digits that give the number back, as a double or as a float.
  void shortest(double number) { digits_of(number); }
  void shortest_float(float number) { digits_of(number); }

  /// An array. Stops at the first number that is not finite and returns its index, else `count`.
  size_t floats(const float* numbers, size_t count) {
    separate();
    text_.append("[");
    char digits[32];
    for (size_t i = 0; i < count; ++i) {
      if (!std::isfinite(numbers[i])) return i;
      if (i != 0) text_.append(",");
      // As a double, so that readers who keep doubles see the very number, too.
      const double number = numbers[i];
      finish_digits(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
    }
    text_.append("]");
    return count;
  }
#endif

 private:
  struct Level {
    Layout layout;
    size_t count;  // members so far
  };

  void begin(char bracket, Layout layout) {
    separate();
    assert(depth_ < kDepth);
    if (depth_ != 0 && levels_[depth_ - 1].layout == Layout::kInline) layout = Layout::kInline;
    text_.append({&bracket, 1});
    levels_[depth_++] = {layout, 0};
  }

  void end(char bracket) {
    const Level level = levels_[--depth_];
    if (level.layout != Layout::kInline && level.count != 0) new_line();
    text_.append({&bracket, 1});
  }

  void separate() {
    if (after_key_) {
      after_key_ = false;
      return;
    }
    if (depth_ == 0) return;
    Level& level = levels_[depth_ - 1];
    const bool starts_line = level.layout == Layout::kLines ||
                             (level.layout == Layout::kRows && level.count % kRow == 0);
    if (level.count != 0) text_.append(starts_line ? "," : ", ");
    if (starts_line) new_line();
    ++level.count;
  }

  void new_line() {
    text_.append("\n");
    for (size_t i = 0; i < depth_; ++i) text_.append("  ");
  }

  void word(std::string_view word) {
    separate();
    text_.append(word);
  }

  void finish_digits(const char* digits, const char* end) {
    text_.append({digits, static_cast<size_t>(end - digits)});
  }

#if !defined(__EMSCRIPTEN__)
  template <class Number>
  void digits_of(Number number) {
    // Without a point readers take it for an integer, which has no sign at zero.
    if (number == 0 && std::signbit(number)) return word("-0.0");
    separate();
    char digits[32];
    finish_digits(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
  }
#endif

  void string(std::string_view text) {
    text_.append("\"");
    while (!text.empty()) {
      const size_t length = utf8_length(text);
      const auto byte = static_cast<unsigned char>(text[0]);
      if (length == 0) {
        text_.append("\xef\xbf\xbd");  // U+FFFD stands for a byte that is not UTF-8
      } else if (byte == '"' || byte == '\\') {
        const char escaped[] = {'\\', text[0]};
        text_.append({escaped, 2});
      } else if (byte < 0x20) {
        constexpr char kHex[] = "0123456789abcdef";
        const char escaped[] = {'\\', 'u', '0', '0', kHex[byte >> 4], kHex[byte & 15]};
        text_.append({escaped, 6});
      } else {
        text_.append(text.substr(0, length));
      }
      text.remove_prefix(length == 0 ? 1 : length);
    }
    text_.append("\"");
  }

  Text& text_;
  Level levels_[kDepth];
  size_t depth_ = 0;
  bool after_key_ = false;
};

}  // namespace mien
