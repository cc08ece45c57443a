// SPDX-License-Identifier: MIT
// From a target to the controls that turn the eyes to it. runtime/probe/probe_gaze.h measures the table.
#pragma once

#include "runtime/base/object.h"

namespace mien {

constexpr uint32_t kGazeSteps = 8;

enum GazeDirection : uint32_t { kGazeLeft, kGazeRight, kGazeUp, kGazeDown };

struct GazeEye {
  float center[3];     // millimeters to the left, up and to the front, in the rig's model space
  uint16_t curves[4];  // [GazeDirection]
  float tangents[4][kGazeSteps];  // of the angle at 1/8, 2/8, ... 1 of the control, ascending
};

struct GazeTable {
  GazeEye eyes[2];  // left, right
  uint32_t
      yaw_first;    // 1: left and right turn about the axis of the eye, up and down about that of
                    // the head; 0: the opposite
  float fit_error;  // degrees, the largest found when the eye turns sideways and up at once
};

/// The table of a rig.
struct Gaze : Object {
  static constexpr uint32_t kTag = 0x6D47'415A;

  uint32_t raw_count = 0;  // of the rig
  GazeTable table = {};
};

/// Sets the curves of both eyes so that they look at a target, which has the form of GazeEye::center. Eyes
/// converge on near targets. `beyond` gets the part that the eyes cannot reach and the head may turn:
/// tangents to the left and up, averaged over both eyes. It may be null. For a target behind an eye, the eye
/// turns sideways as far as it can.
void look_at(const GazeTable& table, const float target[3], float* row, float* beyond);

}  // namespace mien
