// SPDX-License-Identifier: MIT
// Weights of everything that is not skin: eyeballs, teeth, tongue, lashes, the inside of the mouth.
#pragma once

#include "author/weights/skin_weights.h"

namespace mien::author {

/// Influences of one vertex, while they are collected.
struct InfluenceList {
  static constexpr uint32_t kCapacity = 2 * kMaxAuthorInfluences + 8;
  uint32_t joints[kCapacity];
  double values[kCapacity];
  uint32_t count = 0;

  /// Adds to the joint's weight.
  void add(uint32_t joint, double value) {
    if (!(value > 0)) return;
    for (uint32_t i = 0; i < count; ++i) {
      if (joints[i] != joint) continue;
      values[i] += value;
      return;
    }
    joints[count] = joint;
    values[count++] = value;
  }
  double sum() const;
};

/// The m largest weights, without those below 1e-4; their sum in single precision is 1.
void store(const InfluenceList& list, uint32_t vertex, SkinWeights& out);
InfluenceList load(uint32_t vertex, const SkinWeights& from);

/// Components that are not skin. An eyeball turns with its joint. A component that no shape moves
/// is rigid on the head. One that all shapes move rigidly, at least 30 % as far as the chin when
/// the jaw opens, is rigid on the jaw. Others follow the nearest skin, less with more distance.
/// Without shapes, components that lie on the skin follow it, and the others are rigid. With
/// `report`, counts and writes no weights. False if memory ran out.
bool carry_components(const AuthorMesh& mesh, const Placement& placement, uint32_t head,
                      Arena& scratch, SkinWeights& out, WeightReport* report);

/// Median distance of the first facial bones to the nearest other; a share of the diagonal if there
/// is one bone. False if memory ran out.
bool find_median_spacing(const Placement& placement, uint32_t facial, double diagonal,
                         Arena& scratch, double& out);

/// The first bone of a kind, or `otherwise`.
uint32_t bone_of_kind(const Placement& placement, BoneKind kind, uint32_t otherwise);

}  // namespace mien::author
