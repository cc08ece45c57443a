// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "integrations/program/edit/json_document.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

std::string hex_of(std::string_view bytes) {
  std::string text;
  for (char byte : bytes) {
    constexpr char kDigits[] = "0123456789abcdef";
    text += kDigits[static_cast<unsigned char>(byte) >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

class JsonWriter {
 public:
  JsonWriter(const Document& document, Output& output) : document_(document), output_(output) {}

  void run() {
    uint32_t version = 0, layers = 0;
    auto error = sized<MienError>();
    check(mien_document_layer_count(document_.get(), &version, &layers, &error), &error,
          "cannot read layers", document_.shown);
    put("{\n \"dna\": \"2." + std::to_string(version) + "\",\n \"layers\": [");
    for (uint32_t i = 0; i < layers; ++i) {
      put(i == 0 ? "\n  " : ",\n  ");
      write_layer(i);
    }
    put("\n ]");
    const uint64_t count = field("").count;
    for (uint64_t i = 0; i < count; ++i) {
      const std::string name = child("", i);
      put(",\n \"" + name + "\": ");
      write(name, 1);
    }
    put("\n}\n");
    flush();
  }

 private:
  void put(std::string_view text) {
    text_ += text;
    if (text_.size() >= 1 << 16) flush();
  }
  void flush() {
    output_.write(text_);
    text_.clear();
  }

  MienDnaField field(const std::string& path) const {
    auto found = sized<MienDnaField>();
    auto error = sized<MienError>();
    check(mien_document_field(document_.get(), path.c_str(), &found, &error), &error,
          "cannot read " + path, document_.shown);
    return found;
  }
  std::string child(const std::string& path, uint64_t index) const {
    MienStringView name{};
    auto error = sized<MienError>();
    check(mien_document_child_name(document_.get(), path.c_str(), static_cast<uint32_t>(index),
                                   &name, &error),
          &error, "cannot read " + path, document_.shown);
    return to_string(name);
  }

  void write_layer(uint32_t index) {
    auto layer = sized<MienDnaLayer>();
    MienStringView bytes{};
    auto error = sized<MienError>();
    check(mien_document_layer(document_.get(), index, &layer, &bytes, &error), &error,
          "cannot read layers", document_.shown);
    put("[");
    write_text(layer.code);
    put(", \"" + std::to_string(layer.version_major) + "." + std::to_string(layer.version_minor) +
        "\"");
    constexpr size_t kBytesInLine = 48;
    for (size_t at = 0; at < bytes.count; at += kBytesInLine) {
      put(at == 0 ? ", [\n   \"" : ",\n   \"");
      put(hex_of({bytes.data + at, std::min(kBytesInLine, bytes.count - at)}));
      put("\"");
    }
    put(bytes.count != 0 ? "]]" : "]");
  }

  void new_line(size_t depth) {
    put("\n");
    put(std::string(depth, ' '));
  }

  void write(const std::string& path, size_t depth) {
    const MienDnaField found = field(path);
    switch (found.type) {
      case MIEN_FIELD_STRING: return write_text(read_string(document_, path));
      case MIEN_FIELD_LIST: return write_list(path, found.count, depth);
      case MIEN_FIELD_RECORD: return write_record(path, found.count, depth);
      case MIEN_FIELD_F32: return write_numbers(path, found, floats_, depth);
      default: return write_numbers(path, found, integers_, depth);
    }
  }

  void write_list(const std::string& path, uint64_t count, size_t depth) {
    put("[");
    for (uint64_t i = 0; i < count; ++i) {
      if (i != 0) put(",");
      new_line(depth + 1);
      write(element(path, i), depth + 1);
    }
    if (count != 0) new_line(depth);
    put("]");
  }

  void write_record(const std::string& path, uint64_t count, size_t depth) {
    const bool is_short = fits_in_line(path, count);
    put("{");
    for (uint64_t i = 0; i < count; ++i) {
      if (i != 0) put(is_short ? ", " : ",");
      if (!is_short) new_line(depth + 1);
      const std::string name = child(path, i);
      put("\"" + name + "\": ");
      write(path + "." + name, depth + 1);
    }
    if (!is_short) new_line(depth);
    put("}");
  }

  /// Faces, weights of a position, pairs of metadata: a line each.
  bool fits_in_line(const std::string& path, uint64_t count) const {
    uint64_t numbers = 0;
    for (uint64_t i = 0; i < count; ++i) {
      const MienDnaField member = field(path + "." + child(path, i));
      if (member.type == MIEN_FIELD_RECORD || member.type == MIEN_FIELD_LIST) return false;
      numbers += member.is_array ? member.count : 1;
      if (member.count > kNumbersInLine) return false;
    }
    return numbers <= 2 * kNumbersInLine;
  }

  template <class Number>
  void write_numbers(const std::string& path, const MienDnaField& of, std::vector<Number>& values,
                     size_t depth) {
    values.resize(of.count);
    auto error = sized<MienError>();
    check(read(path, values.data(), values.size(), &error), &error, "cannot read " + path,
          document_.shown);
    if (!of.is_array) return write_number(values[0]);
    const bool lines = values.size() > kNumbersInLine;
    put("[");
    for (size_t i = 0; i < values.size(); ++i) {
      if (i != 0) put(lines && i % kNumbersInLine == 0 ? "," : ", ");
      if (lines && i % kNumbersInLine == 0) new_line(depth + 1);
      write_number(values[i]);
    }
    if (lines) new_line(depth);
    put("]");
  }
  MienStatus read(const std::string& path, float* out, size_t count, MienError* error) const {
    return mien_document_read_floats(document_.get(), path.c_str(), 0, count, out, error);
  }
  MienStatus read(const std::string& path, int64_t* out, size_t count, MienError* error) const {
    return mien_document_read_integers(document_.get(), path.c_str(), 0, count, out, error);
  }

  void write_number(int64_t value) { put(std::to_string(value)); }
  void write_number(float value) {
    char digits[32];
    if (!std::isfinite(value)) {
      uint32_t bits = 0;
      memcpy(&bits, &value, sizeof(bits));
      snprintf(digits, sizeof(digits), "\"0x%08x\"", bits);
      return put(digits);
    }
    // A parser takes "-0" for an integer, which has no sign.
    if (value == 0 && std::signbit(value)) return put("-0.0");
    put({digits,
         static_cast<size_t>(std::to_chars(digits, digits + sizeof(digits), value).ptr - digits)});
  }

  void write_text(const std::string& text) {
    std::string_view rest = text;
    std::string quoted = "\"";
    while (!rest.empty()) {
      const size_t length = utf8_length(rest);
      if (length == 0) return put("{\"hex\": \"" + hex_of(text) + "\"}");
      const auto byte = static_cast<unsigned char>(rest[0]);
      if (byte < 0x20 || byte == 0x7F) {
        char escape[8];
        snprintf(escape, sizeof(escape), "\\u%04x", byte);
        quoted += escape;
      } else {
        if (byte == '"' || byte == '\\') quoted += '\\';
        quoted += rest.substr(0, length);
      }
      rest.remove_prefix(length);
    }
    put(quoted + "\"");
  }

  static constexpr size_t kNumbersInLine = 12;

  const Document& document_;
  Output& output_;
  std::string text_;  // not written yet
  std::vector<float> floats_;
  std::vector<int64_t> integers_;
};

}  // namespace

void write_json_document(const Document& document, Output& output) {
  JsonWriter(document, output).run();
}

}  // namespace mien::cli
