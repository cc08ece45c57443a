// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "author/generate/synthetic/head.h"

namespace mien::synthetic {
namespace {

// Names -----------------------------------------------------------------------------------------

/// Raw controls whose names differ in a word or a side: prefix + name + side. How one GUI control drives
/// several of them:
///     A/B    A by its positive half, B by its negative one
///     A+B    A all the way, B from three quarters on
///     A>B>C  one after the other
struct Family {
  uint8_t since;  // smallest detail that has it; kNotMetaHuman: only in the large preset
  bool wide;      // moves much of the face
  RegionKind home;
  const char* prefix;
  const char* names;
  const char* sides;
};

constexpr uint8_t kNotMetaHuman = 4;

constexpr Family kFamilies[] = {
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

bool has_family(const Sizes& sizes, const Family& family) {
  if (family.since == kNotMetaHuman) return sizes.detail == 3 && !sizes.meta_human;
  return family.since <= sizes.detail;
}

struct Word {
  const char* at;
  uint32_t count;
};

/// The word up to one of `stops` or the end; `rest` then begins there.
Word take(const char*& rest, const char* stops) {
  const char* at = rest;
  rest += strcspn(rest, stops);
  return {at, static_cast<uint32_t>(rest - at)};
}

int side_of(Word suffix) {
  char last = suffix.count ? suffix.at[suffix.count - 1] : 0;
  return last == 'L' ? 1 : last == 'R' ? -1 : 0;
}

/// "CTRL_L_mouth_pressU.ty" for the side "UL".
bool name_gui(const char* prefix, Word name, Word suffix, Arena& arena, dna::String& out) {
  int side = side_of(suffix);
  char first = static_cast<char>(name.at[0] | 0x20);  // to lower case
  Text text;
  text.add(side > 0 ? "CTRL_L_" : side < 0 ? "CTRL_R_" : "CTRL_C_").add(prefix).add("_");
  text.add(&first, 1).add(name.at + 1, name.count - 1);
  text.add(suffix.at, suffix.count - (side != 0)).add(".ty");
  return copy_text(arena, text, out);
}

// Reach -----------------------------------------------------------------------------------------

/// Chooses where a raw control is and which regions it moves: its own and the nearest ones.
void place_control(const Regions& regions, const Family& family, int side, Random& random,
                   Control& control) {
  uint8_t home = regions.find(family.home, side);
  const Region& region = regions.items[home];
  control.home = region.center;
  if (region.side == 0) control.home.x += side * 0.5 * region.spread.x;
  control.home.x += random.between(-0.3, 0.3) * region.spread.x;
  control.home.y += random.between(-0.3, 0.3) * region.spread.y;

  struct Near {
    double squared;
    uint8_t region;
  };
  Near nearest[kRegionCount];
  for (uint8_t r = 0; r < kRegionCount; ++r) {
    Vec3 apart = regions.items[r].center - region.center;
    nearest[r] = {dot(apart, apart), r};
  }
  std::sort(nearest, nearest + kRegionCount, [](const Near& a, const Near& b) {
    return a.squared < b.squared || (a.squared == b.squared && a.region < b.region);
  });

  uint32_t count = 2;
  if (family.wide) {
    count = 6 + random.below(5);
  } else {
    while (count < 8 && random.chance(0.6)) ++count;
  }
  double farthest = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const Region& owned = regions.items[nearest[i].region];
    control.regions |= 1u << nearest[i].region;
    Vec3 apart = owned.center - control.home;
    double size = length(owned.spread);
    farthest = std::max(farthest, length(apart) + size);
  }
  control.reach = farthest;
}

// Raw controls ----------------------------------------------------------------------------------

/// Sets the part of the GUI control's range in which it drives the `part`-th of its `parts` controls.
void set_ramps(char joiner, uint32_t part, uint32_t parts, Control& control) {
  control.ramp_count = 1;
  if (joiner == '/' && part == 1) {
    control.ramps[0] = {-1, 0, -1, 0};
  } else if (joiner == '+' && part == 1) {
    control.ramps[0] = {0.75f, 1, 4, -3};
  } else if (joiner == '>') {
    float n = static_cast<float>(parts), k = static_cast<float>(part);
    control.ramps[0] = {k / n, (k + 1) / n, n, -k};
    if (part + 1 < parts) {
      control.ramps[1] = {(k + 1) / n, (k + 2) / n, -n, k + 2};
      control.ramp_count = 2;
    }
  } else {
    control.ramps[0] = {0, 1, 1, 0};
  }
}

struct RawMaker {
  const Regions& regions;
  Random random;
  Arena& arena;
  Head& head;
  uint32_t raw_count = 0;
  uint16_t gui_count = 0;

