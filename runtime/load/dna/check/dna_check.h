// SPDX-License-Identifier: MIT
// Checks every cross reference of a view before anything follows it (docs/dna-format.md, 13 "What
// is checked"). The reader has already checked that arrays lie within the file.
#pragma once

#include "runtime/load/dna/format/dna_view.h"
#include "runtime/load/dna/format/findings.h"

namespace mien::dna {

// `lods` (bit l for LOD l, 0 for all) will be selected: data that only other LODs use need not be valid.

/// Descriptor, dsce and definition: all that LOD selection and the other layers rely on.
/// False if the sink ended the examination.
bool check_definition(const DnaView& view, const FindingSink& sink, uint64_t lods = 0);

/// All other loaded layers. Expects that check_definition found no error.
/// False if the sink ended the examination.
bool check_layers(const DnaView& view, const FindingSink& sink, uint64_t lods = 0);

}  // namespace mien::dna
