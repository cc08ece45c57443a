// SPDX-License-Identifier: MIT
#include "runtime/load/dna/convert/convert_rotations.h"

#include "runtime/base/transform.h"
#include "runtime/load/dna/format/quaternion_columns.h"

namespace mien::dna {
namespace {

constexpr uint32_t kNone = ~uint32_t{0};

/// One triple of angles after another.
class AngleConverter {
 public:
  AngleConverter(const CoordinateSystem& from, const CoordinateSystem& to,
                 const CoordinateChange& change)
      : old_(rotation_convention(from.rotation_sequence, from.rotation_signs, from.rotation_unit)),
        now_(rotation_convention(to.rotation_sequence, to.rotation_signs, to.rotation_unit)),
        turn_(change_of_axes(from.axes, to.axes)), change_(change) {}

  void convert(const float in[3], float out[3]) const {
    int turns = 0;
    for (int i = 0; i < 3; ++i) turns += in[i] != 0;
    if (turns <= 1) {  // the order does not matter, so the result is exact
      for (int d = 0; d < 3; ++d) out[d] = scaled(in[change_.from[d]], change_.angle[d]);
      return;
    }
    euler_from_matrix(now_, transposed(turn_) * matrix_from_euler(old_, in) * turn_, out);
  }

 private:
  RotationConvention old_, now_;
  Matrix3 turn_;
  const CoordinateChange& change_;
};

/// Rows of one joint in a group, by axis; kNone where it has none.
struct JointRows {
  uint32_t row[3] = {kNone, kNone, kNone};

  uint32_t first() const {
    const uint32_t ab = row[0] < row[1] ? row[0] : row[1];
    return ab < row[2] ? ab : row[2];
  }
};

class RowConverter {
 public:
  RowConverter(DnaView& view, const CoordinateSystem& from, const CoordinateSystem& to,
               const CoordinateChange& change, ConvertedArrays& arrays, Arena& arena, Error& error)
      : view_(view), change_(change), rule_(to.rotation_rule), arrays_(arrays), arena_(arena),
        error_(error), angles_(from, to, change) {}

  Status run() {
    const List<JointGroup>& groups = view_.bhvr.joints.groups;
    uint32_t max_rows = 0;
    for (const JointGroup& group : groups) {
      max_rows = group.output_indices.count > max_rows ? group.output_indices.count : max_rows;
    }
    const uint32_t joints = view_.defn.joint_names.count;
    rows_ = arena_.array<JointRows>(joints);
    axes_ = arena_.array<uint8_t>(joints);
    added_ = arena_.array<uint8_t>(max_rows);
    new_rows_ = arena_.array<uint32_t>(max_rows);
    if (rows_.count != joints || axes_.count != joints || added_.count != max_rows ||
        new_rows_.count != max_rows) {
      return arrays_.run_out();
    }
    for (uint32_t g = 0; g < groups.count; ++g) {
      if (Status s = convert_group(groups[g], g); s != Status::kOk) return s;
    }
    return Status::kOk;
  }

 private:
  Status refuse(const JointGroup& group, uint32_t number, uint32_t row, const char* why) {
    const uint32_t joint = group.output_indices[row] / 9;
    const String& name = view_.defn.joint_names[joint];
    return fail(error_, Status::kDnaValue, view_.offset_of(group.output_indices.data + 2 * row),
                "bhvr.joints.jointGroups[%u].outputIndices[%u]: joint %.*s %s; use "
                "MIEN_ROTATION_RULE_CARRIED",
                number, row, static_cast<int>(name.count < 60 ? name.count : 60), name.chars(),
                why);
  }

  static float entry(const JointGroup& group, uint32_t row, uint32_t column) {
    if (row == kNone) return 0;
    return group.values[size_t{row} * group.input_indices.count + column];
  }

  void convert_column(const JointGroup& group, const JointRows& rows, uint32_t column,
                      float out[3]) const {
    const float in[3] = {entry(group, rows.row[0], column), entry(group, rows.row[1], column),
                         entry(group, rows.row[2], column)};
    angles_.convert(in, out);
  }

