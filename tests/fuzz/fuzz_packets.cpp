// SPDX-License-Identifier: MIT
// Any bytes as packets of the Live Link Face app, as a port receives them: decoded, sorted by time, and
// handed on for playing. An input is a run of packets: two bytes of size, one of the time until it
// arrives, the packet.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "integrations/program/live/live_link_face.h"
#include "integrations/program/live/play_out.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

using mien::live::decode_live_link;
using mien::live::kLiveLinkValues;
using mien::live::LiveLinkPacket;
using mien::live::PlayOut;

constexpr int64_t kSecond = 705600000;
constexpr size_t kPacket = 319;

void require(bool holds) {
  if (!holds) abort();
}

void put_word(uint8_t* at, uint32_t word) {
  for (int i = 0; i < 4; ++i) at[i] = static_cast<uint8_t>(word >> (24 - 8 * i));
}

/// A packet with the head of `bytes` made right: mutations of the rest get far.
void make_packet(uint8_t* bytes, uint8_t frame) {
  bytes[0] = 6;
  put_word(bytes + 1, 37);
  put_word(bytes + 42, 12);
  put_word(bytes + 58, frame);
  put_word(bytes + 62, 0);
  put_word(bytes + 66, 60);
  put_word(bytes + 70, 1);
  bytes[74] = kLiveLinkValues;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) { return 0; }

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  constexpr size_t kOne = 3 + kPacket;
  if (size < 4 * kOne && max_size >= 4 * kOne && seed % 5 != 0) {
    std::fill(data + size, data + 4 * kOne, uint8_t{2});
    size = 4 * kOne;
  }
  size = LLVMFuzzerMutate(data, size, max_size);
  for (size_t at = 0, k = 0; seed % 3 != 0 && at + kOne <= size; at += kOne, ++k) {
    data[at] = kPacket >> 8;
    data[at + 1] = kPacket & 255;
    if ((seed >> (k % 24) & 3) != 0) make_packet(data + at + 3, static_cast<uint8_t>(seed + k));
  }
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  PlayOut play_out(kSecond / 20, kSecond);
  int64_t now = 0, last = INT64_MIN;
  std::vector<float> row;
  for (size_t at = 0; at + 3 <= size;) {
    const size_t wanted = size_t{data[at]} << 8 | data[at + 1];
    now += data[at + 2] * (kSecond / 240);
    at += 3;
    // A copy of exactly that size, so that a read past its end is seen.
    const std::vector<uint8_t> bytes(data + at, data + at + std::min(wanted, size - at));
    at += bytes.size();
    LiveLinkPacket packet;
    if (decode_live_link(bytes.data(), bytes.size(), packet) == nullptr) {
      require(packet.device.size() + packet.subject.size() < bytes.size());
      require(packet.seconds >= 0 && packet.seconds < 2.2e9);
      for (const float value : packet.values) require(std::isfinite(value));
      const auto time = static_cast<int64_t>(packet.seconds * static_cast<double>(kSecond));
      play_out.add(time, now, packet.values, kLiveLinkValues);
    }
    for (int64_t time = 0; play_out.take(now, time, row);) {
      require(time > last && time <= now + 2 * kSecond && row.size() == kLiveLinkValues);
      last = time;
    }
  }
  return 0;
}
