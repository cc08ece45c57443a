// SPDX-License-Identifier: MIT
// Every kernel, one per line: its name and its type. The table (kernels.h), the tables of all instruction
// sets (kernel_table.inl) and the check that each kernel has a test (tests/simd) are made from this list.
#pragma once

#include "simd/clip_kernels.h"
#include "simd/compile_kernels.h"
#include "simd/control_kernels.h"
#include "simd/deform_kernels.h"
#include "simd/dense_kernels.h"
#include "simd/derivative_kernels.h"
#include "simd/joint_kernels.h"
#include "simd/lane_kernels.h"
#include "simd/mix_kernels.h"
#include "simd/pose_kernels.h"
#include "simd/rbf_kernels.h"
#include "simd/rotation_kernels.h"
#include "simd/vertex_kernels.h"

#define MIEN_KERNELS(KERNEL)                            \
  KERNEL(joint_columns, JointColumnsKernel)             \
  KERNEL(joint_columns_fixed, JointColumnsKernel)       \
  KERNEL(joint_strips, JointStripsKernel)               \
  KERNEL(joint_strips_fixed, JointStripsKernel)         \
  KERNEL(joint_batch, JointBatchKernel)                 \
  KERNEL(joint_batch_fixed, JointBatchKernel)           \
  KERNEL(finish_sums, FinishSumsKernel)                 \
  KERNEL(finish_runs, FinishRunsKernel)                 \
  KERNEL(scatter_targets, ScatterTargetsKernel)         \
  KERNEL(joint_transposed, JointTransposedKernel)       \
  KERNEL(joint_transposed_fixed, JointTransposedKernel) \
  KERNEL(nonzero, NonzeroKernel)                        \
  KERNEL(different, DifferentKernel)                    \
  KERNEL(psds, PsdsKernel)                              \
  KERNEL(psd_list, PsdListKernel)                       \
  KERNEL(psd_batch, PsdBatchKernel)                     \
  KERNEL(gather_lanes, GatherLanesKernel)               \
  KERNEL(scatter_lanes, ScatterLanesKernel)             \
  KERNEL(gather_inputs, GatherInputsKernel)             \
  KERNEL(floats_from_halves, FloatsFromHalvesKernel)    \
  KERNEL(dense_layer, DenseLayerKernel)                 \
  KERNEL(dense_batch, DenseBatchKernel)                 \
  KERNEL(quaternion_joints, QuaternionJointsKernel)     \
  KERNEL(quaternion_batch, QuaternionBatchKernel)       \
  KERNEL(angles_from_quaternions, EulerKernel)          \
  KERNEL(quaternions_from_angles, EulerKernel)          \
  KERNEL(twist_swing, TwistSwingKernel)                 \
  KERNEL(twist_swing_batch, TwistSwingBatchKernel)      \
  KERNEL(scatter_rotation, ScatterRotationKernel)       \
  KERNEL(rbf_solvers, RbfSolversKernel)                 \
  KERNEL(rbf_batch, RbfBatchKernel)                     \
  KERNEL(joint_locals, JointLocalsKernel)               \
  KERNEL(joint_tree, JointTreeKernel)                   \
  KERNEL(add_target, AddTargetKernel)                   \
  KERNEL(add_target_fixed, AddFixedTargetKernel)        \
  KERNEL(add_target_packed, AddFixedTargetKernel)       \
  KERNEL(floats_from_fixed, FloatsFromFixedKernel)      \
  KERNEL(skin_positions, SkinPositionsKernel)           \
  KERNEL(skin_transposed, SkinTransposedKernel)         \
  KERNEL(face_areas, FaceAreasKernel)                   \
  KERNEL(sum_normals, SumNormalsKernel)                 \
  KERNEL(write_vertices, WriteVerticesKernel)           \
  KERNEL(read_block_rows, ReadBlockRowsKernel)          \
  KERNEL(mark_nonzeros, MarkNonzerosKernel)             \
  KERNEL(largest_magnitude, LargestMagnitudeKernel)     \
  KERNEL(fix_blocks, FixBlocksKernel)                   \
  KERNEL(blend_row, BlendRowKernel)                     \
  KERNEL(cross_rows, CrossRowsKernel)                   \
  KERNEL(add_quintics, AddQuinticsKernel)               \
  KERNEL(limit_row, LimitRowKernel)                     \
  KERNEL(guard_distances, GuardDistancesKernel)         \
  KERNEL(next_samples, NextSamplesKernel)               \
  KERNEL(sample_values, SampleValuesKernel)
