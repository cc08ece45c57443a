// SPDX-License-Identifier: MIT
// Whether a file still has the content that it had: 64 bits of it, which accidents do not keep. No protection against
// files that were made to have the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace mien::cli {

/// The same for the same bytes on every machine, however they are split into calls.
class Fingerprint {
 public:
  Fingerprint();
  /// With the instructions of AVX2 or without, for tests.
  explicit Fingerprint(bool has_avx2) : has_avx2_(has_avx2) {}

  void add(const void* bytes, size_t size) { add_bytes(bytes, size, nullptr); }
  void add(const std::string& text) { add(text.data(), text.size()); }
  /// The bytes of the floats, as they are in memory. Returns the index of the first that is not finite, or `count`: to
  /// look at them in the same pass costs little.
  size_t add_floats(const float* numbers, size_t count);
  /// Sixteen hexadecimal digits.
  std::string text() const;

  static constexpr size_t kStripeBytes = 128, kBlockStripes = 32;

 private:
  void add_bytes(const void* bytes, size_t size, float* float_sum);
  void mix(const unsigned char* stripes, size_t count, float* float_sum);
  void end_block();

  bool has_avx2_;
  uint64_t sums_[8] = {};  // of the products of this block
  uint64_t lanes_[8] = {0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0,
                        0x082efa98ec4e6c89, 0x452821e638d01377, 0xbe5466cf34e90c6c,
                        0xc0ac29b7c97c50dd, 0x3f84d5b5b5470917};  // of the blocks before
  size_t stripe_ = 0;                                             // of the block
  unsigned char rest_[kStripeBytes] = {};                         // of a stripe that is not full
  uint64_t size_ = 0;
};

/// Of a file, or of the names and contents of the files in a folder. Exit code 3 if it cannot be read.
std::string file_fingerprint(const std::string& path);

}  // namespace mien::cli
