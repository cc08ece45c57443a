// SPDX-License-Identifier: MIT
// The 52 ARKit expressions as morph targets, and what that loses against the rig.
#pragma once

#include <functional>

#include "integrations/program/gltf/arkit_controls.h"
#include "integrations/program/gltf/rig_scene.h"

namespace mien::gltf {

/// What mouthClose is a difference to.
enum class MouthClose {
  kAlone,    // the neutral mesh, as for all others
  kWithJaw,  // the mesh with jawOpen at 1: captured data close the lips of an open jaw with it, to
             // the degree that the jaw is open at most
};

struct BakeOptions {
  MouthClose mouth_close = MouthClose::kAlone;
  bool correctives = false;
};

struct BakeReport {
  struct Expression {
    double max_move = 0;  // of a position, meters
    Residual halfway;     // half the target against the rig at half the controls
  };
  std::vector<Expression> expressions;  // kArkitCount of them
  Residual combinations;                // sums of targets against the rig
  Residual corrected;                   // the same with correctives
  size_t corrective_count = 0;          // of all meshes
  ArkitWeights worst{};                 // the combination with the largest distance
  double max_close_with_jaw = 0;        // by how much mouthClose differs in its two ways, meters
  uint32_t combination_count = 0;
  size_t moved_positions = 0;
  double diagonal = 0;  // of the box around all positions, meters
};

/// Adds to each mesh of a still scene a target per expression: the mesh as the rig deforms it with
/// the expression's controls, less the mesh with all controls as they start. Joints, channels,
/// correctives and networks are all in it. Each mesh is evaluated at the finest LOD that shows it.
/// Moves of less than 2e-6 of the diagonal count as rounding and are left out; a mesh that nothing
/// moves gets no targets.
///
/// A target is a straight line, a rotating jaw or eye is not, and expressions together have
/// correctives: the report measures both, the second by random combinations, the same every time:
/// each expression is on with a chance of 1 in 8, by 0 to 1. With MouthClose::kWithJaw, mouthClose
/// is measured with a jaw as open as it, and in combinations never above jawOpen.
///
/// With `options.correctives` each mesh also gets a target for every two expressions that together
/// move it by more than a thousandth of the diagonal beyond their sum, the 128 largest at most: at the
/// product of their weights it makes the two exact (mouthClose with the jaw has none).
///
/// `progress` is called now and then.
BakeReport bake_arkit(const RigSource& source, const ArkitControls& controls,
                      const BakeOptions& options, RigScene& scene,
                      const std::function<void(double share)>& progress = {});

/// Weights of the expressions from raw controls named after them (ArkitControls::by_name).
ArkitWeights arkit_weights(const ArkitControls& controls, const MienFloatView& raw);

/// A baked scene opens with these weights.
void set_baked_pose(RigScene& scene, const ArkitWeights& weights);

/// One row of weights per frame, for every mesh that has targets.
Animation baked_animation(const RigScene& scene, const std::vector<ArkitWeights>& frames,
                          const std::string& name, double rate);

}  // namespace mien::gltf
