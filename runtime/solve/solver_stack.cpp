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
  Span<uint16_t> order;     // [place] joint
  Span<uint16_t> place;     // [joint]
  Span<uint16_t> ends;      // [joint] place behind all that hang on it
  Span<uint16_t> next;      // [joint] next joint with the same parent, or itself
  Span<uint16_t> children;  // [joint] first child, or itself

  JointRange below(uint16_t joint) const { return {place[joint], ends[joint]}; }
};

bool sort_depth_first(const Skeleton& skeleton, Arena& scratch, DepthFirst& out) {
  const uint32_t count = skeleton.joint_count;
  for (Span<uint16_t>* list : {&out.order, &out.place, &out.ends, &out.next, &out.children}) {
    *list = scratch.array<uint16_t>(count);
    if (!list->data && count != 0) return false;
  }
  for (uint32_t j = 0; j < count; ++j) out.next[j] = out.children[j] = static_cast<uint16_t>(j);
  for (uint32_t i = count; i-- > 0;) {  // so that first children come first
    const uint16_t joint = skeleton.order[i], parent = skeleton.parents[joint];
    if (parent == joint) continue;
    if (out.children[parent] != parent) out.next[joint] = out.children[parent];
    out.children[parent] = joint;
  }
  uint16_t place = 0;
  for (uint16_t root : skeleton.order) {
    if (skeleton.parents[root] != root) continue;
    uint16_t joint = root;
    for (bool down = true;;) {
      if (down) {
        out.order[place] = joint;
        out.place[joint] = place++;
        if (out.children[joint] != joint) {
          joint = out.children[joint];
          continue;
        }
      }
      out.ends[joint] = place;
      if (joint == root) break;
      down = out.next[joint] != joint;
      joint = down ? out.next[joint] : skeleton.parents[joint];
    }
  }
  return true;
}

bool overlap(JointRange a, JointRange b) { return a.first < b.end && b.first < a.end; }

