// SPDX-License-Identifier: MIT
#include "integrations/program/io/npy_writer.h"

#include <cstring>
#include <string>

#include "integrations/program/math/finite.h"

namespace mien::cli {

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
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  const size_t finite = math::finite_count(numbers, count);
  if (finite != count) return finite;
  std::vector<unsigned char> bytes(count * 4);
  for (size_t i = 0; i < count; ++i) {
    uint32_t bits;
    std::memcpy(&bits, &numbers[i], 4);
    for (size_t k = 0; k < 4; ++k) bytes[4 * i + k] = static_cast<unsigned char>(bits >> (8 * k));
  }
  output.write(bytes.data(), bytes.size());
  return count;
#else
  return output.write_floats(numbers, count);
#endif
}

}  // namespace mien::cli
