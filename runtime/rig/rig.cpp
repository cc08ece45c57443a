// SPDX-License-Identifier: MIT
#include "runtime/rig/rig.h"

#include "runtime/base/arena.h"

namespace mien {

void release_rig(const Rig* rig) {
  if (rig->owners.fetch_sub(1, std::memory_order_acq_rel) != 1) return;
  Rig* last = const_cast<Rig*>(rig);
  const Allocator allocator = last->allocator;
  const size_t size = last->block_size;
  const SharedBytes* bytes = last->bytes;
  last->tag = 0;
  last->~Rig();
  allocator.put(last, size, kBlockAlignment);
  release_bytes(bytes);
}

}  // namespace mien
