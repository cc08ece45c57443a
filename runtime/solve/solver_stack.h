// SPDX-License-Identifier: MIT
// Solvers move joints after the rig has posed them: eyes aim at a target, a cap moves from hand to head,
// earrings swing.
//
//     pose_joints() -> JointPose -> local transforms -> solver 0, 1, ... -> model and skin matrices
//
// A stack is an ordered list of solvers for one skeleton: immutable, shared by any number of
// characters. Each solver declares which joints it reads and writes. So the stack knows in advance which
// model matrices each solver makes stale; it updates only those that are read next, and the others at
// the end. Joints are kept in depth-first order, where a joint and all below it are one range.
//
// A step writes the matrices of the pose in place, where deformation reads them. It allocates nothing
// and locks nothing. Results are bit-identical for one character and for many.
#pragma once

#include "runtime/base/status.h"
#include "runtime/deform/deformer.h"
#include "runtime/pose/joint_pose.h"

namespace mien {

/// The data of one character that a solver gets. MienSolverPose has the same layout.
struct SolverPose {
  float* locals;          // [joint] kLocalTransformFloats relative to the parent, as
                          // write_local_transforms() has them: what a solver writes
  const float* models;    // [joint] four columns of four
  const float* previous;  // the same for the joints of SolverDesc::previous, after the last step
  const float* row;       // controls and pose variables, or null
  float* outputs;         // SolverDesc::output_count numbers to publish
  void* state;            // SolverDesc::state_size bytes, zeros at first; aligned like a double
  uint32_t lod;
  uint32_t reset;  // 1: the first step, or the character was teleported
};

/// Some characters at a time. Must not allocate.
struct SolverArgs {
  const Skeleton& skeleton;
  const void* params;  // the stack's copy of SolverDesc::params
  int64_t ticks;       // since the last step
  const SolverPose* poses;
  uint32_t count;
};
using SolverFunction = void(const SolverArgs& args);

struct SolverDesc {
  const char* name = "";  // for messages
  SolverFunction* solve = nullptr;
  const void* params = nullptr;  // copied, for all characters
  size_t params_size = 0;
  Span<const uint16_t> reads;     // joints whose model matrix it reads
  Span<const uint16_t> writes;    // joints whose local transform it writes
  Span<const uint16_t> previous;  // joints whose matrix of the last step it reads
  uint32_t state_size = 0;
  uint32_t output_count = 0;
  uint64_t lods = ~uint64_t{0};  // bit l: runs at LOD l
};

struct JointRange {
  uint16_t first, end;  // into Stack::order
  bool has(uint16_t place) const { return place >= first && place < end; }
};

struct Solver {
  Span<const char> name;  // with a zero at its end
  SolverFunction* solve;
  Span<const uint8_t> params;
  uint64_t lods;
  Span<const uint16_t> writes, previous;
  uint32_t first_update, update_count;  // ranges that are stale before it runs and that it reads
  uint32_t first_previous, first_output;
  size_t state_at;
};

/// What a stack is made of.
struct StackPlan {
  const Skeleton* skeleton = nullptr;
  Span<uint16_t> order;  // [place] joint, depth first
  Span<Solver> solvers;
  Span<JointRange> updates;  // of solver 0, 1, ..., then those at the end
  Span<JointRange>
      changed;  // all that any solver moves: their skin matrices are computed at the end
  uint32_t first_last_update = 0;
  uint32_t previous_count = 0, output_count = 0;
  size_t state_size = 0;     // bytes of all solvers
  uint32_t curve_count = 0;  // of the rows that its solvers read
  bool check_writes = false;
};

/// In one block of memory.
struct Stack : Object, StackPlan {
  static constexpr uint32_t kTag = 0x6D53'4F4C;

  const Deformer* deformer = nullptr;  // whose skeleton it is, or null
  ~Stack() { release(deformer); }
};

/// One character in a stack, in one block of memory.
struct StackState : Object {
  static constexpr uint32_t kTag = 0x6D53'5354;

  const Stack* stack = nullptr;
  ~StackState() { release(stack); }

  bool in_batch = false;  // while the arguments of a batch are checked
  bool fresh = true;      // no step was made yet
  Span<float> locals;     // [joint] kLocalTransformFloats
  Span<float> previous;   // [joint of all `previous` lists] kMatrixFloats
  Span<float> outputs;    // of all solvers
  Span<uint8_t> solver_states;
  Span<float> checked;  // with check_writes: locals before a solver
  const char* undeclared =
      nullptr;  // with check_writes: name of the last solver that wrote a joint
                // that is not in its list
};

struct StackDesc {
  Span<const SolverDesc> solvers;  // in the order in which they run
  uint32_t curve_count = 0;        // of the rows that they read
  /// Compares all joints before and after each solver: for debugging.
  bool check_writes = false;
};

/// kIndex for joints that the skeleton does not have; kInvalidArgument for a solver without a function
/// or with a list of writes that is empty, and for one that reads a joint which it does not write
/// itself and which a later solver moves, or moves a parent of: the message names both. kMemory. The skeleton
/// has to outlive the stack.
Status create_stack(const Skeleton& skeleton, const StackDesc& desc, const Allocator& allocator,
                    Stack*& out, Error& error);

/// The same for the skeleton of a deformer, of which the stack becomes an owner.
Status create_stack(const Deformer& deformer, const StackDesc& desc, const Allocator& allocator,
                    Stack*& out, Error& error);

/// Bytes of a state.
size_t stack_state_size(const Stack& stack);

/// The state becomes an owner of the stack. Null if memory ran out.
StackState* create_stack_state(const Stack& stack, const Allocator& allocator);

/// A character to step.
struct StackPose {
  StackState* state;
  JointPose* pose;   // as pose_joints() left it
  const float* row;  // for the solvers, or null
  uint32_t lod;
  bool reset;  // teleported: springs come to rest, space switches do not ease
};

/// All of this stack, all different. `ticks` is 0 or more. At most kMaxStackPoses at a time.
constexpr uint32_t kMaxStackPoses = 64;
void step_stack(const Stack& stack, Span<const StackPose> poses, int64_t ticks);

/// Model matrices of joints from their local transforms: those at `range` in the stack's order, of
/// which the parents are up to date. docs/deformation.md, 1 "Joint transforms".
void update_models(const Stack& stack, JointRange range, const float* locals, float* models);

}  // namespace mien
