// SPDX-License-Identifier: MIT
// Baseline of x86-64.
#define MIEN_KERNEL_ISA sse2
#define MIEN_KERNEL_SSE2 1
#define xsimd mien_xsimd_sse2

#include "simd/kernel_table.inl"
