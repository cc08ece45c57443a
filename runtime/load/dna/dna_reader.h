// SPDX-License-Identifier: MIT
// Bytes -> view. Every offset, count and size is compared with the bytes that remain before it is
// used; every cross reference is checked before it is followed.
#pragma once

#include "runtime/base/coordinate_system.h"
#include "runtime/base/stream.h"
#include "runtime/load/dna/format/dna_view.h"
#include "runtime/load/dna/format/findings.h"

namespace mien::dna {

struct ReadOptions {
  uint32_t layers = kLayersAll;              // LayerMask; what it needs is added
  bool skip_blend_shape_targets = false;     // of the geometry
  bool keep_unknown = true;                  // layers of unknown kind stay in the index
  uint64_t lods = 0;                         // bit l keeps LOD l; 0 keeps all
  const CoordinateSystem* system = nullptr;  // to convert to; null keeps the file's
};

/// Fills `out` with views into `bytes`, which have to outlive it, and into `arena`. Touches only
/// the header, the index, and the bytes of the chosen layers and meshes; of arrays only those with
/// indices. Takes at most about five times the bytes of the lists it reads from the arena. On failure
/// `out` must not be used.
Status read_dna(const uint8_t* bytes, size_t size, const ReadOptions& options, Arena& arena,
                DnaView& out, Error& error);

/// The same from a stream. Reads the header, the index and the chosen layers into the arena, each
/// layer at once; the stream is not needed afterwards. kFileRead if it fails.
Status read_dna(const Stream& stream, const ReadOptions& options, Arena& arena, DnaView& out,
                Error& error);

/// Reads everything and reports every error and warning to `sink`. An error in one layer does not
/// stop the checks of the others. `out` holds what could be read, for inspection only. False if the
/// sink ended the checks.
bool examine_dna(const uint8_t* bytes, size_t size, Arena& arena, DnaView& out,
                 const FindingSink& sink);

}  // namespace mien::dna
