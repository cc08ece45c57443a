// SPDX-License-Identifier: MIT
// Objects behind the handles of the C API. Each is one block of memory, released by its last owner.
//
//     struct Instance : Object {
//       static constexpr uint32_t kTag = ...;   // of its kind
//       const Rig* rig = nullptr;               // made by share(), so that the rig stays
// ~Instance() { release(rig); }           // gives up what it owns; release() frees its block
//     };
//
// Arrays of an object lie in its block or in memory that it owns, such as SharedBytes.
#pragma once

#include <atomic>

#include "runtime/base/arena.h"

namespace mien {

struct Object {
  uint32_t tag = 0;  // T::kTag; first, for the C API to recognize its handles
  mutable std::atomic<uint32_t> owners{1};  // the creator, and every object that refers to it
  Allocator allocator;
  size_t block_size = 0;
};

/// Starts an object at the beginning of a block from `allocator`, aligned to kBlockAlignment.
template <class T, class... Arguments>
T* start_object(void* block, size_t size, const Allocator& allocator, Arguments&&... arguments) {
  T* object = new (block) T(static_cast<Arguments&&>(arguments)...);
  object->tag = T::kTag;
  object->allocator = allocator;
  object->block_size = size;
  return object;
}

/// Creates an object and its arrays, which `place(placer, object)` places. Null if memory ran out.
template <class T, class Place>
T* create_object(const Allocator& allocator, Place place) {
  T* object = create_block<T>(allocator, place);
  if (object) object->tag = T::kTag;
  return object;
}

/// Creates an object without arrays in its block; its constructor takes the allocator. Null if memory ran
/// out.
template <class T>
T* create_object(const Allocator& allocator) {
  void* block = allocator.get(sizeof(T), kBlockAlignment);
  return block ? start_object<T>(block, sizeof(T), allocator, allocator) : nullptr;
}

/// Adds an owner.
template <class T>
const T* share(const T& object) {
  object.owners.fetch_add(1, std::memory_order_relaxed);
  return &object;
}

/// Drops an owner; the last one destroys the object and releases its block. Null is allowed.
template <class T>
void release(const T* object) {
  if (!object || object->owners.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  T* const last = const_cast<T*>(object);
  const Allocator allocator = last->allocator;
  const size_t size = last->block_size;
  last->~T();
  // As bytes: compilers drop a store to a member of an object that is destroyed.
  const uint32_t none = 0;
  memcpy(static_cast<void*>(last), &none, sizeof(none));
  allocator.put(last, size, kBlockAlignment);
}

}  // namespace mien
