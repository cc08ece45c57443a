// SPDX-License-Identifier: MIT
#include "integrations/program/live/landmark_packet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace mien::live {
namespace {

std::string decode(const LandmarkNames& names, const std::string& text, LandmarkPacket& packet) {
  // A copy of exactly that size, so that a read past its end is seen.
  const std::vector<uint8_t> bytes(text.begin(), text.end());
  return LandmarkDecoder(names).decode(bytes.data(), bytes.size(), packet);
}

const LandmarkNames kThree = {{"0", "2", "chin"}, 3, false};
const LandmarkNames kImages = {{"0", "1"}, 2, false};

TEST(LandmarkPacket, OfEachForm) {
  for (const char* text :
       {R"([[1,2,3],[7,7,7],[4,5,6]])", R"({"landmarks":[[1,2,3],null,[4,5,6]],"face":1})",
        R"({"landmarks":[{"x":1,"y":2,"z":3,"visibility":0.5},{},{"x":4,"y":5,"z":6}]})",
        R"({"landmarks":{"2":[4,5,6],"0":{"z":3,"y":2,"x":1}}})"}) {
    LandmarkPacket packet;
    ASSERT_EQ(decode(kThree, text, packet), "") << text;
    EXPECT_EQ(packet.present, 2u) << text;
    EXPECT_EQ(std::vector<float>(packet.values.begin(), packet.values.begin() + 6),
              (std::vector<float>{1, 2, 3, 4, 5, 6}))
        << text;
    EXPECT_TRUE(std::isnan(packet.values[6])) << "the chin is missing";
    EXPECT_LT(packet.seconds, 0);
  }
}

TEST(LandmarkPacket, TimeAndUnknownLandmarks) {
  LandmarkPacket packet;
  ASSERT_EQ(
      decode(kThree, R"({"time":1790000000.25,"landmarks":{"chin":[1,2,3],"ear":"?"}})", packet),
      "");
  EXPECT_EQ(packet.seconds, 1790000000.25);
  EXPECT_EQ(packet.unknown, 1u);
  EXPECT_EQ(packet.values[7], 2);
}

TEST(LandmarkPacket, MissingOnes) {
  LandmarkPacket packet;
  ASSERT_EQ(decode(kThree, R"([[1,NaN,3],[],{"x":1,"y":2,"z":NaN}])", packet), "");
  EXPECT_EQ(packet.present, 0u);
  for (const float v : packet.values) EXPECT_TRUE(std::isnan(v));
  for (const char* text : {"[]", "null", "{\"landmarks\":null}", "{\"landmarks\":{}}", "NaN"}) {
    EXPECT_EQ(decode(kThree, text, packet), "") << text;
    EXPECT_EQ(packet.present, 0u) << text;
  }
  const LandmarkNames odd = {{"NaN", "a\"NaN\\"}, 2, false};
  ASSERT_EQ(decode(odd, R"({"landmarks":{"NaN":[1,2],"a\"NaN\\":[3,4]}})", packet), "");
  EXPECT_EQ(packet.values, (std::vector<float>{1, 2, 3, 4})) << "names are not numbers";
}

TEST(LandmarkPacket, PicturesAndTheirEdges) {
  LandmarkPacket packet;
  ASSERT_EQ(decode(kImages, R"({"size":[200,100],"landmarks":[[0.5,0.25,9],[1,0]]})", packet), "");
  EXPECT_EQ(packet.values, (std::vector<float>{100, 25, 200, 0}));
  ASSERT_EQ(decode(kImages, R"({"size":[200,100],"landmarks":[[1.01,0.5],[0.5,-0.01]]})", packet),
            "");
  EXPECT_EQ(packet.present, 0u) << "outside of the picture";
  ASSERT_EQ(decode(kImages, R"([[300.5,-20],[0,0]])", packet), "");
  EXPECT_EQ(packet.values[0], 300.5f) << "pixels";
  LandmarkNames sized = kImages;
  sized.needs_size = true;
  EXPECT_NE(decode(sized, "[[1,2],[3,4]]", packet), "");
  EXPECT_EQ(decode(sized, "[]", packet), "") << "no face needs no size";
}

