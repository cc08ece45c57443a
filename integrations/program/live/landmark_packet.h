// SPDX-License-Identifier: MIT
// Packets of landmarks: UDP, JSON, as trackers of faces are often made to send them.
//
//     {"time": 12.5, "size": [1280, 720], "landmarks": [[640.2, 310.7], ...]}
//
//     landmarks  a list, whose numbers from 0 are the names, or an object of names. Each is [x, y] or [x, y, z],
//                {"x": 1, "y": 2, "z": 3} with any further members, or null: missing. An empty list, or null: no face
//     time       seconds of the sender. Without it, the time of arrival counts
//     size       of the picture in pixels. With it, x and y in pictures are shares of its width and height, as
//                MediaPipe gives them, and landmarks outside are missing. Without it, they are pixels
//
// The landmarks may also be the whole packet. NaN, which Python writes, means null.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace mien::live {

constexpr uint16_t kLandmarksPort = 11112;

struct LandmarkPacket {
  double seconds = -1;        // time of the sender; negative: it gave none
  float size[2] = {};         // of the picture; 0: it gave none
  std::vector<float> values;  // of each name, 2 or 3 numbers; NaN: missing
  size_t present = 0;         // names that are not missing
  size_t unknown = 0;         // landmarks of other names
};

/// What landmarks of a source have names.
struct LandmarkNames {
  std::vector<std::string> names;
  size_t width = 3;         // numbers of each: 2 in pictures
  bool needs_size = false;  // of the picture
};

class LandmarkDecoder {
 public:
  explicit LandmarkDecoder(LandmarkNames names);

  /// Empty for a packet, else why these bytes are none. Time and memory are in proportion to the bytes.
  std::string decode(const uint8_t* bytes, size_t size, LandmarkPacket& packet) const;

 private:
  LandmarkNames names_;
  std::map<std::string, size_t> places_;  // in the values, by name
  std::map<size_t, size_t> numbers_;      // the same, of names that are numbers
};

}  // namespace mien::live
