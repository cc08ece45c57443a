// SPDX-License-Identifier: MIT
// Joints of the procedural head, and how they carry vertices.
//
//     root - neck01 - neck02 - head - face - skin joints, lids, eyes, upper teeth
//                                        \ jaw - skin joints of the lower face, lower teeth, tongue
//
// The weights of a vertex on the jaw's side of this tree sum to exactly jaw_weight(), so opening the jaw
// needs no other joint. Lids turn about the centers of the eyeballs; the upper ones have a second joint that
// turns half as far, so that the skin between stays on the ball. Neutral rotations are all zero.
#pragma once

#include "author/generate/head/shapes.h"

namespace mien::head {

constexpr uint32_t kMaxJoints = 160;
constexpr uint32_t kMaxInfluences = 8;

/// Joints that are driven by design; others follow a fit.
enum class Drive : uint8_t { kNone, kJaw, kUpperLid, kHalfLid, kLowerLid, kGaze, kTongue, kFit };

struct Joint {
  const char* name = nullptr;  // without the side
  Vec3 position;
  uint16_t parent = 0;
  uint16_t twin = 0;   // its mirror image, or itself
  int8_t side = 0;     // 1 left, -1 right
  uint8_t tier = 0;    // exists at LOD l if tier <= 7 - l
  uint8_t group = 0;   // joint group
  bool below = false;  // is below the jaw in the tree
  Drive drive = Drive::kNone;
};

constexpr uint32_t kJointGroupCount = 6;

struct Skeleton {
  Joint joints[kMaxJoints];
  uint32_t count = 0;
  uint16_t root = 0, neck_low = 0, neck_high = 0, head = 0, face = 0, jaw = 0;
  uint16_t upper_teeth = 0, lower_teeth = 0, tongue[3] = {};
  uint16_t eye[2] = {}, upper_lid[2] = {}, half_lid[2] = {}, lower_lid[2] = {};  // left, right
  double upper_lid_angle = 0, lower_lid_angle = 0;  // degrees by which the neutral pose opens them

  explicit Skeleton(const Form& form);
  static bool in_lod(const Joint& joint, uint32_t lod) { return joint.tier + lod < kLodCount; }
};

struct Weights {
  uint16_t joints[kMaxInfluences];
  float values[kMaxInfluences];
  uint32_t count = 0;
};

/// Uses the joints of a LOD. `on_plane` vertices get exactly symmetric weights.
Weights weigh(const Skeleton& skeleton, uint32_t lod, const Vertex& vertex, bool on_plane);

}  // namespace mien::head
