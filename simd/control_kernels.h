// SPDX-License-Identifier: MIT
// Controls: which are not 0, which differ; correctives.
#pragma once

#include <stdint.h>

#include "simd/lanes.h"

namespace mien {

/// Which values are not 0: bit i % 64 of words[i / 64]. Bits past the last value are 0.
struct NonzeroArgs {
  const float* values;  // 64-byte aligned
  uint64_t* words;
  uint32_t count;
};
using NonzeroKernel = void(const NonzeroArgs& args);

/// Which values differ in their bits from the others: bit i % 64 of words[i / 64]. Bits past the last value
/// are 0.
struct DifferentArgs {
  const float *values, *others;  // at any address
  uint64_t* words;
  uint32_t count;
};
using DifferentKernel = void(const DifferentArgs& args);

/// Correctives, entry after entry:
///
///     controls[outputs[e]] = min(1, weights[e] * product of clamp(controls[input], 0, 1))
///
/// over inputs[first_inputs[e]] ... inputs[first_inputs[e + 1] - 1], in this order; at least the
/// lowest float. Returns the union of `marks` of the outputs whose bits changed. The run_lengths[e]
/// entries from e on have the same number of inputs and do not read each other. No branch depends on
/// values, because which controls are active cannot be predicted.
struct PsdArgs {
  const uint16_t* outputs;
  const float* weights;
  const uint32_t* first_inputs;
  const uint16_t* inputs;
  const uint16_t* run_lengths;
  const uint64_t* marks;  // [control]
  float* controls;
  uint32_t count;
};
using PsdsKernel = uint64_t(const PsdArgs& args);

/// The same for some entries that do not read each other. Lists those of them whose outputs changed in their
/// bits, and returns their number.
struct PsdListArgs {
  const uint16_t* outputs;
  const float* weights;
  const uint32_t* first_inputs;
  const uint16_t* inputs;
  float* controls;
  const uint16_t* entries;
  uint16_t* changed;  // room for `count`; may be `entries`
  uint32_t count;
};
using PsdListKernel = uint32_t(const PsdListArgs& args);

/// The same for many characters, one lane each: controls[32 * c + lane] for controls[c]. Bit k of
/// changed[e] is set if the value in lane k changed.
struct PsdBatchArgs {
  const uint16_t* outputs;
  const float* weights;
  const uint32_t* first_inputs;
  const uint16_t* inputs;
  float* controls;  // 64-byte aligned
  uint32_t* changed;
  uint32_t count;
};
using PsdBatchKernel = void(const PsdBatchArgs& args);

}  // namespace mien
