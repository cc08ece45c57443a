// SPDX-License-Identifier: MIT
// Joint groups -> row blocks (rig-evaluation 4.3, 4.4).
#include <algorithm>
#include <cmath>

#include "runtime/dna/turn_columns.h"
#include "runtime/rig/compile_rig.h"

namespace mien {
namespace {

uint32_t block_rows(uint32_t rows) { return (rows + kBlockRows - 1) / kBlockRows * kBlockRows; }

/// Where a row's result goes. Rows of joints represented by quaternions go nowhere: their columns
/// are turns. With quaternion outputs the attributes behind the rotation move up by one, and angles
/// stand behind all joints until they are made into quaternions.
uint32_t output_of(const dna::DnaView& view, const Rig& rig, uint32_t file_output) {
  const uint32_t joint = file_output / kFileAttributes, attribute = file_output % kFileAttributes;
  if (dna::is_rotation(file_output) && dna::is_quaternion_joint(view, joint)) return kNoOutput;
  if (!rig.quaternion_outputs) return file_output;
  if (dna::is_rotation(file_output)) return rig.joint_value_count() + joint * 3 + attribute - 3;
  return joint * rig.joint_attributes + attribute + (attribute >= 6);
}

void place_variable_values(const dna::DnaView& view, Placer& placer, Rig& rig) {
  size_t total = 0;
  for (uint32_t l = 0; l < rig.lod_count; ++l) {
    size_t values = 0;
    // A row may stand for a whole quaternion.
    for (const dna::JointGroup& group : view.bhvr.joints.groups) {
      values += 4 * size_t{rows_at_lod(group.lods, l)};
    }
    for (const dna::Twist& t : view.twsw.twists) values += 4 * size_t{t.output_joint_indices.count};
    for (const dna::Swing& s : view.twsw.swings) values += 4 * size_t{s.output_joint_indices.count};
    values += 4 * size_t{view.mlbe.joints.output_indices.count};
    total += std::min<size_t>(values, rig.joint_value_count());
  }
  LodLists& lists = rig.variable_joint_values;
  lists.row_of_lod = placer.array<uint16_t>(rig.lod_count);
  lists.first = placer.array<uint32_t>(size_t{rig.lod_count} + 1);
  lists.indices = placer.array<uint16_t>(total);
}

// 16 rows of a row-major big-endian matrix become columns of 16 floats; rows past the end are 0.
void fill_block(const dna::JointGroup& from, uint32_t first_row, float* block) {
  const uint32_t columns = from.input_indices.count;
  const uint32_t rows = std::min(kBlockRows, from.output_indices.count - first_row);
  for (uint32_t r = 0; r < rows; ++r) {
    const uint8_t* row = from.values.data + size_t{first_row + r} * columns * sizeof(float);
    for (uint32_t c = 0; c < columns; ++c) {
      block[size_t{c} * kBlockRows + r] = load_big_endian<float>(row + c * sizeof(float));
    }
  }
}

}  // namespace

void place_joints(const dna::DnaView& view, Placer& placer, Rig& rig) {
  size_t values = 0, columns = 0, outputs = 0;
  const auto& groups = view.bhvr.joints.groups;
  for (const dna::JointGroup& group : groups) {
    const uint32_t rows = block_rows(group.output_indices.count);
    values += size_t{rows} * group.input_indices.count;
    columns += group.input_indices.count;
    outputs += rows;
    rig.joints.widest_group = std::max(rig.joints.widest_group, group.input_indices.count);
    rig.joints.tallest_group = std::max(rig.joints.tallest_group, rows);
  }
  rig.joints.groups = placer.array<JointGroup>(groups.count);
  rig.joints.values = placer.array<float>(values, kBlockAlignment);
  rig.joints.columns = placer.array<uint16_t>(columns);
  rig.joints.outputs = placer.array<uint16_t>(outputs);
  rig.joints.rows_at_lod = placer.array<uint16_t>(size_t{groups.count} * rig.lod_count);
  place_variable_values(view, placer, rig);
}

void fill_joints(const dna::DnaView& view, Span<uint8_t> reach, Rig& rig) {
  JointMatrix& joints = rig.joints;
  size_t value = 0;
  uint32_t column = 0, row = 0;
  for (uint32_t g = 0; g < joints.groups.count; ++g) {
    const dna::JointGroup& from = view.bhvr.joints.groups[g];
    JointGroup& group = joints.groups[g];
    group = {value, column, row, from.input_indices.count, from.output_indices.count};
    for (uint32_t r = 0; r < group.row_count; r += kBlockRows) {
      fill_block(from, r, joints.values.data + value + size_t{r} * group.column_count);
    }
    copy_array(from.input_indices, joints.columns.slice(column, group.column_count));
    for (uint32_t l = 0; l < rig.lod_count; ++l) {
      joints.rows_at_lod[g * rig.lod_count + l] = static_cast<uint16_t>(rows_at_lod(from.lods, l));
    }

    // A row of zeros writes nothing, so that it does not undo what another group writes there.
    // A control is read as long as a row that the LOD reaches has an entry for it.
    const float* block = joints.values.data + value;
    const uint32_t padded_rows = block_rows(group.row_count);
    for (uint32_t r = 0; r < padded_rows; ++r) {
      const float* first =
          block + size_t{r / kBlockRows * kBlockRows} * group.column_count + r % kBlockRows;
      const uint8_t lods = r < group.row_count ? lod_reach(from.lods, rig.lod_count, r) : 0;
      bool any = false;
      for (uint32_t c = 0; c < group.column_count; ++c) {
        if (!(std::fabs(first[size_t{c} * kBlockRows]) > 0.0f)) continue;
        any = true;
        uint8_t& control_reach = reach[joints.columns[column + c]];
        control_reach = std::max(control_reach, lods);
      }
      const uint32_t output = any ? output_of(view, rig, from.output_indices[r]) : kNoOutput;
      joints.outputs[row + r] = static_cast<uint16_t>(output);
    }
    value += size_t{padded_rows} * group.column_count;
    column += group.column_count;
    row += padded_rows;
  }
}

// Ascending, without repetition: values are marked for each LOD, then listed. The neutral pose, not
// filled yet, serves as the place for the marks.
void fill_variable_joint_values(const dna::DnaView& view, Rig& rig) {
  LodLists& lists = rig.variable_joint_values;
  const Span<float>& marks = rig.neutral_joints;
  const auto mark_rotation = [&](uint32_t joint) {
    const uint32_t first = joint * rig.joint_attributes + 3;
    for (uint32_t k = 0; k < rig.joint_attributes - 6; ++k) marks[first + k] = 1.0f;
  };
  for (uint32_t l = 0; l < rig.lod_count; ++l) {
    std::fill(marks.begin(), marks.end(), 0.0f);
    for (const dna::JointGroup& group : view.bhvr.joints.groups) {
      const uint32_t rows = rows_at_lod(group.lods, l);
      for (uint32_t r = 0; r < rows; ++r) {
        const uint32_t output = group.output_indices[r], joint = output / kFileAttributes;
        const bool whole = rig.quaternion_outputs || dna::is_quaternion_joint(view, joint);
        if (dna::is_rotation(output) && whole) {
          mark_rotation(joint);
        } else {
          marks[output_of(view, rig, output)] = 1.0f;
        }
      }
    }
    for (const TwistSwingOutput& output : rig.twist_swing.outputs) {
      if (output.lods >> l & 1) mark_rotation(output.joint);
    }
    for (const MlJoint& joint : rig.ml.joints) {
      if (!(joint.lods >> l & 1)) continue;
      const uint32_t first = joint.joint * rig.joint_attributes;
      for (uint32_t a = 0; a < 3; ++a) {
        if (joint.translation[a] != kNoControl) marks[first + a] = 1.0f;
        if (joint.scale[a] != kNoControl) marks[first + rig.joint_attributes - 3 + a] = 1.0f;
      }
      if (joint.rotation_control != kNoControl) mark_rotation(joint.joint);
    }
    uint32_t at = lists.first[l];
    for (uint32_t v = 0; v < marks.count; ++v) {
      if (marks[v] != 0.0f) lists.indices[at++] = static_cast<uint16_t>(v);
    }
    lists.row_of_lod[l] = static_cast<uint16_t>(l);
    lists.first[l + 1] = at;
  }
}

}  // namespace mien
