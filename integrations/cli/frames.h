// SPDX-License-Identifier: MIT
// FRAMES of `mien eval`: JSON text -> what to write into an instance.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "integrations/cli/cli.h"

namespace mien::cli {

struct Assignment {
  uint32_t index;
  float value;
};

/// Applied in this order: masks, GUI controls, mapping to raw controls, raw controls.
struct Frame {
  std::vector<Assignment> masks;
  std::vector<Assignment> gui;
  bool maps_gui = false;
  std::vector<Assignment> raw;
};

/// Checks names, counts and numbers against the rig. `shown` names the input in messages.
std::vector<Frame> parse_frames(const std::string& text, const MienRig* rig,
                                const std::string& shown);

/// The same from a file; "-" reads standard input.
std::vector<Frame> read_frames(const std::string& path, const MienRig* rig);

/// Brings a fresh instance to the state just before evaluation.
void apply_frame(const Frame& frame, const MienRig* rig, MienInstance* instance);

}  // namespace mien::cli
