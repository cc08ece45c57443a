// SPDX-License-Identifier: MIT
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>

#include "integrations/program/edit/json_document.h"
#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/input.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

using nlohmann::json;

const char* const kWhat = "invalid document";
const char* const kExample = "see 'mien edit --to-json'";

/// Bits of a float or bytes, in hexadecimal digits; false for other text.
bool from_hex(std::string_view text, std::string& out) {
  if (text.size() % 2 != 0) return false;
  for (size_t i = 0; i < text.size(); i += 2) {
    uint8_t byte = 0;
    const auto [end, error] = std::from_chars(text.data() + i, text.data() + i + 2, byte, 16);
    if (error != std::errc() || end != text.data() + i + 2) return false;
    out += static_cast<char>(byte);
  }
  return true;
}

/// Writes what the parser finds to the document. A frame for each object and array around the current place.
class JsonReader : public nlohmann::json_sax<json> {
 public:
  explicit JsonReader(Document& document) : document_(document) {}

  bool null() override { refuse("null is no value of a field"); }
  bool boolean(bool) override { refuse("true and false are no values of fields"); }
  bool binary(json::binary_t&) override { return false; }

  bool number_integer(json::number_integer_t value) override {
    return number(static_cast<float>(value), value);
  }
  bool number_unsigned(json::number_unsigned_t value) override {
    if (value > INT64_MAX) refuse("the number is too large");
    return number(static_cast<float>(value), static_cast<int64_t>(value));
  }
  bool number_float(json::number_float_t, const json::string_t& text) override {
    if (target() != MIEN_FIELD_F32) refuse(text + " is no value of this field");
    float value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    // The smallest numbers are no error, but the result of one that is too small for a float is.
    if (error != std::errc() || end != text.data() + text.size()) refuse(text + " is not a float");
    return number(value, 0);
  }

  bool string(json::string_t& text) override {
    if (frames_.empty()) refuse("this is not an object");
    switch (frames_.back().kind) {
      case Frame::kDocument: return header(text);
      case Frame::kLayer: return layer_text(text);
      case Frame::kLayerBytes:
        if (!from_hex(text, layer_bytes_)) refuse("these are not hexadecimal digits");
        return true;
      case Frame::kHexString: {
        std::string bytes;
        if (key_ != "hex" || !from_hex(text, bytes)) refuse("these are not hexadecimal digits");
        return write_string(frames_.back().path, bytes);
      }
      default: break;
    }
    if (target() == MIEN_FIELD_F32) return number(float_of_bits(text), 0);
    if (target() != MIEN_FIELD_STRING) refuse("a string is no value of this field");
    return write_string(next_path(), text);
  }

  bool start_object(size_t) override {
    if (frames_.empty()) {
      frames_.push_back({Frame::kDocument, ""});
      return true;
    }
    const std::string path = next_path();
    const uint32_t type = target();
    if (type == MIEN_FIELD_STRING) {
      frames_.push_back({Frame::kHexString, path});
    } else if (type == MIEN_FIELD_RECORD) {
      frames_.push_back({Frame::kRecord, path});
    } else {
      refuse("an object is no value of this field");
    }
    return true;
  }
  bool key(json::string_t& key) override {
    key_ = key;
    if (frames_.back().kind == Frame::kDocument && version_ == 0 && key != "dna")
      refuse("\"dna\": \"2.8\", the version, is not the first member");
    return true;
  }
  bool end_object() override {
    frames_.pop_back();
    return true;
  }

