// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/rig_skin.h"

#include <algorithm>
#include <cmath>

namespace mien::gltf {

namespace {

using math::Vec3d;

/// Each joint once, the heaviest first.
void merge(std::vector<Influence>& influences) {
  std::vector<Influence> merged;
  for (const Influence& influence : influences) {
    const auto same = std::find_if(merged.begin(), merged.end(), [&](const Influence& other) {
      return other.joint == influence.joint;
    });
    if (same == merged.end()) {
      merged.push_back(influence);
    } else {
      same->weight += influence.weight;
    }
  }
  std::sort(merged.begin(), merged.end(), [](const Influence& a, const Influence& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.joint < b.joint;
  });
  influences = std::move(merged);
}

/// As stored: the sum may be anything.
std::vector<Influence> stored_influences(const RigSource& source, uint32_t rig_mesh,
                                         uint32_t position) {
  MienIndex16View joints{};
  MienFloatView weights{};
  check(mien_deformer_influences(source.deformer(), rig_mesh, position, &joints, &weights),
        "cannot read skin weights");
  std::vector<Influence> influences;
  for (size_t i = 0; i < joints.count; ++i) {
    influences.push_back({joints.data[i], weights.data[i]});
  }
  merge(influences);
  return influences;
}

/// Weights that float sums of 8 stored values miss by rounding only.
constexpr double kRoundedSum = 1e-5;

/// Positive weights of sum 1.
void correct(std::vector<Influence>& influences, Losses& losses) {
  double stored = 0, positive = 0;
  for (const Influence& influence : influences) stored += influence.weight;
  while (!influences.empty() && !(influences.back().weight > 0)) influences.pop_back();
  for (const Influence& influence : influences) positive += influence.weight;
  const double correction = std::max(std::abs(1 - stored), positive - stored);
  if (correction > kRoundedSum) {
    ++losses.corrected_positions;
    losses.max_correction = std::max(losses.max_correction, correction);
  }
  for (Influence& influence : influences) influence.weight /= positive;
}

/// Floats of sum 1 to the last digit.
void round_weights(std::vector<Influence>& influences) {
  double rest = 1;
  for (Influence& influence : influences) {
    influence.weight = static_cast<float>(influence.weight);
    rest -= influence.weight;
  }
  influences[0].weight = static_cast<float>(influences[0].weight + rest);
}

/// Of each position of a mesh.
using MeshInfluences = std::vector<std::vector<Influence>>;

void fit(const RigSource& source, const SceneOptions& options, const RigScene& scene,
         std::vector<MeshInfluences>& meshes, Losses& losses) {
  std::vector<CrowdedPosition> crowded;
  std::vector<std::vector<Influence>*> origins;
  for (size_t m = 0; m < meshes.size(); ++m) {
    for (uint32_t p = 0; p < meshes[m].size(); ++p) {
      if (meshes[m][p].size() <= options.influences) continue;
      crowded.push_back({scene.rig_meshes[m], p, meshes[m][p]});
      origins.push_back(&meshes[m][p]);
    }
  }
  losses.places = options.influences;
  losses.crowded_positions = crowded.size();
  losses.skin = fit_influences(source, options.influences, crowded, options.progress);
  for (size_t i = 0; i < crowded.size(); ++i) *origins[i] = std::move(crowded[i].influences);
}

void write(const MienMesh& from, const MeshInfluences& positions, size_t places, Mesh& mesh) {
  mesh.influences = static_cast<uint32_t>(places);
  mesh.joints.assign(mesh.positions.size() * places, 0);
  mesh.weights.assign(mesh.positions.size() * places, 0);
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    const std::vector<Influence>& influences = positions[from.vertex_position_indices.data[v]];
    for (size_t k = 0; k < influences.size(); ++k) {
      mesh.joints[v * places + k] = influences[k].joint;
      mesh.weights[v * places + k] = static_cast<float>(influences[k].weight);
    }
  }
}

std::vector<MeshInfluences> read_skins(const RigSource& source, RigScene& result) {
  std::vector<MeshInfluences> meshes;
  for (const uint32_t rig_mesh : result.rig_meshes) {
    const MienMesh from = source.mesh(rig_mesh);
    MeshInfluences& positions = meshes.emplace_back();
    if (from.max_influences == 0) continue;
    for (uint32_t p = 0; p < from.position_count; ++p) {
      positions.push_back(stored_influences(source, rig_mesh, p));
      if (!positions.back().empty()) correct(positions.back(), result.losses);
    }
    result.losses.positions += positions.size();
  }
  return meshes;
}

void write_skins(const RigSource& source, std::vector<MeshInfluences>& meshes, size_t influences,
                 RigScene& result) {
  const size_t places = (influences + 3) / 4 * 4;  // as glTF stores them
  std::vector<Joint>& joints = result.scene.joints;
  const auto still = static_cast<uint16_t>(joints.size());
  bool needs_still = false;
  for (size_t m = 0; m < meshes.size(); ++m) {
    if (meshes[m].empty()) continue;
    for (std::vector<Influence>& position : meshes[m]) {
      needs_still = needs_still || position.empty();
      if (position.empty()) position = {{still, 1}};
      round_weights(position);
    }
    write(source.mesh(result.rig_meshes[m]), meshes[m], places, result.scene.meshes[m]);
  }
  if (!needs_still) return;
  if (joints.size() == 65536) {
    throw ExportError(MIEN_ERROR_DNA_LIMIT, "", "the rig has more than 65535 joints", "");
  }
  joints.emplace_back();
  joints.back().name = "still";
}

/// Where the joints are in the bind pose. Parents may follow their children.
std::vector<Vec3d> joint_origins(const std::vector<Joint>& joints) {
  std::vector<Vec3d> origins;
  for (const Joint& joint : joints) {
    math::Transform place = joint.bind;
    size_t depth = 0;
    for (uint32_t j = joint.parent; j != kNone && depth < joints.size(); j = joints[j].parent) {
      place = joints[j].bind * place;
      ++depth;
    }
    origins.push_back(place.translation);
  }
  return origins;
}

/// Of sum 1.
std::vector<Influence> heaviest(std::vector<Influence> influences, size_t most) {
  double sum = 0;
  influences.resize(most);
  for (const Influence& influence : influences) sum += influence.weight;
  for (Influence& influence : influences) influence.weight /= sum;
  return influences;
}

/// By how much a position is off, at most, when one of the joints turns by ten degrees about any axis.
double turn_error(const std::vector<Influence>& all, const std::vector<Influence>& kept,
                  const std::vector<Vec3d>& origins, const Vec3d& position) {
  constexpr double kChord = 0.17431;  // of ten degrees, for a radius of 1
  double most = 0;
  for (const Influence& influence : all) {
    double lost = influence.weight;
    for (const Influence& other : kept) {
      if (other.joint == influence.joint) lost -= other.weight;
    }
    most = std::max(most, std::abs(lost) * kChord * length(position - origins[influence.joint]));
  }
  return most;
}

}  // namespace

