// SPDX-License-Identifier: MIT
// A file that the caller reads, from an archive or over a network.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mien {

/// `read` copies the bytes from `offset` on into `buffer` and returns how many: fewer than `size` is
/// a failure. Offset and size lie within the `size` bytes of the stream.
struct Stream {
  void* user = nullptr;
  uint64_t size = 0;
  size_t (*read)(void* user, uint64_t offset, void* buffer, size_t size) = nullptr;
};

}  // namespace mien
