// SPDX-License-Identifier: MIT
// Files that are made here: their bytes are handed to libmien through its public interface, so the two
// libraries share no structs but those of mien.h. mien_author.h is the manual.
#include "capi/mien_author.h"

#include "capi/arguments.h"
#include "runtime/author/procedural_head.h"
#include "runtime/author/synthetic_rig.h"
#include "runtime/dna/format/dna_writer.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_PRESET_BODY == int(SyntheticPreset::kBody), "the presets agree");

namespace {

/// A file in the allocator's memory.
struct File {
  Allocator allocator;
  uint8_t* bytes = nullptr;
  size_t size = 0;

  explicit File(const Allocator& from) : allocator(from) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { allocator.put(bytes, size, kBlockAlignment); }
};

bool make_file(const MienGenerateDesc& desc, File& out) {
  Arena arena(out.allocator);
  dna::DnaView view;
  const bool made = desc.preset == MIEN_PRESET_HEAD
                        ? make_procedural_head(desc.seed, arena, out.allocator, view)
                        : make_synthetic_rig(static_cast<SyntheticPreset>(desc.preset), desc.seed,
                                             arena, view, (desc.flags & MIEN_GENERATE_ML) != 0);
  if (!made) return false;
  const dna::WriteOptions options;
  out.size = static_cast<size_t>(dna::encoded_size(view, options));
  out.bytes = static_cast<uint8_t*>(out.allocator.get(out.size, kBlockAlignment));
  if (!out.bytes) return false;
  dna::encode(view, options, out.bytes);
  return true;
}

size_t MIEN_CALLBACK read_made(void* user, uint64_t offset, void* buffer, size_t size) {
  memcpy(buffer, static_cast<const File*>(user)->bytes + offset, size);
  return size;
}

/// libmien reads what it keeps into memory of its own: `file` may go afterwards.
MienStatus open_made(File& file, const MienAllocator* allocator, MienDna** out_dna,
                     MienError* error) {
  const MienStream stream = {&file, file.size, read_made};
  MienDnaDesc desc = mien_dna_desc_default();
  desc.allocator = allocator;
  return mien_dna_open_stream(&stream, &desc, out_dna, error);
}

}  // namespace

MienStatus mien_dna_generate(const MienGenerateDesc* desc, MienDna** out_dna, MienError* error) {
  if (MienStatus status = clear_output(out_dna, error)) return status;
  MienGenerateDesc known;
  if (MienStatus status = read_desc(desc, known, "MienGenerateDesc", error)) return status;
  const MienStatus in_range =
      check_fields({{"MienGenerateDesc.preset", known.preset, MIEN_PRESET_HEAD}}, error);
  if (in_range != MIEN_OK) return in_range;
  if ((known.flags & ~uint32_t{MIEN_GENERATE_ML}) != 0) {
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "MienGenerateDesc.flags is 0x%x, which has bits that are not a MIEN_GENERATE_...",
        known.flags);
  }
  if (known.preset == MIEN_PRESET_HEAD && known.flags != 0) {
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "MIEN_PRESET_HEAD has no machine-learned behavior: MienGenerateDesc.flags must be 0");
  }
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  File file(allocator);
  if (!make_file(known, file)) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for the rig");
  }
  return open_made(file, known.allocator, out_dna, error);
}
