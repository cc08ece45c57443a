// SPDX-License-Identifier: MIT
// AVX-512 F, CD, DQ, BW, VL.
#define MIEN_KERNEL_ISA avx512
#define MIEN_KERNEL_AVX512 1
#define xsimd mien_xsimd_avx512

#include "simd/kernel_table.inl"
