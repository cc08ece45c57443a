// SPDX-License-Identifier: MIT
// Expressions as morph targets, and their error compared with the rig.
#pragma once

#include <functional>

#include "integrations/program/gltf/attachment.h"
#include "integrations/program/gltf/expression_set.h"
#include "integrations/program/gltf/rig_scene.h"

namespace mien::gltf {

struct BakeReport {
  struct Shape {
    std::string name;
    double max_move = 0;  // of a position, meters
    Residual halfway;     // half the target against the rig at half the controls
    Residual combined;  // sums of targets against the rig, in the combinations with this expression
  };
  std::vector<Shape> expressions;
  /// A mesh that follows another: its targets against following the mesh as the rig deforms it.
  struct Follower {
    std::string name;
    std::vector<Residual> halfway, combined;  // by expression
    Residual combinations, corrected;
  };
  std::vector<Follower> followers;
  Residual combinations;          // sums of targets against the rig
  Residual corrected;             // the same with correctives
  size_t corrective_count = 0;    // of all meshes
  std::vector<float> worst;       // weights of the combination with the largest distance
  double max_close_with_jaw = 0;  // by how much mouthClose differs with an open jaw, meters
  uint32_t combination_count = 0;
  size_t moved_positions = 0;
  double diagonal = 0;  // of the box around all positions, meters
};

/// Adds to each mesh of a still scene a target per expression: the mesh as the rig deforms it with
/// the expression's controls, less the mesh with those it is a difference to. Joints, channels,
/// correctives and networks are all in it. Each mesh is evaluated at the finest LOD that shows it.
/// Moves of less than 2e-6 of the diagonal count as rounding and are left out; a mesh that nothing
/// moves gets no targets.
///
/// A target is a straight line, a rotating jaw or eye is not, and expressions together have
/// correctives: the report measures both, the second by random combinations, the same every time:
/// each expression is on with a chance of 1 in 8, by 0 to 1. An expression that is a difference to a pose
/// has a weight of at most that of the expression with this pose (mouthClose and jawOpen); it is left out of
/// the combinations if there is no such expression.
///
/// With `correctives` each mesh also gets a target for every two expressions that together
/// move it by more than a thousandth of the diagonal beyond their sum, the 128 largest at most: at the
/// product of their weights it makes the two exact (differences have none).
///
/// `progress` is called now and then.
BakeReport bake_expressions(const RigSource& source, const RigExpressions& expressions,
                            bool correctives, RigScene& scene,
                            const std::function<void(double share)>& progress = {});

/// Adds to the report the meshes that were attached to the baked scene, over all their vertices, in the same
/// poses.
void measure_attached(const RigSource& source, const RigExpressions& expressions,
                      const RigScene& scene, const std::vector<Attached>& attached,
                      BakeReport& report, const std::function<void(double share)>& progress = {});

/// Weights of the expressions from raw controls named after them (RigExpressions::by_name).
std::vector<float> expression_weights(const RigExpressions& expressions, const MienFloatView& raw);

/// A baked scene opens with these weights.
void set_baked_pose(RigScene& scene, const std::vector<float>& weights);

/// One row of weights per frame, for every mesh that has targets.
Animation baked_animation(const RigScene& scene, const std::vector<std::vector<float>>& frames,
                          const std::string& name, double rate);

}  // namespace mien::gltf
