// SPDX-License-Identifier: MIT
// What one control does: compared with the rig at rest, value by value and position by position.
#pragma once

#include <string>
#include <vector>

#include "integrations/cli/controls.h"
#include "integrations/cli/subject.h"

namespace mien::cli {

struct JointMotion {
  uint32_t joint;
  std::string name;
  float change[9];                     // tx ty tz rx ry rz sx sy sz
  float translation, rotation, scale;  // length of the first, largest angle, largest factor
};

/// A channel, a map or another control whose value changes.
struct ValueChange {
  uint32_t index;
  std::string name;
  float value;
};

/// A corrective that the control is an input of.
struct Corrective {
  uint32_t psd;
  std::vector<std::string> partners;  // its other inputs
  float alone;                        // its value with the control alone
  bool reachable;                     // all inputs are raw controls: the next two are known
  float together;                     // its value with all inputs on
  float further;  // how much further than their sum the inputs together move a position; or, where
                  // there are no meshes, a joint
};

struct MeshMotion {
  const ShownMesh* mesh;
  std::vector<float> distances;  // of each position
  uint32_t moved = 0;
  picture::Box box;      // of what moves, in neutral
  picture::Vec3 center;  // of what moves, in neutral, by how far it moves
  picture::Vec3 mean;    // movement of what moves
  float most = 0;
  uint32_t max_position = 0;
};

struct Influence {
  Control control;
  float value;
  std::vector<ValueChange> raw;  // of a GUI control: what it is mapped to
  std::vector<JointMotion> joints;
  std::vector<ValueChange> channels, maps, rbf, ml;
  std::vector<Corrective> correctives;
  std::vector<MeshMotion> meshes;

  float most() const;  // of all meshes
};

/// Leaves the subject in the pose of the control.
Influence find_influence(Subject& subject, const Control& control, float value,
                         const Session& session);

}  // namespace mien::cli
