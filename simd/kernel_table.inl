// SPDX-License-Identifier: MIT
// All kernels of one instruction set, and their table: the only name its object file exports.

#include "simd/clip_kernels.inl"
#include "simd/compile_kernels.inl"
#include "simd/control_kernels.inl"
#include "simd/deform_kernels.inl"
#include "simd/dense_kernels.inl"
#include "simd/derivative_kernels.inl"
#include "simd/joint_kernels.inl"
#include "simd/kernels.h"
#include "simd/lane_kernels.inl"
#include "simd/mix_kernels.inl"
#include "simd/pose_kernels.inl"
#include "simd/rbf_batch_kernels.inl"
#include "simd/rbf_kernels.inl"
#include "simd/rotation_kernels.inl"
#include "simd/vertex_kernels.inl"

#define MIEN_KERNEL_STRING_OF(name) #name
#define MIEN_KERNEL_STRING(macro) MIEN_KERNEL_STRING_OF(macro)
#define MIEN_KERNEL_ENTRY(name, Type) name,

namespace mien::MIEN_KERNEL_ISA {

extern const KernelTable kTable;  // const alone would keep it inside this file
const KernelTable kTable = {kIsa, kBatchStep, MIEN_KERNEL_STRING(MIEN_KERNEL_ISA),
                            MIEN_KERNELS(MIEN_KERNEL_ENTRY)};

}  // namespace mien::MIEN_KERNEL_ISA