TEST(LandmarkPacket, SaysWhatIsWrong) {
  const std::pair<const char*, const char*> wrong[] = {
      {"", "JSON"},
      {"[[1,2,3]", "JSON"},
      {"[1,2,3]x", "JSON"},
      {"\xff\xfe", "JSON"},
      {"17", "neither"},
      {"{\"landmarks\":\"x\"}", "neither"},
      {"{\"points\":[]}", "no \"landmarks\""},
      {"[[1,2,3],[1,2,3]]", "2 landmarks"},
      {"[[1,2],0,[1,2,3]]", "[x, y, z]"},
      {"[[1,2,3,4],0,[1,2,3]]", "[x, y, z]"},
      {"[7,0,[1,2,3]]", "[x, y, z]"},
      {R"([{"x":1,"y":2},0,[1,2,3]])", "lacks"},
      {R"([[1,2,"3"],0,[1,2,3]])", "no number"},
      {"[[1,2,1e7],0,[1,2,3]]", "a million"},
      {"[[1,2,1e999],0,[1,2,3]]", "JSON"},
      {"[[1,2,Infinity],0,[1,2,3]]", "JSON"},
      {R"({"time":-1,"landmarks":[]})", "time"},
      {R"({"time":"now","landmarks":[]})", "time"},
      {R"({"time":1e11,"landmarks":[]})", "time"},
      {R"({"size":[0,1],"landmarks":[]})", "size"},
      {R"({"size":[1],"landmarks":[]})", "size"},
      {R"({"size":1,"landmarks":[]})", "size"},
      {R"({"landmarks":{"ear":[1,2,3]}})", "none of its landmarks"},
  };
  for (const auto& [text, says] : wrong) {
    LandmarkPacket packet;
    EXPECT_NE(decode(kThree, text, packet).find(says), std::string::npos)
        << text << ": " << decode(kThree, text, packet);
  }
  LandmarkPacket packet;
  EXPECT_NE(decode({{"chin"}, 3, false}, "[[1,2,3]]", packet), "") << "a list has numbers only";
}

/// Deep, long and damaged ones end with a result or a reason, and numbers are finite or missing.
TEST(LandmarkPacket, AnyBytes) {
  std::mt19937 random(5);
  std::string good = R"({"time":1.5,"size":[640,480],"landmarks":[[0.25,0.5],{"x":0.75,"y":NaN}]})";
  std::vector<std::string> texts = {std::string(65507, '['), std::string(65507, '"'),
                                    std::string(65507, '\\')};
  std::string repeated;
  while (repeated.size() < 65500) repeated += "NaN";
  texts.push_back(repeated);
  for (int i = 0; i < 20000; ++i) {
    std::string text = good;
    for (unsigned k = random() % 4 + 1; k-- > 0;) {
      const size_t at = random() % text.size();
      switch (random() % 3) {
        case 0: text[at] = static_cast<char>(random()); break;
        case 1: text[at] = "[]{},:\"1eN-."[random() % 12]; break;
        default: text.erase(at, random() % 5); break;
      }
      if (text.empty()) text = "[";
    }
    texts.push_back(text);
  }
  size_t decoded = 0;
  for (const std::string& text : texts) {
    LandmarkPacket packet;
    if (!decode(kImages, text, packet).empty()) continue;
    ++decoded;
    ASSERT_EQ(packet.values.size(), 4u);
    ASSERT_LE(packet.present, 2u);
    for (const float v : packet.values) ASSERT_TRUE(std::isnan(v) || std::fabs(v) <= 1e6f) << text;
  }
  EXPECT_GT(decoded, 100u) << "some are still packets";
}

}  // namespace
}  // namespace mien::live
