// SPDX-License-Identifier: MIT
// The derivatives of each stage: linearize_...() computes the coefficients, push_...() multiplies
// directions, pull_...() gradients. A value has L lanes, 1 or kBatchLanes. A stage that assigns a value
// clears its gradient, so that earlier writers of it get none.
#pragma once

#include <algorithm>

#include "runtime/derive/derivatives.h"
#include "simd/kernels.h"

namespace mien {

template <uint32_t L>
inline void add_scaled(float* to, const float* from, float factor) {
  for (uint32_t k = 0; k < L; ++k) to[k] += factor * from[k];
}
template <uint32_t L>
inline void clear(float* to) {
  for (uint32_t k = 0; k < L; ++k) to[k] = 0.0f;
}
/// to = from, from = 0.
template <uint32_t L>
inline void take(float* to, float* from) {
  for (uint32_t k = 0; k < L; ++k) {
    to[k] = from[k];
    from[k] = 0.0f;
  }
}

inline bool is_at_lod(uint64_t lods, uint32_t lod) { return lods >> lod & 1; }

/// Where number i of a point stands in its buffer, or kNoPlace: matrices have constant rows.
constexpr size_t kNoPlace = ~size_t{0};
inline size_t place_in_buffer(Point point, size_t i) {
  if (point < Point::kLocals || point > Point::kSkins) return i;
  const size_t column = i % kMatrixFloats / 4, row = i % 4;
  return row == 3 ? kNoPlace : i / kMatrixFloats * kMatrixParts + 3 * column + row;
}

/// Calls f(output) for rotation outputs of the LOD among the first `blocks` blocks, or backwards.
template <class F>
inline void for_each_output(const Span<RotationOutput>& outputs, uint32_t lod, uint32_t blocks,
                            F&& f) {
  for (const RotationOutput& output : outputs) {
    if (is_at_lod(output.lods, lod) && output.lane / kBlockLanes < blocks) f(output);
  }
}
template <class F>
inline void for_each_output_backwards(const Span<RotationOutput>& outputs, uint32_t lod,
                                      uint32_t blocks, F&& f) {
  for (size_t i = outputs.count; i-- > 0;) {
    const RotationOutput& output = outputs[i];
    if (is_at_lod(output.lods, lod) && output.lane / kBlockLanes < blocks) f(output);
  }
}

// Conditional tables, correctives, channels, maps (derive_controls.cpp) ---------------------------
void linearize_tables(Derivatives& d, const Instance& instance);
void linearize_psds(Derivatives& d);
template <uint32_t L>
void push_gui(Derivatives& d);
template <uint32_t L>
void pull_gui(Derivatives& d);
template <uint32_t L>
void push_psds(Derivatives& d);
template <uint32_t L>
void pull_psds(Derivatives& d);
template <uint32_t L>
void push_channels(Derivatives& d);
template <uint32_t L>
void pull_channels(Derivatives& d);
template <uint32_t L>
void push_maps(Derivatives& d);
template <uint32_t L>
void pull_maps(Derivatives& d);

// Networks (derive_neural.cpp) --------------------------------------------------------------------
/// Packs the weights once, when the derivatives are created.
void pack_networks(Derivatives& d);
/// Calls f(where an input of a network is, number), with L lanes or 1 for each control and value.
template <uint32_t L, class T, class F>
void for_each_ml_input(const MlTable& ml, const MlStep& step, T* controls, T* values, F&& f) {
  uint32_t i = 0;
  if (step.gather_count != 0) {
    const uint32_t count = std::min(step.gather_count, ml.layers[step.first_layer].input_count);
    for (; i < count; ++i) {
      f(controls + size_t{ml.controls[step.first_gather + i]} * L, i);
    }
    return;
  }
  for (const MlDependency& from :
       ml.dependencies.slice(step.first_dependency, step.dependency_count)) {
    for (uint32_t k = 0; k < from.count; ++k) f(values + (size_t{from.first} + k) * L, i++);
  }
}
/// The terms of a weighted sum: f(where the value is, output, weight).
template <uint32_t L, class T, class F>
void for_each_ml_term(const MlTable& ml, const MlStep& step, T* controls, T* values, F&& f) {
  for (const MlDependency& from :
       ml.dependencies.slice(step.first_dependency, step.dependency_count)) {
    for (uint32_t i = 0; i < step.output_count; ++i) {
      f(from.gathers ? controls + size_t{ml.controls[from.first + i]} * L
                     : values + (size_t{from.first} + i) * L,
        i, from.weight);
    }
  }
}
/// Evaluates the networks at Derivatives::values, which get the results.
void linearize_ml(Derivatives& d, const Instance& instance);
template <uint32_t L>
void push_ml(Derivatives& d);
template <uint32_t L>
void pull_ml(Derivatives& d);

// RBF solvers (derive_rbf.cpp) --------------------------------------------------------------------
/// Controls that a solver reads.
uint32_t rbf_input_count(const RbfSolverPlan& plan);
uint16_t rbf_input_control(const RbfTable& rbf, const RbfSolverPlan& plan, uint32_t i);
void linearize_rbf(Derivatives& d);
template <uint32_t L>
void push_rbf(Derivatives& d);
template <uint32_t L>
void pull_rbf(Derivatives& d);

// Joint values (derive_joints.cpp; rotations in derive_rotations.cpp) -----------------------------
/// Packed rows that write the joint values, then the angles, at a LOD; kNoRow for those without.
void find_value_rows(const Rig& rig, uint32_t lod, const Span<uint32_t>& value_rows);
/// Fills what depends on the LOD alone.
void find_joint_rows(Derivatives& d);
/// Fills Derivatives::block_starts once, when the derivatives are created.
void count_blocks(Derivatives& d);
template <uint32_t L>
void push_joint_rows(Derivatives& d);
template <uint32_t L>
void pull_joint_rows(Derivatives& d);
/// Where the rotation of a joint is among the joint values.
inline size_t rotation_value(const Rig& rig, uint32_t joint) {
  return size_t{joint} * rig.joint_attributes + 3;
}
inline uint32_t turn_blocks(const Rig& rig, uint32_t lod) {
  return rig.rotations.first_steps.empty() ? 0 : rig.rotations.blocks_at_lod[lod];
}
inline uint32_t twist_blocks(const Rig& rig, uint32_t lod) {
  return rig.twist_swing.outputs.empty() ? 0 : rig.twist_swing.blocks_at_lod[lod];
}
/// The controls that a lane of a twist or swing reads.
inline uint16_t twist_input(const TwistSwingTable& table, uint32_t lane_number, size_t k) {
  return table
      .inputs[(lane_number / kBlockLanes * 4 + k) * kBlockLanes + lane_number % kBlockLanes];
}
/// Calls f(control, step and lane) for the steps of a turn.
template <class F>
void for_each_step(const Rig& rig, uint32_t lod, uint32_t lane_number, F&& f) {
  const RotationTable& table = rig.rotations;
  const size_t block = lane_number / kBlockLanes, lane = lane_number % kBlockLanes;
  const size_t first = table.first_steps[block];
  const size_t of_lod = size_t{lod} * table.block_count() + block;
  const auto steps = static_cast<size_t>(table.lane_steps_at_lod[of_lod * kBlockLanes + lane]);
  for (size_t s = first; s < first + steps; ++s) {
    f(table.columns[s * kBlockLanes + lane], s * kBlockLanes + lane);
  }
}
/// Calls f(joint) for the joints whose angles become quaternions at the LOD.
template <class F>
void for_each_angle_joint(const Rig& rig, uint32_t lod, F&& f) {
  const RotationTable& table = rig.rotations;
  if (table.angle_joints.empty()) return;
  for (uint32_t group = 0; group < rig.joints.group_count; ++group) {
    const GroupRotations& rotations = table.groups[group];
    const uint32_t rows = rig.joints.group_rows_at_lod[size_t{group} * rig.lod_count + lod];
    for (const AngleJoint& joint :
         table.angle_joints.slice(rotations.first_angle_joint, rotations.angle_joint_count)) {
      if (joint.first_row >= rows) break;
      f(joint.joint);
    }
  }
}
void linearize_rotations(Derivatives& d, const Instance& instance);
/// A converted rotation of an ML joint: its derivatives [4][4], and the converted value in place.
void convert_rotation_slopes(Derivatives& d, float* x, float* slopes);
template <uint32_t L>
void push_rotations(Derivatives& d);
template <uint32_t L>
void pull_rotations(Derivatives& d);

// Matrices (derive_pose.cpp) ----------------------------------------------------------------------
void linearize_pose(Derivatives& d, const Instance& instance);
template <uint32_t L>
void push_locals(Derivatives& d);
template <uint32_t L>
void pull_locals(Derivatives& d);
template <uint32_t L>
void push_models(Derivatives& d);
template <uint32_t L>
void pull_models(Derivatives& d);
template <uint32_t L>
void push_skins(Derivatives& d);
template <uint32_t L>
void pull_skins(Derivatives& d);

// Positions (derive_positions.cpp) ----------------------------------------------------------------
/// One direction: lane `lane` of `lanes` in Derivatives::skins and ::weights.
void push_positions(Derivatives& d, uint32_t mesh, uint32_t lane, uint32_t lanes, float* out);
/// Adds to lane `lane` of Derivatives::skins and ::weights.
void pull_positions(Derivatives& d, uint32_t mesh, uint32_t lane, uint32_t lanes,
                    const float* gradients);

}  // namespace mien
