// SPDX-License-Identifier: MIT
#include <cstring>
#include <initializer_list>

#include "runtime/author/procedural_head_dna.h"

namespace mien::head {

using author::copy_text;
using author::make;
using author::make_lod_map;
using author::Text;

namespace {

/// A GUI control drives one expression by its positive half and maybe another by its negative one.
struct GuiControl {
  const char* name;
  const char* positive;
  const char* negative;
};

constexpr GuiControl kGui[] = {
    {"CTRL_L_eye_blink.ty", "eyeBlinkLeft", "eyeWideLeft"},
    {"CTRL_R_eye_blink.ty", "eyeBlinkRight", "eyeWideRight"},
    {"CTRL_L_eye.ty", "eyeLookUpLeft", "eyeLookDownLeft"},
    {"CTRL_R_eye.ty", "eyeLookUpRight", "eyeLookDownRight"},
    {"CTRL_L_eye.tx", "eyeLookOutLeft", "eyeLookInLeft"},
    {"CTRL_R_eye.tx", "eyeLookInRight", "eyeLookOutRight"},
    {"CTRL_L_eye_squint.ty", "eyeSquintLeft", nullptr},
    {"CTRL_R_eye_squint.ty", "eyeSquintRight", nullptr},
    {"CTRL_L_eye_cheekRaise.ty", "cheekSquintLeft", nullptr},
    {"CTRL_R_eye_cheekRaise.ty", "cheekSquintRight", nullptr},
    {"CTRL_L_brow_down.ty", "browDownLeft", nullptr},
    {"CTRL_R_brow_down.ty", "browDownRight", nullptr},
    {"CTRL_C_brow_raiseInner.ty", "browInnerUp", nullptr},
    {"CTRL_L_brow_raiseOuter.ty", "browOuterUpLeft", nullptr},
    {"CTRL_R_brow_raiseOuter.ty", "browOuterUpRight", nullptr},
    {"CTRL_L_nose.ty", "noseSneerLeft", nullptr},
    {"CTRL_R_nose.ty", "noseSneerRight", nullptr},
    {"CTRL_C_cheek_puff.ty", "cheekPuff", nullptr},
    {"CTRL_C_jaw.ty", "jawOpen", nullptr},
    {"CTRL_C_jaw.tx", "jawLeft", "jawRight"},
    {"CTRL_C_jaw_forward.ty", "jawForward", nullptr},
    {"CTRL_C_mouth.tx", "mouthLeft", "mouthRight"},
    {"CTRL_C_mouth_close.ty", "mouthClose", nullptr},
    {"CTRL_C_mouth_funnel.ty", "mouthFunnel", nullptr},
    {"CTRL_C_mouth_pucker.ty", "mouthPucker", nullptr},
    {"CTRL_L_mouth_corner.ty", "mouthSmileLeft", "mouthFrownLeft"},
    {"CTRL_R_mouth_corner.ty", "mouthSmileRight", "mouthFrownRight"},
    {"CTRL_L_mouth_dimple.ty", "mouthDimpleLeft", nullptr},
    {"CTRL_R_mouth_dimple.ty", "mouthDimpleRight", nullptr},
    {"CTRL_L_mouth_stretch.ty", "mouthStretchLeft", nullptr},
    {"CTRL_R_mouth_stretch.ty", "mouthStretchRight", nullptr},
    {"CTRL_C_mouth_lipRollUpper.ty", "mouthRollUpper", nullptr},
    {"CTRL_C_mouth_lipRollLower.ty", "mouthRollLower", nullptr},
    {"CTRL_C_mouth_shrugUpper.ty", "mouthShrugUpper", nullptr},
    {"CTRL_C_mouth_shrugLower.ty", "mouthShrugLower", nullptr},
    {"CTRL_L_mouth_press.ty", "mouthPressLeft", nullptr},
    {"CTRL_R_mouth_press.ty", "mouthPressRight", nullptr},
    {"CTRL_L_mouth_lowerLipDepress.ty", "mouthLowerDownLeft", nullptr},
    {"CTRL_R_mouth_lowerLipDepress.ty", "mouthLowerDownRight", nullptr},
    {"CTRL_L_mouth_upperLipRaise.ty", "mouthUpperUpLeft", nullptr},
    {"CTRL_R_mouth_upperLipRaise.ty", "mouthUpperUpRight", nullptr},
    {"CTRL_C_tongue.ty", "tongueOut", nullptr},
};
constexpr uint32_t kGuiCount = sizeof(kGui) / sizeof(kGui[0]);

/// A wrinkle map rises with one or two expressions.
struct Wrinkle {
  const char* name;
  const char* first;
  const char* second;
};

constexpr Wrinkle kWrinkles[] = {
    {"wrinkle.forehead_inner", "browInnerUp", nullptr},
    {"wrinkle.forehead_L", "browOuterUpLeft", nullptr},
    {"wrinkle.forehead_R", "browOuterUpRight", nullptr},
    {"wrinkle.frown_L", "browDownLeft", nullptr},
    {"wrinkle.frown_R", "browDownRight", nullptr},
    {"wrinkle.crow_feet_L", "eyeSquintLeft", "cheekSquintLeft"},
    {"wrinkle.crow_feet_R", "eyeSquintRight", "cheekSquintRight"},
    {"wrinkle.nose_L", "noseSneerLeft", nullptr},
    {"wrinkle.nose_R", "noseSneerRight", nullptr},
    {"wrinkle.nasolabial_L", "mouthSmileLeft", "mouthUpperUpLeft"},
    {"wrinkle.nasolabial_R", "mouthSmileRight", "mouthUpperUpRight"},
    {"wrinkle.chin", "mouthShrugLower", nullptr},
    {"wrinkle.lips", "mouthPucker", "mouthFunnel"},
    {"blood.cheeks", "cheekPuff", nullptr},
};
constexpr uint32_t kWrinkleCount = sizeof(kWrinkles) / sizeof(kWrinkles[0]);
constexpr uint32_t kMapLods = 4;

uint16_t expression(const char* name) {
  uint16_t i = 0;
  while (strcmp(kExpressions[i].name, name) != 0) ++i;
  return i;
}

struct NewTable {
  dna::NewArray<uint16_t> inputs, outputs;
  dna::NewArray<float> from, to, slope, cut;
  uint32_t used = 0;

