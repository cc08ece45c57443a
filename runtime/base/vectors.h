// SPDX-License-Identifier: MIT
// Helps compilers to vectorize and unroll plain loops.
#pragma once

#include <cstring>

// Put this before a short loop with a known number of iterations over arrays: otherwise g++ unrolls it
// completely and does not vectorize it.
#if defined(__GNUC__)
#define MIEN_VECTOR_LOOP _Pragma("GCC unroll 1")
#else
#define MIEN_VECTOR_LOOP
#endif

// Before a loop of a few loads and stores.
#if defined(__GNUC__)
#define MIEN_UNROLL_FOUR _Pragma("GCC unroll 4")
#else
#define MIEN_UNROLL_FOUR
#endif

namespace mien {

/// Four floats at once: a vector that is loaded soon after would wait for four stores.
inline void store_four(float* to, float a, float b, float c, float d) {
#if defined(__GNUC__)
  typedef float Four __attribute__((vector_size(4 * sizeof(float))));
  const Four four = {a, b, c, d};
#else
  const float four[4] = {a, b, c, d};
#endif
  memcpy(to, &four, sizeof(four));
}

}  // namespace mien