  // Sums of angles follow only if all that is ever added turns about the same axis.
  Status note_axes(const JointGroup& group, uint32_t number, uint32_t row) {
    const uint32_t output = group.output_indices[row], joint = output / 9;
    if (rule_ != RotationRule::kExact || is_quaternion_joint(view_, joint)) return Status::kOk;
    for (uint32_t c = 0; c < group.input_indices.count; ++c) {
      if (entry(group, row, c) != 0) axes_[joint] |= 1u << (output % 9 - 3);
    }
    if ((axes_[joint] & (axes_[joint] - 1)) == 0) return Status::kOk;
    return refuse(group, number, row,
                  "adds Euler angles about several axes, which have no sum in "
                  "another order");
  }

  Status find_rows(const JointGroup& group, uint32_t number) {
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      const uint32_t output = group.output_indices[r];
      if (is_rotation(output)) rows_[output / 9] = JointRows();
    }
    for (uint32_t r = 0; r < group.output_indices.count; ++r) {
      const uint32_t output = group.output_indices[r];
      if (!is_rotation(output)) continue;
      uint32_t& row = rows_[output / 9].row[output % 9 - 3];
      if (row != kNone) return refuse(group, number, r, "has two rows for one angle");
      row = r;
      if (Status s = note_axes(group, number, r); s != Status::kOk) return s;
    }
    return Status::kOk;
  }

  Status check_lods(const JointGroup& group, uint32_t number, const JointRows& rows) {
    for (uint32_t l = 0; l < group.lods.count; ++l) {
      uint32_t active = 0, all = 0;
      for (uint32_t row : rows.row) {
        all += row != kNone;
        active += row != kNone && row < group.lods[l];
      }
      if (active != 0 && active != all) {
        return refuse(group, number, rows.first(), "keeps only some of its angles at a LOD");
      }
    }
    return Status::kOk;
  }

  /// Bits of old axes that have no row yet but get numbers now.
  uint8_t missing_rows(const JointGroup& group, const JointRows& rows) const {
    uint8_t missing = 0;
    for (uint32_t axis = 0; axis < 3; ++axis) missing |= (rows.row[axis] == kNone) << axis;
    uint8_t needed = 0;
    for (uint32_t c = 0; missing && c < group.input_indices.count; ++c) {
      float out[3];
      convert_column(group, rows, c, out);
      for (uint32_t axis = 0; axis < 3; ++axis) needed |= (out[change_.to[axis]] != 0) << axis;
    }
    return missing & needed;
  }

  Status convert_group(JointGroup& group, uint32_t number) {
    if (Status s = find_rows(group, number); s != Status::kOk) return s;
    const uint32_t rows = group.output_indices.count, columns = group.input_indices.count;
    uint32_t count = 0;
    bool turns = false;
    for (uint32_t r = 0; r < rows; ++r) {
      const uint32_t output = group.output_indices[r];
      new_rows_[r] = count++;
      added_[r] = 0;
      if (!is_rotation(output)) continue;
      turns = true;
      const JointRows& of_joint = rows_[output / 9];
      if (of_joint.first() != r) continue;
      if (Status s = check_lods(group, number, of_joint); s != Status::kOk) return s;
      added_[r] = missing_rows(group, of_joint);
      for (uint32_t axis = 0; axis < 3; ++axis) count += added_[r] >> axis & 1;
    }
    if (!turns) return Status::kOk;
    if (count > 65535) {
      return fail(error_, Status::kDnaLimit, kNoOffset,
                  "bhvr.joints.jointGroups[%u]: would have %u rows; 65535 can be counted", number,
                  count);
    }

    const NewArray<uint16_t> outputs = arrays_.room<uint16_t>(count);
    const NewArray<float> values = arrays_.room<float>(size_t{count} * columns);
    const NewArray<uint16_t> lods = arrays_.room<uint16_t>(group.lods.count);
    if (arrays_.out_of_memory()) return Status::kOk;
    for (uint32_t l = 0; l < lods.count; ++l) {
      const uint32_t old = group.lods[l];
      lods.set(l, static_cast<uint16_t>(old < rows ? new_rows_[old] : count));
    }
    for (uint32_t r = 0; r < rows; ++r) fill_rows(group, r, outputs, values);
    group.output_indices = outputs;
    group.values = values;
    group.lods = lods;
    return Status::kOk;
  }

