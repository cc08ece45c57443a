// SPDX-License-Identifier: MIT
// Rig -> Scene: its skeleton, its skinned meshes, its blend shape channels as morph targets.
//
// The file holds Mien's own deformation: joints with translation, rotation and scale relative to their
// parents, targets added before linear skinning. glTF cannot hold what drives joints and channels
// (controls, correctives, networks); poses and animations are results.
#pragma once

#include <functional>

#include "integrations/program/gltf/skin_fit.h"

namespace mien::gltf {

struct SceneOptions {
  std::string name;                            // of the scene
  uint32_t first_lod = 0;                      // number to show for the first LOD that was opened
  uint32_t influences = 4;                     // per vertex, at most: 1 to 12
  bool exact = false;                          // also moves that cannot be seen
  std::function<void(double share)> progress;  // called now and then; may be empty
};

/// Losses in glTF.
struct Losses {
  uint32_t places = 0;           // for influences, per vertex
  size_t positions = 0;          // with influences
  size_t crowded_positions = 0;  // with more influences than there is room for
  SkinLoss skin;                 // of those; of a baked scene only the residual's maximum, when one
                                 // of the bones turns by ten degrees
  size_t corrected_positions = 0;         // with negative weights, or weights that do not sum to 1
  double max_correction = 0;              // largest change of a sum
  std::vector<std::string> empty_meshes;  // left out
};

/// A scene, and where its parts come from.
struct RigScene {
  Scene scene;
  std::vector<uint32_t> rig_meshes;             // of each mesh
  std::vector<std::vector<uint16_t>> channels;  // of each mesh's targets; empty if baked
  Losses losses;
};

/// Meshes without skin and targets: neutral positions and normals, texture coordinates, colors,
/// materials, LODs.
RigScene make_still_scene(const RigSource& source, const SceneOptions& options);

/// The same with skeleton, skin, and a morph target for each channel that a LOD of the mesh drives.
/// Targets turn normals by what the recomputed ones change.
RigScene make_rig_scene(const RigSource& source, const SceneOptions& options);

/// Opens in this pose: `pose` was updated from these channel weights.
void set_pose(RigScene& scene, const RigSource& source, const MienDeformerInstance* pose,
              const MienFloatView& channel_weights);

/// Frames of a rig scene, one after the other, as tracks.
class AnimationRecorder {
 public:
  AnimationRecorder(const RigScene& scene, const RigSource& source, std::string name, double rate);

  /// `transforms`: ten floats per joint, as mien_deformer_instance_local_transforms() gives them.
  void add_frame(const std::vector<float>& transforms, const MienFloatView& channel_weights);

  /// Only what moves: a joint's values that all frames leave at the pose of the scene have no
  /// track.
  Animation finish();

 private:
  const RigScene& scene_;
  const RigSource& source_;
  double rate_;
  Animation animation_;
};

/// All joints of the rig in the neutral pose.
std::vector<Joint> neutral_joints(const RigSource& source);

/// In the neutral pose.
cli::DeformerInstance make_deformer_instance(const RigSource& source);

/// Positions and normals of each vertex of a mesh in a pose, which is deformed for it.
struct PosedVertices {
  std::vector<Float3> positions, normals;
};
PosedVertices posed_vertices(const RigSource& source, uint32_t rig_mesh,
                             MienDeformerInstance* pose);

/// How far each vertex of a mesh moves: `positions` and `normals` as of the pose less those given,
/// in the axes of glTF. Moves below `least` (meters) and turns below half a degree are left out.
MorphTarget difference(const RigSource& source, uint32_t rig_mesh, const MienDeformerInstance* pose,
                       const std::vector<float>& neutral_positions,
                       const std::vector<float>& neutral_normals, double least);

}  // namespace mien::gltf
