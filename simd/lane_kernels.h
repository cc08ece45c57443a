// SPDX-License-Identifier: MIT
// Arrays of many characters, to and from lanes, one lane per character (kBatchLanes).
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "simd/lanes.h"

namespace mien {

/// gather_lanes: to[32 * i + k] = from[k][i] for i < count and k < lane_count, 0 for the other k < 32. Rows
/// need no alignment.
using GatherLanesKernel = void(const float* const* from, uint32_t lane_count, size_t count,
                               float* to);

/// scatter_lanes: to[k][offset + i] = from[32 * i + k] for i < count and k < lane_count.
using ScatterLanesKernel = void(const float* from, size_t count, size_t lane_count,
                                float* const* to, size_t offset);

}  // namespace mien
