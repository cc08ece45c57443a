// SPDX-License-Identifier: MIT
// mien/solve.h.
#include "capi/handles.h"
#include "runtime/solve/solvers.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_NO_JOINT == kNoSolverJoint && sizeof(MienSolverPose) == sizeof(SolverPose) &&
                  offsetof(MienSolverPose, previous) == offsetof(SolverPose, previous) &&
                  offsetof(MienSolverPose, state) == offsetof(SolverPose, state) &&
                  offsetof(MienSolverPose, is_reset) == offsetof(SolverPose, reset),
              "both have one layout");

namespace {

constexpr size_t kMaxSolvers = 256;
constexpr uint32_t kMaxStateBytes = 1 << 20, kMaxOutputs = 4096;

/// Context of a call of a MienUserSolver.
struct UserCall {
  void(MIEN_CALLBACK* solve)(void* user, const MienSolverCall* call);
  void* user;
};

void solve_custom(const SolverArgs& args) {
  const UserCall& to = *static_cast<const UserCall*>(args.params);
  const MienSolverCall call = {reinterpret_cast<const MienSolverPose*>(args.poses),
                               args.skeleton.parents.data, args.ticks, args.count,
                               args.skeleton.joint_count};
  to.solve(to.user, &call);
}

/// Converts the solvers of a desc to those of the runtime, in memory of the arena.
class Describer {
 public:
  Describer(const Skeleton& skeleton, uint32_t curve_count, Arena& arena, MienError* error)
      : skeleton_(skeleton), curve_count_(curve_count), arena_(arena), error_(error) {}

  MienStatus describe_solver(size_t index, const MienSolver& from, SolverDesc& to) {
    index_ = index;
    const int given = (from.aim != nullptr) + (from.space != nullptr) + (from.spring != nullptr) +
                      (from.twist != nullptr) + (from.copy != nullptr) + (from.custom != nullptr);
    if (given != 1) return refuse_solver("exactly one of its pointers has to be set");
    MienStatus status = MIEN_OK;
    if (from.aim) status = describe_aim(*from.aim, to);
    if (from.space) status = describe_space(*from.space, to);
    if (from.spring) status = describe_spring(*from.spring, to);
    if (from.twist) status = describe_twist(*from.twist, to);
    if (from.copy) status = describe_copy(*from.copy, to);
    if (from.custom) status = describe_custom(*from.custom, to);
    if (from.name) to.name = from.name;
    if (from.lods != 0) to.lods = from.lods;
    return status;
  }

 private:
  MienStatus refuse_solver(const char* why) {
    return give_error(error_, MIEN_ERROR_INVALID_ARGUMENT, "solver %zu: %s", index_, why);
  }
  MienStatus no_solver_memory() {
    return give_error(error_, MIEN_ERROR_MEMORY, "no memory for a solver stack");
  }

  MienStatus read_joint(uint32_t from, uint16_t& to) {
    if (from >= skeleton_.joint_count) {
      return give_error(error_, MIEN_ERROR_INDEX, "solver %zu: joint %u of %u", index_, from,
                        skeleton_.joint_count);
    }
    to = static_cast<uint16_t>(from);
    return MIEN_OK;
  }
  MienStatus check_curves(uint32_t first, uint32_t count) {
    if (first < curve_count_ && count <= curve_count_ - first) return MIEN_OK;
    return give_error(error_, MIEN_ERROR_INDEX,
                      "solver %zu: curve %u of %u (MienSolverStackDesc.curve_count)", index_, first,
                      curve_count_);
  }

  static void copy_vector(const float (&from)[3], float (&to)[3]) { memcpy(to, from, sizeof(to)); }

  MienStatus describe_aim(const MienAimSolver& from, SolverDesc& to) {
    const Span<AimSolver> solver = arena_.array<AimSolver>(1);
    if (!solver.data) return no_solver_memory();
    AimSolver& out = solver[0];
    if (MienStatus status = read_joint(from.joint, out.joint)) return status;
    if (from.target_joint != MIEN_NO_JOINT) {
      if (MienStatus status = read_joint(from.target_joint, out.target_joint)) return status;
    } else if (MienStatus status = check_curves(from.target_curve, 3)) {
      return status;
    }
    out.target_curve = from.target_curve;
    copy_vector(from.axis, out.axis);
    copy_vector(from.up_axis, out.up_axis);
    copy_vector(from.up, out.up);
    out.weight = from.weight;
    if (const char* wrong = set_up(out, from.cone_degrees)) return refuse_solver(wrong);
    to = mien::describe(skeleton_, out);
    return MIEN_OK;
  }

