// SPDX-License-Identifier: MIT
// How much work a rig may ask for. Most tables cost a frame in proportion to their bytes. Two can ask
// for more, since what they refer to is shared: RBF solvers, whose poses drive any number of controls,
// and ML operations, which may all run one network or add up one list of values. Their work is counted
// in steps of about a nanosecond, for a frame at each LOD, before anything is evaluated, and compared
// with the bytes of the file.
#pragma once

#include "runtime/rig/rig.h"

namespace mien {

constexpr uint64_t kStepsPerByte = 64;
constexpr uint64_t kLeastBytes = uint64_t{1} << 20;  // a smaller file may ask for as much as this

constexpr uint64_t work_budget(uint64_t bytes) {
  return kStepsPerByte * (bytes > kLeastBytes ? bytes : kLeastBytes);
}

// These stop counting as soon as the budget is exceeded. They follow indices: of a rig out of a baked
// file they expect that those were checked.

/// Steps of the RBF solvers in a frame at each LOD.
uint64_t count_rbf_steps(const Rig& rig, uint64_t budget);

/// The same of the ML operations.
uint64_t count_ml_steps(const Rig& rig, uint64_t budget);

/// Steps of inverting a matrix with a row for each pose, and of finding its entries.
constexpr uint64_t count_inversion_steps(uint64_t poses, uint64_t inputs) {
  return poses * poses * (2 * poses + inputs + 16);
}

}  // namespace mien
