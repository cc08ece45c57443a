// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/bake_skeleton.h"

#include <algorithm>

#include "integrations/program/gltf/rig_skin.h"
#include "integrations/program/io/joint_names.h"

namespace mien::gltf {

namespace {

using math::Transform;

/// For each joint of the rig the nearest kept one among itself and its ancestors, or kNone.
std::vector<uint32_t> nearest_kept(const std::vector<Joint>& joints,
                                   const std::vector<bool>& kept) {
  std::vector<uint32_t> nearest(joints.size(), kNone);
  for (uint32_t j = 0; j < joints.size(); ++j) {
    uint32_t at = j;
    while (at != kNone && !kept[at]) at = joints[at].parent;
    nearest[j] = at;
  }
  return nearest;
}

/// The kept joints, relative to each other.
std::vector<Joint> kept_joints(const std::vector<Joint>& joints, const std::vector<bool>& kept,
                               const std::vector<uint32_t>& new_number) {
  std::vector<Joint> result;
  for (uint32_t j = 0; j < joints.size(); ++j) {
    if (!kept[j]) continue;
    Joint joint = joints[j];
    uint32_t at = joint.parent;
    for (; at != kNone && !kept[at]; at = joints[at].parent) {
      joint.bind = joints[at].bind * joint.bind;
    }
    joint.pose = joint.bind;
    joint.parent = at == kNone ? kNone : new_number[at];
    result.push_back(std::move(joint));
  }
  return result;
}

}  // namespace

void add_bake_skeleton(const RigSource& source, uint32_t influences, RigScene& scene) {
  const std::vector<Joint> joints = neutral_joints(source);
  std::vector<bool> kept(joints.size());
  for (size_t j = 0; j < joints.size(); ++j) {
    kept[j] = cli::is_body_part(joints[j].name,
                                {"neck", "head", "eye", "eyeball", "lefteye", "righteye"});
  };
  if (std::find(kept.begin(), kept.end(), true) == kept.end()) return;
  // What hangs from none of them follows the root.
  for (size_t j = 0; j < joints.size(); ++j) kept[j] = kept[j] || joints[j].parent == kNone;

  std::vector<uint32_t> new_number(joints.size(), kNone);
  uint32_t count = 0;
  for (size_t j = 0; j < joints.size(); ++j) {
    if (kept[j]) new_number[j] = count++;
  }
  std::vector<uint32_t> follows = nearest_kept(joints, kept);
  for (uint32_t& joint : follows) joint = new_number[joint];
  scene.scene.joints = kept_joints(joints, kept, new_number);
  add_skin(source, follows, influences, scene);
}

}  // namespace mien::gltf