/// Adds a range, and what it touches, as one.
uint32_t add_range(Span<JointRange> ranges, uint32_t count, JointRange range) {
  uint32_t kept = 0;
  for (uint32_t i = 0; i < count; ++i) {
    if (overlap(ranges[i], range)) {
      range.first = std::min(range.first, ranges[i].first);
      range.end = std::max(range.end, ranges[i].end);
    } else {
      ranges[kept++] = ranges[i];
    }
  }
  ranges[kept++] = range;
  return kept;
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
          const JointRange range = tree.below(moved);
          if (tree.place[joint] < range.first || tree.place[joint] >= range.end) continue;
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

/// What is stale before each solver, and what of this it reads. Ranges go to `out` if it has memory.
uint32_t plan_updates(Span<const SolverDesc> descs, const DepthFirst& tree, Span<JointRange> stale,
                      Stack& stack, Span<JointRange> out) {
  uint32_t stale_count = 0, used = 0;
  for (size_t i = 0; i < descs.count; ++i) {
    if (out.data) stack.solvers[i].first_update = used;
    for (uint32_t r = 0; r < stale_count;) {
      const bool reads =
          std::any_of(descs[i].reads.begin(), descs[i].reads.end(), [&](uint16_t joint) {
            return tree.place[joint] >= stale[r].first && tree.place[joint] < stale[r].end;
          });
      if (!reads) {
        ++r;
        continue;
      }
      if (out.data) out[used] = stale[r];
      ++used;
      stale[r] = stale[--stale_count];
    }
    if (out.data) stack.solvers[i].update_count = used - stack.solvers[i].first_update;
    for (uint16_t joint : descs[i].writes) {
      stale_count = add_range(stale, stale_count, tree.below(joint));
    }
  }
  if (out.data) {
    stack.first_last_update = used;
    std::copy_n(stale.begin(), stale_count, out.begin() + used);
  }
  return used + stale_count;
}

struct StackPlan {
  Span<const SolverDesc> descs;
  uint32_t update_count, changed_count;
};

void place_stack(const StackPlan& plan, Placer& placer, Stack& stack) {
  placer.array<Stack>(1);
  stack.order = placer.array<uint16_t>(stack.skeleton->joint_count);
  stack.solvers = placer.array<Solver>(plan.descs.count);
  stack.updates = placer.array<JointRange>(plan.update_count);
  stack.changed = placer.array<JointRange>(plan.changed_count);
  stack.state_size = 0;
  stack.previous_count = stack.output_count = 0;
  for (size_t i = 0; i < plan.descs.count; ++i) {
    const SolverDesc& desc = plan.descs[i];
    Solver solver = {};
    solver.solve = desc.solve;
    solver.lods = desc.lods;
    const Span<char> name = placer.array<char>(strlen(desc.name) + 1);
    const Span<uint8_t> params = placer.array<uint8_t>(desc.params_size, kBlockAlignment);
    solver.params = params.data;
    solver.writes = placer.array<uint16_t>(desc.writes.count);
    solver.previous = placer.array<uint16_t>(desc.previous.count);
    solver.first_previous = stack.previous_count;
    solver.first_output = stack.output_count;
    solver.state_at = stack.state_size;
    stack.previous_count += static_cast<uint32_t>(desc.previous.count);
    stack.output_count += desc.output_count;
    stack.state_size += align_up(desc.state_size, kStateAlignment);
    if (placer.measuring()) continue;
    memcpy(name.data, desc.name, name.count);
    solver.name = name.data;
    if (params.count != 0) memcpy(params.data, desc.params, params.count);
    std::copy(desc.writes.begin(), desc.writes.end(), solver.writes.begin());
    std::copy(desc.previous.begin(), desc.previous.end(), solver.previous.begin());
    stack.solvers[i] = solver;
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
  const Span<JointRange> ranges = scratch.array<JointRange>(size_t{skeleton.joint_count} + 1);
  if (!ranges.data || !sort_depth_first(skeleton, scratch, tree)) return no_memory(error);
  const Status status = check_order(desc.solvers, tree, error);
  if (status != Status::kOk) return status;

  Stack stack;
  stack.skeleton = &skeleton;
  stack.allocator = allocator;
  stack.check_writes = desc.check_writes;
  StackPlan plan = {desc.solvers, plan_updates(desc.solvers, tree, ranges, stack, {}), 0};
  for (const SolverDesc& solver : desc.solvers) {
    for (uint16_t joint : solver.writes) {
      plan.changed_count = add_range(ranges, plan.changed_count, tree.below(joint));
    }
  }
  Placer measure(nullptr);
  place_stack(plan, measure, stack);
  stack.block_size = measure.size();
  void* block = allocator.get(stack.block_size, kBlockAlignment);
  if (!block) return no_memory(error);
  Placer placer(block);
  place_stack(plan, placer, stack);
  std::copy(tree.order.begin(), tree.order.end(), stack.order.begin());
  std::copy_n(ranges.begin(), plan.changed_count, stack.changed.begin());
  plan_updates(desc.solvers, tree, ranges, stack, stack.updates);
  out = new (block) Stack(stack);
  return Status::kOk;
}

void release_stack(Stack* stack) {
  if (!stack) return;
  const Allocator allocator = stack->allocator;
  allocator.put(stack, stack->block_size, kBlockAlignment);
}

namespace {

void place_state(const Stack& stack, Placer& placer, StackState& state) {
  placer.array<StackState>(1);
  const size_t floats = size_t{stack.skeleton->joint_count} * kLocalTransformFloats;
  state.locals = placer.array<float>(floats, kBlockAlignment);
  state.previous = placer.array<float>(size_t{stack.previous_count} * kMatrixFloats);
  state.outputs = placer.array<float>(stack.output_count);
  state.checked = placer.array<float>(stack.check_writes ? floats : 0);
  state.solver_states = placer.array<uint8_t>(stack.state_size, kBlockAlignment);
}

}  // namespace

size_t stack_state_size(const Stack& stack) {
  StackState state;
  Placer measure(nullptr);
  place_state(stack, measure, state);
  return measure.size();
}

StackState* create_stack_state(const Stack& stack, const Allocator& allocator) {
  StackState state;
  state.stack = &stack;
  state.allocator = allocator;
  state.block_size = stack_state_size(stack);
  void* block = allocator.get(state.block_size, kBlockAlignment);
  if (!block) return nullptr;
  Placer placer(block);
  place_state(stack, placer, state);
  return new (block) StackState(state);
}

void destroy_stack_state(StackState* state) {
  if (!state) return;
  const Allocator allocator = state->allocator;
  allocator.put(state, state->block_size, kBlockAlignment);
}

// Stepping
// ------------------------------------------------------------------------------------------------

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
    const float* p = models + size_t{parent} * kMatrixFloats;
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 3; ++r) {
        double value = local[c][r];
        if (parent != joint) {
          value = p[r] * local[c][0] + p[4 + r] * local[c][1] + p[8 + r] * local[c][2];
          if (c == 3) value += p[12 + r];
        }
        out[c * 4 + r] = static_cast<float>(value);
      }
      out[c * 4 + 3] = c == 3 ? 1.0f : 0.0f;
    }
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

/// skin = model * inverse bind, both of four columns with a last row of 0 0 0 1.
void update_skins(const Stack& stack, JointRange range, JointPose& pose) {
  for (uint32_t place = range.first; place < range.end; ++place) {
    const size_t at = size_t{stack.order[place]} * kMatrixFloats;
    const float *m = pose.model.data + at, *b = stack.skeleton->inverse_bind.data + at;
    float* out = pose.skin.data + at;
    for (int c = 0; c < 4; ++c) {
      for (int r = 0; r < 3; ++r) {
        double value = double{m[r]} * b[c * 4] + double{m[4 + r]} * b[c * 4 + 1] +
                       double{m[8 + r]} * b[c * 4 + 2];
        if (c == 3) value += m[12 + r];
        out[c * 4 + r] = static_cast<float>(value);
      }
      out[c * 4 + 3] = c == 3 ? 1.0f : 0.0f;
    }
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
    if (std::find(begin, end, j) == end) state.undeclared = solver.name;
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
  solver.solve({*stack.skeleton, solver.params, ticks, poses, count});
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
