// SPDX-License-Identifier: MIT
// From a mesh with bones and weights to a DNA file.
#pragma once

#include "author/fit/correctives.h"
#include "author/fit/regions.h"
#include "author/fit/targets.h"
#include "author/mesh/simplify.h"
#include "runtime/load/dna/format/dna_view.h"

namespace mien::author {

struct RigOptions {
  FitOptions fit;
  bool residual_targets = true;      // blend shape targets hold what joints cannot do
  double residual_threshold = 1e-3;  // shorter offsets are dropped; relative to the face
  uint32_t regions = 0;              // joint groups; 0: as many as have kRowsPerGroup rows each
  bool full_groups = true;           // a control moves all joints of the regions that it owns
  double least_effect = 2e-4;        // of an entry of the matrix; likewise
  uint32_t overlap_correctives = 0;  // at most this many for pairs that double their motion
  bool keep_weights = false;         // the weights are the caller's own: fit motions only
  Span<const uint8_t> own_regions;   // one per bone; empty: computed
  Span<const JointDelta>
      own_motions;                 // by source shape, then bone, in the file's frame; empty: fitted
  Span<const LodMesh> lod_meshes;  // one for each LOD; empty: all LODs have the whole mesh
  Name name = {"head", 4};
  ParallelFor parallel;
  void* user = nullptr;
  bool (*go_on)(void* user, const char* step) = nullptr;  // called before each step; false: stop
};

/// The joint matrix as it is stored: with correctives.
struct GroupReport {
  uint32_t groups = 0;
  uint64_t nonzeros = 0, stored = 0;  // values
  uint64_t full = 0;                  // of one dense matrix: 6 rows for each fitted joint
  double padding[3] = {};             // stored in blocks of 4, 8, 16 rows: share added by padding
  PruneReport pruned;
  FitError before, removed, refitted;  // errors of the joints before and after pruning
};

/// Errors are those of its own vertices.
struct LodReport {
  uint32_t joints = 0, channels = 0;
  size_t vertices = 0, triangles = 0;
  double surface_rms = 0, surface_max = 0;  // distances of the vertices of LOD 0
  double collapsed_error = 0;  // weights of dropped bones on the nearest remaining bone
  double new_error = 0;        // with new weights
  double joints_error = 0;     // with the better of both, refitted to the shapes
  double error = 0;            // of the file, with blend shapes
};

struct RigReport {
  bool stopped = false;   // by go_on
  FitError translations;  // of bones that only translate, with the initial weights
  FitError rotations;     // of bones that also rotate
  FitError joints;        // with refitted weights and groups: as the joints are written
  FitError rig;           // with blend shapes: of the file
  CorrectiveReport correctives;
  uint32_t target_count = 0, target_vertices = 0;  // of expressions
  double target_threshold = 0;                     // shorter offsets were left out
  double target_share = 0;  // share of the moving vertices' displacements that have an offset
  GroupReport groups;
  Span<LodReport> lods;
};

/// Shapes whose names are made of other shapes' names become correctives, the others raw controls.
/// `weights` holds those of LOD 0, or those of every LOD, each over the bones that it keeps and for
/// all vertices of `mesh`. If those of a LOD are missing, the weights of dropped bones go to the
/// nearest remaining bone. All are refitted, those of LOD 0 in place, unless the options keep them.
/// Other LODs may have more influences to choose from than LOD 0. Report and view lie in `arena`,
/// and the view refers to names in it. False if memory ran out or `go_on` stopped it.
bool author_rig(const AuthorMesh& mesh, const Placement& placement, Span<SkinWeights> weights,
                const RigOptions& options, Arena& arena, const Allocator& allocator,
                RigReport& report, dna::DnaView& out);

}  // namespace mien::author
