// SPDX-License-Identifier: MIT
#include "integrations/program/io/npy_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace mien::cli {

namespace {

constexpr size_t kBlock = 64;

/// Without a branch for each number, so that compilers use SIMD.
inline bool is_finite_block(const float* numbers, size_t count) {
  uint32_t all = 0;
  for (size_t i = 0; i < count; ++i) {
    uint32_t bits;
    std::memcpy(&bits, &numbers[i], 4);
    // An exponent of ones, infinite or not a number, carries into the sign.
    all |= (bits & 0x7fffffff) + 0x00800000;
  }
  return all >> 31 == 0;
}

}  // namespace

void write_npy_header(const std::vector<uint64_t>& shape, Output& output) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (";
  for (size_t i = 0; i < shape.size(); ++i) {
    header += (i == 0 ? "" : ", ") + std::to_string(shape[i]);
  }
  header += shape.size() == 1 ? ",), }" : "), }";
  // Magic, version and length take 10 bytes; the data begins at a multiple of 64.
  while ((10 + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string start("\x93NUMPY\x01\x00", 8);
  start += static_cast<char>(header.size() & 255);
  start += static_cast<char>(header.size() >> 8);
  output.write(start + header);
}

size_t write_npy_floats(const float* numbers, size_t count, Output& output) {
  for (size_t first = 0; first < count; first += kBlock) {
    const size_t end = std::min(count, first + kBlock);
    const bool is_whole = end - first == kBlock;  // unrolled then
    if (is_whole ? is_finite_block(numbers + first, kBlock)
                 : is_finite_block(numbers + first, end - first)) {
      continue;
    }
    return static_cast<size_t>(
        std::find_if(numbers + first, numbers + end, [](float x) { return !std::isfinite(x); }) -
        numbers);
  }
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  std::vector<unsigned char> bytes(count * 4);
  for (size_t i = 0; i < count; ++i) {
    uint32_t bits;
    std::memcpy(&bits, &numbers[i], 4);
    for (size_t k = 0; k < 4; ++k) bytes[4 * i + k] = static_cast<unsigned char>(bits >> (8 * k));
  }
  output.write(bytes.data(), bytes.size());
#else
  output.write(numbers, count * 4);
#endif
  return count;
}

}  // namespace mien::cli
