// SPDX-License-Identifier: MIT
// A rig that takes less memory and time, within a stated distance of the positions of the original.
//
//     DNA ──> importance of each entry, delta and weight ──> those below a limit removed ──> DNA, rig, deformer
//                 (sensitivity.h)                               (prune.h)                        │
//                                    limits <──────────── largest distance in all poses ────────┘
//                                                               (proof.h)
//
// Importance decides only what goes first. What may go is decided by the distances that were measured.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/reduce/proof.h"
#include "integrations/program/reduce/prune.h"

namespace mien::cli {

struct ReduceOptions {
  std::vector<double>
      tolerances;     // [LOD] in the unit of the file; the last one serves the LODs after it
  MienRigDesc rig;    // 16-bit storage is tried if it says 32 bits
  std::string shown;  // the file, for messages
};

struct Sizes {
  uint64_t rig_bytes = 0, deformer_bytes = 0, matrix_entries = 0, deltas = 0, influences = 0;
};

struct Reduced {
  Dna dna;
  Rig rig;
  Deformer deformer;
  uint32_t storage = 0;  // MIEN_STORAGE_... that was chosen
  PruneLimits limits;
  Sizes before, after;
  Proof proof;
};

/// Reduces a rig with geometry. The same input gives the same result everywhere the same instruction set runs.
Reduced reduce_rig(const MienDna* dna, const ReduceOptions& options);

/// What was reduced and proven, as text or JSON.
std::string reduction_text(const Reduced& reduced, const std::vector<double>& tolerances,
                           const std::string& unit);
std::string reduction_json(const Reduced& reduced, const std::vector<double>& tolerances,
                           const std::string& unit);

}  // namespace mien::cli
