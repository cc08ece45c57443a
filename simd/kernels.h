// SPDX-License-Identifier: MIT
// The kernel table: one per instruction set, all with the same functions. Arrays in, arrays out; kernels do
// not depend on rigs or files. The headers of the subjects document the kernels and their arguments.
#pragma once

#include <stdint.h>

#include "simd/isa.h"
#include "simd/kernel_list.h"

namespace mien {

struct KernelTable {
  Isa isa;
  uint32_t batch_step;  // lanes that joint_batch and dense_batch compute at a time
  const char* name;
#define MIEN_KERNEL_POINTER(name, Type) Type* name;
  MIEN_KERNELS(MIEN_KERNEL_POINTER)
#undef MIEN_KERNEL_POINTER
};

}  // namespace mien
