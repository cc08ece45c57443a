// SPDX-License-Identifier: MIT
// Images of a recorded performance, evenly spaced, with their times: one sheet or a file each.
#pragma once

#include "integrations/program/commands/render_output.h"
#include "integrations/program/play/recording.h"

namespace mien::cli {

/// As they were typed.
struct StripOptions {
  SceneArguments scene;
  RenderOutputOptions output;
  std::string every, columns;
};

/// The options, parsed before any file is opened.
struct StripPlan {
  PosedSceneOptions scene;
  render::View view;
  render::Size size;
  render::RenderOptions render;
  double every = 0;    // seconds; 0: so that there are 16 images at most
  size_t columns = 0;  // 0: 8 at most
};
StripPlan plan_strip(const StripOptions& options, const std::string& path);

/// Draws frames of the recording to `output`, where %04d makes a file of each. Returns the bytes written.
uint64_t write_strip(const StripPlan& plan, const std::string& target, const Recording& recording,
                     const Captions& captions, const OutputFile& output, const Session& session);

}  // namespace mien::cli
