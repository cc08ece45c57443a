// SPDX-License-Identifier: MIT
// The additions of a VRM 1.0 file to glTF: who the character is, which nodes are the bones of a person,
// which morph targets are its expressions, and how its eyes turn.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "integrations/program/gltf/expression_set.h"
#include "integrations/program/gltf/rig_scene.h"

namespace mien::gltf {

struct HumanBone {
  std::string name;  // of the specification: "leftUpperArm"
  uint32_t joint;
};

/// How far expressions of full weight turn the eyes, in degrees; 0 where there is none or no eye turns.
struct LookAngles {
  double sideways = 0, down = 0, up = 0;
};

struct Vrm {
  std::string name;
  std::vector<std::string> authors;
  std::vector<HumanBone> bones;
  Float3 eyes = {};  // between the eyes, from the head
  LookAngles looks;
};

/// Makes the skeleton of a baked scene that of a person, as VRM 1.0 requires: hips, spine, head and limbs. The
/// head is the one of the rig; bones that the rig has not kept are added where they are in an adult with the
/// rig's distance of the eyes. No vertex follows them, and their names begin with "vrm ". Meshes of a rig
/// without a head follow an added one.
Vrm make_person(const std::string& name, const std::vector<std::string>& authors, RigScene& scene);

/// Of the expressions lookLeft, lookRight, lookDown and lookUp, by the joints of the eyes.
LookAngles measure_looks(const RigSource& source, const RigExpressions& expressions);

/// The extension VRMC_vrm. Joint j is node `first_joint_node` + j, mesh m is node `first_mesh_node` + m.
/// Targets with the names of presets are these presets, the others custom expressions.
nlohmann::ordered_json vrm_json(const Vrm& vrm, const Scene& scene, size_t first_joint_node,
                                size_t first_mesh_node);

}  // namespace mien::gltf
