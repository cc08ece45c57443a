// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>

#include "integrations/program/edit/json_document.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/json_writer.h"
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

using Layout = JsonWriter::Layout;

/// The fields of a document as JSON.
class DocumentText {
 public:
  DocumentText(const Document& document, Output& output) : document_(document), json_(output) {}

  void write() {
    uint32_t version = 0, layers = 0;
    auto error = sized<MienError>();
    check(mien_document_layer_count(document_.get(), &version, &layers, &error), &error,
          "cannot read layers", document_.shown);
    json_.begin_object(Layout::kLines);
    json_.member("dna", "2." + std::to_string(version));
    json_.key("layers");
    json_.begin_array(Layout::kLines);
    for (uint32_t i = 0; i < layers; ++i) write_layer(i);
    json_.end_array();
    write_members("");
    json_.end_object();
    json_.finish();
  }

 private:
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
    json_.begin_array(bytes.count == 0 ? Layout::kInline : Layout::kLines);
    write_text(layer.code);
    json_.value(std::to_string(layer.version_major) + "." + std::to_string(layer.version_minor));
    if (bytes.count != 0) {
      json_.begin_array(Layout::kLines);
      constexpr size_t kBytesInLine = 48;
      for (size_t at = 0; at < bytes.count; at += kBytesInLine) {
        json_.value(hex_of({bytes.data + at, std::min(kBytesInLine, bytes.count - at)}));
      }
      json_.end_array();
    }
    json_.end_array();
  }

  void write_field(const std::string& path) {
    const MienDnaField found = field(path);
    switch (found.type) {
      case MIEN_FIELD_STRING: return write_text(read_string(document_, path));
      case MIEN_FIELD_LIST:
        json_.begin_array(Layout::kLines);
        for (uint64_t i = 0; i < found.count; ++i) write_field(element(path, i));
        return json_.end_array();
      case MIEN_FIELD_RECORD:
        json_.begin_object(fits_in_line(path, found.count) ? Layout::kInline : Layout::kLines);
        write_members(path);
        return json_.end_object();
      case MIEN_FIELD_F32: return write_numbers(path, found, floats_);
      default: return write_numbers(path, found, integers_);
    }
  }

  void write_members(const std::string& path) {
    const uint64_t count = field(path).count;
    for (uint64_t i = 0; i < count; ++i) {
      const std::string name = child(path, i);
      json_.key(name);
      write_field(path.empty() ? name : path + "." + name);
    }
  }

  /// Faces, weights of a position, pairs of metadata: a line each.
  bool fits_in_line(const std::string& path, uint64_t count) const {
    uint64_t numbers = 0;
    for (uint64_t i = 0; i < count; ++i) {
      const MienDnaField member = field(path + "." + child(path, i));
      if (member.type == MIEN_FIELD_RECORD || member.type == MIEN_FIELD_LIST) return false;
      numbers += member.is_array ? member.count : 1;
      if (member.count > JsonWriter::kRow) return false;
    }
    return numbers <= 2 * JsonWriter::kRow;
  }

  template <class Number>
  void write_numbers(const std::string& path, const MienDnaField& of, std::vector<Number>& values) {
    values.resize(of.count);
    auto error = sized<MienError>();
    check(read(path, values.data(), values.size(), &error), &error, "cannot read " + path,
          document_.shown);
    if (!of.is_array) return write_number(values[0]);
    json_.begin_numbers(values.size());
    for (const Number value : values) write_number(value);
    json_.end_array();
  }
  MienStatus read(const std::string& path, float* out, size_t count, MienError* error) const {
    return mien_document_read_floats(document_.get(), path.c_str(), 0, count, out, error);
  }
  MienStatus read(const std::string& path, int64_t* out, size_t count, MienError* error) const {
    return mien_document_read_integers(document_.get(), path.c_str(), 0, count, out, error);
  }

  void write_number(int64_t value) { json_.value(value); }
  void write_number(float value) {
    if (std::isfinite(value)) return json_.shortest_float(value);
    char digits[16];
    uint32_t bits = 0;
    memcpy(&bits, &value, sizeof(bits));
    snprintf(digits, sizeof(digits), "0x%08x", bits);
    json_.value(digits);
  }

  void write_text(const std::string& text) {
    for (std::string_view rest = text; !rest.empty();) {
      const size_t length = utf8_length(rest);
      if (length == 0) {
        json_.begin_object();
        json_.member("hex", hex_of(text));
        return json_.end_object();
      }
      rest.remove_prefix(length);
    }
    json_.value(text);
  }

  const Document& document_;
  JsonWriter json_;
  std::vector<float> floats_;
  std::vector<int64_t> integers_;
};

}  // namespace

void write_json_document(const Document& document, Output& output) {
  DocumentText(document, output).write();
}

}  // namespace mien::cli
