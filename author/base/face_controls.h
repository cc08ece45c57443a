// SPDX-License-Identifier: MIT
// Raw controls of MetaHuman heads, and the GUI controls that drive them. The only such table: generated rigs and
// rigs of meshes use it.
#pragma once

#include "author/base/dna_making.h"

namespace mien::author {

enum RegionKind : uint8_t {
  kForehead,
  kBrow,
  kUpperLid,
  kLowerLid,
  kEye,
  kNose,
  kCheek,
  kUpperLip,
  kLowerLip,
  kMouthCorner,
  kChin,
  kSide,
  kTongue,
  kTeeth,
  kNeck,
  kRegionKindCount
};

/// Raw controls whose names differ in a word or a side: prefix + name + side. How one GUI control drives
/// several of them:
///     A/B    A by its positive half, B by its negative one
///     A+B    A all the way, B from three quarters on
///     A>B>C  one after the other
struct ControlFamily {
  uint8_t
      since;  // smallest detail of generated rigs that has it; kNotMetaHuman: only in the large preset
  bool wide;  // moves much of the face
  RegionKind home;
  const char* prefix;
  const char* names;
  const char* sides;
};

constexpr uint8_t kNotMetaHuman = 4;

constexpr ControlFamily kControlFamilies[] = {
    {1, true, kBrow, "brow", "RaiseIn/Down Lateral RaiseOuter", "L R"},
    {3, false, kSide, "ear", "Up", "L R"},
    {0, false, kUpperLid, "eye", "Blink/Widen", "L R"},
    {2, false, kUpperLid, "eye", "LidPress UpperLidUp/Relax", "L R"},
    {2, false, kLowerLid, "eye", "SquintInner CheekRaise LowerLidUp/LowerLidDown", "L R"},
    {3, false, kCheek, "eye", "FaceScrunch", "L R"},
    {1, false, kEye, "eye", "LookUp/LookDown LookLeft/LookRight", "L R"},
    {3, false, kEye, "eye", "PupilWide/PupilNarrow", "L R"},
    {3, false, kNose, "eye", "ParallelLookDirection", ""},
    {3, false, kUpperLid, "eyelashes", "UpIN/DownIN UpOUT/DownOUT", "L R"},
    {1, false, kNose, "nose", "Wrinkle", "L R"},
    {2, false, kNose, "nose", "NostrilDilate/NostrilCompress", "L R"},
    {3, false, kNose, "nose", "WrinkleUpper NostrilDepress NasolabialDeepen", "L R"},
    {0, true, kMouthCorner, "mouth", "CornerPull/CornerDepress", "L R"},
    {1, true, kMouthCorner, "mouth", "Stretch Dimple", "L R"},
    {3, false, kMouthCorner, "mouth", "StretchLipsClose SharpCornerPull", "L R"},
    {3, false, kMouthCorner, "mouth", "CornerUp/CornerDown CornerWide/CornerNarrow LipsPress",
     "L R"},
    {2, false, kCheek, "mouth", "CheekBlow/CheekSuck", "L R"},
    {3, false, kCheek, "mouth", "LipsBlow", "L R"},
    {2, false, kUpperLip, "mouth", "UpperLipRaise UpperLipRollIn/UpperLipRollOut", "L R"},
    {2, false, kLowerLip, "mouth", "LowerLipDepress LowerLipRollIn/LowerLipRollOut", "L R"},
    {3, false, kUpperLip, "mouth", "UpperLipBite UpperLipTowardsTeeth", "L R"},
    {3, false, kLowerLip, "mouth", "LowerLipBite LowerLipTowardsTeeth", "L R"},
    {1, true, kUpperLip, "mouth", "Funnel", "UL UR"},
    {1, true, kLowerLip, "mouth", "Funnel", "DL DR"},
    {2, false, kUpperLip, "mouth", "Press LipsPurse LipsTogether", "UL UR"},
    {2, false, kLowerLip, "mouth", "Press LipsPurse LipsTogether", "DL DR"},
    {3, false, kUpperLip, "mouth", "LipsTowards LipsTighten LipsPush/LipsPull", "UL UR"},
    {3, false, kLowerLip, "mouth", "LipsTowards LipsTighten LipsPush/LipsPull", "DL DR"},
    {3, false, kUpperLip, "mouth", "LipsThick/LipsThin LipsThickInward/LipsThinInward", "UL UR"},
    {3, false, kLowerLip, "mouth", "LipsThick/LipsThin LipsThickInward/LipsThinInward", "DL DR"},
    {3, false, kUpperLip, "mouth", "CornerSharpen/CornerRounder", "UL UR"},
    {3, false, kLowerLip, "mouth", "CornerSharpen/CornerRounder", "DL DR"},
    {0, true, kUpperLip, "mouth", "Left/Right", ""},
    {2, true, kUpperLip, "mouth", "Up/Down", ""},
    {3, true, kUpperLip, "mouth", "UpperLipShiftLeft/UpperLipShiftRight", ""},
    {3, true, kLowerLip, "mouth", "LowerLipShiftLeft/LowerLipShiftRight", ""},
    {3, false, kUpperLip, "mouth", "StickyU", "C INL INR OUTL OUTR"},
    {3, false, kLowerLip, "mouth", "StickyD", "C INL INR OUTL OUTR"},
    {3, false, kUpperLip, "mouth", "LipsStickyLPh1>LipsStickyLPh2>LipsStickyLPh3", ""},
    {3, false, kUpperLip, "mouth", "LipsStickyRPh1>LipsStickyRPh2>LipsStickyRPh3", ""},
    {2, false, kTongue, "tongue", "Up/Down Left/Right Out/In", ""},
    {3, false, kTongue, "tongue", "TipUp/TipDown TipLeft/TipRight Wide/Narrow BendUp/BendDown", ""},
    {3, false, kTongue, "tongue", "Thick/Thin TwistLeft/TwistRight Press Roll", ""},
    {0, true, kChin, "jaw", "Open+OpenExtreme", ""},
    {1, true, kChin, "jaw", "Fwd/Back", ""},
    {2, true, kChin, "jaw", "Left/Right", ""},
    {3, true, kSide, "jaw", "Clench", "L R"},
    {3, false, kChin, "jaw", "ChinRaiseD ChinRaiseU ChinCompress", "L R"},
    {3, false, kTeeth, "teeth", "Up/Down Left/Right Fwd/Back", "U D"},
    {2, false, kNeck, "neck", "Stretch/MastoidContract", "L R"},
    {3, false, kNeck, "neck", "SwallowPh1>SwallowPh2>SwallowPh3>SwallowPh4", ""},
    {3, false, kNeck, "neck", "ThroatUp/ThroatDown DigastricUp/DigastricDown", ""},
    {3, false, kNeck, "neck", "ThroatExhale/ThroatInhale", ""},
    {kNotMetaHuman, false, kNeck, "neck", "Tense", ""},
    {kNotMetaHuman, true, kNeck, "head", "TurnUp/TurnDown TurnLeft/TurnRight", "U M"},
};

/// A raw control of a family.
struct FamilyControl {
  Span<const char> names;   // of the raw controls of its GUI control
  Span<const char> name;    // its own
  Span<const char> suffix;  // "UL"
  uint32_t part = 0, parts = 1;
  char joiner = 0;
  int side = 0;  // 1 left, -1 right
};

/// The raw controls of a family: for each name and side, those of one GUI control after the other.
class FamilyWalk {
 public:
  explicit FamilyWalk(const ControlFamily& family)
      : family_(family), names_(family.names), sides_(family.sides) {}

  bool next(FamilyControl& out);

 private:
  const ControlFamily& family_;
  const char *names_, *sides_;
  uint32_t at_ = 0, part_ = 0;  // in the names of the GUI control
};

/// "mouthPressUL", after what `out` has.
void write_raw_name(const ControlFamily& family, const FamilyControl& control, Text& out);
/// "CTRL_L_mouth_pressU.ty", after what `out` has.
void write_gui_name(const ControlFamily& family, const FamilyControl& control, Text& out);

/// A raw control is slope * GUI control + cut where that is in the range.
struct Ramp {
  float from = 0, to = 0, slope = 0, cut = 0;
};

/// Returns how many there are: 1 or 2.
uint32_t find_ramps(const FamilyControl& control, Ramp (&out)[2]);

/// A raw control by its name in a rig: "CTRL_expressions.mouthPressUL", case as written. False for other names.
bool find_face_control(Span<const char> name, const ControlFamily*& family, FamilyControl& out);

}  // namespace mien::author
