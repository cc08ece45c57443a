// SPDX-License-Identifier: MIT
// Generated files: their bytes are passed to libmien through its public interface, so the two libraries share
// no structs but those of mien.h.
#pragma once

#include "capi/include/mien_author.h"
#include "runtime/base/arena.h"
#include "runtime/load/dna/format/dna_writer.h"

namespace mien::capi {

/// A file in the allocator's memory.
struct MadeFile {
  Allocator allocator;
  uint8_t* bytes = nullptr;
  size_t size = 0;

  explicit MadeFile(const Allocator& from) : allocator(from) {}
  MadeFile(const MadeFile&) = delete;
  MadeFile& operator=(const MadeFile&) = delete;
  ~MadeFile() { allocator.put(bytes, size, kBlockAlignment); }
};

/// False if memory ran out.
inline bool encode_file(const dna::DnaView& view, MadeFile& out) {
  dna::WriteOptions options;
  options.version = view.version;
  out.size = static_cast<size_t>(dna::encoded_size(view, options));
  out.bytes = static_cast<uint8_t*>(out.allocator.get(out.size, kBlockAlignment));
  if (!out.bytes) return false;
  dna::encode(view, options, out.bytes);
  return true;
}

inline size_t MIEN_CALLBACK read_made(void* user, uint64_t offset, void* buffer, size_t size) {
  memcpy(buffer, static_cast<const MadeFile*>(user)->bytes + offset, size);
  return size;
}

/// libmien copies what it keeps, so `file` need not stay.
inline MienStatus open_made(MadeFile& file, const MienAllocator* allocator, MienDna** out_dna,
                            MienError* error) {
  const MienStream stream = {&file, file.size, read_made};
  MienDnaDesc desc = mien_dna_desc_default();
  desc.allocator = allocator;
  return mien_dna_open_stream(&stream, &desc, out_dna, error);
}

}  // namespace mien::capi
