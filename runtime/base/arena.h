// SPDX-License-Identifier: MIT
// Two ways to put many arrays into few allocations.
//
//   Arena   grows in chunks, for data whose size is not known before a file is read.
//   Placer  measures, then places, for objects of known shape (rig, instance): one block each.
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <new>
#include <type_traits>

#include "runtime/base/allocator.h"
#include "runtime/base/span.h"

namespace mien {

constexpr size_t kBlockAlignment = 64;  // a cache line, and the widest vector we use

inline size_t align_up(size_t value, size_t alignment) {
  return (value + alignment - 1) & ~(alignment - 1);
}

/// Memory that only grows and is released all at once. Destructors do not run, so it takes trivially
/// destructible types only.
class Arena {
 public:
  explicit Arena(const Allocator& allocator) : allocator_(allocator) {}
  ~Arena() { clear(); }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// An estimate of the bytes that will be needed, so that one request is enough. A wrong estimate
  /// costs another request, or memory that stays unused.
  void expect(size_t size) { expected_ = size; }

  /// Null if memory ran out.
  void* allocate(size_t size, size_t alignment) {
    size_t at = align_up(used_, alignment);
    if (!chunk_ || allocator_.arena_chunk == 0 || at > chunk_->size || size > chunk_->size - at) {
      if (!grow(size, alignment)) return nullptr;
      at = align_up(used_, alignment);
    }
    used_ = at + size;
    return reinterpret_cast<uint8_t*>(chunk_) + at;
  }

  /// `count` value-initialized elements; data is null if memory ran out (or count is 0).
  template <class T>
  Span<T> array(size_t count) {
    const Span<T> items = unwritten_array<T>(count);
    for (size_t i = 0; i < items.count; ++i) new (items.data + i) T();
    return items;
  }

  /// Not initialized: for large arrays that are written before they are read.
  template <class T>
  Span<T> unwritten_array(size_t count) {
    static_assert(std::is_trivially_destructible<T>::value, "an arena destroys nothing");
    if (count == 0 || count > SIZE_MAX / 2 / sizeof(T)) return {};
    void* memory = allocate(count * sizeof(T), alignof(T));
    if (!memory) return {};
    return {static_cast<T*>(memory), count};
  }

  /// Bytes taken from the allocator so far.
  size_t reserved() const { return reserved_; }

  void clear() {
    while (chunk_) {
      Chunk* previous = chunk_->previous;
      allocator_.put(chunk_, chunk_->size, kBlockAlignment);
      chunk_ = previous;
    }
    used_ = reserved_ = 0;
  }

 private:
  struct Chunk {
    Chunk* previous;
    size_t size;  // with this header
  };

  // Chunks grow with the memory already taken: a large file needs few of them, and the unused end
  // of the last one stays a fraction of the total.
  bool grow(size_t size, size_t alignment) {
    if (size > SIZE_MAX / 2) return false;
    size_t wanted = align_up(sizeof(Chunk), alignment) + size;
    if (allocator_.arena_chunk != 0) {
      wanted += kBlockAlignment;
      for (size_t step : {allocator_.arena_chunk, reserved_ / 2, expected_}) {
        if (wanted < step) wanted = step;
      }
      wanted = align_up(wanted, kBlockAlignment);
    }
    expected_ = 0;
    void* memory = allocator_.get(wanted, kBlockAlignment);
    if (!memory) return false;
    chunk_ = new (memory) Chunk{chunk_, wanted};
    used_ = sizeof(Chunk);
    reserved_ += wanted;
    return true;
  }

  Allocator allocator_;
  Chunk* chunk_ = nullptr;
  size_t used_ = 0;
  size_t reserved_ = 0;
  size_t expected_ = 0;
};

/// Run the same placing code twice: without memory to measure the size, then with the block.
/// While measuring, the returned spans have a count but no data.
class Placer {
 public:
  explicit Placer(void* block) : base_(static_cast<uint8_t*>(block)) {}

  /// Zeroed when placed.
  template <class T>
  Span<T> array(size_t count, size_t alignment = alignof(T)) {
    const Span<T> items = unwritten_array<T>(count, alignment);
    if (items.data && count) memset(static_cast<void*>(items.data), 0, count * sizeof(T));
    return items;
  }

  /// The object that the block begins with.
  template <class T>
  void object() {
    used_ = sizeof(T);
  }

  /// Not initialized: for large arrays of which every element will be written.
  template <class T>
  Span<T> unwritten_array(size_t count, size_t alignment = alignof(T)) {
    static_assert(std::is_trivially_destructible<T>::value, "a block destroys no arrays");
    used_ = align_up(used_, alignment);
    void* at = base_ ? base_ + used_ : nullptr;
    used_ += count * sizeof(T);
    return {static_cast<T*>(at), count};
  }

  /// Replaces a list by a copy in the block. While measuring, only takes the room.
  template <class T>
  void keep(Span<T>& list, size_t alignment = alignof(T)) {
    static_assert(std::is_trivially_copyable<T>::value, "copied as bytes");
    const auto copy = unwritten_array<std::remove_const_t<T>>(list.count, alignment);
    if (measuring()) return;
    if (list.count != 0) {
      memcpy(static_cast<void*>(copy.data), list.data, list.count * sizeof(T));
    }
    list = copy;
  }

  bool measuring() const { return base_ == nullptr; }
  size_t size() const { return align_up(used_, kBlockAlignment); }

 private:
  uint8_t* base_;
  size_t used_ = 0;
};

/// Bytes of an object and its arrays in one block; `place(placer, object)` places the arrays.
template <class T, class Place>
size_t block_bytes(Place place) {
  T measured;
  Placer measure(nullptr);
  measure.object<T>();
  place(measure, measured);
  return measure.size();
}

/// Creates an object that has an `allocator` and a `block_size`, to be given back by release_block(). Null
/// if memory ran out.
template <class T, class Place>
T* create_block(const Allocator& allocator, Place place) {
  const size_t size = block_bytes<T>(place);
  void* block = allocator.get(size, kBlockAlignment);
  if (!block) return nullptr;
  T* object = new (block) T;
  Placer placer(block);
  placer.object<T>();
  place(placer, *object);
  object->allocator = allocator;
  object->block_size = size;
  return object;
}

template <class T>
void release_block(T* object) {
  if (!object) return;
  const Allocator allocator = object->allocator;
  const size_t size = object->block_size;
  object->~T();
  allocator.put(object, size, kBlockAlignment);
}

}  // namespace mien