  MienStatus describe_space(const MienSpaceSolver& from, SolverDesc& to) {
    const Span<SpaceSolver> solver = arena_.array<SpaceSolver>(1);
    if (!solver.data) return no_solver_memory();
    SpaceSolver& out = solver[0];
    if (MienStatus status = read_joint(from.joint, out.joint)) return status;
    if (MienStatus status = check_curves(from.curve, 1)) return status;
    if (!from.spaces || from.space_count == 0 || from.space_count > kMaxSolverJoints ||
        from.reserved != 0) {
      return refuse_solver("it has no spaces or too many, or reserved is not 0");
    }
    for (uint32_t i = 0; i < from.space_count; ++i) {
      out.spaces[i] = kNoSolverJoint;
      if (from.spaces[i] == MIEN_NO_JOINT) continue;
      if (MienStatus status = read_joint(from.spaces[i], out.spaces[i])) return status;
    }
    out.space_count = from.space_count;
    out.curve = from.curve;
    out.ease_ticks = from.ease_ticks;
    if (const char* wrong = set_up(out)) return refuse_solver(wrong);
    to = mien::describe(skeleton_, out);
    return MIEN_OK;
  }

  MienStatus describe_spring(const MienSpringSolver& from, SolverDesc& to) {
    const Span<SpringSolver> solver = arena_.array<SpringSolver>(1);
    if (!solver.data) return no_solver_memory();
    SpringSolver& out = solver[0];
    if (MienStatus status = read_joint(from.joint, out.joint)) return status;
    out.frequency = from.frequency;
    out.damping = from.damping;
    copy_vector(from.rest_offset, out.rest_offset);
    out.stretch = from.stretch;
    out.teleport = from.teleport;
    if (const char* wrong = set_up(out)) return refuse_solver(wrong);
    to = mien::describe(skeleton_, out);
    return MIEN_OK;
  }

  MienStatus describe_twist(const MienTwistSolver& from, SolverDesc& to) {
    const Span<TwistSolver> solver = arena_.array<TwistSolver>(1);
    if (!solver.data) return no_solver_memory();
    TwistSolver& out = solver[0];
    if (MienStatus status = read_joint(from.source, out.source)) return status;
    copy_vector(from.axis, out.axis);
    if (!from.joints || !from.shares || from.joint_count == 0 ||
        from.joint_count > kMaxSolverJoints || from.reserved != 0) {
      return refuse_solver("it has no joints or shares, or too many, or reserved is not 0");
    }
    for (uint32_t i = 0; i < from.joint_count; ++i) {
      if (MienStatus status = read_joint(from.joints[i], out.joints[i])) return status;
      out.shares[i] = from.shares[i];
    }
    out.joint_count = from.joint_count;
    if (const char* wrong = set_up(out)) return refuse_solver(wrong);
    to = mien::describe(skeleton_, out);
    return MIEN_OK;
  }

  MienStatus describe_copy(const MienCopySolver& from, SolverDesc& to) {
    const Span<CopySolver> solver = arena_.array<CopySolver>(1);
    if (!solver.data) return no_solver_memory();
    CopySolver& out = solver[0];
    if (MienStatus status = read_joint(from.source, out.source)) return status;
    if (MienStatus status = read_joint(from.joint, out.joint)) return status;
    copy_vector(from.mirror_axis, out.mirror_axis);
    out.mirrored = from.is_mirrored != 0;
    out.weight = from.weight;
    if (const char* wrong = set_up(out)) return refuse_solver(wrong);
    to = mien::describe(skeleton_, out);
    return MIEN_OK;
  }

  MienStatus describe_custom(const MienUserSolver& from, SolverDesc& to) {
    const Span<UserCall> call = arena_.array<UserCall>(1);
    if (!call.data) return no_solver_memory();
    if (!from.solve || !from.writes || (!from.reads && from.read_count != 0) ||
        (!from.previous_joints && from.previous_joint_count != 0)) {
      return refuse_solver(
          "it has no function, no writes, or a list is NULL but its count is not 0");
    }
    const uint32_t most = skeleton_.joint_count;  // longer lists name a joint twice
    if (from.write_count == 0 || from.write_count > most || from.read_count > most ||
        from.previous_joint_count > most || from.state_bytes > kMaxStateBytes ||
        from.output_count > kMaxOutputs || from.reserved != 0) {
      return refuse_solver(
          "a list has no or too many joints, state_bytes or output_count is out of range, "
          "or reserved is not 0");
    }
    call[0] = {from.solve, from.user};
    to.name = "custom";
    to.solve = solve_custom;
    to.params = call.data;
    to.params_size = sizeof(UserCall);
    to.reads = {from.reads, from.read_count};
    to.writes = {from.writes, from.write_count};
    to.previous = {from.previous_joints, from.previous_joint_count};
    to.state_size = from.state_bytes;
    to.output_count = from.output_count;
    return MIEN_OK;
  }

