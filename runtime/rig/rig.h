// SPDX-License-Identifier: MIT
// The compiled rig: everything that evaluation reads, in one block of memory. It never changes once
// it is compiled.
//
//     | Rig | tables | correctives | joint matrix | neutral pose | LOD lists | names |
//
// Array elements have no implicit padding: gaps are explicit fields of zeros, so that equal rigs have
// equal bytes in a baked file.
//
// A LOD never needs a list of what to evaluate: tables, correctives and joint rows are ordered so
// that each LOD uses a prefix of what the LOD before it uses.
#pragma once

#include "runtime/base/coordinate_system.h"
#include "runtime/base/shared_bytes.h"
#include "runtime/base/transform.h"
#include "runtime/rig/change_tables.h"
#include "runtime/rig/joint_matrix.h"
#include "runtime/rig/stage_access.h"
#include "simd/isa.h"
#include "simd/lanes.h"
#include "simd/rbf_kernels.h"

namespace mien {

constexpr uint32_t kFileAttributes = 9;  // tx ty tz rx ry rz sx sy sz, as files number them
constexpr uint16_t kNoOutput = 0xFFFF;   // a joint row whose result goes nowhere
constexpr uint32_t kMaxLods = 33;
constexpr float kLargestFloat = 3.40282347e38f;

/// To the range of finite floats; NaN becomes the lowest.
inline float saturated(double value) {
  if (!(value > -kLargestFloat)) return -kLargestFloat;
  return value < kLargestFloat ? static_cast<float>(value) : kLargestFloat;
}

/// The items of each LOD. LODs with the same items share a row.
struct LodLists {
  Span<uint16_t> row_of_lod;
  Span<uint32_t> first;  // [row], one more at the end
  Span<uint16_t> indices;

  Span<uint16_t> at(uint32_t lod) const {
    if (lod >= row_of_lod.count) return {};
    const uint32_t row = row_of_lod[lod];
    return indices.slice(first[row], first[row + 1] - first[row]);
  }
};

/// Piecewise-linear map (docs/rig-evaluation.md, 2 "Conditional tables"): row r fires when from <=
/// input <= to and then adds slope * input + cut to its output. In a run of consecutive rows with the
/// same input and output only the first that fires counts: `run_ends[r]` is the row after the run of r.
struct ControlTable {
  Span<uint16_t> inputs, outputs;
  Span<float> from, to, slope, cut;
  Span<uint32_t> run_ends;
};

/// The same table read backwards (docs/rig-evaluation.md, 2.4 "Raw controls to GUI controls"): for
/// each input its rows, in groups of equal [from, to], groups in order of first appearance.
struct ReverseTable {
  Span<uint32_t> first_group;  // [input], one more at the end
  Span<uint32_t> first_row;    // [group], one more at the end
  Span<uint32_t> rows;         // into the ControlTable
};

/// Correctives in the order of evaluation: an entry follows all that it depends on, and the first
/// `count_at_lod[l]` entries are those that LOD l needs.
///     value = min(1, weight * product of clamp(control, 0, 1) over its inputs)
struct PsdTable {
  Span<uint16_t> outputs;      // [entry] control number
  Span<float> weights;         // [entry]
  Span<uint32_t> first_input;  // [entry], one more at the end
  Span<uint16_t> inputs;       // control numbers
  Span<uint16_t> run_lengths;  // [entry] number of entries from here on that have the same number
                               // of inputs and do not read each other
  Span<uint32_t> count_at_lod;
  Span<uint16_t> entry_of_psd;  // where corrective p stands
};

/// A joint whose angles a group converts to a quaternion, and the first row of the group that writes
/// an angle: the conversion runs at the LODs that use this row.
struct AngleJoint {
  uint16_t joint;
  uint16_t first_row;
};

/// Where to write a rotation that was computed in a lane.
struct RotationOutput {
  uint64_t lods;  // bit l: at LOD l
  uint32_t lane;
  uint16_t joint;
  uint16_t zero;
};

/// What a joint group does to rotations besides writing angles.
///
/// Angles: with quaternion outputs, rotation rows write their angles after all joint values, at
/// 3 * joint; then those of the group's `angle_joints` are converted to quaternions.
///
/// Turns: joints represented by quaternions (docs/rig-evaluation.md, 4.8 "Joints represented by
/// quaternions").
struct GroupRotations {
  uint32_t first_angle_joint, angle_joint_count;  // into RotationTable::angle_joints
  uint32_t first_turn, turn_count;                // into RotationTable::turns
};

/// The turns of all groups are packed into blocks of kBlockLanes, one lane each, as simd/rotation_kernels.h
/// describes: turns used by more LODs first, then those with more steps. A step is a column of the lane's
/// group that turns the joint; a LOD uses the first steps of a lane.
struct RotationTable {
  Span<GroupRotations> groups;  // one for each joint group
  Span<AngleJoint> angle_joints;
  Span<RotationOutput> turns;     // by group, then lane; a later one for the same joint counts
  Span<uint32_t> blocks_at_lod;   // leading blocks
  Span<uint32_t> first_steps;     // [block] into steps, one more at the end
  Span<uint32_t> steps_at_lod;    // [lod][block]: the most steps that a lane uses
  Span<float> lane_steps_at_lod;  // [lod][block][lane]: steps that it uses, as a float
  Span<uint16_t> columns;         // [step][lane]: control that it reads
  Span<float> values;             // [step][x y z w][lane], or
  Span<uint16_t> halves;          // the same in half storage

