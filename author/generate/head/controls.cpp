// SPDX-License-Identifier: MIT
#include <cstring>
#include <initializer_list>

#include "author/generate/head/dna.h"

namespace mien::head {

using author::copy_text;
using author::make;
using author::make_lod_map;
using author::Text;

namespace {

/// The positive half of a GUI control drives one expression, the negative half another, if any.
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
    {"CTRL_L_eye_lidPress.ty", "eyeLidPressL", nullptr},
    {"CTRL_R_eye_lidPress.ty", "eyeLidPressR", nullptr},
    {"CTRL_L_nose.tx", "noseNostrilDilateL", nullptr},
    {"CTRL_R_nose.tx", "noseNostrilDilateR", nullptr},
    {"CTRL_L_nose_nasolabialDeepen.ty", "noseNasolabialDeepenL", nullptr},
    {"CTRL_R_nose_nasolabialDeepen.ty", "noseNasolabialDeepenR", nullptr},
    {"CTRL_L_mouth_lipsPress.ty", "mouthLipsPressL", nullptr},
    {"CTRL_R_mouth_lipsPress.ty", "mouthLipsPressR", nullptr},
    {"CTRL_L_mouth_lipsTogetherU.ty", "mouthLipsTogetherUL", nullptr},
    {"CTRL_R_mouth_lipsTogetherU.ty", "mouthLipsTogetherUR", nullptr},
    {"CTRL_L_mouth_lipsTogetherD.ty", "mouthLipsTogetherDL", nullptr},
    {"CTRL_R_mouth_lipsTogetherD.ty", "mouthLipsTogetherDR", nullptr},
    {"CTRL_L_jaw_clench.ty", "jawClenchL", nullptr},
    {"CTRL_R_jaw_clench.ty", "jawClenchR", nullptr},
    {"CTRL_L_neck_stretch.ty", "neckStretchL", nullptr},
    {"CTRL_R_neck_stretch.ty", "neckStretchR", nullptr},
    {"CTRL_L_neck_mastoidContract.ty", "neckMastoidContractL", nullptr},
    {"CTRL_R_neck_mastoidContract.ty", "neckMastoidContractR", nullptr},
    {"CTRL_C_neck_throat.ty", "neckThroatUp", "neckThroatDown"},
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
  constexpr float kRise = 5;  // the tongue has risen when a fifth of it is out
  const uint32_t count = shapes.corrective_count();
  dna::NewArray<uint16_t> rows, columns;
  dna::NewArray<float> weights;
  uint32_t entries = 0;
  for (uint32_t i = 0; i < count; ++i) entries += shapes.is_of_tongue(kExpressionCount + i) ? 1 : 2;
  if (!make(arena, entries, rows) || !make(arena, entries, columns) ||
      !make(arena, entries, weights)) {
    return false;
  }
  uint32_t used = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const auto add = [&](uint8_t member, float weight) {
      rows.set(used, static_cast<uint16_t>(kExpressionCount + i));
      columns.set(used, member);
      weights.set(used++, weight);
    };
    const bool alone = shapes.is_of_tongue(kExpressionCount + i);
    add(shapes.corrective(i).first, alone ? kRise : 1.0f);
    if (!alone) add(shapes.corrective(i).second, 1);
  }
  out.psd_count = static_cast<uint16_t>(count);
  out.psds = {rows, columns, weights};
  return true;
}

/// Wrinkles appear late: a quarter of the way in the first half, the rest in the second.
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

}  // namespace mien::head
