// SPDX-License-Identifier: MIT
#include "integrations/program/live/live_link_face.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

namespace mien::live {
namespace {

void put(std::string& bytes, uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(word >> shift & 255);
}

void put(std::string& bytes, float number) {
  uint32_t word;
  memcpy(&word, &number, sizeof(word));
  put(bytes, word);
}

struct Made {
  std::string device = "0123456789ABCDEF", subject = "face";
  uint32_t frame = 120, rate = 60, denominator = 1;
  float part = 0.5f;
  uint8_t version = 6, count = kLiveLinkValues;
  float first = 0.25f;

  std::string bytes() const {
    std::string made(1, static_cast<char>(version));
    put(made, static_cast<uint32_t>(device.size()));
    made += device;
    put(made, static_cast<uint32_t>(subject.size()));
    made += subject;
    put(made, frame);
    put(made, part);
    put(made, rate);
    put(made, denominator);
    made += static_cast<char>(count);
    put(made, first);
    for (size_t i = 1; i < kLiveLinkValues; ++i) put(made, static_cast<float>(i) / 64);
    return made;
  }
};

const char* decode(const std::string& text, LiveLinkPacket& packet) {
  // Of exactly that size: a sanitizer sees what lies beyond.
  static std::vector<uint8_t> bytes;
  bytes = std::vector<uint8_t>(text.begin(), text.end());
  return decode_live_link(bytes.data(), bytes.size(), packet);
}

bool is_refused(const Made& made) {
  LiveLinkPacket packet;
  return decode(made.bytes(), packet) != nullptr;
}

TEST(LiveLinkFace, APacketIsReadWhole) {
  LiveLinkPacket packet;
  ASSERT_EQ(decode(Made().bytes(), packet), nullptr);
  EXPECT_EQ(packet.device, "0123456789ABCDEF");
  EXPECT_EQ(packet.subject, "face");
  EXPECT_EQ(packet.seconds, 120.5 / 60);
  EXPECT_EQ(packet.values[0], 0.25f);
  EXPECT_EQ(packet.values[60], 60 / 64.0f);
  EXPECT_STREQ(kLiveLinkNames[0], "EyeBlinkLeft");
  EXPECT_STREQ(kLiveLinkNames[60], "RightEyeRoll");
}

TEST(LiveLinkFace, RatesOfFilmAndEmptyNames) {
  Made made;
  made.device = made.subject = "";
  made.rate = 30000;
  made.denominator = 1001;
  made.frame = 300;
  made.part = 0;
  LiveLinkPacket packet;
  ASSERT_EQ(decode(made.bytes(), packet), nullptr);
  EXPECT_DOUBLE_EQ(packet.seconds, 10.01);
}

TEST(LiveLinkFace, EveryBeginningOfAPacketIsRefusedAndSoIsMore) {
  const std::string whole = Made().bytes();
  LiveLinkPacket packet;
  for (size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(decode(whole.substr(0, size), packet), nullptr) << size;
  }
  EXPECT_NE(decode(whole + '\0', packet), nullptr);
  EXPECT_NE(decode_live_link(nullptr, 0, packet), nullptr);
}

TEST(LiveLinkFace, NumbersOutOfRangeAreRefused) {
  const auto refused = [](auto change) {
    Made made;
    change(made);
    return is_refused(made);
  };
  EXPECT_FALSE(refused([](Made&) {}));
  EXPECT_TRUE(refused([](Made& m) { m.version = 5; }));
  EXPECT_TRUE(refused([](Made& m) { m.count = 60; }));
  EXPECT_TRUE(refused([](Made& m) { m.count = 255; }));
  EXPECT_TRUE(refused([](Made& m) { m.frame = 0x80000000u; }));
  for (float part : {-0.1f, 1.5f, NAN, INFINITY}) {
    EXPECT_TRUE(refused([part](Made& m) { m.part = part; }));
  }
  for (uint32_t rate : {0u, 1001u, 0x80000000u, 0xFFFFFFFFu}) {
    EXPECT_TRUE(refused([rate](Made& m) { m.rate = rate; })) << rate;
  }
  for (uint32_t denominator : {0u, 61u, 0xFFFFFFFFu}) {
    EXPECT_TRUE(refused([denominator](Made& m) { m.denominator = denominator; })) << denominator;
  }
  for (float value : {NAN, INFINITY, -INFINITY}) {
    EXPECT_TRUE(refused([value](Made& m) { m.first = value; }));
  }
  EXPECT_TRUE(refused([](Made& m) { m.device = std::string(256, 'x'); }));
  EXPECT_FALSE(refused([](Made& m) { m.device = std::string(255, 'x'); }));
}

TEST(LiveLinkFace, SizesOfNamesThatLieAreRefused) {
  for (uint32_t size : {15u, 17u, 300u, 0x7FFFFFFFu, 0x80000000u, 0xFFFFFFFFu}) {
    std::string bytes = Made().bytes(), head;
    put(head, size);
    LiveLinkPacket packet;
    EXPECT_NE(decode(bytes.replace(1, 4, head), packet), nullptr) << size;
  }
}

}  // namespace
}  // namespace mien::live
