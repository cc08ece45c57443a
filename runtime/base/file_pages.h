// SPDX-License-Identifier: MIT
// What of a mapped file is in memory.
#pragma once

#include "runtime/base/mapped_file.h"

namespace mien {

/// Lets the system drop the pages of a mapped file from memory. They are read again when they are used.
void forget_pages(const MappedFile& file);

}  // namespace mien
