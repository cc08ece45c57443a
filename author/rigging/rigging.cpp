// SPDX-License-Identifier: MIT
#include "author/rigging/rigging.h"

#include <algorithm>
#include <cstring>

#include "author/base/dna_making.h"
#include "author/place/rank.h"

namespace mien::author {

namespace {

// Joint values have 16-bit numbers, nine for each joint.
constexpr uint32_t kMaxBones = 65536 / 9;
constexpr size_t kMaxName = 200;

Status no_memory(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory for the rig");
}

bool is_caller(const RiggingOptions& options) { return !options.bones.empty(); }

/// Whether expressions move the bone. Those above it were checked.
bool is_moved(Span<const OwnBone> bones, uint32_t b) {
  Bone bone;
  bone.kind = bones[b].kind;
  return is_fitted(bone);
}

/// `moves`: there are expressions to fit.
Status check_bones(const RiggingOptions& options, bool moves, Error& error) {
  const Span<const OwnBone> bones = options.bones;
  if (bones.count > kMaxBones) {
    return fail(error, Status::kAuthorRefused, kNoOffset, "%zu bones: %u are allowed", bones.count,
                kMaxBones);
  }
  uint32_t facial_runs = 0, roots = 0;
  for (uint32_t b = 0; b < bones.count; ++b) {
    const OwnBone& bone = bones[b];
    if (bone.name.count < 1 || bone.name.count > kMaxName) {
      return fail(error, Status::kAuthorMesh, kNoOffset,
                  "the name of bone %u has %zu bytes: 1 to %zu", b, bone.name.count, kMaxName);
    }
    for (uint32_t other = 0; other < b; ++other) {
      if (bones[other].name.count != bone.name.count ||
          memcmp(bones[other].name.data, bone.name.data, bone.name.count) != 0) {
        continue;
      }
      return fail(error, Status::kAuthorMesh, kNoOffset, "bones %u and %u have one name", other, b);
    }
    for (double x : bone.position) {
      if (std::abs(x) < 1e15) continue;
      return fail(error, Status::kAuthorMesh, kNoOffset, "bone %u is at no finite position", b);
    }
    const bool is_root = b == 0;
    if (is_root ? bone.parent != 0 : bone.parent >= b) {
      return fail(error, Status::kAuthorMesh, kNoOffset,
                  "bone %u has parent %u: bone 0 is its own, others have one before them", b,
                  bone.parent);
    }
    if (moves && is_moved(bones, bone.parent)) {
      return fail(
          error, Status::kAuthorRefused, kNoOffset,
          "bone %u hangs below bone %u, which moves with expressions: shapes can be fitted to "
          "bones below still ones only",
          b, bone.parent);
    }
    roots += bone.kind == BoneKind::kRoot;
    facial_runs +=
        bone.kind == BoneKind::kFacial && (b == 0 || bones[b - 1].kind != BoneKind::kFacial);
  }
  if (roots != 1 || bones[0].kind != BoneKind::kRoot || facial_runs != 1) {
    return fail(error, Status::kAuthorMesh, kNoOffset,
                "bones need one root, the first, and facial ones in one run: %u roots, %u runs",
                roots, facial_runs);
  }
  return Status::kOk;
}

/// The caller's bones in place of those that were found; the mask stays.
Status take_bones(const MeshSource& source, const RiggingOptions& options, Arena& arena,
                  Placement& out, Error& error) {
  Span<Bone> bones;
  Span<uint32_t> counts;
  if (!make(arena, options.bones.count, bones) || !make(arena, options.place.lods, counts)) {
    return no_memory(error);
  }
  out.first_facial = out.facial_count = 0;
  for (uint32_t b = 0; b < bones.count; ++b) {
    const OwnBone& own = options.bones[b];
    Bone& bone = bones[b];
    const Vec3 at = {own.position[0], own.position[1], own.position[2]};
    bone.name = own.name;
    bone.position = source.frame.to_internal(at * source.unit);
    bone.parent = own.parent;
    bone.mirror = b;
    bone.kind = own.kind;
    if (own.kind != BoneKind::kFacial) continue;
    if (out.facial_count == 0) out.first_facial = b;
    bone.rank = out.facial_count++;
  }
  // The caller's order is the rank.
  joint_ladder(out.facial_count, options.place.lod_joints, counts);
  out.bones = bones;
  out.lod_facial_counts = counts;
  out.symmetric = false;
  return Status::kOk;
}

Status take_weights(const MeshSource& source, const RiggingOptions& options, const Rigging& rigging,
                    Arena& arena, SkinWeights& out, Error& error) {
  const size_t sources = source.positions.count / 3, m = options.influences;
  const OwnWeights& own = options.weights;
  if (own.weights.count != sources * m || own.joints.count != sources * m) {
    return fail(error, Status::kAuthorMesh, kNoOffset,
                "%zu weights and %zu joints: %zu positions with %zu influences are expected",
                own.weights.count, own.joints.count, sources, m);
  }
  const size_t n = rigging.read.mesh.positions.count;
  out.m = options.influences;
  if (!make(arena, n * m, out.joints) || !make(arena, n * m, out.weights)) return no_memory(error);
  for (size_t v = 0; v < n; ++v) {
    const size_t from = rigging.read.source_vertices[v] * m;
    double sum = 0;
    for (size_t i = 0; i < m; ++i) {
      const float weight = own.weights[from + i];
      if (!(weight >= 0 && weight < 1e15f) ||
          own.joints[from + i] >= rigging.placement.bones.count) {
        return fail(error, Status::kAuthorMesh, kNoOffset,
                    "influence %zu of position %zu is not a weight of a bone", i, from / m);
      }
      sum += double{weight};
    }
    if (!(sum > 0)) {
      return fail(error, Status::kAuthorMesh, kNoOffset, "position %zu has no weight", from / m);
    }
    size_t used = 0;
    for (size_t i = 0; i < m; ++i) {
      if (!(own.weights[from + i] > 0)) continue;
      // The heaviest come first.
      size_t slot = used++;
      const float weight = static_cast<float>(own.weights[from + i] / sum);
      for (; slot > 0 && out.weights[v * m + slot - 1] < weight; --slot) {
        out.weights[v * m + slot] = out.weights[v * m + slot - 1];
        out.joints[v * m + slot] = out.joints[v * m + slot - 1];
      }
      out.weights[v * m + slot] = weight;
      out.joints[v * m + slot] = own.joints[from + i];
    }
  }
  return Status::kOk;
}

/// Values of the source's positions as those of the mesh's vertices.
Status take_bytes(const Rigging& rigging, Span<const uint8_t> own, Arena& arena,
                  Span<const uint8_t>& out, Error& error) {
  const Span<const uint32_t> sources = rigging.read.source_vertices;
  Span<uint8_t> bytes;
  if (!make(arena, own.empty() ? 0 : sources.count, bytes)) return no_memory(error);
  for (size_t v = 0; v < bytes.count; ++v) bytes[v] = own[sources[v]];
  out = bytes;
  return Status::kOk;
}

Status take_groups(const RiggingOptions& options, Arena& arena, Span<const uint8_t>& out,
                   Error& error) {
  Span<uint8_t> groups;
  if (!make(arena, options.bone_groups.count, groups)) return no_memory(error);
  for (size_t b = 0; b < groups.count; ++b) {
    const uint32_t group = options.bone_groups[b];
    if (group >= kMaxOwnRegions) {
      return fail(error, Status::kAuthorMesh, kNoOffset,
                  "bone %zu is in joint group %u: 0 to %u are allowed", b, group,
                  kMaxOwnRegions - 1);
    }
    groups[b] = static_cast<uint8_t>(group);
  }
  out = groups;
  return Status::kOk;
}

Status take_motions(const MeshSource& source, const RiggingOptions& options, Arena& arena,
                    Span<const JointDelta>& out, Error& error) {
  const size_t bones = options.bones.count;
  Span<JointDelta> deltas;
  if (!make(arena, options.bone_motions.count / 6, deltas)) return no_memory(error);
  for (size_t i = 0; i < deltas.count; ++i) {
    const size_t shape = i / bones;
    const uint32_t b = static_cast<uint32_t>(i % bones);
    for (size_t k = 0; k < 6; ++k) {
      const double value = options.bone_motions[6 * i + k] * (k < 3 ? source.unit : 1);
      if (!(std::abs(value) < 1e15)) {
        return fail(error, Status::kAuthorMesh, kNoOffset,
                    "the motion of bone %u for shape %zu is not finite", b, shape);
      }
      (k < 3 ? deltas[i].translation[k] : deltas[i].rotation[k - 3]) = static_cast<float>(value);
    }
    if (deltas[i].is_zero() || is_moved(options.bones, b)) continue;
    return fail(error, Status::kAuthorMesh, kNoOffset,
                "bone %u moves for shape %zu: only facial bones, jaws and eyes do", b, shape);
  }
  out = deltas;
  return Status::kOk;
}

struct Steps {
  const RiggingOptions* options;
  bool stopped = false;

