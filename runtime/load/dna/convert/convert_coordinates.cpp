// SPDX-License-Identifier: MIT
#include "runtime/load/dna/convert/convert_coordinates.h"

#include <algorithm>
#include <cstdio>

#include "runtime/load/dna/convert/convert_networks.h"
#include "runtime/load/dna/convert/convert_rotations.h"
#include "runtime/load/dna/convert/converted_arrays.h"
#include "runtime/load/dna/convert/rotation_controls.h"
#include "runtime/load/dna/format/ml_joint_system.h"
#include "runtime/load/dna/format/quaternion_columns.h"

namespace mien::dna {
namespace {

bool same_system(const CoordinateSystem& a, const CoordinateSystem& b) {
  for (int i = 0; i < 3; ++i) {
    if (a.axes[i] != b.axes[i] || a.rotation_signs[i] != b.rotation_signs[i]) return false;
  }
  return a.translation_unit == b.translation_unit && a.rotation_unit == b.rotation_unit &&
         a.rotation_sequence == b.rotation_sequence && a.face_winding == b.face_winding;
}

/// True if the column turns a joint represented by a quaternion.
bool column_turns(const DnaView& view, const JointGroup& group, uint32_t column) {
  const uint32_t columns = group.input_indices.count;
  for (uint32_t r = 0; r < group.output_indices.count; ++r) {
    if (!is_quaternion_row(view, group.output_indices[r])) continue;
    if (group.values[size_t{r} * columns + column] != 0) return true;
  }
  return false;
}

class CoordinateConverter {
 public:
  CoordinateConverter(DnaView& view, const CoordinateSystem& from, const CoordinateSystem& to,
                      Arena& arena, Error& error)
      : view_(view), from_(from), to_(resolve_system(from, to)),
        change_(coordinate_change(from, to_)), arrays_(view, arena), arena_(arena), error_(error) {}

  Status run() {
    if (same_system(from_, to_)) return Status::kOk;
    using Step = Status (CoordinateConverter::*)();
    constexpr Step kSteps[] = {
        &CoordinateConverter::find_controls,  &CoordinateConverter::convert_definition,
        &CoordinateConverter::convert_tables, &CoordinateConverter::convert_joint_groups,
        &CoordinateConverter::convert_rbf,    &CoordinateConverter::convert_twists_and_swings,
        &CoordinateConverter::convert_ml,     &CoordinateConverter::convert_geometry,
    };
    for (const Step step : kSteps) {
      if (const Status status = (this->*step)(); status != Status::kOk) return status;
      if (arrays_.out_of_memory()) {
        return fail(error_, Status::kMemory, kNoOffset,
                    "no memory to convert to another coordinate system");
      }
    }
    describe();
    return Status::kOk;
  }

 private:
  // Controls ----------------------------------------------------------------------------------

  Status find_controls() {
    return controls_.find(view_, change_, ml_joints_change(), arena_, error_);
  }

  /// The winding does not affect controls.
  bool ml_joints_change() const {
    CoordinateSystem wound = from_;
    wound.face_winding = to_.face_winding;
    return !same_system(wound, to_) && view_.mlbe.joints.output_indices.count != 0;
  }

  /// A field without room for a sign refers to a control.
  Status refuse(const Array<uint16_t>& where, uint32_t index, const char* field) {
    return fail(error_, Status::kDnaValue, view_.offset_of(where.data + 2 * size_t{index}),
                "%s[%u]: control %u is a component of a rotation, and this use of it cannot be "
                "converted; request a coordinate system with the axes and units of the file",
                field, index, unsigned{where[index]});
  }

  /// Renames controls where they may not change their sign.
  Status rename(Array<uint16_t>& controls, const char* field) {
    bool same = true;
    for (uint32_t i = 0; i < controls.count; ++i) {
      const Reading reading = controls_.read(controls[i]);
      if (reading.sign != 1) return refuse(controls, i, field);
      same &= reading.same(controls[i]);
    }
    if (!same) controls = arrays_.map(controls, [this](uint16_t c) { return read(c); });
    return Status::kOk;
  }

