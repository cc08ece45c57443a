// SPDX-License-Identifier: MIT
// place_bones(): the joints of a head: root, neck, head, face, and facial bones at the means of groups of the face
// mask. docs/authoring.md says what follows the published method and what was added.
#pragma once

#include "author/place/kmeans.h"
#include "author/place/landmarks.h"
#include "author/place/linkage.h"
#include "author/place/throat.h"
#include "runtime/base/status.h"

namespace mien::author {

enum class Symmetry : uint8_t { kAuto, kOn, kOff };

struct PlaceOptions {
  uint32_t facial_joints = 240;
  uint32_t lods = 8;
  uint64_t seed = 1;
  Symmetry symmetry = Symmetry::kAuto;
  uint32_t groups = 3;  // in depth; the front one is the mask
  bool paper = false;   // the published method alone, with the neck cut
  bool neck_cut = true;
  bool mask_from_shapes = false;  // the mask is what shapes move, and two rings around it
  bool area_density = false;      // vertices count by their area: for scans
  bool group_in_space = false;    // groups by distance in space, to compare with
  Landmarks landmarks;            // that the caller gave
  // Replace what would be computed; empty: computed.
  Span<const uint8_t> own_groups;   // per vertex: 0 in front, below `groups`
  Span<const uint8_t> own_mask;     // per vertex: not 0 where facial bones are placed
  Span<const uint32_t> lod_joints;  // per LOD: the largest number of facial joints; LOD 0 keeps all
};

/// How neck and head were separated.
enum class NeckSplit : uint8_t { kNoNeck, kLinkage, kAreaLinkage, kPlane };

constexpr uint32_t kMaxGroups = 16;
constexpr uint32_t kRuns = 8, kMaxRuns = 32;  // and one more, which continues from the best

/// Along z.
struct DepthRange {
  double front = 0, back = 0;
};

struct PlaceReport {
  bool face_only = false;  // no back of the head: groups are measured, the mask is everything
  Linkage linkage;         // of all places in depth
  uint32_t group_count = 0;
  uint32_t group_sizes[kMaxGroups] = {};  // front first, of places
  DepthRange group_depths[kMaxGroups];    // of their places; of empty groups 0
  uint32_t border_count = 0;              // 0 if groups are not intervals of z
  double borders[kMaxGroups] = {};        // z between groups, front first
  NeckSplit neck_split = NeckSplit::kNoNeck;
  Vec3 head_mean, neck_mean;
  Throat throat;
  uint32_t mask_positions = 0, added_by_shapes = 0;
  bool paired = false;        // unlike halves with bones in pairs
  double symmetry_error = 0;  // mean distance of mirrored places to the mesh, part of the diagonal
  uint32_t asked_joints = 0;
  KMeansRun runs[kMaxRuns + 1];
  uint32_t run_count = 0, chosen_run = 0;
  double spacing = 0;                 // median distance of a facial bone to the nearest other
  double uncovered = 0;               // part of the mask farther than twice that from all bones
  Span<const double> lod_objectives;  // of the facial bones that each LOD keeps
  uint32_t eye_joints = 0;
  Landmarks landmarks;
  bool jaw_joint = false;
  double jaw_angle = 0;  // degrees, of the shape that opens it
  Name jaw_shape;        // empty: by landmarks, because no shape opens it
};

/// Fails with kAuthorRefused if no bones can be placed.
Status place_bones(const AuthorMesh& mesh, const PlaceOptions& options, const ParallelFor& parallel,
                   Arena& arena, const Allocator& allocator, Placement& out, PlaceReport& report,
                   Error& error);

}  // namespace mien::author