  bool start_array(size_t) override {
    if (frames_.empty()) refuse("this is not an object");
    Frame& around = frames_.back();
    if (around.kind == Frame::kDocument && key_ == "layers") {
      frames_.push_back({Frame::kLayers, "layers"});
    } else if (around.kind == Frame::kLayers) {
      layer_code_.clear();
      layer_version_.clear();
      layer_bytes_.clear();
      frames_.push_back({Frame::kLayer, "layers[" + std::to_string(around.count++) + "]"});
    } else if (around.kind == Frame::kLayer && !layer_version_.empty()) {
      frames_.push_back({Frame::kLayerBytes, around.path});
    } else {
      const std::string path = next_path();
      const MienDnaField found = field(path);
      if (found.type == MIEN_FIELD_LIST) {
        // Elements are of one type, which only an element tells.
        resize(path, 1);
        frames_.push_back({Frame::kList, path, field(path + "[0]").type, 0, 1});
      } else if (found.is_array) {
        floats_.clear();
        integers_.clear();
        frames_.push_back({Frame::kArray, path, found.type});
      } else {
        refuse("an array is no value of this field");
      }
    }
    return true;
  }
  bool end_array() override {
    const Frame frame = frames_.back();
    frames_.pop_back();
    if (frame.kind == Frame::kLayer) add_layer(frame.path);
    if (frame.kind == Frame::kList) resize(frame.path, frame.count);
    if (frame.kind == Frame::kArray) {
      resize(frame.path, frame.type == MIEN_FIELD_F32 ? floats_.size() : integers_.size());
      write_numbers(frame.path, frame.type);
    }
    return true;
  }

  bool parse_error(size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    const std::string message = error.what();
    const size_t tag = message.find("] ");
    fail(kInvalid, kWhat, document_.shown + ", byte " + std::to_string(position),
         one_line(tag == std::string::npos ? message : message.substr(tag + 2)), kExample);
  }

 private:
  struct Frame {
    enum Kind { kDocument, kLayers, kLayer, kLayerBytes, kRecord, kList, kArray, kHexString };
    Kind kind;
    std::string path;
    uint32_t type = 0;      // of the elements of a list or array
    uint64_t count = 0;     // elements so far
    uint64_t capacity = 0;  // elements that the list of the document has
  };

  [[noreturn]] void refuse(const std::string& why) const {
    std::string path = frames_.empty() ? "" : frames_.back().path;
    if (!frames_.empty() &&
        (frames_.back().kind == Frame::kRecord || frames_.back().kind == Frame::kDocument))
      path += (path.empty() ? "" : ".") + key_;
    fail(kInvalid, kWhat, document_.shown + (path.empty() ? "" : ", " + one_line(path)),
         one_line(why), kExample);
  }
  void check_write(MienStatus status, const MienError& error) const {
    if (status != MIEN_OK && status != MIEN_ERROR_MEMORY) refuse(error.message);
    check(status, &error, kWhat, document_.shown);
  }

  MienDnaField field(const std::string& path) const {
    auto found = sized<MienDnaField>();
    auto error = sized<MienError>();
    check_write(mien_document_field(document_.get(), path.c_str(), &found, &error), error);
    return found;
  }
  void resize(const std::string& path, uint64_t count) const {
    auto error = sized<MienError>();
    check_write(mien_document_resize(document_.get(), path.c_str(), count, &error), error);
  }

  /// Type of the field that the next value belongs to.
  uint32_t target() {
    const Frame& frame = frames_.back();
    if (frame.kind == Frame::kArray || frame.kind == Frame::kList) return frame.type;
    if (frame.kind == Frame::kRecord || frame.kind == Frame::kDocument) {
      const MienDnaField found = field(member_path(frame));
      if (found.is_array || found.type == MIEN_FIELD_LIST) refuse("this field is an array");
      return found.type;
    }
    refuse("this is not where such a value belongs");
  }
  std::string member_path(const Frame& frame) const {
    return frame.path.empty() ? key_ : frame.path + "." + key_;
  }
  /// Path of that field; the list grows by an element.
  std::string next_path() {
    Frame& frame = frames_.back();
    if (frame.kind == Frame::kRecord || frame.kind == Frame::kDocument) return member_path(frame);
    if (frame.kind != Frame::kList) refuse("this is not where such a value belongs");
    if (frame.count == frame.capacity) {
      frame.capacity *= 2;
      resize(frame.path, frame.capacity);
    }
    return element(frame.path, frame.count++);
  }

