// SPDX-License-Identifier: MIT
// Bytes that several objects read in place: a mapped file, a copy of it, or the caller's memory. The
// last owner releases them.
#pragma once

#include <cinttypes>

#include "runtime/base/mapped_file.h"
#include "runtime/base/object.h"
#include "runtime/base/stream.h"

namespace mien {

struct SharedBytes : Object {
  MappedFile file;  // empty if the bytes are not those of a file
  const uint8_t* data = nullptr;
  size_t size = 0;

  ~SharedBytes();
};

// T begins with SharedBytes. `what` names it in messages: "a clip".

/// Creates a T with room for `size` bytes behind it, to which `data` points. kMemory.
template <class T>
Status create_with_bytes(uint64_t size, const char* what, const Allocator& allocator, T*& out,
                         Error& error) {
  out = nullptr;
  if (size <= SIZE_MAX / 2) {
    const auto count = static_cast<size_t>(size);
    out = create_object<T>(allocator, [count](Placer& placer, T& made) {
      if (count == 0) return;
      made.data = placer.unwritten_array<uint8_t>(count, kBlockAlignment).data;
      made.size = count;
    });
  }
  if (out) return Status::kOk;
  return fail(error, Status::kMemory, kNoOffset, "no memory for %s of %" PRIu64 " bytes", what,
              size);
}

/// Creates a T that reads a file in place. Errors of open_file(), kMemory.
template <class T>
Status create_from_file(const char* path, FileAccess access, const FileLimits& limits,
                        const char* what, const Allocator& allocator, T*& out, Error& error) {
  Status status = create_with_bytes(0, what, allocator, out, error);
  if (status != Status::kOk) return status;
  status = open_file(path, access, limits, allocator, out->file, error);
  if (status != Status::kOk) {
    release(out);
    out = nullptr;
    return status;
  }
  out->data = out->file.bytes;
  out->size = out->file.size;
  return Status::kOk;
}

/// Creates a T with a copy of a stream. kFileRead, kMemory.
template <class T>
Status create_from_stream(const Stream& stream, const char* what, const Allocator& allocator,
                          T*& out, Error& error) {
  const Status status = create_with_bytes(stream.size, what, allocator, out, error);
  if (status != Status::kOk || out->size == 0) return status;
  const size_t size = out->size;
  if (stream.read(stream.user, 0, const_cast<uint8_t*>(out->data), size) == size) return status;
  release(out);
  out = nullptr;
  return fail(error, Status::kFileRead, kNoOffset,
              "the read function of the stream gave fewer than the %zu bytes asked for", size);
}

}  // namespace mien
