// SPDX-License-Identifier: MIT
// A DNA file that is open: its view, and the memory that the view refers to.
#pragma once

#include "runtime/base/mapped_file.h"
#include "runtime/base/object.h"
#include "runtime/load/dna/dna_reader.h"

namespace mien::dna {

struct DnaFile : Object {
  static constexpr uint32_t kTag = 0x6D44'4E41;

  MappedFile file;  // empty if opened from memory or a stream
  Arena arena;
  DnaView view;

  explicit DnaFile(const Allocator& of) : arena(of) {}
  ~DnaFile() { close_file(file); }
};

// On success, give back `out` with release(). Errors of read_dna() besides those that are named, kMemory.

/// Errors of open_file().
Status open_dna_file(const char* path, FileAccess access, const ReadOptions& options,
                     const Allocator& allocator, DnaFile*& out, Error& error);
/// The bytes are used in place and have to outlive the file.
Status open_dna_memory(Span<const uint8_t> bytes, const ReadOptions& options,
                       const Allocator& allocator, DnaFile*& out, Error& error);
Status open_dna_stream(const Stream& stream, const ReadOptions& options, const Allocator& allocator,
                       DnaFile*& out, Error& error);

}  // namespace mien::dna