  /// The new rows of an old one; of a joint that turns, all of them with the first.
  void fill_rows(const JointGroup& group, uint32_t row, const NewArray<uint16_t>& outputs,
                 const NewArray<float>& values) const {
    const uint32_t output = group.output_indices[row], columns = group.input_indices.count;
    if (!is_rotation(output)) {
      outputs.set(new_rows_[row], static_cast<uint16_t>(output));
      for (uint32_t c = 0; c < columns; ++c) {
        values.set(size_t{new_rows_[row]} * columns + c, entry(group, row, c));
      }
      return;
    }
    const JointRows& of_joint = rows_[output / 9];
    if (of_joint.first() != row) return;
    uint32_t target[3];  // by new axis
    uint32_t next = new_rows_[row] + 1;
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const uint32_t now = change_.to[axis], old_row = of_joint.row[axis];
      const bool adds = added_[row] >> axis & 1;
      target[now] = old_row != kNone ? new_rows_[old_row] : adds ? next++ : kNone;
      if (target[now] == kNone) continue;
      outputs.set(target[now], static_cast<uint16_t>(output / 9 * 9 + 3 + now));
    }
    for (uint32_t c = 0; c < columns; ++c) {
      float out[3];
      convert_column(group, of_joint, c, out);
      for (uint32_t d = 0; d < 3; ++d) {
        if (target[d] != kNone) values.set(size_t{target[d]} * columns + c, out[d]);
      }
    }
  }

  DnaView& view_;
  const CoordinateChange& change_;
  RotationRule rule_;
  ConvertedArrays& arrays_;
  Arena& arena_;
  Error& error_;
  AngleConverter angles_;
  Span<JointRows> rows_;     // by joint, of the current group
  Span<uint8_t> axes_;       // by joint: axes about which Euler angles are added
  Span<uint8_t> added_;      // by row: bits of axes whose rows come behind it
  Span<uint32_t> new_rows_;  // by row
};

}  // namespace

Vec3Array convert_neutral_rotations(const Vec3Array& old, const CoordinateSystem& from,
                                    const CoordinateSystem& to, const CoordinateChange& change,
                                    ConvertedArrays& arrays) {
  const Array<float>* parts[3] = {&old.xs, &old.ys, &old.zs};
  if (change.carries_angles) {
    return {arrays.times(*parts[change.from[0]], change.angle[0]),
            arrays.times(*parts[change.from[1]], change.angle[1]),
            arrays.times(*parts[change.from[2]], change.angle[2])};
  }
  const NewArray<float> xs = arrays.room<float>(old.xs.count);
  const NewArray<float> ys = arrays.room<float>(old.xs.count);
  const NewArray<float> zs = arrays.room<float>(old.xs.count);
  if (arrays.out_of_memory()) return {};
  const AngleConverter angles(from, to, change);
  for (uint32_t j = 0; j < old.xs.count; ++j) {
    const float in[3] = {old.xs[j], old.ys[j], old.zs[j]};
    float turned[3];
    angles.convert(in, turned);
    xs.set(j, turned[0]);
    ys.set(j, turned[1]);
    zs.set(j, turned[2]);
  }
  return {xs, ys, zs};
}

Status convert_rotation_rows(DnaView& view, const CoordinateSystem& from,
                             const CoordinateSystem& to, const CoordinateChange& change,
                             ConvertedArrays& arrays, Arena& arena, Error& error) {
  return RowConverter(view, from, to, change, arrays, arena, error).run();
}

}  // namespace mien::dna
