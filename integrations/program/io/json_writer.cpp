// SPDX-License-Identifier: MIT
#include "integrations/program/io/json_writer.h"

#include <charconv>
#include <cmath>

#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

constexpr size_t kFlushBytes = 64 * 1024;

}  // namespace

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (levels_.empty()) return;
  Level& level = levels_.back();
  const bool starts_line =
      level.layout == Layout::kLines || (level.layout == Layout::kRows && level.count % kRow == 0);
  if (level.count != 0) text_ += starts_line ? "," : ", ";
  if (starts_line) new_line(levels_.size());
  ++level.count;
}

void JsonWriter::begin(char bracket, Layout layout) {
  separate();
  if (!levels_.empty() && levels_.back().layout == Layout::kInline) layout = Layout::kInline;
  text_ += bracket;
  levels_.push_back({layout, 0});
}

void JsonWriter::end(char bracket) {
  const Level level = levels_.back();
  levels_.pop_back();
  if (level.layout != Layout::kInline && level.count != 0) new_line(levels_.size());
  text_ += bracket;
  flush_if_full();
}

void JsonWriter::key(std::string_view name) {
  separate();
  string(name);
  text_ += ": ";
  after_key_ = true;
}

void JsonWriter::value(std::string_view text) {
  separate();
  string(text);
}

void JsonWriter::value(bool truth) {
  separate();
  text_ += truth ? "true" : "false";
}

void JsonWriter::value(uint64_t number) {
  separate();
  text_ += std::to_string(number);
}

void JsonWriter::value(int64_t number) {
  separate();
  text_ += std::to_string(number);
}

void JsonWriter::null() {
  separate();
  text_ += "null";
}

void JsonWriter::fixed(double number, int decimals) {
  separate();
  char digits[400];
  const auto end =
      std::to_chars(digits, digits + sizeof(digits), number, std::chars_format::fixed, decimals)
          .ptr;
  text_.append(digits, end);
}

template <class Number>
void JsonWriter::digits_of(Number number) {
  separate();
  // Without a point readers take it for an integer, which has no sign at zero.
  if (number == 0 && std::signbit(number)) {
    text_ += "-0.0";
    return;
  }
  char digits[32];
  text_.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
  flush_if_full();
}

void JsonWriter::shortest(double number) { digits_of(number); }

void JsonWriter::shortest_float(float number) { digits_of(number); }

size_t JsonWriter::floats(const float* numbers, size_t count) {
  separate();
  text_ += '[';
  char digits[32];
  for (size_t i = 0; i < count; ++i) {
    if (!std::isfinite(numbers[i])) return i;
    if (i != 0) text_ += ',';
    // As a double, so that readers who keep doubles see the very number, too.
    const double number = numbers[i];
    text_.append(digits, std::to_chars(digits, digits + sizeof(digits), number).ptr);
    flush_if_full();
  }
  text_ += ']';
  return count;
}

void JsonWriter::finish() {
  text_ += '\n';
  output_.write(text_);
  text_.clear();
}

void JsonWriter::string(std::string_view text) {
  text_ += '"';
  while (!text.empty()) {
    const size_t length = utf8_length(text);
    const auto byte = static_cast<unsigned char>(text[0]);
    if (length == 0) {
      text_ += "\xef\xbf\xbd";  // U+FFFD stands for a byte that is not UTF-8
    } else if (byte == '"' || byte == '\\') {
      text_ += '\\';
      text_ += text[0];
    } else if (byte < 0x20) {
      constexpr char kHex[] = "0123456789abcdef";
      text_ += "\\u00";
      text_ += kHex[byte >> 4];
      text_ += kHex[byte & 15];
    } else {
      text_.append(text.substr(0, length));
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  text_ += '"';
}

void JsonWriter::flush_if_full() {
  if (text_.size() < kFlushBytes) return;
  output_.write(text_);
  text_.clear();
}

}  // namespace mien::cli
