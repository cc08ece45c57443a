// SPDX-License-Identifier: MIT
// Baseline of AArch64.
#define MIEN_KERNEL_ISA neon
#define MIEN_KERNEL_NEON 1
#define xsimd mien_xsimd_neon

#include "simd/kernel_table.inl"
