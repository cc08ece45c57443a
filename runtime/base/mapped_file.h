// SPDX-License-Identifier: MIT
// A file as read-only bytes: mapped, or read into memory where it cannot be mapped.
#pragma once

#include <cstdint>

#include "runtime/base/allocator.h"
#include "runtime/base/span.h"
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

/// Where reading stops, because a device or a pipe may have no end. Mapped files have no such limit.
struct FileLimits {
  /// Reading stops early if the file does not begin like this; the caller refuses it.
  const char* signature = nullptr;
  size_t signature_size = 0;
  /// More fails with kFileRead.
  uint64_t bytes = uint64_t{1} << 32;
};

/// `path` is UTF-8. On failure `out` holds nothing and `error` says why.
Status open_file(const char* path, FileAccess access, const FileLimits& limits,
                 const Allocator& allocator, MappedFile& out, Error& error);
void close_file(MappedFile& file);

/// The bytes of a file to be written: each call gives the next piece, and an empty one at the end.
struct Pieces {
  void* user;
  Span<const uint8_t> (*next)(void* user);
};

/// Writes to a temporary name in the same folder, then renames: a reader sees the old file or the whole
/// new one, and a failure leaves nothing behind. An existing file keeps its permissions; if its group
/// cannot be kept, the new group gets no more permissions than everyone had. A symbolic link is followed,
/// and refused if it leads nowhere. Devices and pipes are written to directly.
Status write_file(const char* path, const Pieces& pieces, const Allocator& allocator, Error& error);
Status write_file(const char* path, const uint8_t* bytes, size_t size, const Allocator& allocator,
                  Error& error);

// Common to all systems ------------------------------------------------------------------

constexpr size_t kCopyAlignment = 64;

/// "cannot open PATH: reason". Of a long path the end is shown, which tells more than the beginning.
Status fail_file(Error& error, Status status, const char* action, const char* path,
                 const char* reason);

/// Where bytes come from: copies up to `size` bytes to `to` and returns how many; 0 at the end, negative
/// if it fails.
struct ByteSource {
  void* user;
  int64_t (*read)(void* user, void* to, size_t size);
};

/// Reads to the end of a file of unknown size, such as a pipe. kMemory, or kFileRead for a file larger
/// than `limits` allows; gives false in `good` if the source failed.
Status read_to_end(const ByteSource& source, const char* path, size_t expected,
                   const FileLimits& limits, const Allocator& allocator, MappedFile& out,
                   bool& good, Error& error);

}  // namespace mien
