// SPDX-License-Identifier: MIT
// A stream over bytes, which fails when it is told to and looks at what it is asked for.
#pragma once

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/stream.h"

namespace mien {

struct MemoryStream {
  explicit MemoryStream(std::vector<uint8_t> file) : bytes(std::move(file)) {}

  std::vector<uint8_t> bytes;

  size_t fail_at = 0;        // this read, counted from 1, fails; 0: none
  bool reads_short = false;  // by giving one byte too few, else by giving none

  mutable size_t reads = 0;
  mutable std::vector<std::pair<uint64_t, size_t>> ranges;  // offset and size of each read
  mutable std::string wrong;                                // "" if all reads lay in the file

  Stream get() const { return {const_cast<MemoryStream*>(this), bytes.size(), read}; }

  static size_t read(void* user, uint64_t offset, void* buffer, size_t size) {
    const MemoryStream& self = *static_cast<const MemoryStream*>(user);
    if (offset > self.bytes.size() || size > self.bytes.size() - offset) {
      self.wrong = "read past the end";
      return 0;
    }
    if (size == 0) self.wrong = "read nothing";
    self.ranges.push_back({offset, size});
    size_t count = size;
    if (++self.reads == self.fail_at) count = self.reads_short ? size - 1 : 0;
    memcpy(buffer, self.bytes.data() + offset, count);
    return count;
  }
};

}  // namespace mien
