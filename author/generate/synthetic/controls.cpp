// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "author/base/face_controls.h"
#include "author/generate/synthetic/head.h"

namespace mien::synthetic {
namespace {

using author::ControlFamily;
using author::FamilyControl;
using author::FamilyWalk;
using author::kControlFamilies;
using author::kNotMetaHuman;

bool has_family(const Sizes& sizes, const ControlFamily& family) {
  if (family.since == kNotMetaHuman) return sizes.detail == 3 && !sizes.meta_human;
  return family.since <= sizes.detail;
}

// Reach -----------------------------------------------------------------------------------------

/// Chooses where a raw control is and which regions it moves: its own and the nearest ones.
void place_control(const Regions& regions, const ControlFamily& family, int side, Random& random,
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

struct RawMaker {
  const Regions& regions;
  Random random;
  Arena& arena;
  Head& head;
  uint32_t raw_count = 0;
  uint16_t gui_count = 0;

  bool add(const ControlFamily& family, const FamilyControl& made) {
    Text name;
    if (made.part == 0) {
      write_gui_name(family, made, name);
      if (!copy_text(arena, name, head.gui_names[gui_count++])) return false;
    }
    Control& control = head.controls[raw_count++];
    control.gui = static_cast<uint16_t>(gui_count - 1);
    control.ramp_count = static_cast<uint16_t>(find_ramps(made, control.ramps));
    place_control(regions, family, made.side, random, control);
    name.count = 0;
    write_raw_name(family, made, name);
    return copy_text(arena, name, control.name);
  }
};

/// Switches of the face board: GUI controls that drive no raw control.
constexpr const char* kSwitches[] = {"CTRL_convergenceSwitch.ty", "CTRL_eyesAimFollowHead.ty",
                                     "CTRL_faceGUIfollowHead.ty", "CTRL_lookAtSwitch.ty",
                                     "CTRL_rigLogicSwitch.ty"};

bool make_raw_controls(uint64_t seed, Arena& arena, Head& head) {
  Regions regions;
  RawMaker maker = {regions, Random::from_seed(seed, kControlStream), arena, head};
  for (const ControlFamily& family : kControlFamilies) {
    if (!has_family(*head.sizes, family)) continue;
    FamilyWalk walk(family);
    for (FamilyControl control; walk.next(control);) {
      if (!maker.add(family, control)) return false;
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
  constexpr ControlFamily kFamily = {3, true, kNeck, "head", "", ""};
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
