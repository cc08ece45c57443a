// SPDX-License-Identifier: MIT
// One character: its inputs, its last results, and scratch, in one block of memory.
//
//     | Instance | controls: raw, PSD, ML, RBF | GUI | masks | joints | channels | maps | scratch |
#pragma once

#include "runtime/base/arena.h"
#include "runtime/rig/rig.h"

namespace mien {

/// With MIEN_REUSE_SUMS: what changed, and the sums of the joint matrix (changes.h).
struct Changes {
  // [control / 64] bit control % 64: may differ from what the stage last evaluated.
  Span<uint64_t> psds, joints, channels, maps;
  uint32_t all;  // stages that have to evaluate everything

  uint32_t summed_count;  // controls that were not 0 when all sums were computed
  uint32_t roundings;     // of each sum since then, at most
  double largest;         // bound on the magnitudes of the sums, before and after scaling
  Span<float> sums;       // [packed row] before scaling; without those that this LOD does not have
  Span<float> summed;     // [control] the values that they are the sums for

  Span<uint64_t> entries;      // scratch: correctives to compute; zeros outside of calls
  Span<uint16_t> listed;       // scratch: a list of them
  Span<uint64_t> map_outputs;  // scratch
  Span<uint64_t> runs;         // scratch: of RowRuns
  Span<uint64_t> turned;       // scratch: joints whose angles changed
};

struct Instance : Object {
  static constexpr uint32_t kTag = 0x6D49'4E53;

  uint32_t lod = 0;       // of the last evaluation; outputs that this LOD does not have are 0
  bool in_batch = false;  // while the arguments of a batch are checked
  const Rig* rig = nullptr;
  ~Instance() { release(rig); }

  Span<float> controls;
  Span<float> gui;
  Span<float> masks;
  Span<float> joints;
  Span<float> joints_and_angles;  // joints; with quaternion outputs, then 3 angles per joint
  Span<float> channels;
  Span<float> maps;

  // Reuse (runtime/rig/stage_access.h).
  Span<float> previous_raw, previous_masks;  // at the start of the last evaluation
  Span<float> before_writing;                // scratch: old values of controls that a stage writes
  Uses stale = 0;                            // stages and row panels that must be evaluated
  Changes* changes = nullptr;                // null unless the rig has ChangeTables

  Span<float> rotations;      // scratch: of the blocks of RotationTable, or of TwistSwingTable
  Span<float> ml_values;      // outputs of the ML steps, for later steps
  Span<float> ml_layers[2];   // scratch: in and out of the widest network layer
  Span<float> rbf_inputs;     // scratch: of all solvers
  Span<float> rbf_rotations;  // scratch: swings and twists of all solvers
  Span<float> rbf_weights;    // scratch: lanes of all solvers
  Span<float> rbf_results;    // scratch: lanes of all solvers
};

/// Bytes of an instance of a rig.
size_t instance_size(const Rig& rig);

/// Creates an instance in its initial state, at LOD 0. It becomes an owner of the rig. Null if memory ran
/// out.
Instance* create_instance(const Rig& rig, const Allocator& allocator);

/// Resets outputs and intermediate results, but not controls, to their initial values. Everything becomes
/// stale.
void clear_results(Instance& instance);

/// Resets inputs and outputs to their initial values.
void reset_instance(Instance& instance);

}  // namespace mien
