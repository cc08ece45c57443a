// SPDX-License-Identifier: MIT
// FRAMES of `mien eval`: JSON text -> values for the inputs of an instance.
#pragma once

#include <mien.h>

#include <cstdint>
#include <string>
#include <vector>

#include "integrations/program/io/frame_rate.h"

namespace mien::cli {

struct Assignment {
  uint32_t index;
  float value;
};

/// Where the head turns, as tangents: 0.1 to the left is 5.7 degrees.
struct HeadPose {
  float left = 0, up = 0;

  bool turned() const { return left != 0 || up != 0; }
};

/// Applied in this order: masks, GUI controls, the mapping to raw controls, raw controls.
struct Frame {
  std::vector<Assignment> masks;
  std::vector<Assignment> gui;
  bool maps_gui = false;
  std::vector<Assignment> raw;
  HeadPose head;  // joints that no control moves; not part of FRAMES
};

/// Checks names, counts and numbers against the rig. `shown` names the input in messages. `rate`, which may be
/// null, gets the rate if the text has one.
std::vector<Frame> parse_frames(const std::string& text, const MienRig* rig,
                                const std::string& shown, Rate* rate = nullptr);

/// The same from a file; "-" reads standard input.
std::vector<Frame> read_frames(const std::string& path, const MienRig* rig);

/// Writes a frame into a fresh instance, which is then ready to be evaluated.
void apply_frame(const Frame& frame, const MienRig* rig, MienInstance* instance);

}  // namespace mien::cli
