// SPDX-License-Identifier: MIT
// Sized structs of the C interface, ready to be passed. Without GoogleTest, for fuzzers too.
#pragma once

#include "capi/include/mien.h"

namespace mien {

/// A struct of any kind with its size in place.
template <class T>
T sized() {
  T object = {};
  object.struct_size = sizeof(T);
  return object;
}

/// A desc with this allocator, else default.
template <class Desc>
Desc desc_with(const MienAllocator* allocator) {
  Desc desc = sized<Desc>();
  desc.allocator = allocator;
  return desc;
}

inline MienBatchDesc batch_desc(uint32_t capacity, uint32_t tasks = 0,
                                const MienAllocator* allocator = nullptr) {
  MienBatchDesc desc = desc_with<MienBatchDesc>(allocator);
  desc.capacity = capacity;
  desc.tasks = tasks;
  return desc;
}

}  // namespace mien
