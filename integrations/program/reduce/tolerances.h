// SPDX-License-Identifier: MIT
// How far positions may be off, by LOD and by region.
#pragma once

#include "integrations/program/reduce/character.h"

namespace mien::cli {

/// A tolerance of its own for positions of a mesh, or those that a joint moves most.
struct Region {
  std::string pattern;  // of the name of the mesh or joint, see matches_pattern()
  double tolerance;
};

/// In the unit of the file.
struct Tolerances {
  std::vector<double> lods;  // the last one serves the LODs after it
  std::vector<Region> regions;
  std::vector<std::vector<uint16_t>>
      region_of;  // [mesh][position]: 1 + region, 0 for none; empty if there are no regions

  Tolerances(std::vector<double> of_lods) : lods(std::move(of_lods)) {}
  Tolerances(std::initializer_list<double> of_lods) : lods(of_lods) {}

  /// `region` as in region_of.
  double at(uint32_t lod, size_t region) const;
  size_t region_at(uint32_t mesh, uint32_t position) const;
  /// The smallest one of a position, over the LODs whose bits are set.
  double of_position(uint64_t lod_bits, uint32_t mesh, uint32_t position) const;
  double least() const;
};

/// Sets region_of: each position belongs to the first region whose pattern matches the name of its mesh, or that of
/// the joint with the largest weight. Fails if a pattern matches no position.
void find_regions(const Character& character, Tolerances& tolerances);

}  // namespace mien::cli
