// SPDX-License-Identifier: MIT
#include "author/weights/carriers.h"

#include <algorithm>

#include "author/base/dna_making.h"
#include "author/base/exact_math.h"
#include "author/mesh/point_tree.h"
#include "author/place/extra_joints.h"
#include "author/weights/body_weights.h"

namespace mien::author {

namespace {

constexpr double kOnSkin = 0.02;    // parts of the diagonal: lies on the skin
constexpr double kFar = 0.05;       // no longer follows it
constexpr double kRigid = 0.05;     // part of the motion that is not rigid
constexpr double kWithChin = 0.30;  // part of the chin's motion
constexpr double kMoves = 1e-3;     // part of the diagonal: less motion counts as rest

struct Carried {
  Carrier carrier = Carrier::kRigid;
  uint32_t bone = 0;
};

Vec3 moved(const Shape& shape, uint32_t v) {
  const Vec3f d = shape.displacements[v];
  return {d.x, d.y, d.z};
}

/// True if shapes move these vertices rigidly. Points and targets are scratch memory for all of
/// them.
bool moves_rigidly(const AuthorMesh& mesh, Span<const uint32_t> vertices, Span<Vec3> points,
                   Span<Vec3> targets) {
  double motion = 0, rest = 0;
  for (const Shape& shape : mesh.shapes) {
    double here = 0;
    for (size_t i = 0; i < vertices.count; ++i) {
      const Vec3 d = moved(shape, vertices[i]);
      points[i] = mesh.positions[vertices[i]];
      targets[i] = points[i] + d;
      here += dot(d, d);
    }
    if (here == 0) continue;
    motion += here;
    const RigidMotion rigid =
        fit_rigid(points.first(vertices.count), targets.first(vertices.count));
    for (size_t i = 0; i < vertices.count; ++i) {
      const Vec3 off = targets[i] - rigid(points[i]);
      rest += dot(off, off);
    }
  }
  return rest <= kRigid * motion;
}

/// Joints from the root of the tongue to its tip.
struct TongueChain {
  uint32_t bones[Tongue::kJoints];
  uint32_t count = 0;

