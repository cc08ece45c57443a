// SPDX-License-Identifier: MIT
// Generated rigs. mien_author.h is the manual.
#include "author/capi/made_file.h"
#include "author/generate/head/procedural_head.h"
#include "author/generate/synthetic/rig.h"
#include "capi/arguments/arguments.h"
#include "capi/include/mien_author.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_PRESET_BODY == int(SyntheticPreset::kBody) &&
                  MIEN_PRESET_METAHUMAN_HEAD == int(SyntheticPreset::kMetaHumanHead) &&
                  MIEN_PRESET_METAHUMAN_BODY == int(SyntheticPreset::kMetaHumanBody) &&
                  MIEN_PRESET_ARCHETYPE == int(SyntheticPreset::kArchetype),
              "the presets agree");

namespace {

bool make_file(const MienGenerateDesc& desc, MadeFile& out) {
  Arena arena(out.allocator);
  dna::DnaView view;
  const bool made = desc.preset == MIEN_PRESET_HEAD
                        ? make_procedural_head(desc.seed, arena, out.allocator, view)
                        : make_synthetic_rig(static_cast<SyntheticPreset>(desc.preset), desc.seed,
                                             arena, view, (desc.flags & MIEN_GENERATE_ML) != 0);
  if (!made) return false;
  return encode_file(view, out);
}

}  // namespace

MienStatus mien_dna_generate(const MienGenerateDesc* desc, MienDna** out_dna, MienError* error) {
  if (MienStatus status = clear_output(out_dna, error)) return status;
  MienGenerateDesc known;
  if (MienStatus status = read_desc(desc, known, "MienGenerateDesc", error)) return status;
  const MienStatus in_range =
      check_fields({{"MienGenerateDesc.preset", known.preset, MIEN_PRESET_ARCHETYPE}}, error);
  if (in_range != MIEN_OK) return in_range;
  if ((known.flags & ~uint32_t{MIEN_GENERATE_ML}) != 0) {
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "MienGenerateDesc.flags is 0x%x, which has bits that are not a MIEN_GENERATE_...",
        known.flags);
  }
  if (known.preset >= MIEN_PRESET_HEAD && known.flags != 0) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienGenerateDesc.preset %u has no machine-learned behavior: "
                      "MienGenerateDesc.flags must be 0",
                      known.preset);
  }
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  MadeFile file(allocator);
  if (!make_file(known, file)) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for the rig");
  }
  return open_made(file, known.allocator, out_dna, error);
}
