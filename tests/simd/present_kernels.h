// SPDX-License-Identifier: MIT
// The kernel tables that tests of kernels run: those of this CPU.
#pragma once

#include <vector>

#include "simd/kernels.h"

namespace mien {

/// Scalar first. Each call of a kernel by such a table is noted: the program fails at its end if one of
/// MIEN_KERNELS was not called on every instruction set here (tests/simd/kernel_list_test.cpp).
const std::vector<const KernelTable*>& present_kernels();

}  // namespace mien
