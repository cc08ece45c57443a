// SPDX-License-Identifier: MIT
// Coordinate systems as callers ask for them.
#pragma once

#include "capi/arguments/arguments.h"
#include "runtime/base/coordinate_system.h"

namespace mien::capi {

/// A caller's system, which is not NULL.
MienStatus read_system(const MienCoordinateSystem* in, CoordinateSystem& out, MienError* error);

}  // namespace mien::capi
