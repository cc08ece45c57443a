// SPDX-License-Identifier: MIT
#include "integrations/program/gltf/morph_limit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace mien::gltf {

namespace {

double squared(const Float3& v) {
  return double{v[0]} * v[0] + double{v[1]} * v[1] + double{v[2]} * v[2];
}

/// Names of targets, those that move a vertex the furthest first.
std::vector<std::string> by_largest_move(const Scene& scene) {
  std::map<std::string, double> moves;
  std::vector<std::string> names;
  for (const Mesh& mesh : scene.meshes) {
    for (const MorphTarget& target : mesh.targets) {
      if (moves.count(target.name) == 0) names.push_back(target.name);
      double& most = moves[target.name];
      for (const Float3& move : target.positions) most = std::max(most, squared(move));
    }
  }
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return moves[a] > moves[b]; });
  return names;
}

/// Old numbers of the targets of a mesh that stay: with its correctives, those whose factors stay.
std::vector<uint32_t> staying(const Mesh& mesh, const std::set<std::string>& dropped) {
  std::vector<bool> stays;
  for (const MorphTarget& target : mesh.targets) stays.push_back(dropped.count(target.name) == 0);
  for (const Corrective& corrective : mesh.correctives) {
    if (!stays[corrective.product[0]] || !stays[corrective.product[1]]) {
      stays[corrective.target] = false;
    }
  }
  std::vector<uint32_t> numbers;
  for (uint32_t t = 0; t < stays.size(); ++t) {
    if (stays[t]) numbers.push_back(t);
  }
  return numbers;
}

}  // namespace

MorphLoss limit_morphs(size_t most, Scene& scene) {
  std::vector<std::string> names = by_largest_move(scene);
  MorphLoss loss;
  if (names.size() <= most) return loss;
  loss.names.assign(names.begin() + static_cast<std::ptrdiff_t>(most), names.end());
  const std::set<std::string> dropped(loss.names.begin(), loss.names.end());
  double sum = 0;
  size_t count = 0;
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    Mesh& mesh = scene.meshes[m];
    const std::vector<uint32_t> numbers = staying(mesh, dropped);
    const size_t before = mesh.targets.size();
    std::vector<uint32_t> places(before, kNone);
    std::vector<MorphTarget> targets;
    for (const uint32_t t : numbers) {
      places[t] = static_cast<uint32_t>(targets.size());
      targets.push_back(std::move(mesh.targets[t]));
    }
    for (uint32_t t = 0; t < before; ++t) {
      if (places[t] != kNone) continue;
      for (const Float3& move : mesh.targets[t].positions) {
        sum += squared(move);
        ++count;
        loss.max = std::max(loss.max, std::sqrt(squared(move)));
      }
    }
    mesh.targets = std::move(targets);
    std::vector<Corrective> correctives;
    for (const Corrective& c : mesh.correctives) {
      if (places[c.target] == kNone) continue;
      correctives.push_back({places[c.target], {places[c.product[0]], places[c.product[1]]}});
    }
    mesh.correctives = std::move(correctives);
    for (WeightTrack& track : scene.animation.weights) {
      if (track.mesh != m || before == 0) continue;
      std::vector<float> weights;
      for (size_t row = 0; row < track.weights.size(); row += before) {
        for (const uint32_t t : numbers) weights.push_back(track.weights[row + t]);
      }
      track.weights = std::move(weights);
    }
  }
  std::vector<WeightTrack>& tracks = scene.animation.weights;
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [](const WeightTrack& track) { return track.weights.empty(); }),
               tracks.end());
  if (count != 0) loss.rms = std::sqrt(sum / double(count));
  return loss;
}

}  // namespace mien::gltf
