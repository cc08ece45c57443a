// SPDX-License-Identifier: MIT
#include "author/generate/synthetic/body.h"

namespace mien::synthetic {
namespace {

struct BaseBone {
  const char* name;
  const char* parent;  // same side, or in the middle
  bool mirrored;
  Vec3 position;  // of the left bone
  int8_t axis;    // along the limb for drivers, else -1
  uint8_t twists, swings;
};

// Parents precede their children.
constexpr BaseBone kBones[] = {
    {"root", "root", false, {0, 0, 0}, -1, 0, 0},
    {"pelvis", "root", false, {0, 96, 0}, -1, 0, 0},
    {"spine_01", "pelvis", false, {0, 103, 1}, 1, 0, 0},
    {"spine_02", "spine_01", false, {0, 111, 2}, 1, 0, 0},
    {"spine_03", "spine_02", false, {0, 120, 1}, 1, 0, 0},
    {"spine_04", "spine_03", false, {0, 130, -1}, 1, 0, 0},
    {"spine_05", "spine_04", false, {0, 140, -2}, 1, 0, 0},
    {"neck_01", "spine_05", false, {0, 150, -1}, 1, 0, 0},
    {"neck_02", "neck_01", false, {0, 156, 0}, 1, 0, 0},
    {"head", "neck_02", false, {0, 162, 1}, 1, 0, 0},
    {"clavicle", "spine_05", true, {3, 146, 0}, 0, 3, 2},
    {"upperarm", "clavicle", true, {17, 144, -2}, 0, 3, 2},
    {"lowerarm", "upperarm", true, {44, 144, -3}, 0, 3, 2},
    {"hand", "lowerarm", true, {69, 144, -2}, 0, 3, 2},
    {"thumb_01", "hand", true, {72, 142, 2}, 2, 3, 2},
    {"thumb_02", "thumb_01", true, {75, 140, 5}, 2, 0, 0},
    {"thumb_03", "thumb_02", true, {77, 139, 7}, -1, 0, 0},
    {"index_metacarpal", "hand", true, {72, 144, 1}, -1, 0, 0},
    {"index_01", "index_metacarpal", true, {78, 144, 2}, 0, 3, 0},
    {"index_02", "index_01", true, {82, 144, 2}, 0, 0, 0},
    {"index_03", "index_02", true, {84, 144, 2}, -1, 0, 0},
    {"middle_metacarpal", "hand", true, {72, 144, -1}, -1, 0, 0},
    {"middle_01", "middle_metacarpal", true, {78, 144, -1}, 0, 3, 0},
    {"middle_02", "middle_01", true, {83, 144, -1}, 0, 0, 0},
    {"middle_03", "middle_02", true, {86, 144, -1}, -1, 0, 0},
    {"ring_metacarpal", "hand", true, {72, 144, -3}, -1, 0, 0},
    {"ring_01", "ring_metacarpal", true, {78, 144, -3}, 0, 0, 0},
    {"ring_02", "ring_01", true, {82, 144, -3}, 0, 0, 0},
    {"ring_03", "ring_02", true, {85, 144, -3}, -1, 0, 0},
    {"pinky_metacarpal", "hand", true, {72, 143, -5}, -1, 0, 0},
    {"pinky_01", "pinky_metacarpal", true, {77, 143, -5}, 0, 0, 0},
    {"pinky_02", "pinky_01", true, {80, 143, -5}, 0, 0, 0},
    {"pinky_03", "pinky_02", true, {82, 143, -5}, -1, 0, 0},
    {"thigh", "pelvis", true, {9, 92, 0}, 1, 3, 2},
    {"calf", "thigh", true, {10, 50, 0}, 1, 3, 2},
    {"foot", "calf", true, {10, 9, -3}, 1, 3, 2},
    {"ball", "foot", true, {10, 3, 9}, 2, 3, 0},
    {"bigtoe_01", "ball", true, {8, 2, 11}, -1, 0, 0},
    {"bigtoe_02", "bigtoe_01", true, {8, 2, 14}, -1, 0, 0},
    {"indextoe_01", "ball", true, {9.5, 2, 12}, -1, 0, 0},
    {"indextoe_02", "indextoe_01", true, {9.5, 2, 14}, -1, 0, 0},
    {"middletoe_01", "ball", true, {10.5, 2, 11}, -1, 0, 0},
    {"middletoe_02", "middletoe_01", true, {10.5, 2, 13}, -1, 0, 0},
    {"ringtoe_01", "ball", true, {11.5, 2, 10}, -1, 0, 0},
    {"ringtoe_02", "ringtoe_01", true, {11.5, 2, 12}, -1, 0, 0},
    {"littletoe_01", "ball", true, {12.5, 2, 9}, -1, 0, 0},
    {"littletoe_02", "littletoe_01", true, {12.5, 2, 11}, -1, 0, 0},
};

constexpr uint8_t kMiddleCorrectives = 2, kSideCorrectives = 4;

const char* suffix_of(const BaseBone& bone, uint32_t side) {
  return !bone.mirrored ? "" : side == 0 ? "_l" : "_r";
}

uint32_t sides_of(const BaseBone& bone) { return bone.mirrored ? 2 : 1; }

struct BodyMaker {
  Arena& arena;
  Body& body;
  uint32_t joint_count = 0, driver_count = 0;

