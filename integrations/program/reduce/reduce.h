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
  Tolerances tolerances;
  MienRigDesc rig;    // 16-bit storage is tried if it says 32 bits; for the deformer always
  std::string shown;  // the file, for messages
  std::vector<ProofTake> performances;  // more poses to prove it in
};

struct Sizes {
  uint64_t rig_bytes = 0, deformer_bytes = 0, matrix_entries = 0, deltas = 0, influences = 0;
};

struct Reduced {
  Dna dna;
  Rig rig;
  Deformer deformer;
  uint32_t storage = 0, deformer_storage = 0;  // MIEN_STORAGE_... that were chosen
  double delta_error = 0;                      // MienDeformerDesc.delta_error that was chosen
  PruneLimits limits;
  Tolerances tolerances{0.0};  // with their regions
  Sizes before, after;
  Proof proof;
};

/// Reduces a rig with geometry. The same input gives the same result everywhere the same instruction set runs.
Reduced reduce_rig(const MienDna* dna, const ReduceOptions& options);

/// What was reduced and proven, as text or JSON.
std::string reduction_text(const Reduced& reduced, const std::string& unit);
std::string reduction_json(const Reduced& reduced, const std::string& unit);

}  // namespace mien::cli
