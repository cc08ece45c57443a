// SPDX-License-Identifier: MIT
#include "integrations/cli/pictures.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "integrations/cli/names.h"
#include "integrations/cli/options.h"
#include "integrations/cli/output.h"
#include "integrations/picture/label.h"
#include "integrations/picture/png.h"

namespace mien::cli {

namespace {

using picture::Backdrop;
using picture::Camera;
using picture::Color;
using picture::Image;
using picture::View;

constexpr int kLongestSide = 4096;
constexpr uint64_t kLargestSheet = uint64_t{1} << 27;  // pixels

constexpr float kField = 22;
// In the order of the words of --camera.
constexpr View kViews[] = {
    {0, 0, kField, 1},   {35, 4, kField, 1},  {-35, 4, kField, 1}, {90, 0, kField, 1},
    {-90, 0, kField, 1}, {180, 0, kField, 1}, {0, 40, kField, 1},  {0, -35, kField, 1},
};

constexpr Backdrop kBackdrops[] = {{{92, 97, 104}, {38, 41, 46}},
                                   {{250, 250, 249}, {206, 209, 213}}};

struct Range {
  const char* name;
  float least, most;
};
constexpr Range kCameraNumbers[] = {
    {"yaw", -360, 360}, {"pitch", -90, 90}, {"zoom", 0.1f, 20}, {"field of view", 2, 90}};

float parse_camera_number(const std::string& camera, const std::string& word, const Range& range) {
  char* end = nullptr;
  const float value = std::strtof(word.c_str(), &end);
  const bool whole = !word.empty() && end == word.c_str() + word.size();
  if (whole && value >= range.least && value <= range.most) return value;
  fail_usage("--camera \"" + camera + "\"",
             std::string(range.name) + " \"" + word + "\" is not a number from " +
                 std::to_string(static_cast<int>(range.least)) + " to " +
                 std::to_string(static_cast<int>(range.most)),
             "write a name, as front, or YAW,PITCH[,ZOOM[,FIELD]]");
}

/// "%d", "%4d" or "%04d" within a name: where it begins, its length, and how wide it is.
struct NumberPlace {
  size_t begin = std::string::npos, length = 0, width = 0;
  bool zeros = false;
};

NumberPlace find_number(const std::string& output) {
  NumberPlace place;
  place.begin = output.find('%');
  if (place.begin == std::string::npos) return place;
  size_t at = place.begin + 1;
  place.zeros = at < output.size() && output[at] == '0';
  while (at < output.size() && output[at] >= '0' && output[at] <= '9' && place.width < 100) {
    place.width = place.width * 10 + static_cast<size_t>(output[at++] - '0');
  }
  const bool good = at < output.size() && output[at] == 'd' && place.width <= 20 &&
                    output.find('%', at) == std::string::npos;
  if (!good) {
    fail_usage("-o " + output, "a % stands for the number of a picture, once, as %d or %04d",
               "write it as out-%04d.png");
  }
  place.length = at + 1 - place.begin;
  return place;
}

}  // namespace

void add_picture_options(CLI::App& app, PictureOptions& options, const std::string& output_text) {
  app.add_option("-o,--output", options.output, output_text)->type_name("OUT.png");
  app.add_option("--camera", options.camera,
                 "front (default), three-quarter, three-quarter-right, side,\n"
                 "side-right, back, above, below; or YAW,PITCH[,ZOOM[,FIELD]] in\n"
                 "degrees: yaw 90 sees the left side, pitch 90 looks down")
      ->type_name("VIEW");
  app.add_option("--target", options.target,
                 "What to look at: face, eyes, mouth, or a pattern of mesh or\n"
                 "joint names, as *lip* (default: everything; of sheets: the face)")
      ->type_name("NAME");
  app.add_option("--size", options.size, "Pixels of one picture, as 640x640 or 640")
      ->type_name("WxH");
  app.add_option("--background", options.background, "dark (default) or light")->type_name("NAME");
  app.add_option("--samples", options.samples, "Samples per pixel: 1, 4 (default) or 16")
      ->type_name("N");
}

View parse_camera(const std::string& text) {
  const Words& words = option_words("--camera");
  const auto found = std::find(words.begin(), words.end(), text);
  if (found != words.end()) return kViews[found - words.begin()];
  const bool numeric =
      !text.empty() && text.find_first_not_of("0123456789+-.,eE") == std::string::npos;
  if (!numeric) {
    fail_usage("--camera \"" + text + "\"", "neither YAW,PITCH nor one of " + list_of(words, "and"),
               nearest_question(text, words, "choose one of them, or two numbers"));
  }

  float numbers[] = {0, 0, 1, kField};
  size_t count = 0;
  for (size_t begin = 0; begin <= text.size(); ++count) {
    const size_t comma = std::min(text.find(',', begin), text.size());
    if (count == 4) {
      fail_usage("--camera \"" + text + "\"", "more than four numbers",
                 "write YAW,PITCH[,ZOOM[,FIELD]]");
    }
    numbers[count] =
        parse_camera_number(text, text.substr(begin, comma - begin), kCameraNumbers[count]);
    begin = comma + 1;
  }
  if (count < 2) {
    fail_usage("--camera \"" + text + "\"", "one number is not enough",
               "write YAW,PITCH[,ZOOM[,FIELD]]");
  }
  return {numbers[0], numbers[1], numbers[3], numbers[2]};
}

Size parse_size(const std::string& text, Size otherwise) {
  if (text.empty()) return otherwise;
  const size_t by = text.find('x');
  const std::string width = text.substr(0, by);
  const std::string height = by == std::string::npos ? width : text.substr(by + 1);
  const auto side = [&](const std::string& word) {
    const bool digits = !word.empty() && word.size() < 6 &&
                        word.find_first_not_of("0123456789") == std::string::npos;
    const int pixels = digits ? std::atoi(word.c_str()) : 0;
    if (pixels >= 8 && pixels <= kLongestSide) return pixels;
    fail_usage("--size \"" + text + "\"",
               "a side is a whole number of pixels from 8 to " + std::to_string(kLongestSide),
               "write it as 640x480");
  };
  return {side(width), side(height)};
}

picture::RenderOptions parse_render_options(const PictureOptions& options, Size size) {
  picture::RenderOptions render;
  render.width = size.width;
  render.height = size.height;
  render.samples =
      std::atoi(option_words("--samples")[parse_word("--samples", options.samples)].c_str());
  render.backdrop = kBackdrops[parse_word("--background", options.background)];
  return render;
}

Camera aim(const Subject& subject, const std::string& target, const View& view, Size size) {
  return frame_points(subject.stand, view, find_target(subject, target), size.width, size.height);
}

bool is_numbered(const std::string& output) {
  return find_number(output).begin != std::string::npos;
}

std::string numbered(const std::string& output, size_t number) {
  const NumberPlace place = find_number(output);
  std::string digits = std::to_string(number);
  while (digits.size() < place.width) digits.insert(0, place.zeros ? "0" : " ");
  return std::string(output).replace(place.begin, place.length, digits);
}

void write_picture(const std::string& path, const Image& image) {
  Output output(path);
  output.write(picture::to_png(image));
  output.commit();
}

void check_picture_output(const std::string& path, const Session& session) {
  if (path == "-" && session.terminal.out_is_terminal) {
    fail_usage("-o -", "a picture is not for a terminal", "name a file, or pipe the output");
  }
}

Sheet::Sheet(size_t count, size_t columns, Size tile, const Backdrop& backdrop, bool labels)
    : columns_(std::min(columns, count)), tile_(tile),
      text_size_(std::clamp(static_cast<float>(tile.width) / 15, 9.0f, 26.0f)),
      label_height_(labels ? static_cast<int>(text_size_ * 1.7f) : 0) {
  const uint64_t rows = (count + columns_ - 1) / columns_;
  const uint64_t width = columns_ * static_cast<uint64_t>(tile.width + kGap) + kGap;
  const uint64_t height = rows * static_cast<uint64_t>(tile.height + label_height_ + kGap) + kGap;
  if (width * height > kLargestSheet || width > 65535 || height > 65535) {
    fail_usage("--size " + std::to_string(tile.width) + "x" + std::to_string(tile.height),
               std::to_string(count) + " pictures side by side would be " + std::to_string(width) +
                   "x" + std::to_string(height) + " pixels",
               "take a smaller --size, or write single files with a %04d in their name");
  }
  // The page is a little darker than the darkest of the tiles, or as light as the lightest.
  const bool dark = backdrop.edge.g < 128;
  const Color page = dark ? Color{24, 26, 29} : Color{255, 255, 255};
  text_ = dark ? Color{214, 216, 218} : Color{40, 42, 46};
  image_ = Image(static_cast<int>(width), static_cast<int>(height), page);
}

void Sheet::add(const Image& tile, const std::string& label) {
  const int column = static_cast<int>(added_ % columns_), row = static_cast<int>(added_ / columns_);
  ++added_;
  const int x = kGap + column * (tile_.width + kGap);
  const int y = kGap + row * (tile_.height + label_height_ + kGap);
  image_.paste(tile, x, y);
  if (label_height_ == 0) return;
  const auto width = static_cast<float>(tile_.width);
  const std::string text = picture::fit_text(label, text_size_, width - 4);
  const float left = static_cast<float>(x) + (width - picture::text_width(text, text_size_)) / 2;
  const float baseline = static_cast<float>(y + tile_.height) + text_size_ * 1.18f;
  picture::draw_text(image_, left, baseline, text, text_size_, text_);
}

}  // namespace mien::cli