  uint16_t find(const char* name, const char* suffix) const {
    for (int in_the_middle = 0; in_the_middle < 2; ++in_the_middle) {
      const Text text = Text().add(name).add(in_the_middle ? "" : suffix);
      for (uint32_t j = 0; j < joint_count; ++j) {
        const dna::String& other = body.joints[j].name;
        if (other.count == text.count && memcmp(other.data, text.chars, text.count) == 0) {
          return static_cast<uint16_t>(j);
        }
      }
    }
    return 0;  // the root itself
  }

  bool add_base(const BaseBone& bone, uint32_t side) {
    const char* suffix = suffix_of(bone, side);
    BodyJoint& joint = body.joints[joint_count];
    joint.position = bone.position;
    if (side == 1) joint.position.x = -joint.position.x;
    joint.parent = find(bone.parent, suffix);
    if (!copy_text(arena, Text().add(bone.name).add(suffix), joint.name)) return false;
    if (bone.axis >= 0) {
      body.drivers[driver_count++] = {static_cast<uint16_t>(joint_count),
                                      static_cast<uint8_t>(bone.axis), bone.twists, bone.swings,
                                      bone.mirrored ? kSideCorrectives : kMiddleCorrectives};
    }
    ++joint_count;
    return true;
  }

  // Followers lie around their driver, on the way to the next joint of its limb.
  bool add_followers(uint16_t driver, BodyJointKind kind, uint32_t count, const char* what) {
    const BodyJoint& base = body.joints[body.drivers[driver].joint];
    for (uint16_t i = 0; i < count; ++i) {
      BodyJoint& joint = body.joints[joint_count++];
      const double along = (i + 1.0) / (count + 1.0) * (base.position.x < 0 ? -4 : 4);
      joint.position = base.position;
      if (body.drivers[driver].axis == 0) joint.position.x += along;
      if (body.drivers[driver].axis == 1)
        joint.position.y += kind == BodyJointKind::kTwist ? 2 : -2;
      joint.position.z += kind == BodyJointKind::kCorrective ? (i % 2 == 0 ? 2 : -2) : 0;
      joint.parent = body.drivers[driver].joint;
      joint.driver = driver;
      joint.ordinal = i;
      joint.kind = kind;
      Text name = Text().add(base.name).add(what).add(uint64_t{i} + 1);
      if (!copy_text(arena, name, joint.name)) return false;
    }
    return true;
  }
};

}  // namespace

bool Body::joint_in_lod(size_t joint, size_t lod) const {
  const BodyJoint& j = joints[joint];
  switch (j.kind) {
    case BodyJointKind::kBase: return true;
    case BodyJointKind::kTwist: return lod < 3 || j.ordinal == 0;
    case BodyJointKind::kSwing: return lod < 3;
    case BodyJointKind::kCorrective: break;
  }
  return lod == 0 || (lod == 1 && j.ordinal < 2) || (lod == 2 && j.ordinal < 1);
}

bool make_body(Arena& arena, Body& out) {
  uint32_t joints = 0, drivers = 0;
  for (const BaseBone& bone : kBones) {
    const uint32_t sides = sides_of(bone);
    joints += sides;
    if (bone.axis < 0) continue;
    drivers += sides;
    const uint32_t correctives = bone.mirrored ? kSideCorrectives : kMiddleCorrectives;
    joints += sides * (bone.twists + bone.swings + correctives);
  }
  if (!make(arena, joints, out.joints) || !make(arena, drivers, out.drivers)) return false;
  BodyMaker maker{arena, out};
  for (const BaseBone& bone : kBones) {
    for (uint32_t side = 0; side < sides_of(bone); ++side) {
      if (!maker.add_base(bone, side)) return false;
    }
  }
  out.base_count = maker.joint_count;
  for (uint16_t d = 0; d < out.drivers.count; ++d) {
    const BodyDriver& driver = out.drivers[d];
    if (!maker.add_followers(d, BodyJointKind::kTwist, driver.twists, "_twist_") ||
        !maker.add_followers(d, BodyJointKind::kSwing, driver.swings, "_swing_") ||
        !maker.add_followers(d, BodyJointKind::kCorrective, driver.correctives, "_corrective_")) {
      return false;
    }
  }
  assert(maker.joint_count == joints && maker.driver_count == drivers);
  return true;
}

}  // namespace mien::synthetic
