// SPDX-License-Identifier: MIT
#include "runtime/base/shared_bytes.h"

#include "runtime/base/arena.h"

namespace mien {

void release_bytes(const SharedBytes* bytes) {
  if (!bytes || bytes->owners.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  SharedBytes* last = const_cast<SharedBytes*>(bytes);
  last->tag = 0;
  if (last->file.bytes) close_file(last->file);
  const Allocator allocator = last->allocator;
  const size_t size = last->block_size;
  last->~SharedBytes();
  allocator.put(last, size, kBlockAlignment);
}

}  // namespace mien
