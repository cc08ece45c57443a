// SPDX-License-Identifier: MIT
// Tests with a short form for every day and a long one, which runs with MIEN_LONG_TESTS set (ctest -C
// long -L long).
#pragma once

#include <mien_author.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace mien {

/// `many` in long tests, or as many as MIEN_LONG_TESTS says if that is more than 1.
inline size_t rounds(size_t usual, size_t many) {
  const char* wanted = std::getenv("MIEN_LONG_TESTS");
  if (!wanted) return usual;
  const unsigned long long count = std::strtoull(wanted, nullptr, 10);
  return count > 1 ? static_cast<size_t>(count) : many;
}

/// Where random numbers of such a test begin.
inline uint32_t first_seed() {
  const char* wanted = std::getenv("MIEN_LONG_SEED");
  return wanted ? static_cast<uint32_t>(std::strtoul(wanted, nullptr, 10)) : 1;
}

/// Tests that change every byte of a file change every byte_stride()-th: all of them, unless
/// MIEN_BYTE_STRIDE says otherwise. That is for emulated CPUs, where all of them take hours. It is odd
/// there, so that each bit of a byte has its turn.
inline size_t byte_stride() {
  const char* wanted = std::getenv("MIEN_BYTE_STRIDE");
  const unsigned long long stride = wanted ? std::strtoull(wanted, nullptr, 10) : 1;
  return stride != 0 ? static_cast<size_t>(stride) : 1;
}

/// The last of the presets, from tiny on, that such a test generates: with a stride the large one is left out.
inline uint32_t largest_preset() {
  return byte_stride() == 1 ? MIEN_PRESET_LARGE : MIEN_PRESET_MEDIUM;
}

}  // namespace mien