  uint32_t block_count() const { return static_cast<uint32_t>(first_steps.count - 1); }
};

/// The distance function of a solver; numbers as in files.
enum RbfDistance : uint8_t { kEuclidean, kQuaternion, kSwingAngle, kTwistAngle };

/// One RBF solver (docs/rig-evaluation.md, 6 "RBF solvers"), beside its plan.
struct RbfSolver {
  uint32_t first_pose;  // into RbfTable::poses
};

/// Whether the solver compares swings or twists instead of whole rotations.
inline bool takes_parts(const RbfSolverPlan& plan) {
  return plan.angle_inputs == 2 || plan.angle_inputs == 3;
}

struct RbfTable {
  Span<RbfSolver> solvers;
  Span<RbfSolverPlan> plans;  // beside solvers
  bool independent = false;   // no solver reads or writes what another one writes
  Span<uint16_t> inputs;      // control numbers
  Span<uint16_t> rotations;   // control numbers: [block][4][lane], as RbfArgs has them
  Span<float> swings;         // [block][lane], as RbfArgs has them
  Span<uint16_t> poses;       // pose numbers
  Span<float> targets, inverses;
  Span<float> pose_scales, pose_factors;  // [lane]
  Span<uint32_t> first_input;             // [pose] into pose_inputs, one more at the end
  Span<uint32_t> first_output;            // [pose] into pose_outputs, one more at the end
  Span<uint16_t> pose_inputs, pose_outputs;
  Span<float> pose_weights;  // beside pose_outputs
  LodLists lod_solvers;
};

/// One layer of a neural network, in the layout of simd/dense_kernels.h.
struct NetworkLayer {
  uint64_t first_value;  // into MlTable::values
  uint32_t first_bias;   // into MlTable::biases
  uint32_t input_count;
  uint32_t output_count;
  float alpha;
  uint8_t function;
  uint8_t zeros[7];
};

/// Values that an operation takes from another one: `count` floats at `first` of the instance's ML
/// buffer, or the controls at `first` of MlTable::controls. The weight is for weighted sums.
struct MlDependency {
  uint32_t first, count;
  float weight;
  bool gathers;
  uint8_t zeros[3];
};

/// A step of machine-learned behavior (docs/rig-evaluation.md, 8 "Machine-learned behavior"): a network
/// or a weighted sum. Gather and scatter operations are compiled to lists of controls. The results go to
/// `first_output` of the instance's ML buffer, and from there to the controls of the scatter list.
struct MlStep {
  uint64_t lods;                                // bit l: runs at LOD l
  uint32_t first_layer, layer_count;            // none: a weighted sum
  uint32_t first_gather, gather_count;          // into controls: if there are any, the only inputs
  uint32_t first_dependency, dependency_count;  // into dependencies
  uint32_t first_scatter, scatter_count;        // into controls
  uint32_t first_limit;                         // into limits: [lod] leading outputs to scatter
  uint32_t first_output, output_count;
  uint32_t mask;  // or kNoMask
};
constexpr uint32_t kNoMask = ~uint32_t{0};

// An operation takes few bytes in a file, and all may run the same large network, so the file size alone
// does not bound the memory. (For time, see work.h.)
constexpr size_t kMaxBufferFloats = size_t{4} << 20;

/// A joint that machine-learned behavior moves (docs/rig-evaluation.md, 8.6 "ML joints"). Components that
/// it does not drive are kNoControl; a rotation takes three or four consecutive controls, from
/// rotation_control on.
struct MlJoint {
  uint64_t lods;  // bit l: exists at LOD l
  uint16_t joint;
  uint16_t translation[3], scale[3];
  uint16_t rotation_control;
};
constexpr uint16_t kNoControl = 0xFFFF;

struct MlTable {
  Span<MlStep> steps;
  Span<NetworkLayer> layers;
  Span<float> values;     // or
  Span<uint16_t> halves;  // in half storage
  Span<float> biases;
  Span<uint16_t> controls;
  Span<MlDependency> dependencies;
  Span<uint32_t> limits;
  Span<uint8_t>
      default_is_one;  // [control]: what a masked network gives: 1 for the w of a quaternion
  Span<MlJoint> joints;
  uint32_t buffer_size = 0;   // floats of an instance's ML buffer
  uint32_t widest_layer = 0;  // inputs or padded outputs

