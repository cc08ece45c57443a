// SPDX-License-Identifier: MIT
// Limits the work per frame that a file can cause. The cost of most tables is proportional to their
// size. Two can cost more, because they share what they refer to: RBF solvers, whose poses drive any
// number of controls, and ML operations, which may all run one network or sum one list of values.
// Before anything is evaluated, their work is counted, in steps of about a nanosecond, for a frame at
// each LOD, and compared with the size of the file.
#pragma once

#include "runtime/rig/rig.h"

namespace mien {

constexpr uint64_t kStepsPerByte = 64;
constexpr uint64_t kLeastBytes = uint64_t{1} << 20;  // smaller files may cause this much work

constexpr uint64_t work_budget(uint64_t bytes) {
  return kStepsPerByte * (bytes > kLeastBytes ? bytes : kLeastBytes);
}

// These stop counting as soon as the budget is exceeded. They follow indices, so the indices of a rig
// from a baked file must have been checked before.

/// Steps of the RBF solvers in a frame at each LOD.
uint64_t count_rbf_steps(const Rig& rig, uint64_t budget);

/// The same for the ML operations.
uint64_t count_ml_steps(const Rig& rig, uint64_t budget);

/// Steps of inverting a matrix with a row for each pose, and of finding its entries.
constexpr uint64_t count_inversion_steps(uint64_t poses, uint64_t inputs) {
  return poses * poses * (2 * poses + inputs + 16);
}

}  // namespace mien
