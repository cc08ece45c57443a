// SPDX-License-Identifier: MIT
#include "author/rigging/rigging.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/fit/joint_tree.h"
#include "author/place/extra_joints.h"
#include "author/place/joined_eyes.h"
#include "author/rigging/jaw_shape.h"
#include "author/rigging/metahuman_names.h"
#include "author/rigging/own_stages.h"
#include "author/weights/body_weights.h"

namespace mien::author {

namespace {

/// The stages of docs/authoring.md, in order. Each takes the caller's result if there is one.
class Rigger {
 public:
  Rigger(const MeshSource& source, const RiggingOptions& options, Arena& arena,
         const Allocator& allocator, Rigging& out, Error& error)
      : source_(source), options_(options), arena_(arena), allocator_(allocator), out_(out),
        mesh_(out.read.mesh), error_(error) {}

  Status make() {
    using Stage = Status (Rigger::*)();
    struct {
      const char* name;
      double share;  // share of the work before this step
      Stage run;
    } const stages[] = {
        {"mesh", 0, &Rigger::read},
        {"bones", 0.05, &Rigger::place},
        {"weights", 0.15, &Rigger::weigh},
        {"meshes of LODs", 0.3, &Rigger::simplify},
    };
    for (const auto& stage : stages) {
      if (!go_on(stage.name, stage.share)) return canceled();
      if (Status status = (this->*stage.run)(); status != Status::kOk) return status;
    }
    return fit();  // has steps of its own
  }

 private:
  Status read() {
    const Status status = read_mesh(source_, arena_, allocator_, out_.read, error_);
    if (status != Status::kOk) return status;
    if (!options_.place.paper && !separate_eyeballs(out_.read.mesh, arena_, allocator_)) {
      return no_memory();
    }
    if (!has_own_bones()) return status;
    return check_bones(options_, !mesh_.shapes.empty(), error_);
  }

  Status place() {
    PlaceOptions place = options_.place;
    Status status = read_landmarks(source_, options_, place.landmarks, error_);
    if (status != Status::kOk) return status;
    status = take_bytes(out_.read, options_.depth_groups, arena_, place.own_groups, error_);
    if (status == Status::kOk) {
      status = take_bytes(out_.read, options_.mask, arena_, place.own_mask, error_);
    }
    if (status == Status::kOk) status = take_groups(options_, arena_, rig_.own_regions, error_);
    if (status == Status::kOk) {
      status = take_motions(source_, options_, arena_, rig_.own_motions, error_);
    }
    if (status == Status::kOk && has_own_lods()) {
      status = take_lod_meshes(source_, out_.read, options_.lod_meshes, arena_, allocator_,
                               lod_meshes_, error_);
    }
    if (status == Status::kOk) {
      status = place_bones(mesh_, place, options_.parallel, arena_, allocator_, out_.placement,
                           out_.place, error_);
    }
    if (status == Status::kOk && !has_own_bones() && !place.paper && !balance()) {
      return no_memory();
    }
    if (status == Status::kOk && options_.metahuman_names &&
        !name_as_metahuman(out_.placement, arena_)) {
      return no_memory();
    }
    if (status != Status::kOk || !has_own_bones()) return status;
    return take_bones(source_, options_, arena_, out_.placement, error_);
  }

  /// Unless the caller gave the joint of the head.
  bool balance() {
    Landmark& mark = out_.place.landmarks[LandmarkKind::kHead];
    if (mark.given) return true;
    if (!balance_head(mesh_, arena_, out_.placement)) return false;
    for (const Bone& bone : out_.placement.bones) {
      if (bone.kind == BoneKind::kHead) mark.at = bone.position;
    }
    return true;
  }

  /// Weights of every LOD over the bones that it keeps; only of LOD 0 if the caller gave them.
  Status weigh() {
    if (!author::make(arena_, has_own_weights() ? 1 : options_.place.lods, weights_)) {
      return no_memory();
    }
    const Status status = has_own_weights()
                              ? take_weights(out_.read, options_, source_.positions.count / 3,
                                             arena_, weights_[0], error_)
                              : weigh_lods();
    if (status != Status::kOk) return status;
    if (Status measured = measure(out_.made_weights); measured != Status::kOk) return measured;
    if (has_own_bones() || options_.place.paper) return Status::kOk;
    return hang_bones() &&
                   add_jaw_shape(out_.placement, weights_[0], options_.metahuman_names, arena_,
                                 out_.read.mesh, out_.place) &&
                   add_gaze_shapes(out_.placement, options_.metahuman_names, arena_, allocator_,
                                   out_.read.mesh, out_.gaze)
               ? Status::kOk
               : no_memory();
  }