  const Skeleton& skeleton_;
  uint32_t curve_count_;
  Arena& arena_;
  MienError* error_;
  size_t index_ = 0;
};

}  // namespace

// Stack -------------------------------------------------------------------------------------------

MienStatus mien_solver_stack_create(const MienDeformer* deformer, const MienSolverStackDesc* desc,
                                    MienSolverStack** out_solver_stack, MienError* error) {
  if (MienStatus status = clear_output(out_solver_stack, error)) return status;
  if (MienStatus status = check(deformer, "deformer", error)) return status;
  if (!desc) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "desc is NULL");
  MienSolverStackDesc known;
  if (MienStatus status = read_desc(desc, known, "MienSolverStackDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  if (!known.solvers && known.solver_count != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "MienSolverStackDesc.solvers is NULL");
  }
  if (known.solver_count > kMaxSolvers) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT, "%zu solvers; a stack has at most %zu",
                      known.solver_count, kMaxSolvers);
  }
  const Skeleton& skeleton = object(deformer)->skeleton;
  Arena arena(allocator);
  const Span<SolverDesc> solvers = arena.array<SolverDesc>(known.solver_count);
  if (solvers.count != known.solver_count) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a solver stack");
  }
  Describer describer(skeleton, known.curve_count, arena, error);
  for (size_t i = 0; i < solvers.count; ++i) {
    const MienStatus status = describer.describe_solver(i, known.solvers[i], solvers[i]);
    if (status != MIEN_OK) return status;
  }
  Stack* stack = nullptr;
  Error detail;
  const StackDesc stack_desc = {solvers, known.curve_count, known.check_writes != 0};
  const Status status = create_stack(*object(deformer), stack_desc, allocator, stack, detail);
  return give_object(status, stack, detail, out_solver_stack, error);
}

void mien_solver_stack_destroy(MienSolverStack* solver_stack) { destroy(solver_stack); }

MienStatus mien_solver_stack_info(const MienSolverStack* solver_stack,
                                  MienSolverStackInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(solver_stack)) return status;
  const Stack& stack = *object(solver_stack);
  MienSolverStackInfo info = {};
  info.solver_count = static_cast<uint32_t>(stack.solvers.count);
  info.curve_count = stack.curve_count;
  info.output_count = stack.output_count;
  info.joint_count = stack.skeleton->joint_count;
  info.state_bytes = stack_state_size(stack);
  write_struct(out_info, info);
  return MIEN_OK;
}

// State -------------------------------------------------------------------------------------------

MienStatus mien_solver_state_create(const MienSolverStack* solver_stack,
                                    const MienSolverStateDesc* desc,
                                    MienSolverState** out_solver_state, MienError* error) {
  if (MienStatus status = clear_output(out_solver_state, error)) return status;
  if (MienStatus status = check(solver_stack))
    return give_error(error, status, "not a solver stack");
  MienSolverStateDesc known;
  if (MienStatus status = read_desc(desc, known, "MienSolverStateDesc", error)) return status;
  Allocator allocator;
  if (MienStatus status = read_allocator(known.allocator, allocator, error)) return status;
  StackState* state = create_stack_state(*object(solver_stack), allocator);
  if (!state) return give_error(error, MIEN_ERROR_MEMORY, "no memory for a solver state");
  *out_solver_state = reinterpret_cast<MienSolverState*>(state);
  return succeed(error);
}

void mien_solver_state_destroy(MienSolverState* solver_state) { destroy(solver_state); }

namespace {

MienStatus check_input(const StackState& state, const MienDeformerInstance* instance,
                       const MienSolverInput* input) {
  if (MienStatus status = check(instance)) return status;
  const Stack& stack = *state.stack;
  if (object(instance)->deformer != stack.deformer) return MIEN_ERROR_MISMATCH;
  if (input && !input->row && input->row_count != 0) return MIEN_ERROR_NULL_ARGUMENT;
  if (stack.curve_count > (input ? input->row_count : 0)) return MIEN_ERROR_MISMATCH;
  return input && input->lod > 63 ? MIEN_ERROR_INVALID_ARGUMENT : MIEN_OK;
}

}  // namespace

