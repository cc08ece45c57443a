// SPDX-License-Identifier: MIT
#include "integrations/program/io/clip_file.h"

#include <algorithm>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/input.h"

namespace mien::cli {

namespace {

constexpr uint32_t kFramesAtOnce = 1024;

}  // namespace

ClipFile open_clip_file(const std::string& path) {
  constexpr const char* kCannot = "cannot open clip";
  ClipFile file;
  file.shown = shown_name(path);
  auto error = sized<MienError>();
  MienClip* clip = nullptr;
  MienStatus status;
  if (is_stream(path)) {
    file.bytes = read_clip_stream(path);
    // Short strings lie in the object itself, which is going to move.
    file.bytes.reserve(64);
    status = mien_clip_open_memory(file.bytes.data(), file.bytes.size(), nullptr, &clip, &error);
  } else {
    status = mien_clip_open_file(path.c_str(), nullptr, &clip, &error);
  }
  check(status, &error, kCannot, file.shown);
  file.clip.reset(clip);
  file.info = sized<MienClipInfo>();
  check(mien_clip_info(clip, &file.info), nullptr, kCannot, file.shown);
  return file;
}

std::vector<std::string> channel_names(const ClipFile& file) {
  std::vector<std::string> names;
  for (uint32_t c = 0; c < file.info.channel_count; ++c) {
    auto channel = sized<MienClipChannel>();
    check(mien_clip_channel(file.clip.get(), c, &channel), nullptr, "cannot read clip", file.shown);
    names.push_back(to_string(channel.name));
  }
  return names;
}

void for_each_frame(const ClipFile& file,
                    const std::function<void(uint32_t frame, const float* values)>& use) {
  const size_t channels = file.info.channel_count;
  std::vector<float> values(channels * std::min(kFramesAtOnce, file.info.frame_count));
  for (uint32_t first = 0; first < file.info.frame_count; first += kFramesAtOnce) {
    const uint32_t count = std::min(kFramesAtOnce, file.info.frame_count - first);
    auto error = sized<MienError>();
    check(mien_clip_read(file.clip.get(), first, count, values.data(), 0, &error), &error,
          "cannot read clip", file.shown);
    for (uint32_t f = 0; f < count; ++f) use(first + f, values.data() + f * channels);
  }
}

}  // namespace mien::cli
