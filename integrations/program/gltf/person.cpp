// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "integrations/program/gltf/vrm.h"
#include "integrations/program/io/joint_names.h"

namespace mien::gltf {

namespace {

using math::Matrix;
using math::Vec3d;

constexpr double kEyeDistance = 0.063;  // of adults, meters, which the places below are for

/// Where bones are from the head, in meters.
struct Place {
  const char* bone;
  const char* parent;
  Vec3d from_head;
};
constexpr Place kPlaces[] = {
    {"hips", "", {0, -0.60, -0.02}},
    {"spine", "hips", {0, -0.48, -0.03}},
    {"leftUpperLeg", "hips", {0.09, -0.66, -0.02}},
    {"leftLowerLeg", "leftUpperLeg", {0.09, -1.06, -0.02}},
    {"leftFoot", "leftLowerLeg", {0.09, -1.45, -0.04}},
    {"rightUpperLeg", "hips", {-0.09, -0.66, -0.02}},
    {"rightLowerLeg", "rightUpperLeg", {-0.09, -1.06, -0.02}},
    {"rightFoot", "rightLowerLeg", {-0.09, -1.45, -0.04}},
    {"leftUpperArm", "spine", {0.17, -0.16, -0.03}},
    {"leftLowerArm", "leftUpperArm", {0.43, -0.16, -0.03}},
    {"leftHand", "leftLowerArm", {0.68, -0.16, -0.03}},
    {"rightUpperArm", "spine", {-0.17, -0.16, -0.03}},
    {"rightLowerArm", "rightUpperArm", {-0.43, -0.16, -0.03}},
    {"rightHand", "rightLowerArm", {-0.68, -0.16, -0.03}},
};

Matrix world(const std::vector<Joint>& joints, uint32_t joint) {
  Matrix result = matrix_of(joints[joint].bind);
  for (uint32_t at = joints[joint].parent; at != kNone; at = joints[at].parent) {
    result = matrix_of(joints[at].bind) * result;
  }
  return result;
}

Vec3d place_of(const std::vector<Joint>& joints, uint32_t joint) {
  const Matrix m = world(joints, joint);
  return {m.m[0][3], m.m[1][3], m.m[2][3]};
}

/// The joint of a name that hangs nearest to the root: of several, others follow it.
uint32_t find_joint(const std::vector<Joint>& joints, const std::vector<std::string>& words) {
  for (uint32_t j = 0; j < joints.size(); ++j) {
    if (cli::is_body_part(joints[j].name, words)) return j;
  }
  return kNone;
}

/// Eyes by their side: the left one is toward +x.
void find_eyes(const std::vector<Joint>& joints, uint32_t& left, uint32_t& right) {
  left = right = kNone;
  for (uint32_t j = 0; j < joints.size(); ++j) {
    if (!cli::is_body_part(joints[j].name, {"eye", "eyeball", "lefteye", "righteye"})) continue;
    uint32_t& side = place_of(joints, j).x > 0 ? left : right;
    if (side == kNone) side = j;
  }
}

/// A head at the center of all vertices, which then follow it.
uint32_t add_head(Scene& scene) {
  math::Boxd box;
  for (const Mesh& mesh : scene.meshes) {
    for (const Float3& p : mesh.positions) box.add({p[0], p[1], p[2]});
  }
  Joint head;
  head.name = "vrm head";
  if (!box.empty()) head.bind.translation = head.pose.translation = box.center();
  const auto joint = static_cast<uint32_t>(scene.joints.size());
  scene.joints.push_back(head);
  for (Mesh& mesh : scene.meshes) {
    if (mesh.influences != 0) continue;
    mesh.influences = 4;
    mesh.joints.assign(4 * mesh.positions.size(), 0);
    mesh.weights.assign(4 * mesh.positions.size(), 0);
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
      mesh.joints[4 * v] = static_cast<uint16_t>(joint);
      mesh.weights[4 * v] = 1;
    }
  }
  return joint;
}

/// Moves a root below `parent` without moving it in the world. `place` is that of the parent, which does not turn.
void hang(Joint& joint, uint32_t parent, const Vec3d& place) {
  joint.parent = parent;
  joint.bind.translation = joint.bind.translation - place;
  joint.pose.translation = joint.pose.translation - place;
}

}  // namespace

Vrm make_person(const std::string& name, const std::vector<std::string>& authors, RigScene& made) {
  Scene& scene = made.scene;
  std::vector<Joint>& joints = scene.joints;
  uint32_t head = find_joint(joints, {"head"});
  if (head == kNone) head = add_head(scene);
  uint32_t left = kNone, right = kNone;
  find_eyes(joints, left, right);
  const Vec3d center = place_of(joints, head);

  Vrm vrm{name, authors, {{"head", head}}, {0, 0.06f, 0.08f}, {}};
  double scale = 1;
  if (left != kNone && right != kNone) {
    const Vec3d a = place_of(joints, left), b = place_of(joints, right);
    if (length(a - b) > 0) scale = length(a - b) / kEyeDistance;
    const Vec3d between = (a + b) * 0.5 - center;
    vrm.eyes = {static_cast<float>(between.x), static_cast<float>(between.y),
                static_cast<float>(between.z)};
    vrm.bones.push_back({"leftEye", left});
    vrm.bones.push_back({"rightEye", right});
  }
  const uint32_t neck = find_joint(joints, {"neck"});
  const bool is_above = [&] {
    for (uint32_t at = head; neck != kNone && at != kNone; at = joints[at].parent) {
      if (at == neck) return true;
    }
    return false;
  }();
  if (is_above && neck != head) vrm.bones.push_back({"neck", neck});

  const size_t count = joints.size();
  std::vector<Vec3d> places;
  for (const Place& place : kPlaces) {
    Joint joint;
    joint.name = std::string("vrm ") + place.bone;
    places.push_back(center + place.from_head * scale);
    joint.bind.translation = places.back();
    for (size_t p = 0; p < places.size(); ++p) {
      if (std::string(kPlaces[p].bone) != place.parent) continue;
      joint.parent = static_cast<uint32_t>(count + p);
      joint.bind.translation = places.back() - places[p];
    }
    joint.pose = joint.bind;
    vrm.bones.push_back({place.bone, static_cast<uint32_t>(joints.size())});
    joints.push_back(joint);
  }
  const auto spine = static_cast<uint32_t>(count + 1);
  for (size_t j = 0; j < count; ++j) {
    if (joints[j].parent == kNone) hang(joints[j], spine, places[1]);
  }
  return vrm;
}

}  // namespace mien::gltf