MienStatus mien_solver_state_step(MienSolverState* solver_state,
                                  MienDeformerInstance* deformer_instance,
                                  const MienSolverInput* input, int64_t ticks) {
  return mien_solver_state_step_batch(&solver_state, &deformer_instance, input, 1, ticks);
}

MienStatus mien_solver_state_step_batch(MienSolverState* const* solver_states,
                                        MienDeformerInstance* const* deformer_instances,
                                        const MienSolverInput* inputs, size_t count,
                                        int64_t ticks) {
  if (count == 0) return MIEN_OK;
  if (!solver_states || !deformer_instances) return MIEN_ERROR_NULL_ARGUMENT;
  if (ticks < 0 || ticks > kMaxStepTicks) return MIEN_ERROR_INVALID_ARGUMENT;
  for (size_t i = 0; i < count; ++i) {
    if (MienStatus status = check(solver_states[i])) return status;
    if (object(solver_states[i])->stack != object(solver_states[0])->stack)
      return MIEN_ERROR_MISMATCH;
    const MienSolverInput* const input = inputs ? inputs + i : nullptr;
    if (MienStatus status = check_input(*object(solver_states[i]), deformer_instances[i], input))
      return status;
  }
  MienStatus status = MIEN_OK;
  size_t marked = 0;
  for (; marked < count && status == MIEN_OK; ++marked) {
    DeformerInstance& instance = *object(deformer_instances[marked]);
    if (object(solver_states[marked])->in_batch || instance.in_batch) {
      status = MIEN_ERROR_INVALID_ARGUMENT;
      break;
    }
    object(solver_states[marked])->in_batch = instance.in_batch = true;
  }
  for (size_t i = 0; i < marked; ++i) {
    object(solver_states[i])->in_batch = object(deformer_instances[i])->in_batch = false;
  }
  if (status != MIEN_OK) return status;

  const Stack& stack = *object(solver_states[0])->stack;
  StackPose poses[kMaxStackPoses];
  for (size_t first = 0; first < count; first += kMaxStackPoses) {
    const size_t some = count - first < kMaxStackPoses ? count - first : kMaxStackPoses;
    for (size_t i = 0; i < some; ++i) {
      const MienSolverInput input = inputs ? inputs[first + i] : MienSolverInput{};
      poses[i] = {object(solver_states[first + i]), &object(deformer_instances[first + i])->joints,
                  stack.curve_count != 0 ? input.row : nullptr, input.lod, input.is_reset != 0};
    }
    step_stack(stack, {poses, some}, ticks);
  }
  return MIEN_OK;
}

MienStatus mien_solver_state_outputs(const MienSolverState* solver_state, uint32_t solver,
                                     MienFloatView* out_values) {
  if (!out_values) return MIEN_ERROR_NULL_ARGUMENT;
  *out_values = {};
  if (MienStatus status = check(solver_state)) return status;
  const Stack& stack = *object(solver_state)->stack;
  if (solver >= stack.solvers.count) return MIEN_ERROR_INDEX;
  const uint32_t first = stack.solvers[solver].first_output;
  const uint32_t end = solver + 1 < stack.solvers.count ? stack.solvers[solver + 1].first_output
                                                        : stack.output_count;
  *out_values = {object(solver_state)->outputs.data + first, end - first};
  return MIEN_OK;
}

MienStatus mien_solver_state_transforms(const MienSolverState* solver_state,
                                        MienFloatView* out_transforms) {
  if (!out_transforms) return MIEN_ERROR_NULL_ARGUMENT;
  *out_transforms = {};
  if (MienStatus status = check(solver_state)) return status;
  *out_transforms = {object(solver_state)->locals.data, object(solver_state)->locals.count};
  return MIEN_OK;
}

MienStatus mien_solver_state_undeclared(const MienSolverState* solver_state,
                                        MienStringView* out_name) {
  if (!out_name) return MIEN_ERROR_NULL_ARGUMENT;
  *out_name = {};
  if (MienStatus status = check(solver_state)) return status;
  if (!object(solver_state)->stack->check_writes) return MIEN_ERROR_INVALID_ARGUMENT;
  const char* const name = object(solver_state)->undeclared;
  if (name) *out_name = {name, strlen(name)};
  return MIEN_OK;
}
