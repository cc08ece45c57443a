// SPDX-License-Identifier: MIT
#include "author/rigging/own_stages.h"

#include <cmath>
#include <cstring>

#include "author/base/dna_making.h"
#include "author/base/joint_motion.h"
#include "author/place/rank.h"

namespace mien::author {

namespace {

// Joint values have 16-bit numbers, nine for each joint.
constexpr uint32_t kMaxBones = 65536 / 9;
constexpr size_t kMaxName = 200;

Status no_memory(Error& error) {
  return fail(error, Status::kMemory, kNoOffset, "no memory for the rig");
}

/// True if expressions move the bone. Its ancestors were checked.
bool is_moved(Span<const OwnBone> bones, uint32_t b) {
  Bone bone;
  bone.kind = bones[b].kind;
  return is_fitted(bone);
}

}  // namespace

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

Status read_landmarks(const MeshSource& source, const RiggingOptions& options, Landmarks& out,
                      Error& error) {
  for (const OwnLandmark& own : options.landmarks) {
    Landmark* mark = nullptr;
    for (uint32_t k = 0; k < kLandmarkCount; ++k) {
      const char* name = kLandmarkNames[k];
      const bool is_it =
          own.name.count == strlen(name) && memcmp(own.name.data, name, own.name.count) == 0;
      if (is_it) mark = &out.of[k];
    }
    const int length = static_cast<int>(std::min<size_t>(own.name.count, 60));
    if (!mark || mark->given) {
      return fail(error, Status::kAuthorMesh, kNoOffset, "landmark \"%.*s\" is %s", length,
                  own.name.data ? own.name.data : "",
                  mark ? "given twice" : "unknown; docs/authoring.md lists the names");
    }
    const Vec3 at = {own.position[0], own.position[1], own.position[2]};
    mark->at = source.frame.to_internal(at * source.unit);
    if (!(dot(mark->at, mark->at) < 1e24)) {
      return fail(error, Status::kAuthorMesh, kNoOffset, "landmark \"%.*s\" is not at a number",
                  length, own.name.data);
    }
    mark->known = mark->given = true;
    mark->confidence = 1;
  }
  return Status::kOk;
}

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
  out.jaw_share = {};
  return Status::kOk;
}

Status take_weights(const ReadMesh& read, const RiggingOptions& options, size_t sources,
                    Arena& arena, SkinWeights& out, Error& error) {
  const size_t m = options.influences;
  const OwnWeights& own = options.weights;
  if (own.weights.count != sources * m || own.joints.count != sources * m) {
    return fail(error, Status::kAuthorMesh, kNoOffset,
                "%zu weights and %zu joints: %zu positions with %zu influences are expected",
                own.weights.count, own.joints.count, sources, m);
  }
  const size_t n = read.mesh.positions.count;
  out.m = options.influences;
  if (!make(arena, n * m, out.joints) || !make(arena, n * m, out.weights)) return no_memory(error);
  for (size_t v = 0; v < n; ++v) {
    const size_t from = read.source_vertices[v] * m;
    double sum = 0;
    for (size_t i = 0; i < m; ++i) {
      const float weight = own.weights[from + i];
      if (!(weight >= 0 && weight < 1e15f) || own.joints[from + i] >= options.bones.count) {
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
      // The largest come first.
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

Status take_bytes(const ReadMesh& read, Span<const uint8_t> own, Arena& arena,
                  Span<const uint8_t>& out, Error& error) {
  const Span<const uint32_t> sources = read.source_vertices;
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

}  // namespace mien::author
