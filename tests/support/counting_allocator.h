// SPDX-License-Identifier: MIT
// The allocator of tests: it knows what is live, compares what comes back with what was given, and
// fails when it is told to.
#pragma once

#include <cstdio>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <unordered_map>

#include "capi/include/mien.h"

namespace mien {

/// Hands itself out as a MienAllocator. May be used by several threads; its numbers are for when
/// they are done.
class CountingAllocator {
 public:
  // Wishes ----------------------------------------------------------------------------------------

  size_t fail_at = 0;         // this request, counted from 1, gets nothing; 0: none
  bool keep_failing = false;  // nor do those after it
  size_t limit = SIZE_MAX;    // requests that would make `bytes` larger get nothing
  bool misalign = false;      // blocks lie half an alignment off, if that is possible

  // Numbers ---------------------------------------------------------------------------------------

  size_t requests = 0;      // also those that failed
  size_t live = 0;          // blocks
  size_t bytes = 0;         // of live blocks
  size_t peak = 0;          // most bytes at a time
  size_t failed = 0;        // requests that got nothing
  size_t over_limit = 0;    // largest request that `limit` refused
  std::string first_wrong;  // the first thing that was wrong with a call; "" if all was right

  MienAllocator get() { return {this, allocate, release}; }

  /// Nothing live, nothing wrong.
  bool clean() const { return live == 0 && first_wrong.empty(); }

  /// Counts afresh; what is live stays live.
  void restart() {
    requests = failed = over_limit = 0;
    peak = bytes;
  }

  ~CountingAllocator() {
    for (const auto& entry : blocks_) free_block(entry.second);
  }

 private:
  struct Block {
    void* memory;  // of the heap; the block lies in it
    size_t size, alignment;
  };

  static void* allocate(void* user, size_t size, size_t alignment) {
    CountingAllocator& self = *static_cast<CountingAllocator*>(user);
    const std::lock_guard<std::mutex> lock(self.mutex_);
    ++self.requests;
    if (size == 0 || alignment == 0 || (alignment & (alignment - 1)) != 0 || alignment > 64) {
      self.wrong("asked for", size, alignment);
    }
    const bool told = self.fail_at != 0 && (self.requests == self.fail_at ||
                                            (self.keep_failing && self.requests > self.fail_at));
    const bool too_much = size > self.limit || self.bytes > self.limit - size;
    if (too_much && size > self.over_limit) self.over_limit = size;
    if (told || too_much) {
      ++self.failed;
      return nullptr;
    }
    // Exactly as large as asked for, so that the address sanitizer sees a step past the end.
    const size_t shift = self.misalign ? alignment / 2 : 0;
    void* memory = ::operator new (size + shift, std::align_val_t{alignment}, std::nothrow);
    if (!memory) return nullptr;
    // Nobody may rely on what fresh memory holds.
    memset(memory, 0xA5, size + shift);
    void* block = static_cast<char*>(memory) + shift;
    self.blocks_[block] = {memory, size, alignment};
    ++self.live;
    self.bytes += size;
    if (self.bytes > self.peak) self.peak = self.bytes;
    return block;
  }

  static void release(void* user, void* block, size_t size, size_t alignment) {
    CountingAllocator& self = *static_cast<CountingAllocator*>(user);
    const std::lock_guard<std::mutex> lock(self.mutex_);
    const auto found = self.blocks_.find(block);
    if (found == self.blocks_.end())
      return self.wrong("released without having it:", size, alignment);
    const Block given = found->second;
    if (given.size != size || given.alignment != alignment) {
      self.wrong("released as", size, alignment);
      self.wrong("but it was", given.size, given.alignment);
    }
    self.blocks_.erase(found);
    --self.live;
    self.bytes -= given.size;
    free_block(given);
  }

  static void free_block(const Block& block) {
    ::operator delete (block.memory, std::align_val_t{block.alignment});
  }

  void wrong(const char* what, size_t size, size_t alignment) {
    if (!first_wrong.empty()) return;
    char text[120];
    snprintf(text, sizeof(text), "%s %zu bytes at %zu", what, size, alignment);
    first_wrong = text;
  }

  std::mutex mutex_;
  std::unordered_map<void*, Block> blocks_;
};

}  // namespace mien