  bool number(float as_float, int64_t as_integer) {
    if (frames_.empty()) refuse("this is not an object");
    const uint32_t type = target();
    if (type == MIEN_FIELD_STRING || type == MIEN_FIELD_RECORD || type == MIEN_FIELD_LIST)
      refuse("a number is no value of this field");
    if (type == MIEN_FIELD_F32) {
      floats_.push_back(as_float);
    } else {
      integers_.push_back(as_integer);
    }
    if (frames_.back().kind == Frame::kArray) return true;
    write_numbers(next_path(), type);
    return true;
  }
  void write_numbers(const std::string& path, uint32_t type) {
    auto error = sized<MienError>();
    const bool floats = type == MIEN_FIELD_F32;
    check_write(floats ? mien_document_write_floats(document_.get(), path.c_str(), 0,
                                                    floats_.size(), floats_.data(), &error)
                       : mien_document_write_integers(document_.get(), path.c_str(), 0,
                                                      integers_.size(), integers_.data(), &error),
                error);
    floats_.clear();
    integers_.clear();
  }
  bool write_string(const std::string& path, const std::string& text) {
    auto error = sized<MienError>();
    check_write(
        mien_document_write_string(document_.get(), path.c_str(), text.data(), text.size(), &error),
        error);
    return true;
  }

  float float_of_bits(const std::string& text) const {
    uint32_t bits = 0;
    const char* const end = text.data() + text.size();
    const bool is_hex = text.size() == 10 && text.compare(0, 2, "0x") == 0;
    if (!is_hex || std::from_chars(text.data() + 2, end, bits, 16).ptr != end)
      refuse("a string in place of a number holds its bits, \"0x7fc00000\"");
    float value = 0;
    memcpy(&value, &bits, sizeof(value));
    return value;
  }

  /// Two numbers with a dot between.
  bool parse_version(const std::string& text, uint32_t& major, uint32_t& minor) const {
    const char* const end = text.data() + text.size();
    const auto dot = std::from_chars(text.data(), end, major);
    if (dot.ec != std::errc() || dot.ptr == end || *dot.ptr != '.') return false;
    const auto rest = std::from_chars(dot.ptr + 1, end, minor);
    return rest.ec == std::errc() && rest.ptr == end;
  }
  bool header(const std::string& text) {
    if (key_ != "dna") {
      refuse("a string is no value of this field");
    }
    uint32_t generation = 0;
    if (!parse_version(text, generation, version_) || generation != 2 || version_ == 0)
      refuse("\"" + text + "\" is not a version such as \"2.8\"");
    auto error = sized<MienError>();
    check_write(mien_document_clear_layers(document_.get(), version_, &error), error);
    return true;
  }
  bool layer_text(const std::string& text) {
    if (layer_code_.empty()) {
      layer_code_ = text;
    } else if (layer_version_.empty()) {
      layer_version_ = text;
    } else {
      refuse("a layer is [\"code\", \"1.0\"] or [\"code\", \"1.0\", [\"HEX\", ...]]");
    }
    return true;
  }
  void add_layer(const std::string&) {
    uint32_t major = 0, minor = 0;
    if (!parse_version(layer_version_, major, minor))
      refuse("a layer is [\"code\", \"1.0\"] or [\"code\", \"1.0\", [\"HEX\", ...]]");
    auto error = sized<MienError>();
    check_write(mien_document_add_layer(document_.get(), layer_code_.c_str(), major, minor,
                                        layer_bytes_.data(), layer_bytes_.size(), &error),
                error);
  }

  Document& document_;
  std::vector<Frame> frames_;
  std::string key_;       // the last one
  uint32_t version_ = 0;  // 0: not read yet
  std::vector<float> floats_;
  std::vector<int64_t> integers_;
  std::string layer_code_, layer_version_, layer_bytes_;
};

struct CloseJsonFile {
  void operator()(FILE* stream) const {
    if (stream != stdin) std::fclose(stream);
  }
};

}  // namespace

Document read_json_document(const std::string& path, const Session& session) {
  Document document;
  document.shown = shown_name(path);
  document.session = &session;
  const auto check_file = [&](bool good) {
    if (good) return;
    fail(kFile, "cannot read document", document.shown, std::strerror(errno),
         "check the path and its permissions");
  };
  const std::unique_ptr<FILE, CloseJsonFile> stream(path == "-" ? stdin
                                                                : std::fopen(path.c_str(), "rb"));
  check_file(stream != nullptr);
  MienDocument* made = nullptr;
  auto error = sized<MienError>();
  check(mien_document_create(nullptr, nullptr, &made, &error), &error, "cannot edit",
        document.shown);
  document.handle.reset(made);
  JsonReader reader(document);
  json::sax_parse(stream.get(), &reader);
  check_file(std::ferror(stream.get()) == 0);
  return document;
}

}  // namespace mien::cli
