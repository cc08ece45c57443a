// SPDX-License-Identifier: MIT
// Descriptor, controls and joints of an authored rig.
#include "author/base/dna_making.h"
#include "author/base/face_controls.h"
#include "author/rig_dna/rig_model.h"

namespace mien::author {

bool join_text(Arena& arena, std::initializer_list<Name> parts, dna::String& out) {
  size_t count = 0;
  for (const Name& part : parts) count += part.count;
  uint8_t* chars = static_cast<uint8_t*>(arena.allocate(count, 1));
  if (!chars) return false;
  out = {chars, static_cast<uint32_t>(count)};
  for (const Name& part : parts) {
    if (part.count > 0) memcpy(chars, part.data, part.count);
    chars += part.count;
  }
  return true;
}

namespace {

/// Directions of the format: 0 left, 1 right, 2 up, 3 down, 4 front, 5 back.
dna::FileCoordinateSystem axes_of(const Frame& frame) {
  uint16_t axes[3] = {};
  for (int i = 0; i < 3; ++i) {
    axes[frame.axis[i]] = static_cast<uint16_t>(2 * i + (frame.sign[i] < 0));
  }
  return {axes[0], axes[1], axes[2]};
}

bool fill_joint_names(const RigModel& rig, Arena& arena, dna::Definition& out) {
  const Span<const Bone> bones = rig.placement.bones;
  dna::NewArray<uint16_t> parents;
  NewVec3s translations, rotations;
  if (!make(arena, bones.count, out.joint_names) || !make(arena, bones.count, parents) ||
      !translations.allocate(arena, bones.count) || !rotations.allocate(arena, bones.count)) {
    return false;
  }
  for (uint32_t j = 0; j < bones.count; ++j) {
    const Bone& bone = bones[j];
    if (!join_text(arena, {bone.name}, out.joint_names[j])) return false;
    parents.set(j, static_cast<uint16_t>(bone.parent));
    const Vec3 from = bone.parent != j ? bones[bone.parent].position : Vec3();
    translations.set(j, rig.mesh.frame.to_file(bone.position - from));
    rotations.set(j, {});
  }
  out.joint_hierarchy = parents;
  out.neutral_translations = translations;
  out.neutral_rotations = rotations;
  const auto in_lod = [&rig](size_t lod, size_t j) {
    return rig.in_lod(static_cast<uint32_t>(j), lod);
  };
  return make_lod_map(arena, rig.lod_count(), bones.count, in_lod, out.lod_joints);
}

/// Rows: attributes of the region's joints that some control changes, those of the coarsest LODs
/// first. Columns: controls that change one of them.
bool fill_group(const RigModel& rig, uint32_t region, Arena& arena, Span<uint16_t> row_buffer,
                Span<uint16_t> column_buffer, dna::JointGroup& out) {
  const uint32_t bones = static_cast<uint32_t>(rig.placement.bones.count);
  const uint32_t controls = rig.control_count(), lods = rig.lod_count();
  const auto value = [&rig](uint32_t control, uint32_t row) {
    const JointDelta& d = rig.deltas.at(control, row / 9);
    return row % 9 < 3 ? d.translation[row % 9] : d.rotation[row % 9 - 3];
  };
  dna::NewArray<uint16_t> lod_rows;
  if (!make(arena, lods, lod_rows)) return false;
  uint32_t rows = 0, columns = 0;
  for (uint32_t lod = lods; lod-- > 0;) {
    for (uint32_t j = 0; j < bones; ++j) {
      const bool is_new = rig.in_lod(j, lod) && (lod + 1 == lods || !rig.in_lod(j, lod + 1));
      if (!is_new || rig.regions.region[j] != region) continue;
      for (uint32_t a = 0; a < 6; ++a) {
        bool moves = false;
        for (uint32_t c = 0; c < controls && !moves; ++c) moves = value(c, j * 9 + a) != 0;
        if (moves) row_buffer[rows++] = static_cast<uint16_t>(j * 9 + a);
      }
    }
    lod_rows.set(lod, static_cast<uint16_t>(rows));
  }
  for (uint32_t c = 0; c < controls; ++c) {
    bool moves = false;
    for (uint32_t r = 0; r < rows && !moves; ++r) moves = value(c, row_buffer[r]) != 0;
    if (moves) column_buffer[columns++] = static_cast<uint16_t>(c);
  }
  return make_joint_group(arena, lod_rows, row_buffer.first(rows), column_buffer.first(columns),
                          value, out);
}

bool fill_correctives(const RigModel& rig, Arena& arena, dna::Controls& out) {
  size_t entries = 0, entry = 0;
  for (const Combination& c : rig.combinations) entries += c.members.count;
  dna::NewArray<uint16_t> rows, columns;
  dna::NewArray<float> weights;
  if (!make(arena, entries, rows) || !make(arena, entries, columns) ||
      !make(arena, entries, weights)) {
    return false;
  }
  for (uint32_t i = 0; i < rig.combinations.count; ++i) {
    for (const uint32_t member : rig.combinations[i].members) {
      rows.set(entry, static_cast<uint16_t>(rig.expression_count() + i));
      columns.set(entry, static_cast<uint16_t>(member));
      weights.set(entry++, 1);
    }
  }
  out.psd_count = static_cast<uint16_t>(rig.combinations.count);
  out.psds = {rows, columns, weights};
  return true;
}

}  // namespace

bool fill_descriptor(const RigModel& rig, Arena& arena, dna::DnaView& out) {
  dna::Descriptor& desc = out.desc;
  desc.archetype = 5;  // other
  desc.gender = 2;     // other
  desc.coordinate_system = axes_of(rig.mesh.frame);
  desc.lod_count = static_cast<uint16_t>(rig.lod_count());
  return make(arena, 1, desc.metadata) &&
         copy_text(arena, Text().add("generator"), desc.metadata[0].key) &&
         copy_text(arena, Text().add("mien author"), desc.metadata[0].value) &&
         join_text(arena, {rig.name}, desc.name) &&
         copy_text(arena, Text().add("mien_author"), desc.complexity) &&
         copy_text(arena, Text().add("mien_author"), desc.db_name);
}

namespace {

bool same_text(dna::String a, const Text& b) {
  return a.count == b.count && memcmp(a.chars(), b.chars, b.count) == 0;
}

struct DrivingGui {
  uint32_t gui = 0, ramp_count = 1;
  Ramp ramps[2] = {{0, 1, 1, 0}};
};

/// The GUI control of an expression: that of MetaHuman heads, which may drive several expressions, or one of its own.
/// `guis` begins with the `gui_count` names so far.
bool find_driving_gui(Name expression, Arena& arena, Span<dna::String> guis, uint32_t& gui_count,
                      DrivingGui& out) {
  static constexpr char kPrefix[] = "CTRL_";
  const ControlFamily* family = nullptr;
  FamilyControl control;
  out.gui = gui_count;
  if (!find_face_control(expression, family, control)) {
    return join_text(arena, {{kPrefix, 5}, expression}, guis[gui_count++]);
  }
  out.ramp_count = find_ramps(control, out.ramps);
  Text name;
  write_gui_name(*family, control, name);
  for (out.gui = 0; out.gui < gui_count; ++out.gui) {
    if (same_text(guis[out.gui], name)) return true;
  }
  return copy_text(arena, name, guis[gui_count++]);
}

}  // namespace

bool fill_controls(const RigModel& rig, Arena& arena, Arena& scratch, dna::DnaView& out) {
  const size_t count = rig.mesh.shapes.count;
  dna::NewArray<uint16_t> inputs, outputs, map_lods;
  dna::NewArray<float> from, to, slope, cut;
  Span<dna::String> guis;
  Span<DrivingGui> driving;
  uint32_t gui_count = 0, rows = 0;
  if (!make(arena, count, out.defn.raw_control_names) || !make(arena, count, guis) ||
      !make(scratch, count, driving)) {
    return false;
  }
  for (uint32_t i = 0; i < count; ++i) {
    const Name name = rig.mesh.shapes[i].name;
    driving[i] = DrivingGui();
    if (!join_text(arena, {name}, out.defn.raw_control_names[i]) ||
        !find_driving_gui(name, arena, guis, gui_count, driving[i])) {
      return false;
    }
    rows += driving[i].ramp_count;
  }
  out.defn.gui_control_names = {guis.data, gui_count};
  if (!make(arena, rows, inputs) || !make(arena, rows, outputs) || !make(arena, rows, from) ||
      !make(arena, rows, to) || !make(arena, rows, slope) || !make(arena, rows, cut) ||
      !make(arena, rig.lod_count(), map_lods)) {
    return false;
  }
  rows = 0;
  for (uint32_t i = 0; i < count; ++i) {
    for (uint32_t r = 0; r < driving[i].ramp_count; ++r, ++rows) {
      const Ramp& ramp = driving[i].ramps[r];
      inputs.set(rows, static_cast<uint16_t>(driving[i].gui));
      outputs.set(rows, static_cast<uint16_t>(i));
      from.set(rows, ramp.from);
      to.set(rows, ramp.to);
      slope.set(rows, ramp.slope);
      cut.set(rows, ramp.cut);
    }
  }
  out.bhvr.controls.conditionals = {inputs, outputs, from, to, slope, cut};
  if (!fill_correctives(rig, arena, out.bhvr.controls)) return false;
  for (uint32_t lod = 0; lod < rig.lod_count(); ++lod) map_lods.set(lod, 0);
  out.bhvr.maps.lods = map_lods;
  return make_lod_map(
      arena, rig.lod_count(), 0, [](size_t, size_t) { return false; }, out.defn.lod_maps);
}

bool fill_joints(const RigModel& rig, Arena& arena, Arena& scratch, dna::DnaView& out) {
  Span<uint16_t> rows, columns;
  const size_t bones = rig.placement.bones.count;
  dna::Joints& joints = out.bhvr.joints;
  if (!fill_joint_names(rig, arena, out.defn) || !make(scratch, bones * 6, rows) ||
      !make(scratch, rig.control_count(), columns) ||
      !make(arena, rig.regions.count, joints.groups)) {
    return false;
  }
  joints.row_count = static_cast<uint16_t>(9 * bones);
  joints.col_count = static_cast<uint16_t>(rig.control_count());
  for (uint32_t g = 0; g < rig.regions.count; ++g) {
    if (!fill_group(rig, g, arena, rows, columns, joints.groups[g])) return false;
  }
  return true;
}

}  // namespace mien::author
