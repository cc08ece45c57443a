// SPDX-License-Identifier: MIT
// Regions of the face: joints that are near each other and move alike. Each becomes a joint group,
// a dense block of the joint matrix, which only has the controls that own the region.
#pragma once

#include "author/fit/fit_shapes.h"

namespace mien::author {

struct JointRegions {
  Span<uint16_t> region;  // by bone; kNoRegion for those that are never moved
  uint32_t count = 0;

  static constexpr uint16_t kNoRegion = 0xFFFF;
};

/// With this many rows of a group, padding to 4 rows costs less than 2 %.
constexpr uint32_t kRowsPerGroup = 75;
constexpr uint32_t kMaxRegions = 24;      // that are found
constexpr uint32_t kMaxOwnRegions = 256;  // of a caller

/// Average linkage of facial bones on distance and similarity of motion; the halves of a symmetric
/// face get mirrored regions. If `wanted` is 0, regions have about kRowsPerGroup rows each;
/// there are at most kMaxRegions, and one for bones on the plane. The jaw, each eye and each bone of the
/// tongue get regions of their own.
/// False if memory ran out.
bool find_regions(const Placement& placement, const Footprints& footprints, const Motions& motions,
                  uint32_t wanted, Arena& arena, const Allocator& allocator, JointRegions& out);

/// The caller's regions, one number for each bone, below kMaxOwnRegions. Those without fitted bones
/// are left out. False if memory ran out.
bool take_regions(const Placement& placement, Span<const uint8_t> own, Arena& arena,
                  JointRegions& out);

/// Effect of a bone's motion on its footprint, as a length: of its translation, and of its rotation
/// times the root mean square distance from the bone.
double effect_of(const Bone& bone, const Moments& moments, const Affine& motion);

struct PruneReport {
  uint32_t outliers = 0;  // entries of regions that their control does not own
  uint32_t faint = 0;     // entries with an effect below the least one
};

/// A control owns regions with at least this share of its squared effect. Leaving one out adds an
/// error of up to the square root of it, 3 %.
constexpr double kOwnedShare = 0.001;

/// Clears entries of regions that the control does not own, and those with less than
/// `least_effect`. `full`: then marks all bones of owned regions as active.
PruneReport prune(const Placement& placement, const Footprints& footprints,
                  const JointRegions& regions, double least_effect, bool full, size_t control,
                  const Motions& motions);

/// Average linkage on a matrix of `count` rows of distances, which is destroyed: merges the two
/// groups with the smallest mean distance until `groups` are left; of equal ones the first.
/// Numbers them by their first members. False if memory ran out.
bool link_by_distance(Span<double> matrix, uint32_t count, uint32_t groups, Arena& scratch,
                      uint16_t* out);

}  // namespace mien::author
