// SPDX-License-Identifier: MIT
// The handle of a DNA file, for the part of the library that MIEN_BUILD_COMPILER=OFF leaves out.
#pragma once

#include "capi/handles.h"
#include "runtime/base/mapped_file.h"
#include "runtime/load/dna/format/dna_view.h"

struct MienDna {
  uint32_t tag;
  mien::Allocator allocator;
  mien::MappedFile file;  // empty if opened from memory or a stream
  mien::Arena arena;
  mien::dna::DnaView view;
};

namespace mien::capi {

/// An empty MienDna in the allocator's memory; null if memory ran out.
MienDna* new_dna(const Allocator& allocator);

}  // namespace mien::capi
