// SPDX-License-Identifier: MIT
// How far apart two rigs of one character put its positions, over many poses.
#pragma once

#include <random>

#include "integrations/program/reduce/character.h"

namespace mien::cli {

struct LodProof {
  double worst = 0, rms = 0;  // in the unit of the file
  size_t pose = 0;            // the worst one
  uint32_t mesh = 0, position = 0;
};

struct Proof {
  size_t pose_count = 0;
  std::vector<LodProof> lods;
  std::string worst_pose;  // of all LODs, in shares of their tolerances
  double share = 0;        // the largest distance by the tolerance of its LOD
};

/// Each raw control at 1; the raw controls of each corrective at 1; then sparse poses: 2 to 10 % of the raw
/// controls at random values. Always the same ones. What is not set keeps its initial value.
class ProofPoses {
 public:
  explicit ProofPoses(const MienRig* rig);

  static constexpr size_t kSparse = 1000;
  size_t single_count() const { return raw_count_ + psd_count_; }
  size_t count() const { return single_count() + kSparse; }
  void set(size_t pose, MienMutableFloatView raw) const;
  std::string describe(size_t pose) const;

 private:
  const MienRig* rig_;
  uint32_t raw_count_, psd_count_;
  std::vector<float> initial_;
};

/// The tolerance of a LOD: the last one of the list serves all others.
double tolerance_at(const std::vector<double>& tolerances, uint32_t lod);

/// Compares all positions of all LODs in all poses. Stops at the first pose in which a distance exceeds
/// `limit` times its tolerance: then `share` is above `limit`, and the rest of the result incomplete.
Proof prove(Character& original, Character& reduced, const std::vector<double>& tolerances,
            double limit);

}  // namespace mien::cli
