// SPDX-License-Identifier: MIT
// From a posed subject to files: cameras by name, pictures one by one, or side by side on a sheet.
#pragma once

#include <string>
#include <vector>

#include "integrations/cli/subject.h"
#include "integrations/picture/image.h"

namespace mien::cli {

/// As they were typed.
struct PictureOptions {
  std::string output, camera = "front", target, size, background = "dark", samples = "4";
};

struct Size {
  int width = 0, height = 0;
};

/// --camera, --target, --size, --background, --samples and -o.
void add_picture_options(CLI::App& app, PictureOptions& options, const std::string& output_text);

/// "front", or "30,10" (yaw, pitch) and optionally zoom and field of view.
picture::View parse_camera(const std::string& text);

/// "640x480" or "640"; `otherwise` if it is empty.
Size parse_size(const std::string& text, Size otherwise);

picture::RenderOptions parse_render_options(const PictureOptions& options, Size size);

/// The camera of all pictures of a subject that stands still, by its neutral shape.
picture::Camera aim(const Subject& subject, const std::string& target, const picture::View& view,
                    Size size);

/// The file name with the number in place of "%d" or "%04d"; a name without one is a single file.
bool is_numbered(const std::string& output);
std::string numbered(const std::string& output, size_t number);

void write_picture(const std::string& path, const picture::Image& image);

/// Refuses what a person at a terminal could not read, and names that cannot be.
void check_picture_output(const std::string& path, const Session& session);

/// Tiles with labels under them, row by row.
class Sheet {
 public:
  /// Fails if the sheet would be larger than is good for anybody.
  Sheet(size_t count, size_t columns, Size tile, const picture::Backdrop& backdrop, bool labels);

  void add(const picture::Image& tile, const std::string& label);
  const picture::Image& image() const { return image_; }

  static constexpr int kGap = 6;

 private:
  size_t columns_, added_ = 0;
  Size tile_;
  float text_size_;
  int label_height_;
  picture::Color text_;
  picture::Image image_;
};

}  // namespace mien::cli