  bool blend_masks = false;           // masks blend; else they switch
  bool quaternion_rotations = false;  // of the ML joints
  bool converts = false;              // ML joints come in a system of their own:
  bool scale_magnitude = false;       // scales lose their signs
  CoordinateChange change = {};       // from it to the rig's
  RotationConvention rotation;        // its angles
  Matrix3 to_rig;                     // the change of axes, for row vectors
};

/// Joints that follow a quaternion input: first those that swing with it, then those that twist with it
/// (docs/rig-evaluation.md, 7 "Twist and swing").
struct TwistSwing {
  uint32_t first_output, output_count;  // into TwistSwingTable::outputs
};

/// The outputs of all set-ups are packed into blocks of kBlockLanes, one lane each, as
/// simd/rotation_kernels.h describes, those used by more LODs first. They read controls only, so their
/// order matters only where two of them write the same joint.
struct TwistSwingTable {
  Span<TwistSwing> setups;
  Span<RotationOutput> outputs;  // in order; a later one for the same joint counts
  Span<uint32_t> blocks_at_lod;  // leading blocks
  Span<uint16_t> inputs;         // [block][x y z w][lane]: control that it reads
  Span<float> lanes;             // [block][row][lane]

  uint32_t block_count() const { return static_cast<uint32_t>(inputs.count / (4 * kBlockLanes)); }
};

/// Channel i copies a control: the first count_at_lod[l] entries do at LOD l.
struct ChannelTable {
  Span<uint16_t> inputs, outputs;
  Span<uint32_t> count_at_lod;
};

struct NameList {
  Span<uint32_t> first;  // [name] into chars, one more at the end
  Span<char> chars;
  Span<uint32_t> sorted;  // names in ascending order of their bytes, then of their index

  uint32_t count() const { return first.count ? static_cast<uint32_t>(first.count - 1) : 0; }
  Span<char> operator[](uint32_t i) const { return chars.slice(first[i], first[i + 1] - first[i]); }
};

/// Numbers of MIEN_KIND_... in mien.h. Those before kKindsWithNames have names.
enum class Kind : uint32_t {
  kGuiControl,
  kRawControl,
  kPsdControl,
  kMlControl,
  kRbfControl,
  kJoint,
  kBlendShapeChannel,
  kAnimatedMap,
  kMesh,
  kMlMask,
  kJointGroup,
  kRbfSolver,
  kTwistSwing,
};
constexpr size_t kKindsWithNames = 10;

struct Units {
  uint32_t translation = 0, rotation = 0;
  uint32_t axes[3] = {};
  uint32_t rotation_sequence = 0;
  int32_t rotation_signs[3] = {1, 1, 1};
};

struct Rig : Object {
  static constexpr uint32_t kTag = 0x6D52'4947;

  const SharedBytes* bytes = nullptr;     // of a baked rig: where its arrays are; owned with others
  size_t baked_size = 0;                  // of its part of these bytes
  const ChangeTables* changes = nullptr;  // owned; with them, instances keep sums
  ~Rig() {
    release(bytes);
    release(changes);
  }

  const KernelTable* kernels = nullptr;
  uint32_t lod_count = 0;
  Units units;

  // Control vector: raw | PSD | ML | RBF | controls of layers that were not loaded.
  uint32_t gui_count = 0, raw_count = 0, psd_count = 0, ml_count = 0, rbf_count = 0;
  uint32_t control_count = 0;
  uint32_t joint_count = 0, channel_count = 0, map_count = 0, mesh_count = 0, mask_count = 0;
  bool quaternion_outputs = false;
  bool half_storage = false;
  bool portable = false;                        // the same bits on every instruction set
  bool always_evaluate = false;                 // never reuse results whose inputs did not change
  uint32_t joint_attributes = kFileAttributes;  // per joint: 9, or 10 with quaternion outputs
  uint32_t joint_value_count() const { return joint_count * joint_attributes; }
  RotationConvention rotation;

  ControlTable gui_to_raw;
  Span<uint16_t> driven_raw;  // raw controls that gui_to_raw writes, ascending
  ReverseTable raw_to_gui;
  PsdTable psds;
  JointMatrix joints;
  RotationTable rotations;
  RbfTable rbf;
  TwistSwingTable twist_swing;
  MlTable ml;
  ChannelTable channels;
  ControlTable maps;
  Span<uint32_t> map_rows_at_lod;

  Span<Uses> control_uses;             // [control] what reads or writes it (stage_access.h)
  ControlRange ml_writes, rbf_writes;  // hold all controls that the stage writes
  uint32_t feedback_stages = 0;        // ML, RBF: stages that read what they write themselves

  Span<float> initial_controls;  // [raw | PSD | ML | RBF]
  Span<float> neutral_joints;    // joint values
  Span<uint16_t> joint_parents;
  LodLists lod_joints, lod_channels, lod_maps, lod_meshes;
  LodLists variable_joint_values;
  NameList names[kKindsWithNames];
};

/// Joint values; with quaternion outputs, then 3 angles per joint.
inline size_t joints_and_angles_count(const Rig& rig) {
  return rig.joint_value_count() + (rig.quaternion_outputs ? size_t{rig.joint_count} * 3 : 0);
}

}  // namespace mien
