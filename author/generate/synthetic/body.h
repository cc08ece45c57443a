// SPDX-License-Identifier: MIT
// The body of a synthetic rig: the positions of its joints, and which of them follow others. The rotations of
// driver joints are its inputs; RBF solvers compare them with poses, whose controls move corrective joints;
// twist and swing joints follow them directly.
//
// Frame: centimeters, x to the character's left, y up, z to the front; it stands with its arms out.
#pragma once

#include "author/generate/synthetic/head.h"

namespace mien::synthetic {

constexpr uint32_t kBodyLodCount = 4;

enum class BodyJointKind : uint8_t { kBase, kTwist, kSwing, kCorrective };

struct BodyJoint {
  dna::String name;
  Vec3 position;  // on the body; neutral rotations are zero
  uint16_t parent = 0;
  uint16_t driver = 0;   // of joints that follow
  uint16_t ordinal = 0;  // among those of the same kind and driver
  BodyJointKind kind = BodyJointKind::kBase;
};

/// A joint whose rotation is an input: raw controls 4 * driver ... + 3, x y z w.
struct BodyDriver {
  uint16_t joint = 0;
  uint8_t axis = 0;                                 // along the limb: 0, 1, 2
  uint8_t twists = 0, swings = 0, correctives = 0;  // joints that follow
};

struct Body {
  Span<BodyJoint> joints;
  Span<BodyDriver> drivers;
  uint32_t base_count = 0;  // joints that others follow or are attached to

  bool joint_in_lod(size_t joint, size_t lod) const;
};

/// These return false if memory ran out.
bool make_body(Arena& arena, Body& out);

/// One mesh per LOD: a tube around each limb. Fills geom, and mesh names and LODs of defn.
bool make_body_meshes(const Body& body, Arena& arena, dna::DnaView& out);

/// Definition, behavior, RBF, joint metadata, twist and swing, geometry. Controls of poses are numbered after
/// `ml_control_count` others.
bool make_body_rig(uint64_t seed, uint32_t ml_control_count, Arena& arena, dna::DnaView& out);

/// Machine-learned behavior for a rig of a preset: the number of controls that it adds, and its layer.
uint32_t ml_control_count_of(SyntheticPreset preset);
bool add_learned_behavior(SyntheticPreset preset, uint64_t seed, Arena& arena, dna::DnaView& out);

}  // namespace mien::synthetic
