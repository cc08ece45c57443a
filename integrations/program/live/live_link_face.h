// SPDX-License-Identifier: MIT
// Packets of the Live Link Face app: UDP, port 11111 unless the app is told another one.
//
// Big-endian, without padding:
//
//     u8   version, 6          i32  bytes of the device id, then the id
//     i32  bytes of the subject name, then the name
//     i32  frame number        f32  part of a frame      i32  frames per denominator seconds
//     i32  denominator         u8   count, 61            f32  values
//
// The packet ends with the last value. docs/face-capture.md says where these facts are from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace mien::live {

constexpr size_t kLiveLinkValues = 61;
constexpr size_t kMaxLiveLinkName = 255;
constexpr uint16_t kLiveLinkPort = 11111;

/// In the order of the values: 52 expressions, then yaw, pitch and roll of head and eyes.
extern const char* const kLiveLinkNames[kLiveLinkValues];

struct LiveLinkPacket {
  std::string_view device, subject;  // in the bytes of the packet; any bytes
  double seconds = 0;                // time of the frame, counted by the device; not negative
  float values[kLiveLinkValues] = {};
};

/// Null for a packet, else why these bytes are none. Reads nothing but the bytes, and takes the same time
/// whatever they are. Numbers that are not finite are refused.
const char* decode_live_link(const uint8_t* bytes, size_t size, LiveLinkPacket& packet);

}  // namespace mien::live
