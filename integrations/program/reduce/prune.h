// SPDX-License-Identifier: MIT
// Removes what moves positions least.
#pragma once

#include <mien_author.h>

#include "integrations/program/reduce/sensitivity.h"

namespace mien::cli {

/// What moves no position by more than this share of its tolerance is removed.
struct PruneLimits {
  double matrix = 0;    // blocks of the joint matrix
  double deformer = 0;  // deltas of blend shape targets, and influences of positions
};

/// A joint group as in the file.
struct PrunedGroup {
  std::string path;  // of its values
  std::vector<int64_t> inputs, outputs, lods;
  std::vector<float> values;  // [row][column]
};

class Pruning {
 public:
  Pruning(const MienDna* dna, Character& original, const Tolerances& tolerances);

  /// The original without what is below the limits.
  Dna prune(const PruneLimits& limits);

  uint64_t matrix_entries = 0, deltas = 0, influences = 0;  // that the last result has

 private:
  void prune_matrix(double limit);
  bool prune_blocks(const PrunedGroup& group, double limit, std::vector<float>& values) const;
  void prune_weights(uint32_t mesh, double limit);

  Character& original_;
  std::unique_ptr<MienDocument, Destroy<MienDocument, mien_document_destroy>> document_;
  std::vector<PrunedGroup> groups_;
  std::vector<JointReach> reaches_;
  std::vector<std::vector<float>> influence_importance_;  // [mesh]
  double least_tolerance_;
  double radians_;  // in a rotation unit
};

}  // namespace mien::cli
