// SPDX-License-Identifier: MIT
// A rig as plain vectors, written as a DNA file for the library; integrations/program/model evaluates it a
// second time. The two share no code but the numbers of the rig.
#pragma once

#include "author/base/random.h"
#include "integrations/program/model/plain_rig.h"
#include "tests/support/rig_handles.h"

namespace mien {

using Floats = std::vector<float>;

inline Floats copy_of(Span<const float> values) { return {values.begin(), values.end()}; }

using namespace model;

/// Lists and arrays lie in `arena`.
dna::DnaView to_view(const PlainRig& plain, Arena& arena);

/// Written, opened with all checks, and compiled.
RigHandle make_rig(const PlainRig& plain, uint32_t isa = MIEN_ISA_ENVIRONMENT,
                   MienStatus expected = MIEN_OK);

/// Anything goes: odd counts, correctives of correctives, rows of zeros, values written twice,
/// intervals that touch, overlap, or are the wrong way round.
PlainRig random_rig(Random& random);

/// A joint matrix of more than kMaxTileBlockRows blocks, at two LODs. Its numbers are small
/// integers, so that sums of controls that are integers are exact.
PlainRig tall_rig();

}  // namespace mien
