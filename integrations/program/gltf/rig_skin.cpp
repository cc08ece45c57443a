// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/rig_skin.h"

#include <algorithm>
#include <cmath>

namespace mien::gltf {

namespace {

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

void write_skins(const RigSource& source, std::vector<MeshInfluences>& meshes, size_t places,
                 RigScene& result) {
  std::vector<Joint>& joints = result.scene.joints;
  const auto still = static_cast<uint16_t>(joints.size());
  bool needs_still = false;
  for (size_t m = 0; m < meshes.size(); ++m) {
    if (meshes[m].empty()) continue;
    for (std::vector<Influence>& influences : meshes[m]) {
      needs_still = needs_still || influences.empty();
      if (influences.empty()) influences = {{still, 1}};
      round_weights(influences);
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

}  // namespace

void add_skin(const RigSource& source, const SceneOptions& options, RigScene& result) {
  if (result.scene.joints.empty()) return;
  std::vector<MeshInfluences> meshes = read_skins(source, result);
  fit(source, options, result, meshes, result.losses);
  write_skins(source, meshes, options.influences, result);
}

void add_skin(const RigSource& source, const std::vector<uint32_t>& joint_of, RigScene& result) {
  constexpr size_t kPlaces = 4;
  std::vector<MeshInfluences> meshes = read_skins(source, result);
  for (MeshInfluences& mesh : meshes) {
    for (std::vector<Influence>& influences : mesh) {
      for (Influence& influence : influences) {
        influence.joint = static_cast<uint16_t>(joint_of[influence.joint]);
      }
      merge(influences);
      double sum = 0;
      if (influences.size() > kPlaces) influences.resize(kPlaces);
      for (const Influence& influence : influences) sum += influence.weight;
      for (Influence& influence : influences) influence.weight /= sum;
    }
  }
  write_skins(source, meshes, kPlaces, result);
}

}  // namespace mien::gltf
