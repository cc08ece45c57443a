// SPDX-License-Identifier: MIT
// Operations on the whole file that opening a file offers, too: LODs and coordinate systems.
#pragma once

#include "author/document/document.h"
#include "runtime/base/coordinate_system.h"

namespace mien::author {

/// Keeps the LODs whose bits are set, like MienDnaDesc.lods. kLod if none of them exists.
Status keep_lods(Document& document, uint64_t lods, Error& error);

/// Converts to another coordinate system, like MienDnaDesc.system.
Status convert_document(Document& document, const CoordinateSystem& system, Error& error);

}  // namespace mien::author
