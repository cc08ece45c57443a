// SPDX-License-Identifier: MIT
#include "integrations/program/live/landmark_packet.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "integrations/program/io/json_check.h"

namespace mien::live {

namespace {

using PacketJson = nlohmann::json;

constexpr double kLatest = 1e10;     // seconds; those since 1970 are below
constexpr double kFarthest = 1e6;    // of coordinates
constexpr double kMostPixels = 1e5;  // of a side of the picture

/// The text with null where Python writes NaN.
std::string without_nan(const uint8_t* bytes, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  std::string out;
  out.reserve(size);
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    if (!quoted && text.compare(i, 3, "NaN") == 0) {
      out += "null";
      i += 2;
      continue;
    }
    if (text[i] == '"') quoted = !quoted;
    out += text[i];
    if (quoted && text[i] == '\\' && i + 1 < text.size()) out += text[++i];
  }
  return out;
}

/// False unless it is a number of that size at most.
bool read_number(const PacketJson& value, double most, double& out) {
  if (!value.is_number()) return false;
  out = value.get<double>();
  return std::fabs(out) <= most;
}

/// One coordinate of a landmark, by its place or its name; null if it is not there.
const PacketJson* coordinate(const PacketJson& landmark, size_t k) {
  static const char* const kAxes[] = {"x", "y", "z"};
  if (landmark.is_array()) return k < landmark.size() ? &landmark[k] : nullptr;
  const auto found = landmark.find(kAxes[k]);
  return found == landmark.end() ? nullptr : &*found;
}

/// Writes a landmark, or leaves it missing. Empty, or what is wrong.
std::string read_landmark(const PacketJson& landmark, size_t width, LandmarkPacket& packet,
                          float* to) {
  if (landmark.is_null()) return "";
  const bool is_list = landmark.is_array() && landmark.size() >= width && landmark.size() <= 3;
  if (!is_list && !landmark.is_object()) {
    return width == 3 ? "a landmark is not [x, y, z]" : "a landmark is not [x, y]";
  }
  double values[3] = {};
  for (size_t k = 0; k < width; ++k) {
    const PacketJson* value = coordinate(landmark, k);
    if (!value) return width == 3 ? "a landmark lacks x, y or z" : "a landmark lacks x or y";
    if (value->is_null()) return "";
    if (!read_number(*value, kFarthest, values[k])) {
      return "a coordinate is no number, or above a million";
    }
    if (width == 2 && packet.size[k] > 0) {
      if (values[k] < 0 || values[k] > 1) return "";
      values[k] *= static_cast<double>(packet.size[k]);
    }
  }
  for (size_t k = 0; k < width; ++k) to[k] = static_cast<float>(values[k]);
  ++packet.present;
  return "";
}

/// Time and size. Empty, or what is wrong.
std::string read_head(const PacketJson& document, LandmarkPacket& packet) {
  if (const auto time = document.find("time"); time != document.end()) {
    if (!read_number(*time, kLatest, packet.seconds) || packet.seconds < 0) {
      packet.seconds = -1;
      return "\"time\" is not a number of seconds from 0 on";
    }
  }
  const auto size = document.find("size");
  if (size == document.end()) return "";
  if (!size->is_array() || size->size() != 2) return "\"size\" is not [width, height]";
  for (size_t k = 0; k < 2; ++k) {
    double pixels = 0;
    if (!read_number((*size)[k], kMostPixels, pixels) || pixels < 1) {
      return "\"size\" is not [width, height] in pixels";
    }
    packet.size[k] = static_cast<float>(pixels);
  }
  return "";
}

}  // namespace

LandmarkDecoder::LandmarkDecoder(LandmarkNames names) : names_(std::move(names)) {
  for (size_t i = 0; i < names_.names.size(); ++i) {
    const std::string& name = names_.names[i];
    places_[name] = i * names_.width;
    size_t number = 0;
    const char* const end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data(), end, number);
    if (error == std::errc() && stop == end) numbers_[number] = i * names_.width;
  }
}

std::string LandmarkDecoder::decode(const uint8_t* bytes, size_t size,
                                    LandmarkPacket& packet) const {
  packet = LandmarkPacket();
  packet.values.assign(names_.names.size() * names_.width, NAN);
  const PacketJson document = cli::parse_written_json<PacketJson>(without_nan(bytes, size));
  if (document.is_discarded()) return "it is not JSON";
  const PacketJson* landmarks = &document;
  if (document.is_object()) {
    if (std::string why = read_head(document, packet); !why.empty()) return why;
    const auto found = document.find("landmarks");
    if (found == document.end()) return "it has no \"landmarks\"";
    landmarks = &*found;
  }
  if (landmarks->is_null()) return "";
  if (!landmarks->is_structured()) return "its landmarks are neither a list nor an object";
  if (landmarks->empty()) return "";
  if (names_.needs_size && packet.size[0] <= 0) {
    return "it has no \"size\" of the picture, and there is no camera in the file of --landmarks";
  }
  if (landmarks->is_array()) {
    if (numbers_.empty()) return "its landmarks are a list, but those of the rig have names";
    if (landmarks->size() <= numbers_.rbegin()->first) {
      return "it has " + std::to_string(landmarks->size()) + " landmarks, but number " +
             std::to_string(numbers_.rbegin()->first) + " has a place on the rig";
    }
    packet.unknown = landmarks->size() - numbers_.size();
    for (const auto& [number, place] : numbers_) {
      std::string why =
          read_landmark((*landmarks)[number], names_.width, packet, packet.values.data() + place);
      if (!why.empty()) return why;
    }
    return "";
  }
  for (const auto& [name, landmark] : landmarks->items()) {
    const auto known = places_.find(name);
    if (known == places_.end()) {
      ++packet.unknown;
      continue;
    }
    std::string why =
        read_landmark(landmark, names_.width, packet, packet.values.data() + known->second);
    if (!why.empty()) return why;
  }
  if (packet.unknown == landmarks->size()) return "none of its landmarks has a place on the rig";
  return "";
}

}  // namespace mien::live
