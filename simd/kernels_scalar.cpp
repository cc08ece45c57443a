// SPDX-License-Identifier: MIT
// Plain C++: what the other instruction sets are tested against, and the fall-back.
#define MIEN_KERNEL_ISA scalar
#define MIEN_KERNEL_SCALAR 1

#include "simd/kernel_table.inl"