  uint16_t read(uint16_t control) const { return controls_.read(control).control; }

  // Definition --------------------------------------------------------------------------------

  Status convert_definition() {
    Definition& defn = view_.defn;
    defn.neutral_translations = arrays_.vectors(defn.neutral_translations, change_);
    defn.neutral_rotations =
        convert_neutral_rotations(defn.neutral_rotations, from_, to_, change_, arrays_);
    return Status::kOk;
  }

  // Tables ------------------------------------------------------------------------------------

  Status convert_tables() {
    Controls& controls = view_.bhvr.controls;
    if (Status s = rename(controls.conditionals.output_indices,
                          "bhvr.controls.conditionals.outputIndices");
        s != Status::kOk) {
      return s;
    }
    if (Status s = rename(controls.psds.columns, "bhvr.controls.psds.columns"); s != Status::kOk) {
      return s;
    }
    if (Status s =
            rename(view_.bhvr.channels.input_indices, "bhvr.blendShapeChannels.inputIndices");
        s != Status::kOk) {
      return s;
    }
    return convert_maps();
  }

  // Of a control that changes its sign, intervals are mirrored.
  Status convert_maps() {
    ConditionalTable& table = view_.bhvr.maps.conditionals;
    const Array<uint16_t> inputs = table.input_indices;
    bool negated = false;
    for (uint32_t r = 0; r < inputs.count; ++r) {
      const Reading reading = controls_.read(inputs[r]);
      if (reading.sign == 0)
        return refuse(inputs, r, "bhvr.animatedMaps.conditionals.inputIndices");
      negated |= reading.sign < 0;
    }
    if (!negated) return rename(table.input_indices, "bhvr.animatedMaps.conditionals.inputIndices");
    const auto sign = [&](uint32_t r) { return controls_.read(inputs[r]).sign; };
    const Array<float> from = table.from_values, to = table.to_values;
    table.from_values =
        arrays_.remake(from, [&](uint32_t r) { return sign(r) < 0 ? -to[r] : from[r]; });
    table.to_values =
        arrays_.remake(to, [&](uint32_t r) { return sign(r) < 0 ? -from[r] : to[r]; });
    const Array<float> slopes = table.slope_values;
    table.slope_values =
        arrays_.remake(slopes, [&](uint32_t r) { return sign(r) < 0 ? -slopes[r] : slopes[r]; });
    table.input_indices = arrays_.map(inputs, [this](uint16_t c) { return read(c); });
    return Status::kOk;
  }

  // Joint groups ------------------------------------------------------------------------------

  /// The new attribute that a row writes, and its factor.
  uint32_t new_output(uint32_t output) const {
    const uint32_t attribute = output % 9;
    return output - attribute % 3 + change_.to[attribute % 3];
  }
  double row_factor(uint32_t output) const {
    const uint32_t attribute = output % 9, now = change_.to[attribute % 3];
    return attribute < 3 ? change_.vector[now] : attribute < 6 ? change_.angle[now] : 1.0;
  }

  Status convert_joint_groups() {
    if (!change_.carries_angles) {
      if (Status s = convert_rotation_rows(view_, from_, to_, change_, arrays_, arena_, error_);
          s != Status::kOk) {
        return s;
      }
      if (arrays_.out_of_memory()) return Status::kOk;  // run() tells
    }
    for (uint32_t g = 0; g < view_.bhvr.joints.groups.count; ++g) {
      if (Status s = convert_joint_group(view_.bhvr.joints.groups[g], g); s != Status::kOk)
        return s;
    }
    return Status::kOk;
  }

