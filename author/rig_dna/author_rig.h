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
  bool residual_targets = true;  // what joints cannot do becomes blend shape targets
  double residual_threshold =
      1e-3;                    // shorter offsets are left out; in shares of the face's diagonal
  uint32_t regions = 0;        // joint groups; 0: as many as have kRowsPerGroup rows each
  bool full_groups = true;     // a control moves all joints of the regions that it owns
  double least_effect = 2e-4;  // of an entry of the matrix; likewise
  uint32_t overlap_correctives = 0;  // at most as many, for pairs that double their motion
  bool keep_weights = false;         // the weights are the caller's own: fit motions only
  Span<const uint8_t> own_regions;   // one per bone; empty: found
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
  double padding[3] = {};             // stored in blocks of 4, 8, 16 rows: shares on top
  PruneReport pruned;
  FitError before, removed, refitted;  // errors of the joints around the pruning
};

/// Errors are those of its own vertices.
struct LodReport {
  uint32_t joints = 0, channels = 0;
  size_t vertices = 0, triangles = 0;
  double surface_rms = 0, surface_max = 0;  // distances of the vertices of LOD 0
  double collapsed_error = 0;  // with dropped bones' weights on the nearest bone that is left
  double new_error = 0;        // with new weights
  double joints_error = 0;     // with the better of both, refitted to the shapes
  double error = 0;            // of the file, with blend shapes
};

struct RigReport {
  bool stopped = false;   // by go_on
  FitError translations;  // of bones that only move, with the weights as they came
  FitError rotations;     // of bones that turn too
  FitError joints;        // with refitted weights and in groups: of the joints that are written
  FitError rig;           // with blend shapes: of the file
  CorrectiveReport correctives;
  uint32_t target_count = 0, target_vertices = 0;  // of expressions
  double target_threshold = 0;                     // shorter offsets were left out
  double target_share = 0;  // of the displacements of moving vertices, those with an offset
  GroupReport groups;
  Span<LodReport> lods;
};

/// Shapes whose names are made of other shapes' names become correctives, the others raw controls.
/// `weights` holds those of LOD 0, or those of every LOD, each over the bones that it keeps and of all
/// vertices of `mesh`; where
/// they are missing, dropped bones hand theirs to the nearest one that is left. They are refitted
/// unless the options keep them, those of LOD 0 in place; further LODs may have more influences to
/// choose from than LOD 0. Report and view lie in `arena`, and the view refers to names
/// in it. False if memory ran out or `go_on` stopped it.
bool author_rig(const AuthorMesh& mesh, const Placement& placement, Span<SkinWeights> weights,
                const RigOptions& options, Arena& arena, const Allocator& allocator,
                RigReport& report, dna::DnaView& out);

}  // namespace mien::author