  /// A GUI control, and the raw controls that it drives.
  bool add(const Family& family, Word names, Word suffix) {
    uint32_t parts = 1;
    char joiner = 0;
    for (uint32_t i = 0; i < names.count; ++i) {
      if (!strchr("/+>", names.at[i])) continue;
      joiner = names.at[i];
      ++parts;
    }
    const char* rest = names.at;
    for (uint32_t part = 0; part < parts; ++part, ++rest) {
      Word name = take(rest, "/+> ");
      if (part == 0 && !name_gui(family.prefix, name, suffix, arena, head.gui_names[gui_count])) {
        return false;
      }
      Control& control = head.controls[raw_count++];
      control.gui = gui_count;
      set_ramps(joiner, part, parts, control);
      place_control(regions, family, side_of(suffix), random, control);
      Text text;
      text.add(family.prefix).add(name.at, name.count).add(suffix.at, suffix.count);
      if (!copy_text(arena, text, control.name)) return false;
    }
    ++gui_count;
    return true;
  }
};

/// Switches of the face board: GUI controls that drive no raw control.
constexpr const char* kSwitches[] = {"CTRL_convergenceSwitch.ty", "CTRL_eyesAimFollowHead.ty",
                                     "CTRL_faceGUIfollowHead.ty", "CTRL_lookAtSwitch.ty",
                                     "CTRL_rigLogicSwitch.ty"};

bool make_raw_controls(uint64_t seed, Arena& arena, Head& head) {
  Regions regions;
  RawMaker maker = {regions, Random::from_seed(seed, kControlStream), arena, head};
  for (const Family& family : kFamilies) {
    if (!has_family(*head.sizes, family)) continue;
    for (const char* names = family.names;; ++names) {
      Word name = take(names, " ");
      for (const char* sides = family.sides;; ++sides) {
        Word side = take(sides, " ");
        if (!maker.add(family, name, side)) return false;
        if (!*sides) break;
      }
      if (!*names) break;
    }
  }
  if (head.sizes->meta_human) {
    for (const char* name : kSwitches) {
      if (!copy_text(arena, Text().add(name), head.gui_names[maker.gui_count++])) return false;
    }
  }
  assert(maker.raw_count == head.sizes->raw_count && maker.gui_count == head.sizes->gui_count);

  for (uint32_t i = 0; i < head.input_count(); ++i) {
    const char* const parts[] = {".qx", ".qy", ".qz", ".qw"};
    dna::String& name = head.controls[maker.raw_count++].name;
    if (!copy_text(arena, Text().add(kNeckInputs[i / 4]).add(parts[i % 4]), name)) return false;
  }
  return true;
}

// RBF pose controls -----------------------------------------------------------------------------

/// One for each direction of each joint that turns; they move the neck.
bool make_pose_controls(uint64_t seed, Arena& arena, Head& head) {
  const char* const directions[] = {"TurnUp",    "TurnDown", "TurnLeft",
                                    "TurnRight", "TiltLeft", "TiltRight"};
  constexpr Family kFamily = {3, true, kNeck, "head", "", ""};
  Regions regions;
  Random random = Random::from_seed(seed, kPoseControlStream);
  for (uint32_t i = 0; i < head.pose_count(); ++i) {
    Control& control = head.controls[head.raw_count() + head.sizes->psd_count + i];
    place_control(regions, kFamily, 0, random, control);
    Text name = Text()
                    .add("head")
                    .add(directions[i / 3])
                    .add(i % 3 == 0   ? "U"
                         : i % 3 == 1 ? "M"
                                      : "D");
    if (!copy_text(arena, name, control.name)) return false;
  }
  return true;
}

// Correctives -----------------------------------------------------------------------------------

bool same_members(const Control& a, const Control& b) {
  return a.member_count == b.member_count &&
         std::equal(a.members, a.members + a.member_count, b.members);
}

/// Draws members that overlap with the first and are not driven by the same GUI control.
void draw_members(Span<const Control> raw, uint32_t wanted, Random& random, Control& corrective) {
  uint16_t* members = corrective.members;
  members[0] = static_cast<uint16_t>(random.below(static_cast<uint32_t>(raw.count)));
  uint16_t count = 1;
  for (uint32_t tries = 0; count < wanted && tries < 400; ++tries) {
    uint16_t candidate = static_cast<uint16_t>(random.below(static_cast<uint32_t>(raw.count)));
    bool fits = (raw[candidate].regions & raw[members[0]].regions) != 0;
    for (uint16_t m = 0; m < count; ++m) fits = fits && raw[candidate].gui != raw[members[m]].gui;
    if (fits) members[count++] = candidate;
  }
  std::sort(members, members + count);
  corrective.member_count = count;
}

/// A corrective acts where at least two of its members do.
void place_corrective(Span<const Control> raw, Control& corrective) {
  uint32_t once = 0;
  double share = 1.0 / corrective.member_count;
  for (uint16_t m = 0; m < corrective.member_count; ++m) {
    const Control& member = raw[corrective.members[m]];
    corrective.regions |= once & member.regions;
    once |= member.regions;
    corrective.home = corrective.home + member.home * share;
    corrective.reach = std::max(corrective.reach, member.reach);
  }
}

bool make_correctives(uint64_t seed, Arena& arena, Head& head) {
  Random random = Random::from_seed(seed, kCorrectiveStream);
  const uint32_t raw_count = head.raw_count();
  Span<const Control> raw = head.controls.first(head.sizes->raw_count);
  for (size_t c = raw_count; c < raw_count + head.sizes->psd_count; ++c) {
    Control& corrective = head.controls[c];
    bool taken = true;
    while (taken) {
      uint32_t kind = random.below(10);
      draw_members(raw, kind < 6 ? 2 : kind < 9 ? 3 : 4 + random.below(2), random, corrective);
      taken = corrective.member_count < 2;
      for (size_t other = raw_count; other < c && !taken; ++other) {
        taken = same_members(head.controls[other], corrective);
      }
    }
    place_corrective(raw, corrective);
    Text name;
    for (uint16_t m = 0; m < corrective.member_count; ++m) {
      name.add(m ? "_" : "").add(raw[corrective.members[m]].name);
    }
    if (!copy_text(arena, name, corrective.name)) return false;
  }
  return true;
}

}  // namespace

bool make_controls(uint64_t seed, Arena& arena, Head& head) {
  const Sizes& sizes = *head.sizes;
  return make(arena, sizes.gui_count, head.gui_names) &&
         make(arena, size_t{head.raw_count()} + sizes.psd_count + head.pose_count(),
              head.controls) &&
         make_raw_controls(seed, arena, head) && make_correctives(seed, arena, head) &&
         make_pose_controls(seed, arena, head);
}

}  // namespace mien::synthetic
