// SPDX-License-Identifier: MIT
// Rigs and deformers to and from baked files.
#pragma once

#include "runtime/baked/part.h"
#include "runtime/deform/deformer.h"
#include "simd/isa.h"

namespace mien {

/// Bytes of a file with a rig and, unless it is null, a deformer of this rig.
size_t baked_size(const Rig& rig, const Deformer* deformer);
/// `bytes` has baked_size() bytes. The same objects give the same bytes.
void bake(const Rig& rig, const Deformer* deformer, uint8_t* bytes);

/// Takes one block of `allocator` for everything that is not in the file, and becomes an owner of the
/// bytes. `baked` must have a rig. Give `out` back with release().
Status open_baked_rig(const Baked& baked, const KernelTable* kernels, const Allocator& allocator,
                      Rig*& out, Error& error);

/// The same for a deformer of `rig`, which was opened from this file. It becomes an owner of the rig.
/// `baked` must have a deformer.
Status open_baked_deformer(const Baked& baked, const Rig& rig, const KernelTable* kernels,
                           const Allocator& allocator, Deformer*& out, Error& error);

// What the above are made of ----------------------------------------------------------------------

PartMeasure measure_part(const Rig& rig);
PartMeasure measure_part(const Deformer& deformer);
/// `bytes` are zero, and as many as measured. Returns the entry in the table of parts, except for its
/// offset.
BakedPart write_part(const Rig& rig, uint8_t* bytes);
BakedPart write_part(const Deformer& deformer, uint8_t* bytes);

/// Every count and every index in the tables: evaluation, batches, names and statistics stay within the
/// arrays, whatever the floats are. Only tables cost time. `full` also checks the order of names and of
/// correctives. kBakedStructure.
Status check_rig(const Rig& rig, uint64_t bytes, bool full, Error& error);

/// The same for deformation, and for indices that callers follow: triangles, channels, positions of
/// vertices. Each position and each vertex is written once, so tasks never write the same memory. `full`
/// also checks the order of joints.
Status check_deformer(const Deformer& deformer, bool full, Error& error);

}  // namespace mien