  Status convert_joint_group(JointGroup& group, uint32_t number) {
    const uint32_t columns = group.input_indices.count, rows = group.output_indices.count;
    // Rotation rows have been converted already if their order changes.
    const auto factor_of = [&](uint32_t output) {
      return is_rotation(output) && !change_.carries_angles ? 1.0 : row_factor(output);
    };
    bool same_values = true, moves = false, negates = false;
    for (uint32_t r = 0; r < rows; ++r) same_values &= factor_of(group.output_indices[r]) == 1;
    for (uint32_t c = 0; c < columns; ++c) {
      const Reading reading = controls_.read(group.input_indices[c]);
      moves |= !reading.same(group.input_indices[c]);
      negates |= reading.sign < 0;
      const bool lost = reading.sign == 0 || (reading.sign < 0 && column_turns(view_, group, c));
      if (!lost) continue;
      char field[80];
      snprintf(field, sizeof(field), "bhvr.joints.jointGroups[%u].inputIndices", number);
      return refuse(group.input_indices, c, field);
    }
    if (!same_values || negates) {
      Span<float> signs = arena_.array<float>(columns);
      if (columns && !signs.data) return arrays_.run_out();
      for (uint32_t c = 0; c < columns; ++c) signs[c] = controls_.read(group.input_indices[c]).sign;
      const NewArray<float> values = arrays_.room<float>(group.values.count);
      for (uint32_t r = 0, i = 0; values.data && r < rows; ++r) {
        const double factor = factor_of(group.output_indices[r]);
        for (uint32_t c = 0; c < columns; ++c, ++i) {
          values.set(i, scaled(group.values[i] * signs[c], factor));
        }
      }
      arrays_.keep_offset<float>(values, group.values);
      group.values = values;
    }
    if (moves)
      group.input_indices =
          arrays_.map(group.input_indices, [this](uint16_t c) { return read(c); });
    if (change_.moves_axes) {
      group.output_indices = arrays_.map(group.output_indices, [this](uint16_t output) {
        if (is_rotation(output) && !change_.carries_angles) return output;
        return static_cast<uint16_t>(new_output(output));
      });
    }
    return Status::kOk;
  }

  // RBF ---------------------------------------------------------------------------------------

  Status convert_rbf() {
    for (uint32_t s = 0; s < view_.rbfb.solvers.count; ++s) {
      RbfSolver& solver = view_.rbfb.solvers[s];
      solver.radius = scaled(solver.radius, change_.angle_unit);
      const Status status =
          solver.distance_method == 0 ? convert_numbers(solver, s) : convert_rotations(solver, s);
      if (status != Status::kOk) return status;
    }
    for (uint32_t p = 0; p < view_.rbfe.poses.count; ++p) {
      if (Status s = convert_pose(view_.rbfe.poses[p], p); s != Status::kOk) return s;
    }
    return Status::kOk;
  }

  /// Euclidean distances: each input on its own.
  Status convert_numbers(RbfSolver& solver, uint32_t number) {
    const Array<uint16_t> inputs = solver.raw_control_indices;
    bool same = true, negates = false;
    for (uint32_t i = 0; i < inputs.count; ++i) {
      const Reading reading = controls_.read(inputs[i]);
      if (reading.sign == 0) return refuse_solver(inputs, i, number);
      same &= reading.same(inputs[i]);
      negates |= reading.sign < 0;
    }
    if (same) return Status::kOk;
    if (negates) {
      const Array<float> old = solver.raw_control_values;
      solver.raw_control_values = arrays_.remake(old, [&](uint32_t i) {
        return controls_.read(inputs[i % inputs.count]).sign < 0 ? -old[i] : old[i];
      });
    }
    solver.raw_control_indices = arrays_.map(inputs, [this](uint16_t c) { return read(c); });
    return Status::kOk;
  }