void add_skin(const RigSource& source, const SceneOptions& options, RigScene& result) {
  if (result.scene.joints.empty()) return;
  std::vector<MeshInfluences> meshes = read_skins(source, result);
  fit(source, options, result, meshes, result.losses);
  write_skins(source, meshes, options.influences, result);
}

void add_skin(const RigSource& source, const std::vector<uint32_t>& joint_of, uint32_t influences,
              RigScene& result) {
  std::vector<MeshInfluences> meshes = read_skins(source, result);
  const std::vector<Vec3d> origins = joint_origins(result.scene.joints);
  Losses& losses = result.losses;
  losses.places = influences;
  for (size_t m = 0; m < meshes.size(); ++m) {
    const MienMesh from = source.mesh(result.rig_meshes[m]);
    for (size_t p = 0; p < meshes[m].size(); ++p) {
      std::vector<Influence>& all = meshes[m][p];
      for (Influence& influence : all) {
        influence.joint = static_cast<uint16_t>(joint_of[influence.joint]);
      }
      merge(all);
      if (all.size() <= influences) continue;
      const std::vector<Influence> kept = heaviest(all, influences);
      ++losses.crowded_positions;
      double& most = losses.skin.residual.max;
      most =
          std::max(most, turn_error(all, kept, origins, source.point(from.positions.data + 3 * p)));
      all = kept;
    }
  }
  write_skins(source, meshes, influences, result);
}

}  // namespace mien::gltf
