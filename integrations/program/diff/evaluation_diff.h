// SPDX-License-Identifier: MIT
// How the results of two rigs differ, control by control.
#pragma once

#include <map>
#include <string>
#include <unordered_map>

#include "integrations/program/diff/dna_diff.h"

namespace mien::cli {

/// New names of elements by their old ones, by MIEN_KIND_....
using RenamedByKind = std::map<uint32_t, std::unordered_map<std::string, std::string>>;

/// Evaluates each raw control of both rigs at 1, the others at their initial values, at LOD 0. Compares what
/// both have by name. Does nothing if a file has no behavior.
void diff_evaluation(const MienDna* before, const MienDna* after, const RenamedByKind& renamed,
                     DnaDiff& diff);

}  // namespace mien::cli
