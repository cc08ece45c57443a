// SPDX-License-Identifier: MIT
// A file as read-only bytes: mapped, or read into memory where it cannot be mapped.
#pragma once

#include <cstdint>

#include "runtime/base/allocator.h"
#include "runtime/base/status.h"

namespace mien {

struct MappedFile {
  const uint8_t* bytes = nullptr;
  size_t size = 0;
  bool mapped = false;
  size_t capacity = 0;  // of the copy, if it is one
  Allocator allocator;
};

enum class FileAccess : uint32_t {
  kMap = 0,   // map; read into memory if the system refuses (pipes, some network drives)
  kRead = 1,  // always read: the file may be truncated or rewritten while it is in use
};

/// `path` is UTF-8. On failure `out` holds nothing and `error` says why.
Status open_file(const char* path, FileAccess access, const Allocator& allocator, MappedFile& out,
                 Error& error);
void close_file(MappedFile& file);

/// Writes to a temporary name beside `path`, then renames: a reader sees the old file or the whole
/// new one, and a failure leaves nothing behind. Devices and pipes are written to directly.
Status write_file(const char* path, const uint8_t* bytes, size_t size, const Allocator& allocator,
                  Error& error);

}  // namespace mien
