// SPDX-License-Identifier: MIT
// Rotations of joint groups: angles that become quaternions, and joints represented by quaternions
// (docs/rig-evaluation.md, 4.3, 4.7, 4.8), which are called turns here.
#include <algorithm>

#include "runtime/base/half.h"
#include "runtime/load/compile/plan_block_rows.h"
#include "simd/lanes.h"

namespace mien {
namespace {

enum class RowKind { kOther, kAngle, kTurn };

/// kOther also for rotation rows that write plain Euler outputs.
RowKind kind_of(const dna::DnaView& view, bool quaternion_outputs, uint32_t output) {
  if (!dna::is_rotation(output)) return RowKind::kOther;
  if (dna::is_quaternion_row(view, output)) return RowKind::kTurn;
  return quaternion_outputs ? RowKind::kAngle : RowKind::kOther;
}

/// Upper bound of the joints that rows of a kind belong to: rows of one joint usually adjoin.
uint32_t count_joints(const dna::DnaView& view, const dna::JointGroup& group, RowKind kind,
                      bool quaternion_outputs) {
  uint32_t count = 0, last = 0xFFFFFFFF;
  for (uint32_t r = 0; r < group.output_indices.count; ++r) {
    const uint32_t output = group.output_indices[r];
    if (kind_of(view, quaternion_outputs, output) != kind) continue;
    if (output / kFileAttributes != last) ++count;
    last = output / kFileAttributes;
  }
  return count;
}

constexpr uint32_t kNoRotation = ~uint32_t{0};

/// Scratch of planning.
struct Scratch {
  Span<uint32_t> position;        // [joint]: its angle joint or turn in this group, or kNoRotation
  Span<uint32_t> first_rows;      // [column] of the widest group
  Span<uint32_t> columns_at_lod;  // [lod]
};

/// Lists the joints of a kind in order of their first row. Of turns, rows of zeros and rows that no
/// LOD reaches do not count: they must not undo what another group turned. `position` is all kNoRotation,
/// before and after.
uint32_t list_angle_joints(const dna::DnaView& view, const dna::JointGroup& group,
                           const Span<uint32_t>& position, AngleJoint* out) {
  uint32_t count = 0;
  for (uint32_t r = 0; r < group.output_indices.count; ++r) {
    const uint32_t output = group.output_indices[r], joint = output / kFileAttributes;
    if (kind_of(view, true, output) != RowKind::kAngle || position[joint] != kNoRotation) continue;
    position[joint] = count;
    out[count++] = {static_cast<uint16_t>(joint), static_cast<uint16_t>(r)};
  }
  for (uint32_t i = 0; i < count; ++i) position[out[i].joint] = kNoRotation;
  return count;
}

uint32_t list_turns(const dna::DnaView& view, const GroupColumns& columns, uint32_t g,
                    const Span<uint32_t>& position, PlannedTurn* out) {
  const dna::JointGroup& group = view.bhvr.joints.groups[g];
  uint32_t count = 0;
  for (uint32_t r = 0; r < group.output_indices.count; ++r) {
    const uint32_t output = group.output_indices[r], joint = output / kFileAttributes;
    if (kind_of(view, false, output) != RowKind::kTurn) continue;
    if (r >= rows_at_lod(group.lods, 0) || columns.is_zero(r)) continue;
    if (position[joint] == kNoRotation) {
      position[joint] = count;
      out[count] = {};
      out[count].group = g;
      out[count].joint = static_cast<uint16_t>(joint);
      std::fill(out[count].rows, out[count].rows + 3, kNoRotation);
      for (uint32_t l = 0; l < view.desc.lod_count; ++l) {
        out[count].lods |= uint64_t{rows_at_lod(group.lods, l) > r} << l;
      }
      out[count++].reach = lod_reach(group.lods, view.desc.lod_count, r);
    }
    uint32_t& row = out[position[joint]].rows[output % kFileAttributes - 3];
    if (row == kNoRotation) row = r;
  }
  for (uint32_t i = 0; i < count; ++i) position[out[i].joint] = kNoRotation;
  return count;
}

/// Calls f(index) for the columns that turn a joint, of the first `count` in the order of its group.
template <class F>
void for_each_step(const GroupColumns& columns, const PlannedTurn& turn, const uint32_t* order,
                   uint32_t count, F&& f) {
  for (uint32_t k = 0; k < count; ++k) {
    bool any = false;
    for (const uint32_t row : turn.rows) {
      any = any || (row != kNoRotation && columns.is_nonzero(row, order[k]));
    }
    if (any) f(k);
  }
}

Status no_memory(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory to compile rotations");
}

/// One quaternion for each lane of a step; of the two that mean the same rotation the one with
/// w >= 0, so that blending with the identity never needs to ask.
void fill_step(const dna::JointGroup& group, const PlannedTurn& turn, uint32_t column, size_t at,
               const Rig& rig) {
  float angles[3] = {};
  for (int axis = 0; axis < 3; ++axis) {
    if (turn.rows[axis] == kNoRotation) continue;
    angles[axis] =
        saturated(group.values[size_t{turn.rows[axis]} * group.input_indices.count + column]);
  }
  const Quaternion q = quaternion_from_euler(rig.rotation, angles);
  const float sign = q.w < 0 ? -1.0f : 1.0f;
  for (float part : {q.x, q.y, q.z, q.w}) {
    if (rig.half_storage) {
      rig.rotations.halves[at] = half_from_float(part * sign);
    } else {
      rig.rotations.values[at] = part * sign;
    }
    at += kBlockLanes;
  }
}

}  // namespace

Status plan_rotations(const dna::DnaView& view, const JointPlan& joints, const Rig& rig,
                      Arena& arena, RotationPlan& plan, Error& error) {
  const auto& groups = view.bhvr.joints.groups;
  plan.columns = joints.groups;
  size_t turns = 0, angle_joints = 0, columns = 0, widest = 0;
  for (const dna::JointGroup& group : groups) {
    if (rig.quaternion_outputs) {
      angle_joints += count_joints(view, group, RowKind::kAngle, rig.quaternion_outputs);
    }
    const size_t count = count_joints(view, group, RowKind::kTurn, rig.quaternion_outputs);
    if (count == 0) continue;
    turns += count;
    columns += group.input_indices.count;
    widest = std::max<size_t>(widest, group.input_indices.count);
  }
  plan.groups = arena.array<GroupRotations>(groups.count);
  plan.first_columns = arena.array<uint32_t>(size_t{groups.count} + 1);
  if (!plan.first_columns.data || (groups.count && !plan.groups.data)) return no_memory(error);
  if (turns + angle_joints == 0) return Status::kOk;
  plan.angle_joints = arena.array<AngleJoint>(angle_joints);
  plan.turns = arena.array<PlannedTurn>(turns);
  plan.order = arena.array<uint32_t>(columns);
  plan.used_at_lod = arena.array<uint32_t>(turns * rig.lod_count);
  plan.sorted = arena.array<uint32_t>(turns);
  const Scratch scratch = {arena.array<uint32_t>(rig.joint_count), arena.array<uint32_t>(widest),
                           arena.array<uint32_t>(rig.lod_count)};
  const size_t lods = turns * rig.lod_count;
  if ((angle_joints && !plan.angle_joints.data) || (turns && !plan.turns.data) ||
      (columns && !plan.order.data) || (lods && !plan.used_at_lod.data) ||
      (turns && !plan.sorted.data) || (rig.joint_count && !scratch.position.data) ||
      (widest && !scratch.first_rows.data) || (rig.lod_count && !scratch.columns_at_lod.data)) {
    return no_memory(error);
  }
  std::fill(scratch.position.begin(), scratch.position.end(), kNoRotation);

  uint32_t turn = 0, angle_joint = 0, column = 0;
  for (uint32_t g = 0; g < groups.count; ++g) {
    const dna::JointGroup& group = groups[g];
    GroupRotations& rotations = plan.groups[g];
    rotations = {angle_joint, 0, turn, 0};
    if (angle_joints) {
      rotations.angle_joint_count =
          list_angle_joints(view, group, scratch.position, plan.angle_joints.data + angle_joint);
      angle_joint += rotations.angle_joint_count;
    }
    if (turns) {
      rotations.turn_count =
          list_turns(view, plan.columns[g], g, scratch.position, plan.turns.data + turn);
    }
    plan.first_columns[g] = column;
    if (rotations.turn_count == 0) continue;
    const Span<uint32_t> order = plan.order.slice(column, group.input_indices.count);
    const uint32_t used = dna::order_quaternion_columns(view, group, scratch.first_rows, order,
                                                        scratch.columns_at_lod.data);
    column += used;
    for (uint32_t i = 0; i < rotations.turn_count; ++i, ++turn) {
      PlannedTurn& planned = plan.turns[turn];
      uint32_t* at_lod = plan.used_at_lod.data + size_t{turn} * rig.lod_count;
      for_each_step(plan.columns[g], planned, order.data, used, [&](uint32_t k) {
        ++planned.steps;
        for (uint32_t l = 0; l < rig.lod_count; ++l) {
          at_lod[l] += (planned.lods >> l & 1) && k < scratch.columns_at_lod[l];
        }
      });
    }
  }
  plan.first_columns[groups.count] = column;
  plan.angle_joints = plan.angle_joints.first(angle_joint);
  plan.turns = plan.turns.first(turn);
  plan.sorted = plan.sorted.first(turn);
  for (uint32_t t = 0; t < turn; ++t) plan.sorted[t] = t;
  std::sort(plan.sorted.begin(), plan.sorted.end(), [&](uint32_t a, uint32_t b) {
    const PlannedTurn &x = plan.turns[a], &y = plan.turns[b];
    if (x.reach != y.reach) return x.reach > y.reach;
    return x.steps != y.steps ? x.steps > y.steps : a < b;
  });
  for (uint32_t i = 0, most = 0; i < turn; ++i) {
    plan.turns[plan.sorted[i]].lane = i;
    most = std::max(i % kBlockLanes ? most : 0, plan.turns[plan.sorted[i]].steps);
    if ((i + 1) % kBlockLanes == 0 || i + 1 == turn) plan.step_count += most;
  }
  return Status::kOk;
}

void place_rotations(const RotationPlan& plan, Placer& placer, Rig& rig) {
  RotationTable& table = rig.rotations;
  const size_t blocks = align_up(plan.turns.count, kBlockLanes) / kBlockLanes;
  const size_t lanes = plan.step_count * kBlockLanes, values = lanes * 4;
  table.groups = placer.array<GroupRotations>(plan.groups.count);
  table.angle_joints = placer.array<AngleJoint>(plan.angle_joints.count);
  table.turns = placer.array<RotationOutput>(plan.turns.count);
  table.blocks_at_lod = placer.array<uint32_t>(rig.lod_count);
  table.first_steps = placer.array<uint32_t>(blocks + 1);
  table.steps_at_lod = placer.array<uint32_t>(blocks * rig.lod_count);
  table.lane_steps_at_lod =
      placer.array<float>(blocks * rig.lod_count * kBlockLanes, kBlockAlignment);
  table.columns = placer.array<uint16_t>(lanes);
  table.values = placer.array<float>(rig.half_storage ? 0 : values, kBlockAlignment);
  table.halves = placer.array<uint16_t>(rig.half_storage ? values : 0, kBlockAlignment);
}

void fill_rotations(const dna::DnaView& view, const RotationPlan& plan, Rig& rig) {
  RotationTable& table = rig.rotations;
  std::copy(plan.groups.begin(), plan.groups.end(), table.groups.begin());
  std::copy(plan.angle_joints.begin(), plan.angle_joints.end(), table.angle_joints.begin());
  const uint32_t blocks = table.block_count();
  for (uint32_t i = 0; i < plan.sorted.count; ++i) {
    const uint32_t block = i / kBlockLanes, lane = i % kBlockLanes;
    const PlannedTurn& turn = plan.turns[plan.sorted[i]];
    table.turns[plan.sorted[i]] = {turn.lods, i, turn.joint, 0};
    const auto steps =
        std::max(lane ? table.first_steps[block + 1] - table.first_steps[block] : 0, turn.steps);
    table.first_steps[block + 1] = table.first_steps[block] + steps;
    const uint32_t* used = plan.used_at_lod.data + size_t{plan.sorted[i]} * rig.lod_count;
    for (uint32_t l = 0; l < rig.lod_count; ++l) {
      const size_t at = size_t{l} * blocks + block;
      if (l < turn.reach) table.blocks_at_lod[l] = block + 1;
      table.steps_at_lod[at] = std::max(table.steps_at_lod[at], used[l]);
      table.lane_steps_at_lod[at * kBlockLanes + lane] = static_cast<float>(used[l]);
    }
  }
  for (const GroupRotations& group : plan.groups) {
    const Span<RotationOutput> turns = table.turns.slice(group.first_turn, group.turn_count);
    std::sort(turns.begin(), turns.end(),
              [](const RotationOutput& a, const RotationOutput& b) { return a.lane < b.lane; });
  }
  for (const PlannedTurn& turn : plan.turns) {
    const dna::JointGroup& group = view.bhvr.joints.groups[turn.group];
    const uint32_t first = plan.first_columns[turn.group];
    const uint32_t* order = plan.order.data + first;
    const uint32_t lane = turn.lane % kBlockLanes;
    size_t step = table.first_steps[turn.lane / kBlockLanes];
    const GroupColumns& columns = plan.columns[turn.group];
    const uint32_t count = plan.first_columns[turn.group + 1] - first;
    for_each_step(columns, turn, order, count, [&](uint32_t k) {
      table.columns[step * kBlockLanes + lane] = columns.inputs[order[k]];
      fill_step(group, turn, order[k], step++ * 4 * kBlockLanes + lane, rig);
    });
  }
  // The padding of a step reads a control that the step reads anyway.
  for (size_t block = 0; block < blocks; ++block) {
    const size_t count = std::min<size_t>(plan.sorted.count - block * kBlockLanes, kBlockLanes);
    for (size_t step = table.first_steps[block]; step < table.first_steps[block + 1]; ++step) {
      const auto steps = step - table.first_steps[block];
      const auto has = [&](size_t lane) {
        return lane < count && plan.turns[plan.sorted[block * kBlockLanes + lane]].steps > steps;
      };
      uint16_t* columns = table.columns.data + step * kBlockLanes;
      size_t some = 0;
      while (!has(some)) ++some;
      for (size_t lane = 0; lane < kBlockLanes; ++lane) {
        if (!has(lane)) columns[lane] = columns[some];
      }
    }
  }
}

}  // namespace mien
