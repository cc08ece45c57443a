// SPDX-License-Identifier: MIT
// What attached meshes lose by targets: measure_attached() of expression_bake.h.
#include <algorithm>

#include "integrations/program/gltf/bake_poses.h"
#include "integrations/program/gltf/expression_bake.h"

namespace mien::gltf {

namespace {

/// A baked scene with what is attached to it, in the pose of the rig.
class Followers {
 public:
  Followers(const RigSource& source, const RigScene& scene, const std::vector<Attached>& attached)
      : source_(source), scene_(scene), attached_(attached), places_(scene.scene.meshes.size()) {}

  /// Vertices of all attached meshes, by number of mesh. Meshes attach to those before them.
  template <class Deform>
  const std::vector<std::vector<math::Vec3d>>& follow(Face& face, const Deform& deform) {
    std::fill(places_.begin(), places_.end(), std::vector<math::Vec3d>());
    for (const Attached& mesh : attached_) {
      if (mesh.base < scene_.rig_meshes.size() && places_[mesh.base].empty()) {
        const uint32_t rig_mesh = scene_.rig_meshes[mesh.base];
        const MienMesh from = source_.mesh(rig_mesh);
        deform(rig_mesh, finest_lod(from));
        const std::vector<float> positions = face.positions(rig_mesh);
        for (uint32_t v = 0; v < from.vertex_count; ++v) {
          const size_t p = from.vertex_position_indices.data[v];
          places_[mesh.base].push_back(source_.point(positions.data() + 3 * p));
        }
      }
      places_[mesh.mesh] = mesh.follow(places_[mesh.base]);
    }
    return places_;
  }

 private:
  const RigSource& source_;
  const RigScene& scene_;
  const std::vector<Attached>& attached_;
  std::vector<std::vector<math::Vec3d>> places_;
};

/// What a viewer adds to the neutral vertices.
std::vector<math::Vec3d> sum_of_targets(const Mesh& mesh, const Weights& weights, bool corrected) {
  std::vector<math::Vec3d> moves(mesh.positions.size());
  const auto add = [&](const MorphTarget& target, double weight) {
    for (size_t i = 0; i < target.vertices.size() && weight != 0; ++i) {
      const Float3& move = target.positions[i];
      moves[target.vertices[i]] += math::Vec3d{move[0], move[1], move[2]} * weight;
    }
  };
  for (size_t e = 0; e < weights.size() && e < mesh.targets.size(); ++e) {
    add(mesh.targets[e], weights[e]);
  }
  for (const Corrective& pair : mesh.correctives) {
    if (corrected)
      add(mesh.targets[pair.target], weights[pair.product[0]] * weights[pair.product[1]]);
  }
  return moves;
}

Distances distances_of(const std::vector<math::Vec3d>& posed, const std::vector<math::Vec3d>& from,
                       const std::vector<math::Vec3d>& moves) {
  Distances distances;
  for (size_t v = 0; v < posed.size(); ++v) {
    const math::Vec3d off = posed[v] - from[v] - moves[v];
    distances.add(dot(off, off));
  }
  return distances;
}

}  // namespace

void measure_attached(const RigSource& source, const RigExpressions& set, const RigScene& scene,
                      const std::vector<Attached>& attached, BakeReport& report,
                      const std::function<void(double share)>& progress) {
  if (attached.empty()) return;
  const size_t count = set.expressions.size(), first = report.followers.size();
  Face face(source, set);
  Followers followers(source, scene, attached);
  struct Sums {
    std::vector<Distances> halfway, combined;
    Distances together, corrected;
  };
  std::vector<Sums> sums(attached.size());
  for (Sums& sum : sums) {
    sum.halfway.resize(count);
    sum.combined.resize(count);
  }
  const auto mesh_of = [&](size_t a) -> const Mesh& {
    return scene.scene.meshes[attached[a].mesh];
  };
  const auto controls = [&](const std::vector<ControlValue>& values) {
    return followers.follow(face, [&](uint32_t rig_mesh, uint32_t lod) {
      face.deform(rig_mesh, lod, times(values, 0.5f), false);
    });
  };
  Weights weights(count);
  for (size_t e = 0; e < count; ++e) {
    const auto base = controls(set.expressions[e].minus), posed = controls(set.expressions[e].plus);
    weights[e] = 0.5;
    for (size_t a = 0; a < attached.size(); ++a) {
      const uint32_t m = attached[a].mesh;
      sums[a].halfway[e] =
          distances_of(posed[m], base[m], sum_of_targets(mesh_of(a), weights, false));
    }
    weights[e] = 0;
  }
  const auto neutral = controls({});
  Combinations combinations(set);
  for (uint32_t i = 0; i < kCombinations; ++i) {
    if (progress) progress(double(i) / kCombinations);
    combinations.draw(weights);
    const auto& posed = followers.follow(
        face, [&](uint32_t rig_mesh, uint32_t lod) { face.deform(rig_mesh, lod, weights, false); });
    for (size_t a = 0; a < attached.size(); ++a) {
      const uint32_t m = attached[a].mesh;
      const Distances off =
          distances_of(posed[m], neutral[m], sum_of_targets(mesh_of(a), weights, false));
      sums[a].together.add(off);
      add_to_active(off, weights, sums[a].combined);
      sums[a].corrected.add(
          distances_of(posed[m], neutral[m], sum_of_targets(mesh_of(a), weights, true)));
    }
  }
  for (size_t a = 0; a < attached.size(); ++a) {
    report.followers.push_back(
        {mesh_of(a).name, {}, {}, sums[a].together.residual(1), sums[a].corrected.residual(1)});
    BakeReport::Follower& follower = report.followers[first + a];
    for (const Distances& distances : sums[a].halfway) {
      follower.halfway.push_back(distances.residual(1));
    }
    for (const Distances& distances : sums[a].combined) {
      follower.combined.push_back(distances.residual(1));
    }
  }
}

}  // namespace mien::gltf
