// SPDX-License-Identifier: MIT
// Pictures as pixels and files, and the text in them.
#include "integrations/program/render/image.h"

#include <gtest/gtest.h>
#include <png.h>

#include "integrations/program/render/hair_texture.h"
#include "integrations/program/render/label.h"
#include "integrations/program/render/png.h"
#include "integrations/program/render/texture.h"

namespace mien::render {
namespace {

using namespace math;

Image gradient(int width, int height) {
  Image image(width, height, {});
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.set(x, y, {uint8_t(x * 7), uint8_t(y * 5), uint8_t(x ^ y)});
    }
  }
  return image;
}

Image decode(const std::string& bytes) {
  png_image head{};
  head.version = PNG_IMAGE_VERSION;
  Image image;
  if (!png_image_begin_read_from_memory(&head, bytes.data(), bytes.size())) return image;
  EXPECT_EQ(head.format & PNG_FORMAT_FLAG_ALPHA, 0u);
  head.format = PNG_FORMAT_RGB;
  image = Image(int(head.width), int(head.height), {});
  EXPECT_TRUE(png_image_finish_read(&head, nullptr, image.pixels.data(), 0, nullptr));
  return image;
}

TEST(Png, ComesBackAsItWas) {
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 200}, {640, 7}, {97, 101}}) {
    const Image image = gradient(width, height);
    const std::string bytes = to_png(image);
    EXPECT_EQ(bytes.compare(1, 3, "PNG"), 0);
    const Image back = decode(bytes);
    EXPECT_EQ(back.width, width);
    EXPECT_EQ(back.height, height);
    EXPECT_EQ(back.pixels, image.pixels);
    EXPECT_EQ(to_png(image), bytes);
  }
}

TEST(Png, GrayAndAlphaComeBackAsTheyWere) {
  const Image gray(3, 2, {90, 90, 90});
  const std::vector<uint8_t> alpha = {0, 1, 2, 128, 254, 255};
  std::vector<uint8_t> back_alpha;
  const Image back = read_png(to_gray_png(gray, alpha), back_alpha);
  EXPECT_EQ(back.pixels, gray.pixels);
  EXPECT_EQ(back_alpha, alpha);
}

TEST(Png, GrayComesBackAsItWas) {
  const Image gray(5, 3, {17, 17, 17});
  std::vector<uint8_t> alpha = {1};
  const Image back = read_png(to_gray_png(gray, {}), alpha);
  EXPECT_EQ(back.pixels, gray.pixels);
  EXPECT_TRUE(alpha.empty());
}

TEST(Png, ErrorsAreInTheWordsOfTheLibrary) {
  try {
    to_png(Image());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("libpng: ", 0), 0u) << error.what();
  }
}

/// Share of a part of the texture, in pixels from the lower left corner, that is opaque.
double covered(const HairMap& map, int left, int low, int width, int height) {
  int opaque = 0;
  for (int y = low; y < low + height; ++y) {
    for (int x = left; x < left + width; ++x) {
      const int row = map.gray.height - 1 - y;
      opaque += map.alpha[size_t(row * map.gray.width + x)] >= 102;
    }
  }
  return double(opaque) / (width * height);
}

TEST(HairMap, HairsTaperAndStayInTheirLanes) {
  const HairMap map = make_hair_map();
  ASSERT_EQ(map.gray.width, 512);
  ASSERT_EQ(map.gray.height, 640);
  EXPECT_EQ(make_hair_map().alpha, map.alpha);
  // Of the line: thinner at the roots than in the middle; thin and loose hairs: skin shows between them.
  EXPECT_LT(covered(map, 320, 384, 64, 30), 0.6 * covered(map, 320, 480, 64, 60));
  EXPECT_LT(covered(map, 384, 384, 64, 256), 0.4);
  EXPECT_LT(covered(map, 448, 384, 64, 256), 0.3);
  for (int lane = 0; lane < 5;
       ++lane) {  // locks: full from the root to the middle, thin at the tips
    EXPECT_GT(covered(map, 64 * lane + 16, 420, 32, 60), 0.8) << lane;
    EXPECT_LT(covered(map, 64 * lane, 620, 64, 20), 0.35) << lane;
  }
  EXPECT_LT(covered(map, 0, 128, 256, 24), 0.5 * covered(map, 0, 256, 256, 128));
  for (int lane = 0; lane < 16; ++lane) {  // lashes, brows, lashes
    const bool lash = lane < 4 || lane >= 12;
    const double root = covered(map, 32 * lane, lash ? 0 : 40, 32, 24);
    EXPECT_GT(root, 0.2) << lane;
    EXPECT_LT(root, 0.8) << lane;
    EXPECT_LT(covered(map, 32 * lane, 116, 32, 12), 0.15) << lane;
  }
}

TEST(Color, EncodesWhatItDecodes) {
  for (int i = 0; i < 256; ++i) {
    const Color color = {uint8_t(i), uint8_t(255 - i), 128};
    EXPECT_EQ(to_srgb(to_linear(color)), color) << i;
  }
  EXPECT_NEAR(to_linear({188, 0, 0}).x, 0.5f, 0.005f);  // half the light is 188, not 128
  EXPECT_EQ(to_srgb({-1, 7, std::nanf("")}), (Color{0, 255, 0}));
}

