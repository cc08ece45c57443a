// SPDX-License-Identifier: MIT
// Whether a file still has the content that it had: 64 bits of it, which accidents do not keep. No protection against
// files that were made to have the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace mien::cli {

/// The same for the same bytes on every machine, however they are split into add() calls.
class Fingerprint {
 public:
  void add(const void* bytes, size_t size);
  void add(const std::string& text) { add(text.data(), text.size()); }
  /// Sixteen hexadecimal digits.
  std::string text() const;

 private:
  void mix(const unsigned char* bytes, size_t block_count);

  // Four lanes of eight bytes, so that products do not wait for each other.
  uint64_t lanes_[4] = {0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0,
                        0x082efa98ec4e6c89};
  unsigned char rest_[32] = {};
  uint64_t size_ = 0;
};

/// Of a file, or of the names and contents of the files in a folder. Exit code 3 if it cannot be read.
std::string file_fingerprint(const std::string& path);

}  // namespace mien::cli
