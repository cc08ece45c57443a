// SPDX-License-Identifier: MIT
#include "runtime/load/dna/convert/rotation_controls.h"

#include <cstring>

namespace mien::dna {
namespace {

/// Length of `name` without an ending ".x" or ".qx" with this letter; 0 if it has none.
uint32_t stem_of(const String& name, char letter, bool with_q) {
  const uint32_t ending = with_q ? 3 : 2;
  if (name.count <= ending) return 0;
  const char* end = name.chars() + name.count - ending;
  if (end[0] != '.' || end[ending - 1] != letter || (with_q && end[1] != 'q')) return 0;
  return name.count - ending;
}

/// Names of the parts of one quaternion: S.qx S.qy S.qz S.qw, or without the q.
bool named_as_quaternion(const List<String>& names, const uint16_t controls[4], bool with_q) {
  const String& first = names[controls[0]];
  const uint32_t stem = stem_of(first, 'x', with_q);
  for (int part = 1; part < 4 && stem != 0; ++part) {
    const String& name = names[controls[part]];
    if (stem_of(name, "xyzw"[part], with_q) != stem) return false;
    if (memcmp(name.data, first.data, stem) != 0) return false;
  }
  return stem != 0;
}

constexpr uint16_t kQuaternionDistances = 1;  // this method and those after it read quaternions

}  // namespace

const RotationControls::Role* RotationControls::role_of(uint32_t control) const {
  if (control < raw_.count) return &raw_[control];
  if (control < first_ml_ || control - first_ml_ >= ml_.count) return nullptr;
  return &ml_[control - first_ml_];
}

Reading RotationControls::read(uint32_t control) const {
  const Role* role = role_of(control);
  if (role && (role->part != 0 || role->moves_joint)) return role->reading;
  return {static_cast<uint16_t>(control), 1};
}

bool RotationControls::moves_ml_joint(uint32_t control) const {
  const Role* role = role_of(control);
  return role && role->moves_joint;
}

bool RotationControls::is_quaternion(const uint16_t controls[4]) const {
  for (uint8_t part = 0; part < 4; ++part) {
    const Role* role = role_of(controls[part]);
    if (!role || role->part != part + 1 || role->first != controls[0]) return false;
  }
  return true;
}

double RotationControls::unit_of(uint32_t control) const {
  const Role* role = role_of(control);
  return role ? role->unit : 1.0;
}

Status RotationControls::add_quaternion(const DnaView& view, const CoordinateChange& change,
                                        const uint16_t controls[4], Error& error) {
  for (uint8_t part = 0; part < 4; ++part) {
    Role& role = *role_of(controls[part]);
    Reading reading = {controls[part], 1};
    if (part < 3) {
      const uint8_t now = change.to[part];
      reading = {controls[now], static_cast<int8_t>(change.turn[now])};
    }
    if (role.part == 0) {
      role.part = static_cast<uint8_t>(part + 1);
      role.first = controls[0];
      role.reading = reading;
      any_ |= !reading.same(controls[part]);
    }
    if (role.part == part + 1 && role.first == controls[0] &&
        role.reading.control == reading.control) {
      continue;
    }
    const bool raw = controls[part] < raw_.count;
    const String& name = raw ? view.defn.raw_control_names[controls[part]]
                             : view.mlbh.control_names[controls[part] - first_ml_];
    return fail(error, Status::kDnaValue, view.offset_of(name.data),
                "control %u (%.*s) is part of two rotations: its value cannot be converted to "
                "another system",
                unsigned{controls[part]}, static_cast<int>(name.count < 80 ? name.count : 80),
                name.chars());
  }
  return Status::kOk;
}

// Four neighbors of one name, as rig builders write them.
Status RotationControls::add_named(const DnaView& view, const CoordinateChange& change,
                                   Error& error) {
  const List<String>& names = view.defn.raw_control_names;
  for (uint32_t i = 0; i + 4 <= names.count; ++i) {
    const uint16_t four[4] = {static_cast<uint16_t>(i), static_cast<uint16_t>(i + 1),
                              static_cast<uint16_t>(i + 2), static_cast<uint16_t>(i + 3)};
    if (!named_as_quaternion(names, four, true)) continue;
    if (Status s = add_quaternion(view, change, four, error); s != Status::kOk) return s;
  }
  return Status::kOk;
}

Status RotationControls::add_solvers(const DnaView& view, const CoordinateChange& change,
                                     Error& error) {
  for (const RbfSolver& solver : view.rbfb.solvers) {
    const Array<uint16_t>& inputs = solver.raw_control_indices;
    for (uint32_t i = 0; i + 4 <= inputs.count; i += 4) {
      const uint16_t four[4] = {inputs[i], inputs[i + 1], inputs[i + 2], inputs[i + 3]};
      bool raw = true;
      for (uint16_t control : four) raw &= control < raw_.count;
      // Euclidean distances are of plain numbers too; the names tell.
      if (!raw || (solver.distance_method < kQuaternionDistances &&
                   !named_as_quaternion(view.defn.raw_control_names, four, false))) {
        continue;
      }
      if (Status s = add_quaternion(view, change, four, error); s != Status::kOk) return s;
    }
  }
  return Status::kOk;
}

template <class Setups>
Status RotationControls::add_setups(const DnaView& view, const CoordinateChange& change,
                                    const Setups& setups, Error& error) {
  for (const auto& setup : setups) {
    const Array<uint16_t>& in = setup.input_control_indices;
    const uint16_t four[4] = {in[0], in[1], in[2], in[3]};
    bool raw = true;
    for (uint16_t control : four) raw &= control < raw_.count;
    if (!raw) continue;
    if (Status s = add_quaternion(view, change, four, error); s != Status::kOk) return s;
  }
  return Status::kOk;
}

// As evaluation reads them: a rotation begins at the first control listed for the joint.
Status RotationControls::add_ml_joints(const DnaView& view, const CoordinateChange& change,
                                       Arena& arena, Error& error) {
  const MlJoints& joints = view.mlbe.joints;
  const MlJointWidths widths = ml_joint_widths(joints);
  const uint32_t attributes = widths.all(), joint_count = view.defn.joint_names.count;
  ml_ = arena.array<Role>(view.mlbh.control_names.count);
  Span<uint8_t> turned = arena.array<uint8_t>(joint_count);
  if (ml_.count != view.mlbh.control_names.count || turned.count != joint_count) {
    return fail(error, Status::kMemory, kNoOffset, "no memory to convert ML joints");
  }
  any_ = true;
  for (uint32_t i = 0; i < joints.output_indices.count; ++i) {
    const uint32_t joint = joints.output_indices[i] / attributes;
    const uint32_t attribute = joints.output_indices[i] % attributes;
    const bool translates = attribute < widths.translation;
    const bool turns = !translates && attribute < widths.translation + widths.rotation;
    if (turns && turned[joint]) continue;
    if (turns) turned[joint] = 1;
    const uint32_t control = joints.input_indices[i], parts = turns ? widths.rotation : 1;
    const double unit = translates            ? change.length_unit
                        : turns && parts == 3 ? change.angle_unit
                                              : 1;
    const bool lost = turns || change.moves_axes || unit != 1;
    for (uint32_t part = 0; part < parts; ++part) {
      Role* role = control + part < first_ml_ ? nullptr : role_of(control + part);
      if (!role || role->moves_joint) {
        return fail(error, Status::kDnaValue, view.offset_of(joints.input_indices.data + 2 * i),
                    "mlbe.mlbJoints.inputIndices[%u]: control %u %s: the joint cannot be converted "
                    "to another system",
                    i, control + part, role ? "moves another joint too" : "is not an ML control");
      }
      role->moves_joint = true;
      role->unit = unit;
      role->reading = {static_cast<uint16_t>(control + part), static_cast<int8_t>(lost ? 0 : 1)};
    }
    if (parts != 4) continue;
    const uint16_t first = static_cast<uint16_t>(control);
    const uint16_t four[4] = {first, static_cast<uint16_t>(first + 1),
                              static_cast<uint16_t>(first + 2), static_cast<uint16_t>(first + 3)};
    if (Status s = add_quaternion(view, change, four, error); s != Status::kOk) return s;
  }
  return Status::kOk;
}

Status RotationControls::find(const DnaView& view, const CoordinateChange& change,
                              bool ml_joints_change, Arena& arena, Error& error) {
  first_ml_ = view.first_ml();
  if (change.moves_axes) {
    raw_ = arena.array<Role>(view.defn.raw_control_names.count);
    if (raw_.count != view.defn.raw_control_names.count) {
      return fail(error, Status::kMemory, kNoOffset, "no memory to convert controls");
    }
    if (Status s = add_named(view, change, error); s != Status::kOk) return s;
    if (Status s = add_solvers(view, change, error); s != Status::kOk) return s;
    if (Status s = add_setups(view, change, view.twsw.twists, error); s != Status::kOk) return s;
    if (Status s = add_setups(view, change, view.twsw.swings, error); s != Status::kOk) return s;
  }
  return ml_joints_change ? add_ml_joints(view, change, arena, error) : Status::kOk;
}

}  // namespace mien::dna
