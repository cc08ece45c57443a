// SPDX-License-Identifier: MIT
// Operations on the file as a whole, which opening a file has, too: LODs and coordinate systems.
#pragma once

#include "author/document/document.h"
#include "runtime/base/coordinate_system.h"

namespace mien::author {

/// Keeps the LODs whose bits are set, as MienDnaDesc.lods. kLod if there is none of them.
Status keep_lods(Document& document, uint64_t lods, Error& error);

/// Converts to another coordinate system, as MienDnaDesc.system.
Status convert_document(Document& document, const CoordinateSystem& system, Error& error);

}  // namespace mien::author
