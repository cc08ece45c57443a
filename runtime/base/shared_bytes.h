// SPDX-License-Identifier: MIT
// Bytes that several objects read in place: a mapped file, a copy of it, or the caller's memory. The
// last owner releases them.
#pragma once

#include <atomic>

#include "runtime/base/mapped_file.h"

namespace mien {

struct SharedBytes {
  uint32_t tag = 0;  // first, for the C API to recognize its handles
  Allocator allocator;
  size_t block_size = 0;                    // of the object that begins with this
  mutable std::atomic<uint32_t> owners{1};  // the creator, and every object that reads the bytes
  MappedFile file;                          // empty if the bytes belong to the caller
  const uint8_t* data = nullptr;
  size_t size = 0;
};

/// Drops one owner; the last one closes the file and releases the block. Null is allowed.
void release_bytes(const SharedBytes* bytes);

}  // namespace mien
