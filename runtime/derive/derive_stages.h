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
/// Evaluates the networks at Derivatives::values, which get the results.
void linearize_ml(Derivatives& d, const Instance& instance);
template <uint32_t L>
void push_ml(Derivatives& d);
template <uint32_t L>
void pull_ml(Derivatives& d);

// RBF solvers (derive_rbf.cpp) --------------------------------------------------------------------
/// Controls that a solver reads.
uint32_t rbf_input_count(const RbfSolverPlan& plan);
void linearize_rbf(Derivatives& d);
template <uint32_t L>
void push_rbf(Derivatives& d);
template <uint32_t L>
void pull_rbf(Derivatives& d);

// Joint values (derive_joints.cpp; rotations in derive_rotations.cpp) -----------------------------
/// For the LOD.
void find_value_rows(Derivatives& d);
template <uint32_t L>
void push_joint_rows(Derivatives& d);
template <uint32_t L>
void pull_joint_rows(Derivatives& d);
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
