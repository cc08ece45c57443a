// SPDX-License-Identifier: MIT
// Regions of the face: joints that lie together and move together. Each becomes a joint group, a dense
// block of the joint matrix, and holds only expressions that own it.
#pragma once

#include "runtime/author/fit/fit_shapes.h"

namespace mien::author {

struct JointRegions {
  Span<uint16_t> region;  // by bone; fixed bones have none that counts
  uint32_t count = 0;
};

}  // namespace mien::author
