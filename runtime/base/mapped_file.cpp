// SPDX-License-Identifier: MIT
#include "runtime/base/mapped_file.h"

#include <cstdio>
#include <cstring>

namespace mien {

Status fail_file(Error& error, Status status, const char* action, const char* path,
                 const char* reason) {
  constexpr size_t kMaxShown = 140;
  const size_t length = strlen(path);
  const char* shown = length > kMaxShown ? path + (length - kMaxShown) : path;
  while (shown != path && (*shown & 0xC0) == 0x80) ++shown;  // not within a character of UTF-8
  return fail(error, status, kNoOffset, "cannot %s %s%s: %s", action, shown == path ? "" : "...",
              shown, reason);
}

Status write_file(const char* path, const uint8_t* bytes, size_t size, const Allocator& allocator,
                  Error& error) {
  Span<const uint8_t> left{bytes, size};
  const auto next = [](void* user) {
    Span<const uint8_t>& rest = *static_cast<Span<const uint8_t>*>(user);
    const Span<const uint8_t> piece = rest;
    rest = {};
    return piece;
  };
  return write_file(path, {&left, next}, allocator, error);
}

// Grows by half, so the memory taken stays within a small multiple of the bytes read.
Status read_to_end(const ByteSource& source, const char* path, size_t expected,
                   const FileLimits& limits, const Allocator& allocator, MappedFile& out,
                   bool& good, Error& error) {
  out = {};
  good = true;
  size_t capacity = expected + 1;  // one more, so that the end is seen without growing
  uint8_t* bytes = static_cast<uint8_t*>(allocator.get(capacity, kCopyAlignment));
  size_t size = 0;
  bool ended = false, signed_well = limits.signature_size == 0;
  while (bytes) {
    while (size < capacity && !ended) {
      const int64_t count = source.read(source.user, bytes + size, capacity - size);
      ended = count <= 0;
      good = count >= 0;
      if (count > 0) size += static_cast<size_t>(count);
      if (signed_well || size < limits.signature_size) continue;
      signed_well = memcmp(bytes, limits.signature, limits.signature_size) == 0;
      ended |= !signed_well;
    }
    if (ended || size > limits.bytes) break;
    const size_t larger = capacity + capacity / 2 + 64 * 1024;
    uint8_t* moved = static_cast<uint8_t*>(allocator.get(larger, kCopyAlignment));
    if (moved) memcpy(moved, bytes, size);
    allocator.put(bytes, capacity, kCopyAlignment);
    bytes = moved;
    capacity = larger;
  }
  if (!bytes) {
    return fail_file(error, Status::kMemory, "read", path, "no memory");
  }
  if (!good || size > limits.bytes) {
    allocator.put(bytes, capacity, kCopyAlignment);
    if (!good) return Status::kFileRead;
    char reason[64];
    snprintf(reason, sizeof(reason), "it has more than %llu bytes",
             static_cast<unsigned long long>(limits.bytes));
    return fail_file(error, Status::kFileRead, "read", path, reason);
  }
  out.bytes = bytes;
  out.size = size;
  out.capacity = capacity;
  out.allocator = allocator;
  return Status::kOk;
}

}  // namespace mien
