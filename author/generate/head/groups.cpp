// SPDX-License-Identifier: MIT
// Joints by name, and their motions as joint groups: one for each part of the face.
#include "author/generate/head/dna.h"

namespace mien::head {

using author::copy_text;
using author::make;
using author::make_lod_map;
using author::Text;

namespace {

bool fill_joint_names(const Skeleton& skeleton, Arena& arena, dna::Definition& out) {
  const size_t count = skeleton.count;
  dna::NewArray<uint16_t> parents;
  dna::NewArray<float> values[6];
  if (!make(arena, count, out.joint_names) || !make(arena, count, parents)) return false;
  for (dna::NewArray<float>& v : values) {
    if (!make(arena, count, v)) return false;
  }
  for (uint32_t j = 0; j < count; ++j) {
    const Joint& joint = skeleton.joints[j];
    Text name;
    name.add(joint.side > 0 ? "L_" : joint.side < 0 ? "R_" : "C_").add(joint.name);
    if (!copy_text(arena, name, out.joint_names[j])) return false;
    parents.set(j, joint.parent);
    Vec3 at = joint.position;
    if (joint.parent != j) at = at - skeleton.joints[joint.parent].position;
    values[0].set(j, static_cast<float>(at.x));
    values[1].set(j, static_cast<float>(at.y));
    values[2].set(j, static_cast<float>(at.z));
    for (int k = 3; k < 6; ++k) values[k].set(j, 0);
  }
  out.joint_hierarchy = parents;
  out.neutral_translations = {values[0], values[1], values[2]};
  out.neutral_rotations = {values[3], values[4], values[5]};
  const auto in_lod = [&skeleton](size_t lod, size_t joint) {
    return Skeleton::in_lod(skeleton.joints[joint], static_cast<uint32_t>(lod));
  };
  return make_lod_map(arena, kLodCount, count, in_lod, out.lod_joints);
}

/// Rows: attributes of the group's joints that some shape changes, those of the coarsest LODs
/// first. Columns: shapes that change one of them.
bool fill_group(const Head& head, uint32_t group, Arena& arena, Span<uint16_t> row_buffer,
                Span<uint16_t> column_buffer, dna::JointGroup& out) {
  const Skeleton& skeleton = head.skeleton;
  const auto value = [&head](uint32_t shape, uint32_t row) {
    const JointDelta& d = head.deltas.at(shape, row / 9);
    return row % 9 < 3 ? d.translation[row % 9] : d.rotation[row % 9 - 3];
  };
  uint32_t rows = 0, columns = 0;
  uint32_t rows_of_tier[kLodCount] = {};
  for (uint32_t tier = 0; tier < kLodCount; ++tier) {
    for (uint32_t j = 0; j < skeleton.count; ++j) {
      if (skeleton.joints[j].tier != tier || skeleton.joints[j].group != group) continue;
      for (uint32_t a = 0; a < 6; ++a) {
        bool moves = false;
        for (uint32_t s = 0; s < head.shapes.count(); ++s) moves |= value(s, j * 9 + a) != 0;
        if (moves) row_buffer[rows++] = static_cast<uint16_t>(j * 9 + a);
      }
    }
    rows_of_tier[tier] = rows;
  }
  for (uint32_t s = 0; s < head.shapes.count(); ++s) {
    bool moves = false;
    for (uint32_t r = 0; r < rows; ++r) moves |= value(s, row_buffer[r]) != 0;
    if (moves) column_buffer[columns++] = static_cast<uint16_t>(s);
  }
  dna::NewArray<uint16_t> lods;
  if (!make(arena, kLodCount, lods)) return false;
  for (uint32_t lod = 0; lod < kLodCount; ++lod) {
    lods.set(lod, static_cast<uint16_t>(rows_of_tier[kLodCount - 1 - lod]));
  }
  return author::make_joint_group(arena, lods, row_buffer.first(rows), column_buffer.first(columns),
                                  value, out);
}

}  // namespace

bool fill_joints(const Head& head, Arena& arena, Arena& scratch, dna::DnaView& out) {
  Span<uint16_t> rows, columns;
  if (!fill_joint_names(head.skeleton, arena, out.defn) ||
      !make(scratch, size_t{head.skeleton.count} * 6, rows) ||
      !make(scratch, head.shapes.count(), columns) ||
      !make(arena, kJointGroupCount, out.bhvr.joints.groups)) {
    return false;
  }
  out.bhvr.joints.row_count = static_cast<uint16_t>(9 * head.skeleton.count);
  out.bhvr.joints.col_count = static_cast<uint16_t>(head.shapes.count());
  for (uint32_t g = 0; g < kJointGroupCount; ++g) {
    if (!fill_group(head, g, arena, rows, columns, out.bhvr.joints.groups[g])) return false;
  }
  return true;
}

}  // namespace mien::head
