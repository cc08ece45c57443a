// SPDX-License-Identifier: MIT
#include "runtime/mix/gaze.h"

#include <cmath>

namespace mien {
namespace {

/// The control that turns by a tangent of 0 or more.
float control_at(const float* tangents, float tangent) {
  float from = 0.0f;
  for (uint32_t i = 0; i < kGazeSteps; ++i) {
    if (tangent < tangents[i]) {
      return (static_cast<float>(i) + (tangent - from) / (tangents[i] - from)) / kGazeSteps;
    }
    from = tangents[i];
  }
  return 1.0f;
}

/// Sets two opposite curves; returns the tangent beyond their reach.
float turn(const GazeEye& eye, uint32_t direction, float tangent, float* row) {
  const bool opposite = tangent < 0.0f;
  const float size = opposite ? -tangent : tangent;
  const float* tangents = eye.tangents[direction + opposite];
  row[eye.curves[direction + !opposite]] = 0.0f;
  row[eye.curves[direction + opposite]] = control_at(tangents, size);
  const float over = size - tangents[kGazeSteps - 1];
  return over > 0.0f ? (opposite ? -over : over) : 0.0f;
}

}  // namespace

void look_at(const GazeTable& table, const float target[3], float* row, float* beyond) {
  float left = 0.0f, up = 0.0f;
  for (const GazeEye& eye : table.eyes) {
    const float l = target[0] - eye.center[0], u = target[1] - eye.center[1];
    const float ahead = target[2] - eye.center[2];
    const float f = ahead > 1.0f ? ahead : 1.0f;
    const float across = l / (table.yaw_first ? std::sqrt(u * u + f * f) : f);
    const float above = u / (table.yaw_first ? f : std::sqrt(l * l + f * f));
    left += 0.5f * turn(eye, kGazeLeft, across, row);
    up += 0.5f * turn(eye, kGazeUp, above, row);
  }
  if (!beyond) return;
  beyond[0] = left;
  beyond[1] = up;
}

}  // namespace mien