  void add(uint32_t bone) {
    if (count < Tongue::kJoints) bones[count++] = bone;
  }
  /// Two neighbors share what lies between them.
  void share(const Placement& placement, Vec3 p, InfluenceList& list) const {
    const auto depth = [&](uint32_t i) { return placement.bones[bones[i]].position.z; };
    uint32_t i = 0;
    while (i + 1 < count && p.z > depth(i + 1)) ++i;
    const double t = i + 1 < count ? smooth_step(depth(i), depth(i + 1), p.z) : 0;
    list.add(bones[i], 1 - t);
    if (i + 1 < count) list.add(bones[i + 1], t);
  }
};

/// True if there is skin on both sides of most of these vertices, as there is of teeth.
bool is_between_cheeks(const AuthorMesh& mesh, Span<const uint32_t> vertices) {
  constexpr size_t kSamples = 16;
  const size_t step = vertices.count / kSamples + 1;
  size_t inside = 0, all = 0;
  for (size_t i = 0; i < vertices.count; i += step, ++all) {
    const Vec3 p = mesh.positions[vertices[i]];
    bool has[2] = {false, false};
    for (size_t t = 0; t + 2 < mesh.triangles.count && !(has[0] && has[1]); t += 3) {
      const uint32_t* c = mesh.triangles.data + t;
      if (!mesh.is_skin[c[0]]) continue;
      double area[3], sum = 0, x = 0;
      for (int k = 0; k < 3; ++k) {
        const Vec3 a = mesh.positions[c[(k + 1) % 3]] - p, b = mesh.positions[c[(k + 2) % 3]] - p;
        area[k] = a.y * b.z - a.z * b.y;
        sum += area[k];
        x += area[k] * (mesh.positions[c[k]].x - p.x);
      }
      const bool is_hit = (area[0] > 0 && area[1] > 0 && area[2] > 0) ||
                          (area[0] < 0 && area[1] < 0 && area[2] < 0);
      if (is_hit) has[x / sum > 0] = true;
    }
    inside += has[0] && has[1];
  }
  return 2 * inside > all;
}

}  // namespace

bool carry_components(const AuthorMesh& mesh, const Placement& placement, uint32_t head,
                      Arena& scratch, SkinWeights& out, WeightReport* report) {
  const size_t n = mesh.positions.count;
  if (mesh.component_count < 2) return true;
  Span<uint32_t> ends, members, eye_of, skin;
  Span<Vec3> points, targets, skin_points;
  if (!make(scratch, mesh.component_count + 1, ends) || !make(scratch, n, members) ||
      !make(scratch, mesh.component_count, eye_of) || !make(scratch, n, skin) ||
      !make(scratch, n, points) || !make(scratch, n, targets) || !make(scratch, n, skin_points)) {
    return false;
  }
  Eye eyes[kMaxEyes];
  uint32_t eye_count = 0;
  if (!find_eyes(mesh, placement.symmetry_plane, placement.symmetric, scratch, eyes, eye_count,
                 eye_of)) {
    return false;
  }
  for (uint32_t v = 0; v < n; ++v) ++ends[mesh.component[v] + 1];
  for (uint32_t c = 0; c < mesh.component_count; ++c) ends[c + 1] += ends[c];
  // ends[c] is the start of component c, and its end once its members are filled in.
  size_t skin_count = 0;
  for (uint32_t v = 0; v < n; ++v) {
    members[ends[mesh.component[v]]++] = v;
    if (!mesh.is_skin[v] || mesh.welded[v] != v) continue;
    skin[skin_count] = v;
    skin_points[skin_count++] = mesh.positions[v];
  }
  PointTree tree;
  if (!tree.build(skin_points.first(skin_count), scratch)) return false;

  // How far the chin moves when the jaw opens: the mean of the 200 that move most, as for the
  // joint.
  Jaw jaw;
  if (!find_jaw(mesh, placement.symmetry_plane, scratch, jaw)) return false;
  uint32_t jaw_bone = kNone;
  for (uint32_t b = 0; b < placement.bones.count; ++b) {
    if (placement.bones[b].kind == BoneKind::kJaw) jaw_bone = b;
  }

  Tongue tongue;
  if (!find_tongue(mesh, scratch, tongue)) return false;
  TongueChain tongue_bones;
  for (uint32_t b = 0; b < placement.bones.count; ++b) {
    if (placement.bones[b].kind == BoneKind::kTongue) tongue_bones.add(b);
  }

  const BodyChain body = body_chain(placement);
  for (uint32_t c = 0, from = 0; c < mesh.component_count; from = ends[c++]) {
    const Span<const uint32_t> all = members.slice(from, ends[c] - from);
    if (all.empty() || mesh.is_skin[all[0]]) continue;
    if (c == tongue.component && tongue_bones.count > 0) {
      if (report) {
        ++report->rigid_components;
        continue;
      }
      for (uint32_t v : all) {
        InfluenceList list;
        tongue_bones.share(placement, mesh.positions[v], list);
        store(list, v, out);
      }
      continue;
    }
    Carried part = {Carrier::kRigid, head};
    if (eye_of[c] != kNone) {
      for (uint32_t b = 0; b < placement.bones.count; ++b) {
        const Eye& eye = eyes[eye_of[c]];
        if (placement.bones[b].kind == BoneKind::kEye &&
            length(placement.bones[b].position - eye.center) <= eye.radius) {
          part.bone = b;
        }
      }
    } else {
      if (jaw_bone != kNone && jaw.shape != kNone && jaw.chin_motion > 0) {
        double motion = 0;
        for (uint32_t v : all) motion += length(moved(mesh.shapes[jaw.shape], v));
        if (motion > kWithChin * jaw.chin_motion * static_cast<double>(all.count)) {
          part.bone = jaw_bone;
        }
      }
      if (jaw_bone != kNone && !placement.jaw_share.empty()) {
        double share = 0;
        for (uint32_t v : all) share += double{placement.jaw_share[v]};
        if (share > 0.5 * static_cast<double>(all.count)) part.bone = jaw_bone;
      }
      bool follows;
      if (mesh.shapes.empty()) {
        size_t near = 0;
        for (uint32_t v : all) {
          near += tree.nearest(mesh.positions[v]).squared_distance <=
                  kOnSkin * kOnSkin * mesh.diagonal * mesh.diagonal;
        }
        follows = near * 20 >= all.count * 19 &&
                  (placement.jaw_share.empty() || !is_between_cheeks(mesh, all));
      } else {
        double farthest = 0;
        for (const Shape& shape : mesh.shapes) {
          for (uint32_t v : all) farthest = std::max(farthest, length(moved(shape, v)));
        }
        // The joint of the head never moves; the jaw moves rigidly.
        follows = farthest > kMoves * mesh.diagonal &&
                  (part.bone != jaw_bone || !moves_rigidly(mesh, all, points, targets));
      }
      if (follows) part.carrier = Carrier::kNearestSkin;
    }
    if (report) {
      report->rigid_components += part.carrier == Carrier::kRigid;
      report->following_components += part.carrier == Carrier::kNearestSkin;
      continue;
    }
    Vec3 mean;
    for (uint32_t v : all) mean = mean + mesh.positions[v];
    // A collar or a necklace bends with the neck.
    const bool is_on_body =
        part.bone == head &&
        height_in_neck(placement, mean * (1 / static_cast<double>(all.count))) < 1;
    for (uint32_t v : all) {
      InfluenceList list;
      double rigid = 1;
      if (part.carrier == Carrier::kNearestSkin) {
        const Near near = tree.nearest(mesh.positions[v]);
        rigid = smooth_step(kOnSkin, kFar, std::sqrt(near.squared_distance) / mesh.diagonal);
        const InfluenceList there = load(skin[near.point], out);
        for (uint32_t i = 0; i < there.count; ++i) {
          list.add(there.joints[i], there.values[i] * (1 - rigid));
        }
      }
      if (is_on_body) {
        double shares[BodyChain::kCapacity];
        share_body(body, height_in_neck(placement, mesh.positions[v]),
                   front_of_neck(placement, mesh.positions[v]), shares);
        for (uint32_t i = 0; i < body.count; ++i) list.add(body.bones[i], rigid * shares[i]);
      } else {
        list.add(part.bone, rigid);
      }
      store(list, v, out);
    }
  }
  return true;
}

}  // namespace mien::author
