// SPDX-License-Identifier: MIT
// Arrays of 32-bit floats as NPY files of NumPy, written piece by piece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "integrations/program/io/output.h"

namespace mien::cli {

/// The header; the numbers follow in C order.
void write_npy_header(const std::vector<uint64_t>& shape, Output& output);

/// Some of the numbers. Returns the index of the first that is not finite, or `count`; then all are written.
size_t write_npy_floats(const float* numbers, size_t count, Output& output);

}  // namespace mien::cli
