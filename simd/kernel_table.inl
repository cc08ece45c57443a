// SPDX-License-Identifier: MIT
// All kernels of one instruction set, and their table: the only name its object file exports.

#include "simd/clip_kernels.inl"
#include "simd/compile_kernels.inl"
#include "simd/control_kernels.inl"
#include "simd/deform_kernels.inl"
#include "simd/dense_kernels.inl"
#include "simd/joint_kernels.inl"
#include "simd/mix_kernels.inl"
#include "simd/pose_kernels.inl"
#include "simd/rbf_batch_kernels.inl"
#include "simd/rbf_kernels.inl"
#include "simd/rotation_kernels.inl"
#include "simd/vertex_kernels.inl"

#define MIEN_KERNEL_STRING_OF(name) #name
#define MIEN_KERNEL_STRING(macro) MIEN_KERNEL_STRING_OF(macro)

namespace mien::MIEN_KERNEL_ISA {

extern const KernelTable kTable;  // const alone would keep it inside this file
const KernelTable kTable = {kIsa,
                            MIEN_KERNEL_STRING(MIEN_KERNEL_ISA),
                            joint_columns,
                            joint_columns_fixed,
                            joint_strips,
                            joint_strips_fixed,
                            joint_batch,
                            joint_batch_fixed,
                            scatter_targets,
                            kBatchStep,
                            nonzero,
                            psds,
                            psd_batch,
                            finish_sums,
                            gather_inputs,
                            floats_from_halves,
                            dense_layer,
                            dense_batch,
                            quaternion_joints,
                            angles_from_quaternions,
                            quaternions_from_angles,
                            twist_swing,
                            quaternion_batch,
                            twist_swing_batch,
                            scatter_rotation,
                            rbf_solvers,
                            rbf_batch,
                            gather_lanes,
                            scatter_lanes,
                            joint_locals,
                            joint_tree,
                            add_target,
                            skin_positions,
                            face_areas,
                            sum_normals,
                            write_vertices,
                            read_block_rows,
                            mark_nonzeros,
                            largest_magnitude,
                            fix_blocks,
                            blend_row,
                            cross_rows,
                            add_quintics,
                            limit_row,
                            guard_distances,
                            next_samples,
                            sample_values};

}  // namespace mien::MIEN_KERNEL_ISA
