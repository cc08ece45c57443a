// SPDX-License-Identifier: MIT
#include "runtime/deform/deformer.h"

#include <algorithm>

namespace mien {

const SkinRun* run_of(const DeformMesh& mesh, uint32_t place) {
  const auto begins_behind = [](uint32_t p, const SkinRun& run) { return p < run.first; };
  return std::upper_bound(mesh.runs.begin(), mesh.runs.end(), place, begins_behind) - 1;
}

void write_target(const DeformMesh& mesh, uint32_t target, float* out) {
  std::fill(out, out + size_t{mesh.position_count} * 3, 0.0f);
  const auto comes_before = [](const TargetPiece& piece, uint32_t t) { return piece.target < t; };
  for (uint32_t block = 0; block < mesh.block_count(); ++block) {
    const TargetPiece* const begin = mesh.pieces.data + mesh.first_piece[block];
    const TargetPiece* const end = mesh.pieces.data + mesh.first_piece[block + 1];
    for (const TargetPiece* piece = std::lower_bound(begin, end, target, comes_before);
         piece != end && piece->target == target; ++piece) {
      for (size_t d = piece->first_delta; d < size_t{piece->first_delta} + piece->count; ++d) {
        const uint32_t place = block * kBlockPlaces + mesh.delta_places[d];
        float* at = out + size_t{mesh.position_at[place]} * 3;
        for (size_t k = 0; k < 3; ++k) at[k] += mesh.deltas[d * 3 + k];
      }
    }
  }
}

void release_deformer(const Deformer* deformer) {
  if (deformer->owners.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  Deformer* last = const_cast<Deformer*>(deformer);
  const Allocator allocator = last->allocator;
  const size_t size = last->block_size;
  const Rig* rig = last->rig;
  last->tag = 0;
  last->~Deformer();
  allocator.put(last, size, kBlockAlignment);
  release_rig(rig);
}

}  // namespace mien
