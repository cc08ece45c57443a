// SPDX-License-Identifier: MIT
// Scene -> USD, as text (.usda).
#pragma once

#include <functional>
#include <string>

#include "integrations/program/gltf/rig_scene.h"

namespace mien::gltf {

struct UsdOptions {
  double rate = 30;  // frames per second: one frame is one time code
  // With a cache: frames, and each mesh in each of them. The file then has no skeleton and no blend shapes.
  size_t cached_frames = 0;
  std::function<PosedVertices(size_t mesh, size_t frame)> posed;
};

/// A USD layer; the same scene gives the same bytes everywhere.
///
///     /NAME                SkelRoot, or Xform with a cache; the default prim
///       /Skeleton          joints, parents first, with their bind and rest transforms
///       /Animation         SkelAnimation: the pose in which the scene opens, or its animation; blend shape
///                          weights by name
///       /LOD_0/MESH        Mesh with SkelBindingAPI; /LOD_0/MESH/SHAPE is a BlendShape
///       /Materials/NAME    UsdPreviewSurface
///
/// Stage metadata says meters, y up and the rate. Names of prims may have letters, digits and _ only: others
/// become _, and the exact name is the displayName of the prim. Names of blend shapes in the animation are exact;
/// those of joints are in the customData of the skeleton, in order. LODs but the first are invisible.
///
/// Throws ExportError for numbers that are not finite.
std::string write_usda(const Scene& scene, const UsdOptions& options);

}  // namespace mien::gltf
