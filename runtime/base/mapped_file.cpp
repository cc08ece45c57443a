// SPDX-License-Identifier: MIT
#include "runtime/base/mapped_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#if defined(_WIN32)
#include <process.h>
#else
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace mien {
namespace {

constexpr size_t kCopyAlignment = 64;

// Of a long path the end is shown, which tells more than the beginning.
Status fail_file(Error& error, Status status, const char* action, const char* path,
                 const char* reason) {
  constexpr size_t kMaxShown = 140;
  const size_t length = strlen(path);
  const char* shown = length > kMaxShown ? path + (length - kMaxShown) : path;
  while (shown != path && (*shown & 0xC0) == 0x80) ++shown;  // not within a character of UTF-8
  return fail(error, status, kNoOffset, "cannot %s %s%s: %s", action, shown == path ? "" : "...",
              shown, reason);
}

// Reads to the end of a file of unknown size, such as a pipe. Grows by half, so the memory taken stays
// within a small multiple of the bytes read.
Status read_stream(FILE* stream, const char* path, size_t expected, const Allocator& allocator,
                   MappedFile& out, Error& error) {
  size_t capacity = expected + 1;  // one more, so that the end is seen without growing
  uint8_t* bytes = static_cast<uint8_t*>(allocator.get(capacity, kCopyAlignment));
  size_t size = 0;
  while (bytes) {
    size += fread(bytes + size, 1, capacity - size, stream);
    if (size < capacity) break;
    size_t larger = capacity + capacity / 2 + 64 * 1024;
    uint8_t* moved = static_cast<uint8_t*>(allocator.get(larger, kCopyAlignment));
    if (moved) memcpy(moved, bytes, size);
    allocator.put(bytes, capacity, kCopyAlignment);
    bytes = moved;
    capacity = larger;
  }
  if (!bytes) {
    return fail_file(error, Status::kMemory, "read", path, "no memory");
  }
  if (ferror(stream)) {
    allocator.put(bytes, capacity, kCopyAlignment);
    return fail_file(error, Status::kFileRead, "read", path, strerror(errno));
  }
  out.bytes = bytes;
  out.size = size;
  out.capacity = capacity;
  out.mapped = false;
  out.allocator = allocator;
  return Status::kOk;
}

// A device or a pipe must be written to; a rename would put a file in its place.
bool is_replaceable(const char* path) {
#if defined(_WIN32)
  (void)path;
  return true;
#else
  struct stat about;
  return stat(path, &about) != 0 || S_ISREG(about.st_mode);
#endif
}

}  // namespace

#if defined(_WIN32)

Status open_file(const char* path, FileAccess, const Allocator& allocator, MappedFile& out,
                 Error& error) {
  out = {};
  FILE* stream = fopen(path, "rb");
  if (!stream) {
    return fail_file(error, Status::kFileOpen, "open", path, strerror(errno));
  }
  Status status = read_stream(stream, path, 64 * 1024, allocator, out, error);
  fclose(stream);
  return status;
}

void close_file(MappedFile& file) {
  file.allocator.put(const_cast<uint8_t*>(file.bytes), file.capacity, kCopyAlignment);
  file = {};
}

#else

Status open_file(const char* path, FileAccess access, const Allocator& allocator, MappedFile& out,
                 Error& error) {
  out = {};
  int descriptor = open(path, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) {
    return fail_file(error, Status::kFileOpen, "open", path, strerror(errno));
  }
  struct stat about;
  if (fstat(descriptor, &about) != 0 || S_ISDIR(about.st_mode)) {
    int reason = S_ISDIR(about.st_mode) ? EISDIR : errno;
    close(descriptor);
    return fail_file(error, Status::kFileRead, "read", path, strerror(reason));
  }
  const bool regular = S_ISREG(about.st_mode) && about.st_size > 0;
  if (regular && static_cast<uint64_t>(about.st_size) > SIZE_MAX - 1) {
    close(descriptor);
    return fail_file(error, Status::kMemory, "read", path, "too large for the address space");
  }
  if (access == FileAccess::kMap && regular) {
    size_t size = static_cast<size_t>(about.st_size);
    void* map = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (map != MAP_FAILED) {
      close(descriptor);
      out.bytes = static_cast<const uint8_t*>(map);
      out.size = size;
      out.mapped = true;
      return Status::kOk;
    }
  }
  FILE* stream = fdopen(descriptor, "rb");
  if (!stream) {
    int reason = errno;
    close(descriptor);
    return fail_file(error, Status::kFileRead, "read", path, strerror(reason));
  }
  size_t expected = regular ? static_cast<size_t>(about.st_size) : 64 * 1024;
  Status status = read_stream(stream, path, expected, allocator, out, error);
  fclose(stream);
  return status;
}

void close_file(MappedFile& file) {
  if (file.mapped) {
    munmap(const_cast<uint8_t*>(file.bytes), file.size);
  } else {
    file.allocator.put(const_cast<uint8_t*>(file.bytes), file.capacity, kCopyAlignment);
  }
  file = {};
}

#endif

Status write_file(const char* path, const uint8_t* bytes, size_t size, const Allocator& allocator,
                  Error& error) {
  if (!is_replaceable(path)) {
    FILE* device = fopen(path, "wb");
    bool done = device && fwrite(bytes, 1, size, device) == size;
    done = device && fclose(device) == 0 && done;
    if (done) return Status::kOk;
    return fail_file(error, Status::kFileWrite, "write", path, strerror(errno));
  }

  // The temporary file stands in the same folder: only there can a rename be atomic.
  const size_t capacity = strlen(path) + 48;
  char* temporary = static_cast<char*>(allocator.get(capacity, 1));
  if (!temporary) return fail_file(error, Status::kMemory, "write", path, "no memory");
#if defined(_WIN32)
  const int process = _getpid();
#else
  const int process = static_cast<int>(getpid());
#endif
  // Unique among processes by the process number, among threads by a stack address.
  snprintf(temporary, capacity, "%s.tmp%d-%zx", path, process, reinterpret_cast<size_t>(&path));

  FILE* stream = fopen(temporary, "wbx");
  bool written = stream && fwrite(bytes, 1, size, stream) == size;
  int reason = errno;
  if (stream && fclose(stream) != 0 && written) {
    written = false;
    reason = errno;
  }
#if defined(_WIN32)
  if (written) remove(path);
#endif
  if (written && rename(temporary, path) != 0) {
    written = false;
    reason = errno;
  }
  Status status = Status::kOk;
  if (!written) {
    if (stream) remove(temporary);
    status = fail_file(error, Status::kFileWrite, "write", path, strerror(reason));
  }
  allocator.put(temporary, capacity, 1);
  return status;
}

}  // namespace mien
