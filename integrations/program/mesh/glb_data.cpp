// SPDX-License-Identifier: MIT
#include "integrations/program/mesh/glb_data.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "integrations/program/io/json_check.h"
#include "integrations/program/io/text.h"

namespace mien::cli {

namespace {

// Nodes and targets may name the same data again and again. Of real files none has a fraction of this.
constexpr size_t kMaxNumbers = size_t{1} << 22, kMaxNumbersPerByte = 32;

}  // namespace

GlbData::GlbData(const std::string& bytes, const std::string& path)
    : path_(path), numbers_left_(kMaxNumbers + bytes.size() * kMaxNumbersPerByte) {
  const auto word = [&](size_t at) {
    uint32_t value = 0;
    if (bytes.size() < 4 || at > bytes.size() - 4) fail("", "truncated", "get the file again");
    for (size_t i = 0; i < 4; ++i) {
      value |= uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    }
    return value;
  };
  if (word(4) != 2) {
    fail("byte 4", "version " + std::to_string(word(4)) + ": 2 is supported",
         "export it as glTF 2.0");
  }
  std::string json;
  for (size_t at = 12; bytes.size() >= 8 && at <= bytes.size() - 8;) {
    const size_t size = word(at);
    const uint32_t kind = word(at + 4);
    at += 8;
    if (size > bytes.size() - at) {
      fail("byte " + std::to_string(at),
           "truncated: a chunk of " + std::to_string(size) + " bytes does not fit",
           "get the file again");
    }
    if (kind == 0x4E4F534A && json.empty()) json = bytes.substr(at, size);
    if (kind == 0x004E4942 && binary_.empty()) binary_ = std::string_view(bytes).substr(at, size);
    at += (size + 3) / 4 * 4;
  }
  root_ = cli::parse_written_json<Json>(json);
  if (!root_.is_object()) fail("", "its JSON is not valid", "export it again");
  for (const Json& name : list(root_, "extensionsRequired")) {
    if (name.is_string() && name.get<std::string>() == "KHR_mesh_quantization") continue;
    fail("",
         "it needs the extension " + (name.is_string() ? one_line(name.get<std::string>()) : "?"),
         "export it without compression");
  }
}

void GlbData::take_numbers(size_t count) {
  if (count > numbers_left_) {
    fail("", "its meshes, targets and animations name the same data too often", "make it smaller");
  }
  numbers_left_ -= count;
}

void GlbData::copy(size_t view_index, size_t offset, size_t type, bool normalized, size_t count,
                   size_t width, std::vector<double>& out) const {
  const Json& view = element("bufferViews", view_index);
  if (whole(view, "buffer", 0) != 0 || !text(element("buffers", 0), "uri").empty()) {
    fail("", "its data lie in another file", "export it as one .glb file");
  }
  const size_t sizes[] = {1, 1, 2, 2, 0, 4, 4};  // from 5120
  if (type < 5120 || type > 5126 || sizes[type - 5120] == 0) {
    fail("", "numbers of type " + std::to_string(type) + " are not known");
  }
  const size_t size = sizes[type - 5120];
  const size_t stride = std::max(whole(view, "byteStride", 0), size_t{0});
  const size_t step = stride ? stride : size * width;
  const size_t begin = whole(view, "byteOffset", 0), length = whole(view, "byteLength", 0);
  if (begin > binary_.size() || length > binary_.size() - begin || offset > length ||
      (count > 0 && (step < size * width || (count - 1) > (length - offset) / step ||
                     (count - 1) * step + size * width > length - offset))) {
    fail("buffer view " + std::to_string(view_index),
         "it does not have " + std::to_string(count) + " elements within the file");
  }
  out.reserve(count * width);
  const char* from = binary_.data() + begin + offset;
  for (size_t i = 0; i < count; ++i) {
    for (size_t k = 0; k < width; ++k) {
      const char* at = from + i * step + k * size;
      uint32_t bits = 0;
      for (size_t b = 0; b < size; ++b)
        bits |= uint32_t{static_cast<unsigned char>(at[b])} << (8 * b);
      double value = 0;
      switch (type) {
        case 5120: value = static_cast<int8_t>(bits); break;
        case 5121: value = bits; break;
        case 5122: value = static_cast<int16_t>(bits); break;
        case 5123: value = bits; break;
        case 5125: value = bits; break;
        default: {
          float single;
          memcpy(&single, &bits, sizeof(single));
          value = double{single};
        }
      }
      const double largest[] = {127, 255, 32767, 65535, 1, 4294967295.0, 1};
      if (normalized) value = std::max(value / largest[type - 5120], -1.0);
      if (!std::isfinite(value)) {
        fail("buffer view " + std::to_string(view_index), "a number is not finite");
      }
      out.push_back(value);
    }
  }
}

std::vector<double> GlbData::numbers(size_t index, size_t width, const char* what) {
  const Json& accessor = element("accessors", index);
  const char* const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  const char* const wanted = width == 16 ? "MAT4" : types[width];
  if (text(accessor, "type") != wanted) {
    fail("accessor " + std::to_string(index),
         std::string(what) + " should have the type " + wanted);
  }
  const size_t count = whole(accessor, "count", 0), type = whole(accessor, "componentType", 0);
  take_numbers(count * width);
  const auto normal = accessor.find("normalized");
  const bool normalized = normal != accessor.end() && normal->is_boolean() && normal->get<bool>();
  std::vector<double> out;
  if (accessor.contains("bufferView")) {
    copy(whole(accessor, "bufferView", 0), whole(accessor, "byteOffset", 0), type, normalized,
         count, width, out);
  } else {
    // Zeros, as of targets that do not move a mesh, and sparse ones over them: bounded by what others
    // of the file hold.
    if (count > binary_.size())
      fail("accessor " + std::to_string(index), "it is larger than the file");
    out.assign(count * width, 0);
  }
  const auto sparse = accessor.find("sparse");
  if (sparse == accessor.end()) return out;
  if (!sparse->is_object() || !sparse->contains("indices") || !sparse->contains("values") ||
      !(*sparse)["indices"].is_object() || !(*sparse)["values"].is_object()) {
    fail("accessor " + std::to_string(index), "its sparse part is incomplete");
  }
  const size_t changed = whole(*sparse, "count", 0);
  take_numbers(changed * (width + 1));
  const Json &places = (*sparse)["indices"], &values = (*sparse)["values"];
  std::vector<double> at, with;
  copy(whole(places, "bufferView", 0), whole(places, "byteOffset", 0),
       whole(places, "componentType", 0), false, changed, 1, at);
  copy(whole(values, "bufferView", 0), whole(values, "byteOffset", 0), type, normalized, changed,
       width, with);
  for (size_t i = 0; i < changed; ++i) {
    if (!(at[i] >= 0 && at[i] < static_cast<double>(count))) {
      fail("accessor " + std::to_string(index), "it changes an element that is not there");
    }
    for (size_t k = 0; k < width; ++k) {
      out[static_cast<size_t>(at[i]) * width + k] = with[i * width + k];
    }
  }
  return out;
}

}  // namespace mien::cli
