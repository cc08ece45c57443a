// SPDX-License-Identifier: MIT
#include "runtime/solve/solver_stack.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace mien {
namespace {

constexpr size_t kStateAlignment = alignof(double);

// Creating
// ------------------------------------------------------------------------------------------------

/// Joints depth first, in scratch memory.
struct DepthFirst {
  Span<uint16_t> order;  // [place] joint
  Span<uint16_t> place;  // [joint]
  Span<uint16_t> ends;   // [joint] place after all its descendants
  Span<uint16_t> next;   // [joint] while sorting: place of its next child

  JointRange below(uint16_t joint) const { return {place[joint], ends[joint]}; }
};

bool sort_depth_first(const Skeleton& skeleton, Arena& scratch, DepthFirst& out) {
  const uint32_t count = skeleton.joint_count;
  for (Span<uint16_t>* list : {&out.order, &out.place, &out.ends, &out.next}) {
    *list = scratch.array<uint16_t>(count);
    if (list->count != count) return false;
  }
  const Span<uint16_t> sizes = out.ends;  // of a joint and its descendants, until its end is known
  for (uint32_t i = count;
       i-- > 0;) {  // parents come before their children in the skeleton's order
    const uint16_t joint = skeleton.order[i], parent = skeleton.parents[joint];
    ++sizes[joint];
    if (parent != joint) sizes[parent] = static_cast<uint16_t>(sizes[parent] + sizes[joint]);
  }
  uint16_t next_root = 0;
  for (uint16_t joint : skeleton.order) {
    const uint16_t parent = skeleton.parents[joint];
    uint16_t& place = parent == joint ? next_root : out.next[parent];
    out.order[place] = joint;
    out.place[joint] = place;
    out.next[joint] = static_cast<uint16_t>(place + 1);
    out.ends[joint] = place = static_cast<uint16_t>(place + sizes[joint]);
  }
  return true;
}

bool overlap(JointRange a, JointRange b) { return a.first < b.end && b.first < a.end; }

/// Adds a range, merged with those it touches.
void add_range(Span<JointRange>& ranges, JointRange range) {
  size_t kept = 0;
  for (const JointRange& other : ranges) {
    if (overlap(other, range)) {
      range.first = std::min(range.first, other.first);
      range.end = std::max(range.end, other.end);
    } else {
      ranges[kept++] = other;
    }
  }
  ranges.data[kept] = range;
  ranges.count = kept + 1;
}

Status check_joints(const Skeleton& skeleton, const SolverDesc& solver, Error& error) {
  for (const Span<const uint16_t>& list : {solver.reads, solver.writes, solver.previous}) {
    for (uint16_t joint : list) {
      if (joint < skeleton.joint_count) continue;
      return fail(error, Status::kIndex, kNoOffset, "solver %s: joint %u of %u", solver.name, joint,
                  skeleton.joint_count);
    }
  }
  if (solver.solve && !solver.writes.empty()) return Status::kOk;
  return fail(error, Status::kInvalidArgument, kNoOffset,
              "solver %s: it has no function, or writes no joint", solver.name);
}

Status check_order(Span<const SolverDesc> solvers, const DepthFirst& tree, Error& error) {
  for (size_t i = 0; i < solvers.count; ++i) {
    const Span<const uint16_t> own = solvers[i].writes;
    for (uint16_t joint : solvers[i].reads) {
      if (std::find(own.begin(), own.end(), joint) != own.end()) continue;  // to change it further
      for (size_t later = i + 1; later < solvers.count; ++later) {
        for (uint16_t moved : solvers[later].writes) {
          if (!tree.below(moved).has(tree.place[joint])) continue;
          return fail(
              error, Status::kInvalidArgument, kNoOffset,
              "solver %s reads joint %u, which the later solver %s moves: change the order, "
              "or read the joint of the previous step",
              solvers[i].name, joint, solvers[later].name);
        }
      }
    }
  }
  return Status::kOk;
}

Solver planned_solver(const SolverDesc& from, StackPlan& plan) {
  Solver solver = {};
  solver.name = {from.name, strlen(from.name) + 1};
  solver.solve = from.solve;
  solver.params = {static_cast<const uint8_t*>(from.params), from.params_size};
  solver.lods = from.lods;
  solver.writes = from.writes;
  solver.previous = from.previous;
  solver.first_previous = plan.previous_count;
  solver.first_output = plan.output_count;
  solver.state_at = plan.state_size;
  plan.previous_count += static_cast<uint32_t>(from.previous.count);
  plan.output_count += from.output_count;
  plan.state_size += align_up(from.state_size, kStateAlignment);
  return solver;
}

/// Of lists in scratch memory; the stack gets copies. False if memory ran out.
bool plan_stack(const StackDesc& desc, const DepthFirst& tree, Arena& scratch, StackPlan& plan) {
  const size_t joints = tree.order.count;
  size_t writes = 0;
  for (const SolverDesc& solver : desc.solvers) writes += solver.writes.count;
  Span<JointRange> stale = scratch.array<JointRange>(joints);
  plan.order = tree.order;
  plan.solvers = scratch.array<Solver>(desc.solvers.count);
  plan.changed = scratch.array<JointRange>(joints);
  plan.updates = scratch.array<JointRange>(writes);  // each write makes one range stale at most
  if (stale.count != joints || plan.changed.count != joints || plan.updates.count != writes ||
      plan.solvers.count != desc.solvers.count) {
    return false;
  }
  stale.count = plan.changed.count = plan.updates.count = 0;
  const auto update = [&](size_t r) { plan.updates.data[plan.updates.count++] = stale[r]; };
  for (size_t i = 0; i < desc.solvers.count; ++i) {
    const SolverDesc& from = desc.solvers[i];
    Solver& solver = plan.solvers[i] = planned_solver(from, plan);
    // The ranges that are stale before it runs, and those of them that it reads.
    solver.first_update = static_cast<uint32_t>(plan.updates.count);
    for (size_t r = 0; r < stale.count;) {
      const JointRange range = stale[r];
      const bool reads = std::any_of(from.reads.begin(), from.reads.end(),
                                     [&](uint16_t joint) { return range.has(tree.place[joint]); });
      if (!reads) {
        ++r;
        continue;
      }
      update(r);
      stale[r] = stale[stale.count - 1];
      --stale.count;
    }
    solver.update_count = static_cast<uint32_t>(plan.updates.count) - solver.first_update;
    for (uint16_t joint : from.writes) {
      add_range(stale, tree.below(joint));
      add_range(plan.changed, tree.below(joint));
    }
  }
  plan.first_last_update = static_cast<uint32_t>(plan.updates.count);
  for (size_t r = 0; r < stale.count; ++r) update(r);
  return true;
}

void place_stack(Placer& placer, Stack& stack) {
  placer.keep(stack.order);
  placer.keep(stack.solvers);
  placer.keep(stack.updates);
  placer.keep(stack.changed);
  for (Solver& solver : stack.solvers) {
    placer.keep(solver.name);
    placer.keep(solver.params, kBlockAlignment);
    placer.keep(solver.writes);
    placer.keep(solver.previous);
  }
}

Status no_memory(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory for a solver stack");
}

}  // namespace

