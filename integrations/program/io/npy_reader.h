// SPDX-License-Identifier: MIT
// Arrays from NPY files of NumPy.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mien::cli {

struct NpyArray {
  std::vector<uint64_t> shape;
  std::vector<float> numbers;  // in C order
};

/// Numbers of the types f4, f8, and i and u of 1 to 8 bytes, little-endian. Fails with kInvalid: another
/// type, another order, a size that does not fit the shape, numbers that are not finite as floats; NaN may be there if
/// `nan`.
NpyArray read_npy(const std::string& bytes, const std::string& path, bool nan = false);

/// The same, or the only array of an NPZ file, compressed or not.
NpyArray read_npy_or_npz(const std::string& bytes, const std::string& path, bool nan = false);

}  // namespace mien::cli
