// SPDX-License-Identifier: MIT
// Rigs that are made here. mien.h is the manual.
#include "capi/handles.h"
#include "runtime/author/procedural_head.h"
#include "runtime/author/synthetic_rig.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_PRESET_BODY == int(SyntheticPreset::kBody), "the presets agree");

MienStatus mien_dna_generate(const MienGenerateDesc* desc, MienDna** out_dna, MienError* error) {
  if (MienStatus status = clear_output(out_dna, error)) return status;
  MienGenerateDesc known;
  if (MienStatus status = read_desc(desc, known, "MienGenerateDesc", error)) return status;
  if (known.preset > MIEN_PRESET_HEAD) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienGenerateDesc.preset %u is no MIEN_PRESET_...", known.preset);
  }
  if ((known.flags & ~uint32_t{MIEN_GENERATE_ML}) != 0) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienGenerateDesc.flags has unknown bits: 0x%x", known.flags);
  }
  if (known.preset == MIEN_PRESET_HEAD && known.flags != 0) {
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "MIEN_PRESET_HEAD has no learned behavior: MienGenerateDesc.flags is to be 0");
  }
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  MienDna* dna = new_dna(allocator);
  const bool ml = (known.flags & MIEN_GENERATE_ML) != 0;
  const bool made = dna && (known.preset == MIEN_PRESET_HEAD
                                ? make_procedural_head(known.seed, dna->arena, allocator, dna->view)
                                : make_synthetic_rig(static_cast<SyntheticPreset>(known.preset),
                                                     known.seed, dna->arena, dna->view, ml));
  if (!made) {
    mien_dna_close(dna);
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for the rig");
  }
  *out_dna = dna;
  return succeed(error);
}
