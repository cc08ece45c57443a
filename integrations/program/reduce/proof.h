// SPDX-License-Identifier: MIT
// How far apart two rigs of one character put its positions, over many poses.
#pragma once

#include <random>

#include "integrations/program/reduce/tolerances.h"

namespace mien::cli {

struct LodProof {
  double worst = 0, rms = 0;  // in the unit of the file
  size_t pose = 0;            // the worst one
  uint32_t mesh = 0, position = 0;
};

/// Over all LODs.
struct RegionProof {
  double worst = 0, share = 0;  // the largest share of its tolerance, and the distance there
  size_t pose = 0;
  uint32_t lod = 0, mesh = 0, position = 0;
  std::string shown_pose;
};

/// Distances at LOD 0, for images: [mesh][position] in the unit of the file. Meshes of other LODs have none.
struct ProofMap {
  std::vector<float> raw;  // controls of the worst pose
  std::vector<std::vector<float>> in_worst_pose, largest;
};

struct Proof {
  size_t pose_count = 0;
  ProofMap map;
  std::vector<LodProof> lods;
  std::vector<RegionProof> regions;  // those without a region, then each region
  std::string worst_pose;            // of all LODs, in shares of their tolerances
  double share = 0;                  // the largest distance by the tolerance of its LOD
};

/// Frames that the caller gives.
struct ProofTake {
  std::string shown;                       // the file
  std::vector<std::vector<float>> frames;  // raw controls
};

/// Each raw control at 1; the raw controls of each corrective at 1; then sparse poses: 2 to 10 % of the raw
/// controls at random values; then performances. Always the same ones. What is not set keeps its initial value.
class ProofPoses {
 public:
  ProofPoses(const MienRig* rig, const std::vector<ProofTake>& performances);

  static constexpr size_t kSparse = 1000;
  size_t single_count() const { return raw_count_ + psd_count_; }
  size_t count() const { return single_count() + kSparse + frame_count_; }
  void set(size_t pose, MienMutableFloatView raw) const;
  std::string describe(size_t pose) const;

 private:
  /// The performance of a pose, which becomes the number of its frame; null for other poses.
  const ProofTake* performance_of(size_t& pose) const;

  const MienRig* rig_;
  const std::vector<ProofTake>& performances_;
  uint32_t raw_count_, psd_count_;
  size_t frame_count_ = 0;
  std::vector<float> initial_;
};

/// Compares all positions of all LODs in all poses. Stops at the first pose in which a distance exceeds
/// `limit` times its tolerance: then `share` is above `limit`, and the rest of the result incomplete.
Proof prove(Character& original, Character& reduced, const Tolerances& tolerances, double limit,
            const std::vector<ProofTake>& performances = {});

}  // namespace mien::cli