  bool allocate(Arena& arena, size_t rows) {
    return make(arena, rows, inputs) && make(arena, rows, outputs) && make(arena, rows, from) &&
           make(arena, rows, to) && make(arena, rows, slope) && make(arena, rows, cut);
  }
  void add(uint32_t input, uint32_t output, float from_value, float to_value, float slope_value,
           float cut_value) {
    inputs.set(used, static_cast<uint16_t>(input));
    outputs.set(used, static_cast<uint16_t>(output));
    from.set(used, from_value);
    to.set(used, to_value);
    slope.set(used, slope_value);
    cut.set(used++, cut_value);
  }
  dna::ConditionalTable table() const { return {inputs, outputs, from, to, slope, cut}; }
};

bool fill_gui(Arena& arena, dna::DnaView& out) {
  NewTable table;
  if (!make(arena, kExpressionCount, out.defn.raw_control_names) ||
      !make(arena, kGuiCount, out.defn.gui_control_names) ||
      !table.allocate(arena, kExpressionCount)) {
    return false;
  }
  for (uint32_t i = 0; i < kExpressionCount; ++i) {
    if (!copy_text(arena, Text().add(kExpressions[i].name), out.defn.raw_control_names[i])) {
      return false;
    }
  }
  for (uint32_t i = 0; i < kGuiCount; ++i) {
    if (!copy_text(arena, Text().add(kGui[i].name), out.defn.gui_control_names[i])) return false;
    table.add(i, expression(kGui[i].positive), 0, 1, 1, 0);
    if (kGui[i].negative) table.add(i, expression(kGui[i].negative), -1, 0, -1, 0);
  }
  assert(table.used == kExpressionCount);
  out.bhvr.controls.conditionals = table.table();
  return true;
}

bool fill_correctives(const Shapes& shapes, Arena& arena, dna::Controls& out) {
  const uint32_t count = shapes.corrective_count();
  dna::NewArray<uint16_t> rows, columns;
  dna::NewArray<float> weights;
  if (!make(arena, size_t{count} * 2, rows) || !make(arena, size_t{count} * 2, columns) ||
      !make(arena, size_t{count} * 2, weights)) {
    return false;
  }
  for (uint32_t i = 0; i < count; ++i) {
    const uint8_t members[2] = {shapes.corrective(i).first, shapes.corrective(i).second};
    for (uint32_t m = 0; m < 2; ++m) {
      rows.set(2 * i + m, static_cast<uint16_t>(kExpressionCount + i));
      columns.set(2 * i + m, members[m]);
      weights.set(2 * i + m, 1);
    }
  }
  out.psd_count = static_cast<uint16_t>(count);
  out.psds = {rows, columns, weights};
  return true;
}

/// Wrinkles show late: a quarter of the way in the first half, the rest in the second.
bool fill_wrinkles(Arena& arena, dna::DnaView& out) {
  uint32_t rows = 0;
  for (const Wrinkle& w : kWrinkles) rows += w.second ? 4 : 2;
  NewTable table;
  dna::NewArray<uint16_t> lods;
  if (!make(arena, kWrinkleCount, out.defn.map_names) || !table.allocate(arena, rows) ||
      !make(arena, kLodCount, lods)) {
    return false;
  }
  for (uint32_t i = 0; i < kWrinkleCount; ++i) {
    const Wrinkle& w = kWrinkles[i];
    if (!copy_text(arena, Text().add(w.name), out.defn.map_names[i])) return false;
    for (const char* name : {w.first, w.second}) {
      if (!name) continue;
      table.add(expression(name), i, 0, 0.5f, 0.5f, 0);
      table.add(expression(name), i, 0.5f, 1, 1.5f, -0.5f);
    }
  }
  for (uint32_t lod = 0; lod < kLodCount; ++lod) {
    lods.set(lod, static_cast<uint16_t>(lod < kMapLods ? rows : 0));
  }
  out.bhvr.maps = {lods, table.table()};
  const auto in_lod = [](size_t lod, size_t) { return lod < kMapLods; };
  return make_lod_map(arena, kLodCount, kWrinkleCount, in_lod, out.defn.lod_maps);
}

}  // namespace

bool fill_controls(const Head& head, Arena& arena, dna::DnaView& out) {
  return fill_gui(arena, out) && fill_correctives(head.shapes, arena, out.bhvr.controls) &&
         fill_wrinkles(arena, out);
}

// Joints ----------------------------------------------------------------------------------------

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
  uint32_t rows = 0, columns = 0, joints = 0;
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
  for (uint32_t r = 0; r < rows; ++r) {
    joints += r == 0 || row_buffer[r] / 9 != row_buffer[r - 1] / 9;
  }

  dna::NewArray<uint16_t> lods, inputs, outputs, members;
  dna::NewArray<float> values;
  if (!make(arena, kLodCount, lods) || !make(arena, columns, inputs) ||
      !make(arena, rows, outputs) || !make(arena, size_t{rows} * columns, values) ||
      !make(arena, joints, members)) {
    return false;
  }
  for (uint32_t lod = 0; lod < kLodCount; ++lod) {
    lods.set(lod, static_cast<uint16_t>(rows_of_tier[kLodCount - 1 - lod]));
  }
  for (uint32_t c = 0; c < columns; ++c) inputs.set(c, column_buffer[c]);
  uint32_t member = 0;
  for (uint32_t r = 0; r < rows; ++r) {
    outputs.set(r, row_buffer[r]);
    const bool first = r == 0 || row_buffer[r] / 9 != row_buffer[r - 1] / 9;
    if (first) members.set(member++, static_cast<uint16_t>(row_buffer[r] / 9));
    for (uint32_t c = 0; c < columns; ++c) {
      values.set(size_t{r} * columns + c, value(column_buffer[c], row_buffer[r]));
    }
  }
  out = {lods, inputs, outputs, values, members};
  return true;
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