  /// The others read quaternions: those of inputs turn, those that the rig computes stay as they
  /// are.
  Status convert_rotations(RbfSolver& solver, uint32_t number) {
    const Array<uint16_t> inputs = solver.raw_control_indices;
    const uint32_t quaternions = inputs.count / 4;
    uint32_t turned = 0;
    for (uint32_t q = 0; q < quaternions; ++q) {
      const uint16_t four[4] = {inputs[4 * q], inputs[4 * q + 1], inputs[4 * q + 2],
                                inputs[4 * q + 3]};
      if (controls_.is_quaternion(four)) {
        ++turned;
        continue;
      }
      for (uint32_t part = 0; part < 4; ++part) {
        if (!controls_.read(four[part]).same(four[part])) {
          return refuse_solver(inputs, 4 * q + part, number);
        }
      }
    }
    if (turned == 0) return Status::kOk;
    const bool has_axis = solver.distance_method >= 2;
    if (has_axis && turned != quaternions && change_.moves_axes) {
      return refuse_solver(inputs, 0, number);
    }
    if (has_axis) solver.twist_axis = change_.to[solver.twist_axis];
    const Array<float> old = solver.raw_control_values;
    solver.raw_control_values = arrays_.remake(old, [&](uint32_t i) {
      const uint32_t input = i % inputs.count, part = input % 4, first = i - part;
      if (input / 4 >= quaternions || part == 3) return old[i];
      const uint16_t four[4] = {inputs[input - part], inputs[input - part + 1],
                                inputs[input - part + 2], inputs[input - part + 3]};
      if (!controls_.is_quaternion(four)) return old[i];
      return old[first + change_.from[part]] * change_.turn[part];
    });
    return Status::kOk;
  }

  Status refuse_solver(const Array<uint16_t>& inputs, uint32_t index, uint32_t number) {
    char field[80];
    snprintf(field, sizeof(field), "rbfb.solvers[%u].rawControlIndices", number);
    return refuse(inputs, index, field);
  }

  // Inputs are multiplied, outputs added to: signs go into the weights.
  Status convert_pose(RbfPoseControls& pose, uint32_t number) {
    char field[80];
    float sign = 1;
    const Array<uint16_t> inputs = pose.input_control_indices;
    for (uint32_t i = 0; i < inputs.count; ++i) {
      const Reading reading = controls_.read(inputs[i]);
      snprintf(field, sizeof(field), "rbfe.poses[%u].inputControlIndices", number);
      if (reading.sign == 0) return refuse(inputs, i, field);
      sign *= reading.sign;
    }
    snprintf(field, sizeof(field), "rbfe.poses[%u].outputControlIndices", number);
    if (Status s = rename(pose.output_control_indices, field); s != Status::kOk) return s;
    if (sign < 0) {
      pose.output_control_weights =
          arrays_.map(pose.output_control_weights, [](float weight) { return -weight; });
    }
    pose.input_control_indices = arrays_.map_if_new(inputs, [this](uint16_t c) { return read(c); });
    return Status::kOk;
  }

  // Twist and swing ---------------------------------------------------------------------------

  template <class Setup>
  Status convert_setup(Setup& setup, const char* layer_field, uint32_t number) {
    if (!change_.moves_axes) return Status::kOk;
    const Array<uint16_t>& in = setup.input_control_indices;
    const uint16_t four[4] = {in[0], in[1], in[2], in[3]};
    if (!controls_.is_quaternion(four)) {
      char field[80];
      snprintf(field, sizeof(field), "twsw.%s[%u]", layer_field, number);
      return fail(error_, Status::kDnaValue, view_.offset_of(in.data),
                  "%s: reads a rotation that the rig computes itself: it cannot be converted to "
                  "other axes",
                  field);
    }
    setup.twist_axis = change_.to[setup.twist_axis];
    return Status::kOk;
  }

  Status convert_twists_and_swings() {
    TwistSwingBehavior& twsw = view_.twsw;
    for (uint32_t t = 0; t < twsw.twists.count; ++t) {
      if (Status s = convert_setup(twsw.twists[t], "twists", t); s != Status::kOk) return s;
    }
    for (uint32_t s = 0; s < twsw.swings.count; ++s) {
      const Status status = convert_setup(twsw.swings[s], "swings", s);
      if (status != Status::kOk) return status;
    }
    return Status::kOk;
  }

  // Learned behavior -------------------------------------------------------------------------

  Status convert_ml() {
    if (Status s = convert_networks(view_, controls_, arrays_, arena_, error_); s != Status::kOk) {
      return s;
    }
    return ml_joints_change() ? convert_ml_joints() : Status::kOk;
  }

