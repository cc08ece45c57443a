// SPDX-License-Identifier: MIT
#include "integrations/program/commands/render_output.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "integrations/program/commands/options.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/output.h"
#include "integrations/program/render/png.h"

namespace mien::cli {

namespace {

using render::Backdrop;
using render::Image;
using render::Size;
using render::View;

constexpr int kLongestSide = 4096;

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
  float min, max;
};
constexpr Range kCameraNumbers[] = {
    {"yaw", -360, 360}, {"pitch", -90, 90}, {"zoom", 0.1f, 20}, {"field of view", 2, 90}};

float parse_camera_number(const std::string& camera, const std::string& word, const Range& range) {
  char* end = nullptr;
  const float value = std::strtof(word.c_str(), &end);
  const bool whole = !word.empty() && end == word.c_str() + word.size();
  if (whole && value >= range.min && value <= range.max) return value;
  char numbers[64];
  std::snprintf(numbers, sizeof(numbers), "%g to %g", double{range.min}, double{range.max});
  fail_usage("--camera \"" + camera + "\"",
             std::string(range.name) + " \"" + word + "\" is not a number from " + numbers,
             "give a name such as front, or YAW,PITCH[,ZOOM[,FIELD]]");
}

/// "%d", "%4d" or "%04d" in a name: position and length of it, and width of the number.
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
    fail_usage("-o " + output, "% stands for the number of an image, once, as %d or %04d",
               "write it as out-%04d.png");
  }
  place.length = at + 1 - place.begin;
  return place;
}

}  // namespace

void add_scene_options(CLI::App& app, SceneArguments& arguments) {
  app.add_option("RIG", arguments.rig,
                 "DNA file with geometry, or baked file; - reads standard input")
      ->type_name("")
      ->required();
  app.add_option("--lod", arguments.lod, "LOD to show (default: 0, the finest)")->type_name("N");
  app.add_option(
         "--meshes", arguments.meshes,
         "Only these meshes, for example head*,teeth* (default: all except\nthose that need "
         "textures: eye shells, lashes, saliva)")
      ->type_name("PATTERN");
}

PosedSceneOptions parse_scene_options(const SceneArguments& arguments) {
  PosedSceneOptions options;
  options.rig = arguments.rig;
  options.lod = parse_lod(arguments.lod, false);
  options.meshes = arguments.meshes;
  return options;
}

void add_camera_options(CLI::App& app, RenderOutputOptions& options, const std::string& group) {
  CLI::Option* const all[] = {
      app.add_option("--camera", options.camera,
                     "front (default), three-quarter, three-quarter-right, side,\n"
                     "side-right, back, above, below; or YAW,PITCH[,ZOOM[,FIELD]] in\n"
                     "degrees: yaw 90 sees the left side, pitch 90 looks down")
          ->type_name("VIEW"),
      app.add_option("--target", options.target,
                     "What to look at: face, eyes, mouth, or a pattern of mesh or\n"
                     "joint names such as *lip* (default: everything; for sheets and\n"
                     "strips the face)")
          ->type_name("NAME"),
      app.add_option("--size", options.size, "Size of an image in pixels, such as 640x480 or 640")
          ->type_name("WxH"),
      app.add_option("--background", options.background, "dark (default) or light")
          ->type_name("NAME"),
      app.add_option("--samples", options.samples, "Samples per pixel: 1, 4 (default) or 16")
          ->type_name("N"),
  };
  if (group.empty()) return;
  for (CLI::Option* option : all) option->group(group);
}

void add_render_output_options(CLI::App& app, RenderOutputOptions& options,
                               const std::string& output_text) {
  add_output_options(app, options.output, output_text, "OUT.png");
  add_camera_options(app, options);
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

render::RenderOptions parse_render_options(const RenderOutputOptions& options, Size size) {
  render::RenderOptions render;
  render.width = size.width;
  render.height = size.height;
  render.samples =
      std::atoi(option_words("--samples")[parse_word("--samples", options.samples)].c_str());
  render.backdrop = kBackdrops[parse_word("--background", options.background)];
  return render;
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

void require_png_name(const std::string& output) {
  std::string ending = std::filesystem::path(output).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending.empty() || ending == ".png") return;
  fail_usage("-o " + output, "images are PNG files", "let the name end in .png");
}

uint64_t write_png(const std::string& path, const Image& image) {
  Output output(path);
  output.write(render::to_png(image));
  output.commit();
  return output.size();
}

render::Sheet make_sheet(const render::SheetLayout& layout, const Backdrop& backdrop) {
  if (!layout.fits()) {
    fail_usage(
        "--size " + std::to_string(layout.tile.width) + "x" + std::to_string(layout.tile.height),
        std::to_string(layout.count) + " images side by side would be " +
            std::to_string(layout.width()) + "x" + std::to_string(layout.height()) + " pixels",
        "use a smaller --size, or write one file per image with %04d in the name");
  }
  return {layout, backdrop};
}

}  // namespace mien::cli
