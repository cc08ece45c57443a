// SPDX-License-Identifier: MIT
// Floating-point environments that a host may have set: flush-to-zero, other directions of rounding.
#pragma once

#include <gtest/gtest.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <cfenv>
#include <string>

namespace mien {

// The word that governs floats, and its bits for subnormal results, and inputs, that count as 0.
#if defined(__SSE2__)
constexpr unsigned kFlushBits = 0x8040;
inline unsigned control_word() { return _mm_getcsr(); }
inline void set_control_word(unsigned word) { _mm_setcsr(word); }
#elif defined(__aarch64__)
constexpr unsigned kFlushBits = 1u << 24;
inline unsigned control_word() {
  uint64_t word;
  asm volatile("mrs %0, fpcr" : "=r"(word));
  return static_cast<unsigned>(word);
}
inline void set_control_word(unsigned word) { asm volatile("msr fpcr, %0" ::"r"(uint64_t{word})); }
#elif defined(__arm__)
constexpr unsigned kFlushBits = 1u << 24;
inline unsigned control_word() {
  unsigned word;
  asm volatile("vmrs %0, fpscr" : "=r"(word));
  return word;
}
inline void set_control_word(unsigned word) { asm volatile("vmsr fpscr, %0" ::"r"(word)); }
#else
constexpr unsigned kFlushBits = 0;  // RISC-V and s390x keep what is subnormal
inline unsigned control_word() { return 0; }
inline void set_control_word(unsigned) {}
#endif

struct Environment {
  bool flushes;
  int direction;
};
constexpr Environment kUsual = {false, FE_TONEAREST}, kFlushing = {true, FE_TONEAREST};
constexpr Environment kHosts[] = {kFlushing,
                                  {false, FE_DOWNWARD},
                                  {false, FE_UPWARD},
                                  {false, FE_TOWARDZERO},
                                  {true, FE_TOWARDZERO}};

/// The environment of the host, for as long as it lives.
struct Host {
  int direction = std::fegetround();
  unsigned word = control_word();
  explicit Host(const Environment& wanted) {
    EXPECT_EQ(std::fesetround(wanted.direction), 0);
    if (wanted.flushes) set_control_word(control_word() | kFlushBits);
  }
  ~Host() {
    std::fesetround(direction);
    set_control_word(word);
  }
};

inline std::string told(const Environment& host) {
  return "direction " + std::to_string(host.direction) + (host.flushes ? ", flushing" : "");
}

}  // namespace mien
