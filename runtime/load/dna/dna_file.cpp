// SPDX-License-Identifier: MIT
#include "runtime/load/dna/dna_file.h"

namespace mien::dna {
namespace {

/// Creates a file and lets `read` fill it; drops it if that fails.
template <class Read>
Status open(const Allocator& allocator, DnaFile*& out, Error& error, Read read) {
  out = create_object<DnaFile>(allocator);
  if (!out) return fail(error, Status::kMemory, kNoOffset, "no memory for a DNA handle");
  const Status status = read(*out);
  if (status == Status::kOk) return status;
  release(out);
  out = nullptr;
  return status;
}

}  // namespace

Status open_dna_file(const char* path, FileAccess access, const ReadOptions& options,
                     const Allocator& allocator, DnaFile*& out, Error& error) {
  return open(allocator, out, error, [&](DnaFile& dna) {
    const Status status = open_file(path, access, {"DNA", 3}, allocator, dna.file, error);
    if (status != Status::kOk) return status;
    return read_dna(dna.file.bytes, dna.file.size, options, dna.arena, dna.view, error);
  });
}

Status open_dna_memory(Span<const uint8_t> bytes, const ReadOptions& options,
                       const Allocator& allocator, DnaFile*& out, Error& error) {
  return open(allocator, out, error, [&](DnaFile& dna) {
    return read_dna(bytes.data, bytes.count, options, dna.arena, dna.view, error);
  });
}

Status open_dna_stream(const Stream& stream, const ReadOptions& options, const Allocator& allocator,
                       DnaFile*& out, Error& error) {
  return open(allocator, out, error,
              [&](DnaFile& dna) { return read_dna(stream, options, dna.arena, dna.view, error); });
}

}  // namespace mien::dna
