// SPDX-License-Identifier: MIT
// AVX2 with FMA: x86-64 since about 2013.
#define MIEN_KERNEL_ISA avx2
#define MIEN_KERNEL_AVX2 1
#define xsimd mien_xsimd_avx2

#include "simd/kernel_table.inl"
