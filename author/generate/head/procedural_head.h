// SPDX-License-Identifier: MIT
// The procedural head: a stylized person with 72 expressions, correctives, wrinkle maps and 8 LODs,
// generated from formulas, so that it is free of anyone's rights.
//
// Colors have no field in DNA files. They are in the descriptor's metadata, under the key
// "mien.colors.<mesh name>": base64 (RFC 4648, padded) of three bytes per position, sRGB.
#pragma once

#include "runtime/base/arena.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien {

/// A 2.8 file with all layers loaded, like make_synthetic_rig(). The same seed gives the same bytes
/// wherever doubles are those of IEEE 754. Seed 0 is the designed person; others differ in skull,
/// face, hair, age and colors. Takes about 40 MB from `scratch` during the call. False if memory ran
/// out.
bool make_procedural_head(uint64_t seed, Arena& arena, const Allocator& scratch, dna::DnaView& out);

}  // namespace mien