Status create_stack(const Skeleton& skeleton, const StackDesc& desc, const Allocator& allocator,
                    Stack*& out, Error& error) {
  out = nullptr;
  for (const SolverDesc& solver : desc.solvers) {
    const Status status = check_joints(skeleton, solver, error);
    if (status != Status::kOk) return status;
  }
  Arena scratch(allocator);
  DepthFirst tree;
  if (!sort_depth_first(skeleton, scratch, tree)) return no_memory(error);
  const Status status = check_order(desc.solvers, tree, error);
  if (status != Status::kOk) return status;
  StackPlan plan;
  plan.skeleton = &skeleton;
  plan.curve_count = desc.curve_count;
  plan.check_writes = desc.check_writes;
  if (!plan_stack(desc, tree, scratch, plan)) return no_memory(error);
  out = create_object<Stack>(allocator, [&](Placer& placer, Stack& stack) {
    static_cast<StackPlan&>(stack) = plan;
    place_stack(placer, stack);
  });
  return out ? Status::kOk : no_memory(error);
}

Status create_stack(const Deformer& deformer, const StackDesc& desc, const Allocator& allocator,
                    Stack*& out, Error& error) {
  const Status status = create_stack(deformer.skeleton, desc, allocator, out, error);
  if (status == Status::kOk) out->deformer = share(deformer);
  return status;
}

