// SPDX-License-Identifier: MIT
#include "integrations/program/commands/solve_mix.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mien::cli {

namespace {

/// Numbers of a point in a frame; 0: a surface, or joints.
size_t width_of(const SolveTarget& target) {
  return target.points.empty() ? 0 : target.width / target.points.size();
}

float amount_of(const SolveTarget& target) {
  if (!target.weights.empty()) {
    return std::accumulate(target.weights.begin(), target.weights.end(), 0.0f);
  }
  return static_cast<float>(target.points.empty() ? target.width : target.points.size());
}

}  // namespace

std::vector<uint32_t> list_used_points(const SolveTarget& target) {
  std::vector<uint32_t> used;
  for (uint32_t i = 0; i < target.points.size(); ++i) {
    if (target.weights.empty() || target.weights[i] > 0) used.push_back(i);
  }
  return used;
}

void keep_used(const std::vector<uint32_t>& used, size_t per_point, float* row) {
  for (size_t i = 0; i < used.size(); ++i) {
    std::copy_n(row + per_point * used[i], per_point, row + per_point * i);
  }
}

FitTargets::FitTargets(const std::vector<SolveTarget>& targets, const std::vector<float>& weights)
    : amount_(amount_of(targets[0])) {
  const bool several = targets.size() > 1;
  for (const SolveTarget& target : targets) {
    parts_.push_back({&target, list_used_points(target), points_.size(), {}});
    for (const uint32_t i : parts_.back().used) points_.push_back(target.points[i]);
  }
  for (size_t t = 0; t < targets.size(); ++t) {
    const SolveTarget& target = targets[t];
    const Part& part = parts_[t];
    const float own = amount_of(target);
    const float scale = (weights.empty() ? 1.0f : weights[t]) * (own > 0 ? amount_ / own : 1.0f);
    if (target.kind == TargetKind::kJoints) {
      joints_.resize(target.width);
      joint_weight_ = several ? scale : 0;
      joint_weights_ = target.weights;
      if (joint_weights_.empty() && several) joint_weights_.assign(target.width, 1.0f);
      continue;
    }
    const bool surface = target.kind == TargetKind::kSurface;
    if (several || !target.weights.empty()) {
      std::vector<float>& to = surface && several ? surface_weights_ : point_weights_;
      to.resize(points_.size(), surface ? 0.0f : 1.0f);
      for (size_t i = 0; i < part.used.size(); ++i) {
        const float mask = target.weights.empty() ? 1.0f : target.weights[part.used[i]];
        to[part.first + i] = mask * scale;
      }
    }
    if (target.kind == TargetKind::kLandmarks2) {
      images_.assign(2 * points_.size(), NAN);
      camera_ = target.camera ? &*target.camera : nullptr;
    } else if (!surface) {
      places_.assign(3 * points_.size(), NAN);
    }
  }
  if (!targets[0].point_offsets.empty()) {
    offsets_ = targets[0].point_offsets;
    keep_used(parts_[0].used, 3, offsets_.data());
  }
}

void FitTargets::describe(MienFitDesc& desc) const {
  desc.points = points_.data();
  desc.point_count = points_.size();
  if (!joint_weights_.empty()) desc.joint_weights = joint_weights_.data();
}

void FitTargets::begin(MienFitFrame& frame) {
  frame.joints = joints_.empty() ? nullptr : joints_.data();
  frame.points = places_.empty() ? nullptr : places_.data();
  frame.images = images_.empty() ? nullptr : images_.data();
  frame.joint_weight = joint_weight_;
  frame.point_weights = point_weights_.empty() ? nullptr : point_weights_.data();
  frame.surface_weights = surface_weights_.empty() ? nullptr : surface_weights_.data();
  frame.point_offsets = offsets_.empty() ? nullptr : offsets_.data();
}

void FitTargets::read(size_t frame, MienFitFrame& out) {
  for (Part& part : parts_) {
    const SolveTarget& target = *part.target;
    if (target.kind == TargetKind::kSurface) {
      surface_ = target.read_surface(frame);
      fit_surface_ = create_surface(surface_);
      out.surface = fit_surface_.get();
      continue;
    }
    part.row.resize(target.width);
    target.read(frame, part.row.data());
    if (target.kind == TargetKind::kJoints) {
      joints_ = part.row;
      out.joints = joints_.data();
      continue;
    }
    const size_t width = width_of(target);
    std::vector<float>& to = target.kind == TargetKind::kLandmarks2 ? images_ : places_;
    for (size_t i = 0; i < part.used.size(); ++i) {
      std::copy_n(part.row.data() + width * part.used[i], width,
                  to.data() + width * (part.first + i));
    }
  }
}

KindResidual residual_of(const MienFitResult& result, TargetKind kind) {
  switch (kind) {
    case TargetKind::kJoints: return {result.joint_residual, result.joint_worst};
    case TargetKind::kLandmarks2: return {result.image_residual, result.image_worst};
    case TargetKind::kSurface: return {result.surface_residual, result.surface_worst};
    default: return {result.point_residual, result.point_worst};
  }
}

}  // namespace mien::cli
