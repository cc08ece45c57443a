// SPDX-License-Identifier: MIT
// Any bytes as a packet of landmarks, as a port receives them. An input is a byte that chooses which landmarks have
// places, and the packet.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "integrations/program/live/landmark_packet.h"
#include "tests/fuzz/time_limit.h"
#include "tests/support/cpu_time.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace {

using mien::live::LandmarkDecoder;
using mien::live::LandmarkNames;
using mien::live::LandmarkPacket;
using Random = std::minstd_rand;

void require(bool holds, const char* promise) {
  if (holds) return;
  fprintf(stderr, "broken: %s\n", promise);
  abort();
}

const LandmarkNames kSources[] = {{{"0", "1", "2", "3"}, 3, false},
                                  {{"0", "1", "3", "chin"}, 2, true},
                                  {{"chin", "nose \"tip\""}, 3, false},
                                  {{"5", "00", "18446744073709551616"}, 2, false}};
constexpr size_t kSourceCount = sizeof kSources / sizeof *kSources;

const char* const kWhole[] = {
    R"({"time": 12.5, "size": [1280, 720], "landmarks": [[0.1, 0.2, 0.3], {"x": 0.4, "y": 0.5, "z": 1, "v": 0},
        null, [NaN, 1, 2], [3, 4, 5], [6, 7, 8]]})",
    R"({"landmarks": {"chin": [1, 2, 3], "nose \"tip\"": {"x": 1, "y": 2, "z": 3}, "ear": []}})",
    "[[1, 2], [3, 4], [5, 6], [7, 8], [9, 10], [11, 12]]", "{\"time\": 1, \"landmarks\": []}",
    "null"};
const char* const kParts[] = {"null",
                              "NaN",
                              "\"NaN\"",
                              "[1, 2, 3]",
                              "{\"x\": 1, \"y\": 2, \"z\": 3}",
                              "1e308",
                              "-1e6",
                              "1e7",
                              "[]",
                              "{}",
                              "\"size\":",
                              "\"time\":",
                              "\"landmarks\":",
                              "\"chin\":",
                              "\\\"",
                              "\\u0000",
                              "[[[[",
                              "\xff",
                              ",",
                              "18446744073709551616"};

template <size_t N>
const char* any_of(const char* const (&words)[N], Random& random) {
  return words[random() % N];
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) { return 0; }

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  Random random(seed);
  std::string text(reinterpret_cast<const char*>(data), size);
  if (text.size() < 2 || random() % 32 == 0) {
    text = static_cast<char>(random() % kSourceCount);
    text += any_of(kWhole, random);
  } else if (random() % 2 == 0) {
    return LLVMFuzzerMutate(data, size, max_size);
  } else {
    const size_t at = 1 + random() % text.size();
    const size_t length = random() % 3 == 0 ? random() % 16 : 0;
    text.replace(at, length, any_of(kParts, random));
  }
  size = std::min(text.size(), max_size);
  std::memcpy(data, text.data(), size);
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const LandmarkNames& source = kSources[data[0] % kSourceCount];
  const LandmarkDecoder decoder(source);
  // A copy of exactly that size, so that a read past its end is seen.
  const std::vector<uint8_t> bytes(data + 1, data + size);
  LandmarkPacket packet;
  const double begin = mien::cpu_seconds();
  const std::string why = decoder.decode(bytes.data(), bytes.size(), packet);
  std::string slow;
  mien::check_time(mien::cpu_seconds() - begin, bytes.size(), slow);
  require(slow.empty(), slow.c_str());
  if (!why.empty()) {
    require(why.size() < 300, "a reason is one line");
    return 0;
  }
  require(packet.values.size() == source.names.size() * source.width, "a row has all landmarks");
  require(packet.seconds == -1 || (packet.seconds >= 0 && packet.seconds <= 1e10), "time");
  size_t present = 0;
  for (size_t i = 0; i < source.names.size(); ++i) {
    const float* const values = packet.values.data() + i * source.width;
    const bool there = std::isfinite(values[0]);
    for (size_t k = 0; k < source.width; ++k) {
      require(std::isfinite(values[k]) == there, "a landmark is there or missing");
      require(!there || std::fabs(values[k]) <= 1e6f, "coordinates have a bound");
      require(!there || packet.size[0] == 0 || source.width == 3 ||
                  (values[k] >= 0 && values[k] <= packet.size[k]),
              "shares are within the picture");
    }
    present += there;
  }
  require(present == packet.present, "landmarks are counted");
  return 0;
}