  // ML joints keep their axes and angles and tell which they are (keys 3 to 9); evaluation converts. Keys
  // that would only repeat the rig's own system are removed, so that converting back leaves no trace.
  // Scales that had signs keep them, and those that had none get none.
  Status convert_ml_joints() {
    MlJoints& joints = view_.mlbe.joints;
    const MlJointSystem before = ml_joint_system(joints, from_);
    uint16_t own[kMlSystemKeyCount], rigs[kMlSystemKeyCount];
    describe_system(from_, own);
    describe_system(to_, rigs);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < joints.parameter_keys.count; ++i) {
      const uint16_t key = joints.parameter_keys[i];
      if (!is_system_key(key)) {
        kept += key != kMlScaleKey;
      } else if (before.stated) {
        own[key - kMlFirstSystemKey] = joints.parameter_values[i];
      }
    }
    if (Status s = check_ml_vectors(own); s != Status::kOk) return s;

    const uint32_t most = kept + kMlSystemKeyCount + 1;
    const NewArray<uint16_t> keys = arrays_.room<uint16_t>(most);
    const NewArray<uint16_t> values = arrays_.room<uint16_t>(most);
    if (arrays_.out_of_memory()) return Status::kOk;
    uint32_t count = 0;
    const auto add = [&](uint16_t key, uint16_t value) {
      keys.set(count, key);
      values.set(count++, value);
    };
    for (uint32_t i = 0; i < joints.parameter_keys.count; ++i) {
      const uint16_t key = joints.parameter_keys[i];
      if (!is_system_key(key) && key != kMlScaleKey) add(key, joints.parameter_values[i]);
    }
    if (!std::equal(own, own + kMlSystemKeyCount, rigs)) {
      for (uint16_t i = 0; i < kMlSystemKeyCount; ++i) {
        add(static_cast<uint16_t>(kMlFirstSystemKey + i), own[i]);
      }
    }
    const auto state = [&] {
      joints.parameter_keys = Array<uint16_t>(keys).first(count);
      joints.parameter_values = Array<uint16_t>(values).first(count);
    };
    state();
    if (ml_joint_widths(joints).scale != 0 &&
        ml_joint_system(joints, to_).scale_magnitude != before.scale_magnitude) {
      add(kMlScaleKey, before.scale_magnitude);
      state();
    }
    return Status::kOk;
  }

  static bool is_system_key(uint16_t key) {
    return key >= kMlFirstSystemKey && key <= kMlLastSystemKey;
  }

  static void describe_system(const CoordinateSystem& system, uint16_t out[kMlSystemKeyCount]) {
    for (int i = 0; i < 3; ++i) {
      out[i] = static_cast<uint16_t>(system.axes[i]);
      out[3 + i] = static_cast<uint16_t>(system.rotation_signs[i]);  // -1 becomes 65535
    }
    out[6] = static_cast<uint16_t>(system.rotation_sequence);
  }

  // A vector turns as a whole: where only some of its parts are given and axes change places, there
  // is no control for what comes out.
  Status check_ml_vectors(const uint16_t own[kMlSystemKeyCount]) {
    bool moves = false;
    for (int i = 0; i < 3; ++i) moves |= own[i] / 2 != to_.axes[i] / 2;
    const MlJoints& joints = view_.mlbe.joints;
    const MlJointWidths widths = ml_joint_widths(joints);
    const uint32_t attributes = widths.all();
    if (!moves) return Status::kOk;
    Span<uint8_t> parts = arena_.array<uint8_t>(size_t{view_.defn.joint_names.count} * 2);
    if (view_.defn.joint_names.count && !parts.data) return arrays_.run_out();
    for (uint32_t i = 0; i < joints.output_indices.count; ++i) {
      const uint32_t joint = joints.output_indices[i] / attributes;
      const uint32_t attribute = joints.output_indices[i] % attributes;
      const uint32_t scale = widths.translation + widths.rotation;
      if (attribute < widths.translation) parts[2 * joint] |= 1u << attribute;
      if (attribute >= scale) parts[2 * joint + 1] |= 1u << (attribute - scale);
    }
    for (uint32_t i = 0; i < parts.count; ++i) {
      if (parts[i] == 0 || parts[i] == 7) continue;
      return fail(error_, Status::kDnaValue, view_.offset_of(joints.output_indices.data),
                  "mlbe.mlbJoints: joint %u gets only a part of its %s: it cannot be converted to "
                  "other axes",
                  i / 2, i % 2 ? "scale" : "translation");
    }
    return Status::kOk;
  }

