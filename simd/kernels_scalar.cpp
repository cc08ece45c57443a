// SPDX-License-Identifier: MIT
// Plain C++: the reference for the other instruction sets, and the fallback.
#define MIEN_KERNEL_ISA scalar
#define MIEN_KERNEL_SCALAR 1

#include "simd/kernel_table.inl"