  bool go_on(const char* step, double share) {
    stopped = stopped || (options->go_on && !options->go_on(options->user, step, share));
    return !stopped;
  }
};

/// Steps of the fit do not tell how far they are: each takes half of what is left.
struct FitSteps {
  Steps* steps;
  double share;

  static bool go_on(void* user, const char* step) {
    FitSteps& fit = *static_cast<FitSteps*>(user);
    fit.share += (1 - fit.share) * 0.25;
    return fit.steps->go_on(step, fit.share);
  }
};

}  // namespace

Status make_rig(const MeshSource& source, const RiggingOptions& options, Arena& arena,
                const Allocator& allocator, Rigging& out, Error& error) {
  out = Rigging();
  Steps steps = {&options};
  const auto canceled = [&] { return fail(error, Status::kAuthorCanceled, kNoOffset, "canceled"); };
  if (!steps.go_on("mesh", 0)) return canceled();
  Status status = read_mesh(source, arena, allocator, out.read, error);
  if (status == Status::kOk && is_caller(options))
    status = check_bones(options, !out.read.mesh.shapes.empty(), error);
  if (status != Status::kOk) return status;

  if (!steps.go_on("bones", 0.05)) return canceled();
  const AuthorMesh& mesh = out.read.mesh;
  PlaceOptions place = options.place;
  status = take_bytes(out, options.depth_groups, arena, place.own_groups, error);
  if (status == Status::kOk) status = take_bytes(out, options.mask, arena, place.own_mask, error);
  RigOptions rig;
  if (status == Status::kOk) status = take_groups(options, arena, rig.own_regions, error);
  if (status == Status::kOk) status = take_motions(source, options, arena, rig.own_motions, error);
  Span<LodMesh> lod_meshes;
  const bool own_lods = !options.lod_meshes.empty();
  if (status == Status::kOk && own_lods) {
    status =
        take_lod_meshes(source, out.read, options.lod_meshes, arena, allocator, lod_meshes, error);
  }
  if (status != Status::kOk) return status;
  status =
      place_bones(mesh, place, options.parallel, arena, allocator, out.placement, out.place, error);
  if (status == Status::kOk && is_caller(options)) {
    status = take_bones(source, options, arena, out.placement, error);
  }
  if (status != Status::kOk) return status;

  if (!steps.go_on("weights", 0.15)) return canceled();
  const bool own_weights = options.weights.weights.count > 0;
  Span<SkinWeights> lods;
  if (!make(arena, own_weights ? 1 : options.place.lods, lods)) return no_memory(error);
  if (own_weights) {
    status = take_weights(source, options, out, arena, lods[0], error);
    if (status != Status::kOk) return status;
  }
  for (uint32_t first = 0; first < lods.count && !own_weights; first += kWeightLanes) {
    const uint32_t count =
        std::min<uint32_t>(static_cast<uint32_t>(lods.count) - first, kWeightLanes);
    WeightOptions weigh[kWeightLanes];
    for (uint32_t l = 0; l < count; ++l) {
      // Shapes choose among more joints where most are gone.
      const bool chooses = first + l > 0 && !mesh.shapes.empty();
      weigh[l].influences = chooses ? kMaxAuthorInfluences : options.influences;
      weigh[l].facial_bones = out.placement.lod_facial_counts[first + l];
    }
    if (!make_lod_weights(mesh, out.placement, {weigh, count}, options.parallel, arena, allocator,
                          lods.slice(first, count))) {
      return no_memory(error);
    }
    if (!steps.go_on("weights", 0.15 + 0.15 * (first + count) / static_cast<double>(lods.count))) {
      return canceled();
    }
  }
  if (!measure_weights(mesh, out.placement, lods[0], allocator, out.made_weights)) {
    return no_memory(error);
  }

  if (!steps.go_on("meshes of LODs", 0.3)) return canceled();
  SimplifyOptions simplify;
  simplify.share = options.lod_triangles;
  simplify.lods = options.place.lods;
  if (!own_lods && !make_lod_meshes(mesh, simplify, arena, allocator, lod_meshes)) {
    return no_memory(error);
  }
  rig.lod_meshes = lod_meshes;

  rig.regions = options.joint_groups;
  rig.overlap_correctives = options.overlap_correctives;
  rig.residual_targets = options.residual_targets;
  rig.keep_weights = own_weights;
  rig.name = options.name;
  rig.parallel = options.parallel;
  FitSteps fit = {&steps, 0.3};
  rig.user = &fit;
  rig.go_on = FitSteps::go_on;
  if (!author_rig(mesh, out.placement, lods, rig, arena, allocator, out.rig, out.dna)) {
    return steps.stopped ? canceled() : no_memory(error);
  }
  out.weights = lods[0];
  if (!mesh.shapes.empty() &&
      !measure_weights(mesh, out.placement, lods[0], allocator, out.fitted_weights)) {
    return no_memory(error);
  }
  return Status::kOk;
}

}  // namespace mien::author