  // Geometry ----------------------------------------------------------------------------------

  Status convert_geometry() {
    for (Mesh& mesh : view_.geom.meshes) {
      mesh.positions = arrays_.vectors(mesh.positions, change_);
      mesh.normals = arrays_.directions(mesh.normals, change_);
      for (BlendShapeTarget& target : mesh.blend_shape_targets) {
        target.deltas = arrays_.vectors(target.deltas, change_);
      }
      if (change_.reverses_faces) reverse_faces(mesh);
    }
    return Status::kOk;
  }

  // One block for all corners of the mesh.
  void reverse_faces(Mesh& mesh) {
    size_t corners = 0;
    for (const Face& face : mesh.faces) corners += face.layout_indices.count;
    const NewArray<uint32_t> room = arrays_.room<uint32_t>(corners);
    if (!room.data) return;
    uint32_t at = 0;
    for (Face& face : mesh.faces) {
      const Array<uint32_t> old = face.layout_indices;
      const uint32_t begin = at;
      for (uint32_t i = 0; i < old.count; ++i, ++at) room.set(at, old[i == 0 ? 0 : old.count - i]);
      face.layout_indices = {room.data + 4 * size_t{begin}, old.count};
    }
  }

  // Descriptor --------------------------------------------------------------------------------

  void describe() {
    const uint32_t* axes = to_.axes;
    const int32_t* signs = to_.rotation_signs;
    view_.desc.coordinate_system = {static_cast<uint16_t>(axes[0]), static_cast<uint16_t>(axes[1]),
                                    static_cast<uint16_t>(axes[2])};
    view_.desc.translation_unit = static_cast<uint16_t>(to_.translation_unit);
    view_.desc.rotation_unit = static_cast<uint16_t>(to_.rotation_unit);
    view_.dsce = {to_.rotation_sequence,
                  {signs[0], signs[1], signs[2]},
                  static_cast<uint8_t>(to_.face_winding)};
    const bool plain = to_.rotation_sequence == 0 && signs[0] + signs[1] + signs[2] == 3;
    const bool stated = (plain || view_.version >= 7) && to_.face_winding == 0;
    if (!stated && !version_has_face_winding(view_.version)) view_.version = 8;
  }

  DnaView& view_;
  const CoordinateSystem& from_;
  const CoordinateSystem to_;
  const CoordinateChange change_;
  ConvertedArrays arrays_;
  Arena& arena_;
  Error& error_;
  RotationControls controls_;
};

}  // namespace

CoordinateSystem system_of(const DnaView& view) {
  CoordinateSystem system;
  system.axes[0] = view.desc.coordinate_system.x_axis;
  system.axes[1] = view.desc.coordinate_system.y_axis;
  system.axes[2] = view.desc.coordinate_system.z_axis;
  system.translation_unit = view.desc.translation_unit;
  system.rotation_unit = view.desc.rotation_unit;
  system.rotation_sequence = view.dsce.rotation_sequence;
  system.rotation_signs[0] = view.dsce.rotation_sign.x;
  system.rotation_signs[1] = view.dsce.rotation_sign.y;
  system.rotation_signs[2] = view.dsce.rotation_sign.z;
  system.face_winding = view.dsce.face_winding_order;
  return system;
}

Status convert_coordinates(DnaView& view, const CoordinateSystem& to, Arena& arena, Error& error) {
  const CoordinateSystem from = system_of(view);
  if (!spans_space(from.axes)) {
    return fail(error, Status::kDnaValue, kNoOffset,
                "desc.coordinateSystem: the axes %u, %u, %u do not span space: the rig cannot be "
                "converted to another system",
                from.axes[0], from.axes[1], from.axes[2]);
  }
  return CoordinateConverter(view, from, to, arena, error).run();
}

}  // namespace mien::dna
