// SPDX-License-Identifier: MIT
// What joint groups do to rotations: angles that become quaternions, and joints represented by
// quaternions (docs/rig-evaluation.md, 4.3, 4.7, 4.8).
#include <algorithm>

#include "runtime/base/half.h"
#include "runtime/compile/plan_block_rows.h"

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

constexpr uint32_t kNone = ~uint32_t{0};

/// For the time of compilation; sized for the largest group and all joints.
struct Scratch {
  Span<uint32_t> position;       // [joint]: where a joint stands in its list, or kNone
  Span<uint32_t> first_rows;     // [column]
  Span<uint32_t> column_order;   // [column]
  Span<uint32_t> rotation_rows;  // [quaternion joint][axis]: its row, or kNone
};

/// Lists the joints of a kind in order of their first row; returns how many. Of quaternion joints,
/// rows of zeros and rows that no LOD reaches do not count: they must not undo what another group
/// turned. `position` is all kNone, before and after.
uint32_t list_joints(const dna::DnaView& view, const dna::JointGroup& group, RowKind kind,
                     bool quaternion_outputs, const Scratch& scratch, QuaternionJoint* out) {
  uint32_t count = 0;
  for (uint32_t r = 0; r < group.output_indices.count; ++r) {
    const uint32_t output = group.output_indices[r];
    if (kind_of(view, quaternion_outputs, output) != kind) continue;
    if (kind == RowKind::kTurn && (r >= rows_at_lod(group.lods, 0) || is_zero(group, r))) continue;
    uint32_t& position = scratch.position[output / kFileAttributes];
    if (position == kNone) {
      position = count;
      out[count++] = {static_cast<uint16_t>(output / kFileAttributes), static_cast<uint16_t>(r)};
    }
    if (kind != RowKind::kTurn) continue;
    const uint32_t axis = output % kFileAttributes - 3;
    uint32_t* rows = scratch.rotation_rows.data + size_t{position} * 3;
    if (rows[axis] == kNone) rows[axis] = r;
  }
  for (uint32_t i = 0; i < count; ++i) scratch.position[out[i].joint] = kNone;
  return count;
}

/// One quaternion for each column and joint; of the two that mean the same rotation the one with
/// w >= 0, so that blending with the identity never needs to ask.
void fill_turns(const dna::JointGroup& group, uint32_t column_count, const Scratch& scratch,
                const Rig& rig, const GroupRotations& rotations) {
  for (uint32_t j = 0; j < rotations.quaternion_joint_count; ++j) {
    const uint32_t* rows = scratch.rotation_rows.data + size_t{j} * 3;
    const size_t lane = rotations.first_value +
                        size_t{j / kBlockLanes} * column_count * 4 * kBlockLanes + j % kBlockLanes;
    for (uint32_t k = 0; k < column_count; ++k) {
      float angles[3] = {};
      for (int axis = 0; axis < 3; ++axis) {
        if (rows[axis] == kNone) continue;
        angles[axis] =
            group.values[size_t{rows[axis]} * group.input_indices.count + scratch.column_order[k]];
      }
      const Quaternion q = quaternion_from_euler(rig.rotation, angles);
      const float sign = q.w < 0 ? -1.0f : 1.0f;
      size_t at = lane + size_t{k} * 4 * kBlockLanes;
      for (float part : {q.x, q.y, q.z, q.w}) {
        if (rig.half_storage) {
          rig.rotations.halves[at] = half_from_float(part * sign);
        } else {
          rig.rotations.values[at] = part * sign;
        }
        at += kBlockLanes;
      }
    }
  }
}

}  // namespace

void place_rotations(const dna::DnaView& view, Placer& placer, Rig& rig) {
  size_t angle_joints = 0, quaternion_joints = 0, columns = 0, values = 0;
  const auto& groups = view.bhvr.joints.groups;
  for (const dna::JointGroup& group : groups) {
    angle_joints += count_joints(view, group, RowKind::kAngle, rig.quaternion_outputs);
    const size_t turns = count_joints(view, group, RowKind::kTurn, rig.quaternion_outputs);
    quaternion_joints += turns;
    rig.rotations.max_quaternion_joints =
        std::max(rig.rotations.max_quaternion_joints, static_cast<uint32_t>(turns));
    if (turns == 0) continue;
    columns += group.input_indices.count;
    values += align_up(turns, kBlockLanes) * 4 * group.input_indices.count;
  }
  rig.rotations.groups = placer.array<GroupRotations>(groups.count);
  rig.rotations.angle_joints = placer.array<QuaternionJoint>(angle_joints);
  rig.rotations.quaternion_joints = placer.array<QuaternionJoint>(quaternion_joints);
  rig.rotations.columns = placer.array<uint16_t>(columns);
  rig.rotations.columns_at_lod = placer.array<uint32_t>(size_t{groups.count} * rig.lod_count);
  rig.rotations.values = placer.array<float>(rig.half_storage ? 0 : values, kBlockAlignment);
  rig.rotations.halves = placer.array<uint16_t>(rig.half_storage ? values : 0, kBlockAlignment);
}

Status fill_rotations(const dna::DnaView& view, Arena& arena, Rig& rig, Error& error) {
  RotationTable& table = rig.rotations;
  const size_t columns = rig.joints.widest_group;
  const size_t rows = size_t{rig.joints.tallest_group} * 3;
  const Scratch scratch = {arena.array<uint32_t>(rig.joint_count), arena.array<uint32_t>(columns),
                           arena.array<uint32_t>(columns), arena.array<uint32_t>(rows)};
  if ((rig.joint_count && !scratch.position.data) || (rows && !scratch.rotation_rows.data) ||
      (columns && (!scratch.first_rows.data || !scratch.column_order.data))) {
    return fail(error, Status::kMemory, kNoOffset, "no memory to compile rotations");
  }
  std::fill(scratch.position.begin(), scratch.position.end(), kNone);

  uint32_t angle_joint = 0, quaternion_joint = 0, column = 0;
  size_t value = 0;
  for (uint32_t g = 0; g < table.groups.count; ++g) {
    const dna::JointGroup& group = view.bhvr.joints.groups[g];
    GroupRotations& rotations = table.groups[g];
    rotations = {angle_joint, 0, quaternion_joint, 0, column, 0, value};
    const size_t most = std::min(rows, size_t{group.output_indices.count} * 3);
    std::fill(scratch.rotation_rows.begin(), scratch.rotation_rows.begin() + most, kNone);
    rotations.angle_joint_count = list_joints(view, group, RowKind::kAngle, rig.quaternion_outputs,
                                              scratch, table.angle_joints.data + angle_joint);
    rotations.quaternion_joint_count =
        list_joints(view, group, RowKind::kTurn, rig.quaternion_outputs, scratch,
                    table.quaternion_joints.data + quaternion_joint);
    angle_joint += rotations.angle_joint_count;
    quaternion_joint += rotations.quaternion_joint_count;
    if (rotations.quaternion_joint_count == 0) continue;

    rotations.column_count =
        dna::order_quaternion_columns(view, group, scratch.first_rows, scratch.column_order,
                                      table.columns_at_lod.data + size_t{g} * rig.lod_count);
    for (uint32_t k = 0; k < rotations.column_count; ++k) {
      table.columns[column + k] = group.input_indices[scratch.column_order[k]];
    }
    fill_turns(group, rotations.column_count, scratch, rig, rotations);
    column += rotations.column_count;
    value += align_up(rotations.quaternion_joint_count, kBlockLanes) * 4 * rotations.column_count;
  }
  return Status::kOk;
}

}  // namespace mien