namespace {

void place_state(Placer& placer, const Stack& stack, StackState& state) {
  const size_t floats = size_t{stack.skeleton->joint_count} * kLocalTransformFloats;
  state.locals = placer.array<float>(floats, kBlockAlignment);
  state.previous = placer.array<float>(size_t{stack.previous_count} * kMatrixFloats);
  state.outputs = placer.array<float>(stack.output_count);
  state.checked = placer.array<float>(stack.check_writes ? floats : 0);
  state.solver_states = placer.array<uint8_t>(stack.state_size, kBlockAlignment);
}

}  // namespace

size_t stack_state_size(const Stack& stack) {
  return block_bytes<StackState>(
      [&](Placer& placer, StackState& state) { place_state(placer, stack, state); });
}

StackState* create_stack_state(const Stack& stack, const Allocator& allocator) {
  auto* const state = create_object<StackState>(
      allocator, [&](Placer& placer, StackState& made) { place_state(placer, stack, made); });
  if (state) state->stack = share(stack);
  return state;
}

// Stepping
// ------------------------------------------------------------------------------------------------

namespace {

void put_last_row(float* matrix) {
  matrix[3] = matrix[7] = matrix[11] = 0.0f;
  matrix[15] = 1.0f;
}

/// out = a * b in double precision; both of four columns with a last row of 0 0 0 1, which those of b may
/// lack.
template <class T>
void multiply(const float* a, const T* b, size_t column, float* out) {
  for (int c = 0; c < 4; ++c, b += column) {
    for (int r = 0; r < 3; ++r) {
      double value = double{a[r]} * b[0] + double{a[4 + r]} * b[1] + double{a[8 + r]} * b[2];
      if (c == 3) value += a[12 + r];
      out[c * 4 + r] = static_cast<float>(value);
    }
  }
  put_last_row(out);
}

}  // namespace

void update_models(const Stack& stack, JointRange range, const float* locals, float* models) {
  for (uint32_t place = range.first; place < range.end; ++place) {
    const uint16_t joint = stack.order[place], parent = stack.skeleton->parents[joint];
    const float* t = locals + size_t{joint} * kLocalTransformFloats;
    const double x = t[3], y = t[4], z = t[5], w = t[6];
    const double square = x * x + y * y + z * z + w * w, s = square > 0 ? 2 / square : 0;
    const double local[4][3] = {
        {(1 - s * (y * y + z * z)) * t[7], s * (x * y + w * z) * t[7], s * (x * z - w * y) * t[7]},
        {s * (x * y - w * z) * t[8], (1 - s * (x * x + z * z)) * t[8], s * (y * z + w * x) * t[8]},
        {s * (x * z + w * y) * t[9], s * (y * z - w * x) * t[9], (1 - s * (x * x + y * y)) * t[9]},
        {t[0], t[1], t[2]}};
    float* out = models + size_t{joint} * kMatrixFloats;
    if (parent != joint) {
      multiply(models + size_t{parent} * kMatrixFloats, local[0], 3, out);
      continue;
    }
    for (int i = 0; i < 12; ++i) out[i / 3 * 4 + i % 3] = static_cast<float>(local[i / 3][i % 3]);
    put_last_row(out);
  }
}

