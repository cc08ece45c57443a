// SPDX-License-Identifier: MIT
// Targets of one run of `mien solve` as the arrays of a fit: the points of one target after those of the other.
#pragma once

#include "integrations/program/commands/solve_target.h"

namespace mien::cli {

/// The points that --mask leaves. Steps look at samples of the points of a fit, so it has no others.
std::vector<uint32_t> list_used_points(const SolveTarget& target);

/// Moves the numbers of the points of a fit to the front.
void keep_used(const std::vector<uint32_t>& used, size_t per_point, float* row);

class FitTargets {
 public:
  /// `weights` are those of --weights: one for each target, or none. The targets outlive this.
  FitTargets(const std::vector<SolveTarget>& targets, const std::vector<float>& weights);

  /// Points and weights of joint values, which live as long as this.
  void describe(MienFitDesc& desc) const;
  /// Arrays and weights that all frames share.
  void begin(MienFitFrame& frame);
  /// The numbers of a frame.
  void read(size_t frame, MienFitFrame& out);

  /// Data of the first target: what weights of other terms are relative to.
  float amount() const { return amount_; }
  const MienFitCamera* camera() const { return camera_; }
  /// What was read of the first target.
  const std::vector<float>& row() const { return parts_[0].row; }
  const SurfaceMesh& surface() const { return surface_; }

 private:
  struct Part {
    const SolveTarget* target;
    std::vector<uint32_t> used;  // of its points
    size_t first;                // of these in the fit
    std::vector<float> row;
  };

  std::vector<Part> parts_;
  std::vector<MienSolvePoint> points_;
  std::vector<float> point_weights_, surface_weights_;  // empty: 1
  std::vector<float> joint_weights_, offsets_;
  float joint_weight_ = 0, amount_ = 0;
  const MienFitCamera* camera_ = nullptr;
  std::vector<float> joints_, places_, images_;  // of a frame; empty: no target of the kind
  SurfaceMesh surface_;
  FitSurface fit_surface_;
};

/// The residual of the targets of a kind, and the largest one that counts.
struct KindResidual {
  double rms = 0, worst = 0;
};
KindResidual residual_of(const MienFitResult& result, TargetKind kind);

}  // namespace mien::cli
