// SPDX-License-Identifier: MIT
#include "runtime/base/allocator.h"

#include <cstddef>
#include <cstdlib>

#if defined(_WIN32)
#include <malloc.h>
#endif

namespace mien {
namespace {

void* heap_allocate(void*, size_t size, size_t alignment) {
#if defined(_WIN32)
  return _aligned_malloc(size, alignment);
#else
  // aligned_alloc wants a size that is a multiple of the alignment, and in some C libraries an
  // alignment that is no less than that of a pointer.
  if (alignment <= alignof(std::max_align_t)) return malloc(size);
  if (size > SIZE_MAX - alignment) return nullptr;
  return aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
#endif
}

void heap_release(void*, void* block, size_t, size_t) {
#if defined(_WIN32)
  _aligned_free(block);
#else
  free(block);
#endif
}

}  // namespace

Allocator default_allocator() { return {nullptr, heap_allocate, heap_release}; }

}  // namespace mien
