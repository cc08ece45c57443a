// SPDX-License-Identifier: MIT
// From a mesh to a rig: all stages in order. The caller may replace the result of each.
#pragma once

#include "author/mesh/own_lods.h"
#include "author/place/place.h"
#include "author/rig_dna/author_rig.h"
#include "author/rigging/gaze_shapes.h"
#include "author/weights/skin_weights.h"

namespace mien::author {

/// A bone of the caller, in the caller's frame and unit.
struct OwnBone {
  Name name;
  double position[3];
  uint32_t parent;
  BoneKind kind;
};

/// A landmark of the caller, in the caller's frame and unit.
struct OwnLandmark {
  Name name;
  double position[3];
};

/// Weights of the caller: one row per position of the source, one column per influence.
struct OwnWeights {
  Span<const uint16_t> joints;
  Span<const float> weights;
};

struct RiggingOptions {
  PlaceOptions place;  // except own_groups and own_mask
  uint32_t influences = 8;
  double lod_triangles = 0.5;  // share of the LOD before it that each LOD keeps
  bool residual_targets = true;
  bool metahuman_names = false;  // of bones that are placed and controls that are added
  Name name = {"head", 4};
  Span<const OwnLandmark> landmarks;
  Span<const OwnBone> bones;  // empty: placed
  OwnWeights weights;         // empty: made
  // Supplied by the caller; empty: computed. One for each position of the source:
  Span<const uint8_t> depth_groups, mask;
  Span<const uint32_t> bone_groups;  // one for each of `bones`
  Span<const LodSource> lod_meshes;  // one for each LOD but LOD 0
  // Six for each shape and each of `bones`: translation, degrees; in the caller's frame and unit.
  Span<const double> bone_motions;
  uint32_t joint_groups = 0;         // 0: as many as are large enough
  uint32_t overlap_correctives = 0;  // at most as many
  ParallelFor parallel;
  void* user = nullptr;
  /// Called on the calling thread before each step; false stops. Null: never.
  bool (*go_on)(void* user, const char* step, double share) = nullptr;
};

struct Rigging {
  ReadMesh read;
  Placement placement;
  PlaceReport place;
  SkinWeights weights;                        // of LOD 0, as they are written
  WeightReport made_weights, fitted_weights;  // before and after the fit to shapes
  GazeReport gaze;
  RigReport rig;
  dna::DnaView dna;
};

/// Fails with kAuthorMesh if arrays contradict each other, kAuthorRefused if the mesh cannot be
/// rigged, kAuthorCanceled if go_on returned false. `out` refers to `arena` and `source`.
Status make_rig(const MeshSource& source, const RiggingOptions& options, Arena& arena,
                const Allocator& allocator, Rigging& out, Error& error);

/// What was done and measured, as JSON (docs/authoring.md, 6 "The report"). False if memory ran
/// out.
bool write_report(const MeshSource& source, const RiggingOptions& options, const Rigging& rigging,
                  Arena& arena, Span<const char>& out);

}  // namespace mien::author
