// SPDX-License-Identifier: MIT
// The effect of one control: the neutral pose and the pose with the control set, compared value by value
// and position by position.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/io/controls.h"
#include "integrations/program/scene/posed_scene.h"

namespace mien::cli {

struct JointMotion {
  uint32_t joint;
  std::string name;
  float change[9];    // tx ty tz rx ry rz sx sy sz
  float translation;  // length
  float rotation;     // largest angle
  float scale;        // largest change of a factor
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
  float value_alone;                  // with the control alone
  bool reachable;                     // all inputs are raw controls: the next two are known
  float value_together;               // with all inputs set
  float beyond_sum;  // largest distance of a position with all inputs set from the sum of what the
                     // inputs move it alone; of a joint, where there are no meshes
};

struct MeshMotion {
  const SceneMesh* mesh;
  std::vector<float> distances;  // of each position
  uint32_t moved = 0;            // positions that move; the next three are over those
  math::Box box;                 // neutral
  math::Vec3 center;             // neutral, weighted by distance
  math::Vec3 mean;               // movement
  float max_distance = 0;
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

  float max_distance() const;  // over all meshes
};

/// Leaves the scene in the pose of the control.
Influence find_influence(PosedScene& scene, const Control& control, float value,
                         const Session& session);

}  // namespace mien::cli
