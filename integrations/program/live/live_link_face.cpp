// SPDX-License-Identifier: MIT
#include "integrations/program/live/live_link_face.h"

#include <cmath>
#include <cstring>

namespace mien::live {

const char* const kLiveLinkNames[kLiveLinkValues] = {
    "EyeBlinkLeft",
    "EyeLookDownLeft",
    "EyeLookInLeft",
    "EyeLookOutLeft",
    "EyeLookUpLeft",
    "EyeSquintLeft",
    "EyeWideLeft",
    "EyeBlinkRight",
    "EyeLookDownRight",
    "EyeLookInRight",
    "EyeLookOutRight",
    "EyeLookUpRight",
    "EyeSquintRight",
    "EyeWideRight",
    "JawForward",
    "JawLeft",
    "JawRight",
    "JawOpen",
    "MouthClose",
    "MouthFunnel",
    "MouthPucker",
    "MouthLeft",
    "MouthRight",
    "MouthSmileLeft",
    "MouthSmileRight",
    "MouthFrownLeft",
    "MouthFrownRight",
    "MouthDimpleLeft",
    "MouthDimpleRight",
    "MouthStretchLeft",
    "MouthStretchRight",
    "MouthRollLower",
    "MouthRollUpper",
    "MouthShrugLower",
    "MouthShrugUpper",
    "MouthPressLeft",
    "MouthPressRight",
    "MouthLowerDownLeft",
    "MouthLowerDownRight",
    "MouthUpperUpLeft",
    "MouthUpperUpRight",
    "BrowDownLeft",
    "BrowDownRight",
    "BrowInnerUp",
    "BrowOuterUpLeft",
    "BrowOuterUpRight",
    "CheekPuff",
    "CheekSquintLeft",
    "CheekSquintRight",
    "NoseSneerLeft",
    "NoseSneerRight",
    "TongueOut",
    "HeadYaw",
    "HeadPitch",
    "HeadRoll",
    "LeftEyeYaw",
    "LeftEyePitch",
    "LeftEyeRoll",
    "RightEyeYaw",
    "RightEyePitch",
    "RightEyeRoll",
};

namespace {

constexpr uint8_t kVersion = 6;

/// Bytes that are left; reading past the end fails and stays failed.
struct Reader {
  const uint8_t* at;
  size_t left;
  bool failed = false;

  const uint8_t* take(size_t size) {
    if (failed || size > left) {
      failed = true;
      return nullptr;
    }
    const uint8_t* taken = at;
    at += size;
    left -= size;
    return taken;
  }
  uint8_t byte() {
    const uint8_t* taken = take(1);
    return taken ? *taken : uint8_t{0};
  }
  uint32_t word() {
    const uint8_t* b = take(4);
    if (!b) return 0;
    return uint32_t{b[0]} << 24 | uint32_t{b[1]} << 16 | uint32_t{b[2]} << 8 | uint32_t{b[3]};
  }
  float number() {
    const uint32_t bits = word();
    float value;
    static_assert(sizeof(value) == sizeof(bits), "");
    memcpy(&value, &bits, sizeof(value));
    return value;
  }
  std::string_view name() {
    const uint32_t size = word();
    if (size > kMaxLiveLinkName) failed = true;
    const uint8_t* taken = take(size);
    return taken ? std::string_view(reinterpret_cast<const char*>(taken), size)
                 : std::string_view();
  }
};

}  // namespace

const char* decode_live_link(const uint8_t* bytes, size_t size, LiveLinkPacket& packet) {
  Reader reader = {bytes, size};
  if (reader.byte() != kVersion) return "not version 6";
  packet.device = reader.name();
  packet.subject = reader.name();
  const uint32_t frame = reader.word();
  const float part = reader.number();
  const uint32_t rate = reader.word(), denominator = reader.word();
  const uint8_t count = reader.byte();
  if (reader.failed) return "cut off, or a name is too long";
  if (count != kLiveLinkValues) return "not 61 values";
  if (reader.left != kLiveLinkValues * sizeof(float)) return "of another size than its values";
  if (frame > INT32_MAX || !(part >= 0) || !(part <= 1)) return "a frame number out of range";
  // 1 to 1000 frames a second.
  const bool rate_is_known = denominator >= 1 && denominator <= 100000 && rate >= denominator &&
                             rate <= uint64_t{1000} * denominator;
  if (!rate_is_known) return "a frame rate out of range";
  packet.seconds = (static_cast<double>(frame) + static_cast<double>(part)) *
                   static_cast<double>(denominator) / static_cast<double>(rate);
  for (float& value : packet.values) {
    value = reader.number();
    if (!std::isfinite(value)) return "a value that is not finite";
  }
  return nullptr;
}

}  // namespace mien::live
