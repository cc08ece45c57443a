// SPDX-License-Identifier: MIT
// CLIP on the command line.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "integrations/program/io/handles.h"

namespace mien::cli {

struct ClipFile {
  std::string shown;  // path, or "standard input"
  std::string bytes;  // of a stream, which the clip points into
  Clip clip;
  MienClipInfo info;
};

/// `path` may be "-".
ClipFile open_clip_file(const std::string& path);

std::vector<std::string> channel_names(const ClipFile& file);

/// Calls `use` with the number of each frame and its values.
void for_each_frame(const ClipFile& file,
                    const std::function<void(uint32_t frame, const float* values)>& use);

}  // namespace mien::cli
