// SPDX-License-Identifier: MIT
#include "author/base/face_controls.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

namespace mien::author {
namespace {

std::string text_of(const Text& text) { return {text.chars, text.count}; }

struct Found {
  bool known = false;
  std::string gui, raw;
  Ramp ramps[2];
  uint32_t ramp_count = 0;

  explicit Found(const std::string& name) {
    const ControlFamily* family = nullptr;
    FamilyControl control;
    known = find_face_control({name.data(), name.size()}, family, control);
    if (!known) return;
    Text gui_text, raw_text;
    write_gui_name(*family, control, gui_text);
    write_raw_name(*family, control, raw_text);
    gui = text_of(gui_text);
    raw = text_of(raw_text);
    ramp_count = find_ramps(control, ramps);
  }
};

TEST(FaceControls, AreFoundByTheirNamesInRigs) {
  const Found lip("CTRL_expressions.mouthPressUL");
  ASSERT_TRUE(lip.known);
  EXPECT_EQ(lip.raw, "mouthPressUL");
  EXPECT_EQ(lip.gui, "CTRL_L_mouth_pressU.ty");
  EXPECT_EQ(Found("CTRL_expressions.jawOpen").gui, "CTRL_C_jaw_open.ty");
  EXPECT_EQ(Found("CTRL_expressions.eyeLookLeftR").gui, "CTRL_R_eye_lookLeft.ty");
}

TEST(FaceControls, HalvesOfAGuiControlDriveTwoOfThem) {
  const Found pull("CTRL_expressions.mouthCornerPullR"),
      depress("CTRL_expressions.mouthCornerDepressR");
  EXPECT_EQ(pull.gui, "CTRL_R_mouth_cornerPull.ty");
  EXPECT_EQ(depress.gui, pull.gui);
  ASSERT_EQ(pull.ramp_count, 1u);
  ASSERT_EQ(depress.ramp_count, 1u);
  EXPECT_EQ(pull.ramps[0].slope, 1);
  EXPECT_EQ(pull.ramps[0].to, 1);
  EXPECT_EQ(depress.ramps[0].slope, -1);
  EXPECT_EQ(depress.ramps[0].from, -1);
  EXPECT_EQ(Found("CTRL_expressions.mouthLipsStickyLPh1").ramp_count, 2u);
}

TEST(FaceControls, OtherNamesAreNone) {
  for (const char* name : {"", "CTRL_expressions.", "mouthPressUL", "CTRL_expressions.mouthPress",
                           "CTRL_expressions.mouthPressULx", "CTRL_expressions.neckTense",
                           "ctrl_expressions.jawOpen"}) {
    EXPECT_FALSE(Found(name).known) << name;
  }
}

TEST(FaceControls, TheTableHasEachOnceAndAsManyAsTheHeads) {
  std::set<std::string> raws, guis;
  for (const ControlFamily& family : kControlFamilies) {
    if (family.since == kNotMetaHuman) continue;
    FamilyWalk walk(family);
    for (FamilyControl control; walk.next(control);) {
      Text raw, gui;
      write_raw_name(family, control, raw);
      write_gui_name(family, control, gui);
      EXPECT_TRUE(raws.insert(text_of(raw)).second) << text_of(raw);
      guis.insert(text_of(gui));
      EXPECT_TRUE(Found("CTRL_expressions." + text_of(raw)).known) << text_of(raw);
    }
  }
  EXPECT_EQ(raws.size(), 251u);
  EXPECT_EQ(guis.size(), 169u);
}

}  // namespace
}  // namespace mien::author
