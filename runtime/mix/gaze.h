// SPDX-License-Identifier: MIT
// Where eyes look -> the controls that turn them. runtime/probe/probe_gaze.h measures the table.
#pragma once

#include <cstdint>

namespace mien {

constexpr uint32_t kGazeSteps = 8;

enum GazeDirection : uint32_t { kGazeLeft, kGazeRight, kGazeUp, kGazeDown };

struct GazeEye {
  float center[3];    // millimeters to the left, up and to the front, in the model space of the rig
  uint16_t lanes[4];  // [GazeDirection]
  float tangents[4][kGazeSteps];  // of the angle at 1/8, 2/8, ... 1 of the control, rising
};

struct GazeTable {
  GazeEye eyes[2];  // left, right
  uint32_t
      yaw_first;    // 1: left and right turn about the axis of the eye, up and down about that of
                    // the head; 0: the other way round
  float fit_error;  // degrees, the largest that was found where both directions turn at once
};

/// Sets the lanes of both eyes so that they look at a target, given like GazeEye::center; so near
/// targets make eyes converge. `beyond` gets the tangents to the left and up that are beyond what
/// the eyes reach, the mean of both, for the head to turn; it may be null. A target behind an eye is as
/// far aside as it goes.
void look_at(const GazeTable& table, const float target[3], float* row, float* beyond);

}  // namespace mien