namespace {

/// Solvers may write scales, on which normals depend.
void note_scales(const Stack& stack, const StackState& state, JointPose& pose) {
  for (const Solver& solver : stack.solvers) {
    for (uint16_t joint : solver.writes) {
      const float* scale = state.locals.data + size_t{joint} * kLocalTransformFloats + 7;
      if (scale[0] == scale[1] && scale[1] == scale[2] && scale[0] > 0) continue;
      pose.non_uniform_scale = true;
    }
  }
}

void update_skins(const Stack& stack, JointRange range, JointPose& pose) {
  for (uint32_t place = range.first; place < range.end; ++place) {
    const size_t at = size_t{stack.order[place]} * kMatrixFloats;
    multiply(pose.model.data + at, stack.skeleton->inverse_bind.data + at, 4, pose.skin.data + at);
  }
}

void update_all(const Stack& stack, uint32_t first, uint32_t end, const StackPose& character) {
  for (uint32_t i = first; i < end; ++i) {
    update_models(stack, stack.updates[i], character.state->locals.data,
                  character.pose->model.data);
  }
}

void keep_previous(const Stack& stack, const StackPose& character) {
  for (const Solver& solver : stack.solvers) {
    float* to = character.state->previous.data + size_t{solver.first_previous} * kMatrixFloats;
    for (uint16_t joint : solver.previous) {
      const float* from = character.pose->model.data + size_t{joint} * kMatrixFloats;
      to = std::copy(from, from + kMatrixFloats, to);
    }
  }
}

void note_undeclared(const Solver& solver, StackState& state) {
  const size_t bytes = kLocalTransformFloats * sizeof(float);
  for (uint32_t j = 0; j < state.stack->skeleton->joint_count; ++j) {
    const size_t at = j * kLocalTransformFloats;
    if (memcmp(state.checked.data + at, state.locals.data + at, bytes) == 0) continue;
    const uint16_t* const begin = solver.writes.begin();
    const uint16_t* const end = solver.writes.end();
    if (std::find(begin, end, j) == end) state.undeclared = solver.name.data;
  }
}

void run_solver(const Stack& stack, const Solver& solver, Span<const StackPose> characters,
                int64_t ticks) {
  SolverPose poses[kMaxStackPoses];
  uint32_t count = 0;
  for (const StackPose& character : characters) {
    // Whether it runs or not: later solvers rely on it.
    update_all(stack, solver.first_update, solver.first_update + solver.update_count, character);
    if (!(solver.lods >> character.lod & 1)) continue;
    StackState& state = *character.state;
    if (stack.check_writes)
      std::copy(state.locals.begin(), state.locals.end(), state.checked.begin());
    SolverPose& pose = poses[count++];
    pose.locals = state.locals.data;
    pose.models = character.pose->model.data;
    pose.previous = state.previous.data + size_t{solver.first_previous} * kMatrixFloats;
    pose.row = character.row;
    pose.outputs = state.outputs.data + solver.first_output;
    pose.state = state.solver_states.data + solver.state_at;
    pose.lod = character.lod;
    pose.reset = character.reset || state.fresh;
  }
  if (count == 0) return;
  solver.solve({*stack.skeleton, solver.params.data, ticks, poses, count});
  if (!stack.check_writes) return;
  for (const StackPose& character : characters) {
    if (solver.lods >> character.lod & 1) note_undeclared(solver, *character.state);
  }
}

}  // namespace

void step_stack(const Stack& stack, Span<const StackPose> characters, int64_t ticks) {
  assert(characters.count <= kMaxStackPoses && ticks >= 0);
  for (const StackPose& character : characters) {
    StackState& state = *character.state;
    write_local_transforms(*stack.skeleton, *character.pose, state.locals.data);
    state.undeclared = nullptr;
    if (state.fresh) keep_previous(stack, character);
  }
  for (const Solver& solver : stack.solvers) run_solver(stack, solver, characters, ticks);
  for (const StackPose& character : characters) {
    update_all(stack, stack.first_last_update, static_cast<uint32_t>(stack.updates.count),
               character);
    for (const JointRange& range : stack.changed) update_skins(stack, range, *character.pose);
    note_scales(stack, *character.state, *character.pose);
    keep_previous(stack, character);
    character.state->fresh = false;
  }
}

}  // namespace mien
