// SPDX-License-Identifier: MIT
#include "integrations/program/reduce/tolerances.h"

#include <algorithm>
#include <cmath>

#include "integrations/program/io/controls.h"

namespace mien::cli {

double Tolerances::at(uint32_t lod, size_t region) const {
  if (region != 0) return regions[region - 1].tolerance;
  return lods[std::min<size_t>(lod, lods.size() - 1)];
}

size_t Tolerances::region_at(uint32_t mesh, uint32_t position) const {
  return region_of.empty() ? 0 : region_of[mesh][position];
}

double Tolerances::of_position(uint64_t lod_bits, uint32_t mesh, uint32_t position) const {
  const size_t region = region_at(mesh, position);
  double smallest = INFINITY;
  for (uint32_t lod = 0; lod < 64; ++lod) {
    if (lod_bits >> lod & 1) smallest = std::min(smallest, at(lod, region));
  }
  return smallest;
}

double Tolerances::least() const {
  double smallest = *std::min_element(lods.begin(), lods.end());
  for (const Region& region : regions) smallest = std::min(smallest, region.tolerance);
  return smallest;
}

void find_regions(const Character& character, Tolerances& tolerances) {
  tolerances.region_of.clear();
  if (tolerances.regions.empty()) return;
  const MienRig* rig = character.rig.get();
  const auto region_named = [&](const std::string& name) {
    size_t r = 0;
    while (r < tolerances.regions.size() && !matches_pattern(tolerances.regions[r].pattern, name)) {
      ++r;
    }
    return r;
  };
  std::vector<size_t> of_joint(rig_count(rig, MIEN_KIND_JOINT));
  for (uint32_t j = 0; j < of_joint.size(); ++j) {
    of_joint[j] = region_named(rig_name(rig, MIEN_KIND_JOINT, j));
  }
  std::vector<size_t> found(tolerances.regions.size() + 1);
  for (uint32_t m = 0; m < rig_count(rig, MIEN_KIND_MESH); ++m) {
    const size_t of_mesh = region_named(rig_name(rig, MIEN_KIND_MESH, m));
    const uint32_t count = character.mesh(m).position_count;
    std::vector<uint16_t>& regions = tolerances.region_of.emplace_back(count);
    for (uint32_t p = 0; p < count; ++p) {
      MienIndex16View joints{};
      MienFloatView weights{};
      character.influences(m, p, joints, weights);
      size_t region = of_mesh;
      if (joints.count != 0) {
        const float* const largest = std::max_element(weights.data, weights.data + weights.count);
        region = std::min(region, of_joint[joints.data[largest - weights.data]]);
      }
      ++found[region];
      if (region != tolerances.regions.size()) regions[p] = static_cast<uint16_t>(region + 1);
    }
  }
  for (size_t r = 0; r < tolerances.regions.size(); ++r) {
    if (found[r] != 0) continue;
    fail_usage("--region " + tolerances.regions[r].pattern,
               "no position belongs to it: no mesh has such a name, nor a joint that moves any "
               "position most, or earlier regions have them all",
               "mien info --names joints,meshes lists names");
  }
}

}  // namespace mien::cli
