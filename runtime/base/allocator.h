// SPDX-License-Identifier: MIT
// Memory comes from the caller, per object. The library itself never calls malloc.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien {

/// `allocate` returns memory of at least `size` bytes at a multiple of `alignment` (a power of two,
/// 64 at most), or null. `release` gets the same size and alignment back.
struct Allocator {
  void* user = nullptr;
  void* (*allocate)(void* user, size_t size, size_t alignment) = nullptr;
  void (*release)(void* user, void* block, size_t size, size_t alignment) = nullptr;
  /// The smallest request of an Arena. 0: each of its arrays is a block of its own that ends with it, so
  /// that tests can let any of them fail, and sanitizers notice an access past its end.
  size_t arena_chunk = 16 * 1024;

  /// Null also if the allocator gave a misaligned block, which goes back to it.
  void* get(size_t size, size_t alignment) const {
    void* block = allocate(user, size, alignment);
    if ((reinterpret_cast<uintptr_t>(block) & (alignment - 1)) == 0) return block;
    release(user, block, size, alignment);
    return nullptr;
  }
  void put(void* block, size_t size, size_t alignment) const {
    if (block) release(user, block, size, alignment);
  }
};

/// The C library's heap.
Allocator default_allocator();

}  // namespace mien