  /// Puts bones that move with the jaw below it.
  bool hang_bones() {
    Jaw jaw;
    Arena scratch(allocator_);
    if (!find_jaw(mesh_, out_.placement.symmetry_plane, scratch, jaw)) return false;
    if (!jaw.found) return true;
    const RigidMotion& turn = jaw.motion;
    Affine opened;
    for (int r = 0; r < 3; ++r) {
      opened.rows[r] = {turn.rotation[r][0], turn.rotation[r][1], turn.rotation[r][2]};
    }
    opened.shift = turn.shift;
    return hang_on_jaw(mesh_, mesh_.shapes[jaw.shape], opened, weights_[0], arena_, out_.placement);
  }

  Status weigh_lods() {
    const uint32_t lods = static_cast<uint32_t>(weights_.count);
    for (uint32_t first = 0; first < lods; first += kWeightLanes) {
      const uint32_t count = std::min(lods - first, kWeightLanes);
      WeightOptions weigh[kWeightLanes];
      for (uint32_t l = 0; l < count; ++l) {
        // LODs with few joints may choose among more influences.
        const bool chooses = first + l > 0 && !mesh_.shapes.empty();
        weigh[l].influences = chooses ? kMaxAuthorInfluences : options_.influences;
        weigh[l].facial_bones = out_.placement.lod_facial_counts[first + l];
      }
      if (!make_lod_weights(mesh_, out_.placement, {weigh, count}, options_.parallel, arena_,
                            allocator_, weights_.slice(first, count))) {
        return no_memory();
      }
      if (!go_on("weights", 0.15 + 0.15 * (first + count) / static_cast<double>(lods))) {
        return canceled();
      }
    }
    return Status::kOk;
  }

  Status simplify() {
    SimplifyOptions simplify;
    simplify.share = options_.lod_triangles;
    simplify.lods = options_.place.lods;
    return has_own_lods() || make_lod_meshes(mesh_, simplify, arena_, allocator_, lod_meshes_)
               ? Status::kOk
               : no_memory();
  }

  /// Motions and weights that suit the shapes, and the file.
  Status fit() {
    rig_.lod_meshes = lod_meshes_;
    rig_.regions = options_.joint_groups;
    rig_.overlap_correctives = options_.overlap_correctives;
    rig_.residual_targets = options_.residual_targets;
    rig_.keep_weights = has_own_weights();
    rig_.name = options_.name;
    rig_.parallel = options_.parallel;
    rig_.user = this;
    rig_.go_on = [](void* user, const char* step) {
      Rigger& rigger = *static_cast<Rigger*>(user);
      // Steps of the fit do not report progress: each counts as a quarter of the remaining work.
      rigger.fit_share_ += (1 - rigger.fit_share_) * 0.25;
      return rigger.go_on(step, rigger.fit_share_);
    };
    if (!author_rig(mesh_, out_.placement, weights_, rig_, arena_, allocator_, out_.rig,
                    out_.dna)) {
      return out_.rig.stopped ? canceled() : no_memory();
    }
    out_.weights = weights_[0];
    return mesh_.shapes.empty() ? Status::kOk : measure(out_.fitted_weights);
  }

  Status measure(WeightReport& out) {
    return measure_weights(mesh_, out_.placement, weights_[0], allocator_, out) ? Status::kOk
                                                                                : no_memory();
  }

  bool has_own_bones() const { return !options_.bones.empty(); }
  bool has_own_weights() const { return !options_.weights.weights.empty(); }
  bool has_own_lods() const { return !options_.lod_meshes.empty(); }

  bool go_on(const char* step, double share) const {
    return !options_.go_on || options_.go_on(options_.user, step, share);
  }
  Status canceled() { return fail(error_, Status::kAuthorCanceled, kNoOffset, "canceled"); }
  Status no_memory() { return fail(error_, Status::kMemory, kNoOffset, "no memory for the rig"); }

  const MeshSource& source_;
  const RiggingOptions& options_;
  Arena& arena_;
  const Allocator& allocator_;
  Rigging& out_;
  const AuthorMesh& mesh_;  // of out_
  Error& error_;
  RigOptions rig_;
  Span<LodMesh> lod_meshes_;
  Span<SkinWeights> weights_;  // of each LOD
  double fit_share_ = 0.3;
};

}  // namespace

Status make_rig(const MeshSource& source, const RiggingOptions& options, Arena& arena,
                const Allocator& allocator, Rigging& out, Error& error) {
  out = Rigging();
  return Rigger(source, options, arena, allocator, out, error).make();
}

}  // namespace mien::author
