// SPDX-License-Identifier: MIT
// Counts requests that pass by the caller's allocator. It replaces operator new, so one file of a
// program includes it.
#pragma once

#include <cstdlib>
#include <new>

namespace {
size_t g_news = 0;
}

// Inlined, gcc takes these for a mismatch.
[[gnu::noinline]] void* operator new(size_t size) {
  ++g_news;
  void* memory = malloc(size ? size : 1);
  if (!memory) abort();
  return memory;
}
[[gnu::noinline]] void* operator new(size_t size, const std::nothrow_t&) noexcept {
  ++g_news;
  return malloc(size ? size : 1);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { free(memory); }