TEST(Image, PartsOutsideAreCutOff) {
  Image image(8, 8, {1, 2, 3});
  image.paste(gradient(6, 6), -3, 5);
  EXPECT_EQ(image.at(0, 5), gradient(6, 6).at(3, 0));
  EXPECT_EQ(image.at(3, 5), (Color{1, 2, 3}));
  image.paste(gradient(6, 6), 100, 100);
  image.paste(gradient(6, 6), -100, 0);
  image.fill(6, 6, 50, 50, {9, 9, 9});
  EXPECT_EQ(image.at(7, 7), (Color{9, 9, 9}));
  image.blend(-1, 0, {}, 1);
  image.blend(8, 8, {}, 1);
  image.blend(0, 0, {255, 255, 255}, 1);
  EXPECT_EQ(image.at(0, 0), (Color{255, 255, 255}));
}

/// Columns from the first to the last one with ink.
std::pair<int, int> inked(const Image& image, Color paper) {
  std::pair<int, int> columns = {image.width, -1};
  for (int x = 0; x < image.width; ++x) {
    for (int y = 0; y < image.height; ++y) {
      if (image.at(x, y) == paper) continue;
      columns.first = std::min(columns.first, x);
      columns.second = x;
    }
  }
  return columns;
}

TEST(Label, DrawsEveryCharacterWithinItsWidth) {
  const Color paper = {20, 20, 20};
  for (char c = '!'; c <= '~'; ++c) {
    for (const float size : {9.0f, 14.0f, 40.0f}) {
      const std::string text(1, c);
      Image image(80, 80, paper);
      draw_text(image, 20, 50, text, size, {255, 255, 255});
      const auto [left, right] = inked(image, paper);
      ASSERT_LE(left, right) << c << " shows nothing";
      const int slack = 1 + int(size * 0.06f + 1);
      EXPECT_GE(left, 20 - slack) << c;
      EXPECT_LE(right, int(20 + text_width(text, size)) + slack) << c;
    }
  }
}

TEST(Label, CharactersDiffer) {
  std::vector<std::vector<uint8_t>> pictures;
  for (char c = '!'; c <= '~'; ++c) {
    Image image(40, 40, {});
    draw_text(image, 8, 28, std::string(1, c), 24, {255, 255, 255});
    for (const auto& other : pictures) EXPECT_NE(image.pixels, other) << c;
    pictures.push_back(image.pixels);
  }
}

// A box is 4 by 10 units of 0.07 of the size: 28 by 70 pixels at size 100.
TEST(Label, CharactersWithoutAGlyphAreBoxes) {
  const Color paper = {}, ink = {255, 255, 255};
  const auto drawn = [&](const char* text) {
    Image image(80, 90, paper);
    draw_text(image, 10, 80, text, 100, ink);
    return image;
  };
  const Image box = drawn("\xc3\xa4");
  for (int x = 10; x <= 38; x += 7) {
    EXPECT_EQ(box.at(x, 80), ink) << x;
    EXPECT_EQ(box.at(x, 10), ink) << x;
  }
  for (int y = 10; y <= 80; y += 10) {
    EXPECT_EQ(box.at(10, y), ink) << y;
    EXPECT_EQ(box.at(38, y), ink) << y;
  }
  for (int y = 20; y <= 70; y += 10) {
    for (int x = 17; x <= 31; x += 7) EXPECT_EQ(box.at(x, y), paper) << x << ", " << y;
    EXPECT_EQ(box.at(50, y), paper) << y;
  }
  // One for each character and for each byte that is none.
  for (const char* text :
       {"\xe2\x82\xac", "\xf0\x9f\x98\x80", "\xff", "\x80", "\t", "\n", "\x7f"}) {
    EXPECT_EQ(drawn(text).pixels, box.pixels) << text;
  }
  for (const char* text : {"\xc3\xa4\xe2\x82\xac", "\xff\xfe", "\t\n"}) {
    EXPECT_FLOAT_EQ(text_width(text, 100), (4 + 2.5f + 4) * 7) << text;
  }
  EXPECT_EQ(text_width("", 20), 0);
}

TEST(Label, TextIsCutOffAtTheEdges) {
  const Color paper = {1, 2, 3}, ink = {255, 255, 255};
  Image image(30, 12, paper);
  draw_text(image, 25, 40, "below", 20, ink);
  draw_text(image, 31.5f, 8, "right", 20, ink);
  draw_text(image, -200, 8, "left", 20, ink);
  EXPECT_EQ(image.pixels, Image(30, 12, paper).pixels);

  // What is inside is the same as in the middle of a larger image.
  Image larger(230, 112, paper);
  draw_text(larger, 90, 54, "\xc3\xa4 across all edges", 20, ink);
  draw_text(image, -10, 4, "\xc3\xa4 across all edges", 20, ink);
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 30; ++x) EXPECT_EQ(image.at(x, y), larger.at(x + 100, y + 50));
  }
}

TEST(Label, LongNamesKeepBothEnds) {
  const std::string name = "CTRL_expressions.mouthCornerPullLeft";
  EXPECT_EQ(fit_text(name, 12, 1000), name);
  const std::string fitted = fit_text(name, 12, 100);
  EXPECT_LE(text_width(fitted, 12), 100);
  EXPECT_GT(text_width(fitted, 12), 80);
  EXPECT_EQ(fitted.compare(0, 3, "CTR"), 0);
  EXPECT_EQ(fitted.substr(fitted.size() - 4), "Left");
  EXPECT_EQ(fit_text(name, 12, 0), "..");
  EXPECT_EQ(fit_text("", 12, 10), "");
  // A character of several bytes is kept whole or not at all.
  const std::string euros =
      "\xe2\x82\xac\xe2\x82\xac\xe2\x82\xac\xe2\x82\xac\xe2\x82\xac\xe2\x82\xac";
  const std::string cut = fit_text(euros, 12, text_width(euros, 12) * 0.7f);
  EXPECT_EQ((cut.size() - 2) % 3, 0u);
}

}  // namespace
}  // namespace mien::render
