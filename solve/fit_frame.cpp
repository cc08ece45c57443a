// SPDX-License-Identifier: MIT
// mien_fit_solve() and mien_fit_solve_frames(): checks of arguments, and results.
#include <algorithm>
#include <cmath>

#include "solve/frame.h"

using namespace mien;
using namespace mien::capi;

namespace {

constexpr uint32_t kMostStages = 16;

bool is_weight(float v) { return v >= 0 && std::isfinite(v); }

MienStatus check_camera(const MienFitFrame& in) {
  const MienFitCamera& camera = *in.camera;
  bool known = false;
  for (const float v : camera.rotation) {
    if (!std::isfinite(v)) return MIEN_ERROR_INVALID_ARGUMENT;
    known = known || v != 0;
  }
  for (size_t k = 0; k < 2; ++k) {
    if (!std::isfinite(camera.center[k]) || !std::isfinite(camera.focal[k]) ||
        (in.rigid && !(camera.focal[k] > 0))) {
      return MIEN_ERROR_INVALID_ARGUMENT;
    }
  }
  for (const float v : camera.translation) {
    if (!std::isfinite(v)) return MIEN_ERROR_INVALID_ARGUMENT;
  }
  return known || in.rigid ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT;
}

MienStatus check_frame(const MienFit& fit, const MienFitFrame& in) {
  const bool any = in.points || in.images || in.surface;
  if (any && fit.points.count == 0) return MIEN_ERROR_NULL_ARGUMENT;
  if (in.images && !in.camera) return MIEN_ERROR_NULL_ARGUMENT;
  if (in.images) {
    if (MienStatus status = check_camera(in)) return status;
  }
  if (in.surface) {
    if (MienStatus status = check_tag(in.surface, kFitSurfaceTag)) return status;
  }
  for (const float weight :
       {in.prior_weight, in.smooth_weight, in.sparse_weight, in.symmetric_weight, in.robust_scale,
        in.joint_weight, in.surface_reach, in.image_weight, in.image_robust_scale}) {
    if (!is_weight(weight)) return MIEN_ERROR_INVALID_ARGUMENT;
  }
  for (const float* const weights : {in.point_weights, in.surface_weights}) {
    for (size_t i = 0; weights && i < fit.points.count; ++i) {
      if (!is_weight(weights[i])) return MIEN_ERROR_INVALID_ARGUMENT;
    }
  }
  for (size_t i = 0; in.point_offsets && i < 3 * fit.points.count; ++i) {
    if (!std::isfinite(in.point_offsets[i])) return MIEN_ERROR_INVALID_ARGUMENT;
  }
  if (MienStatus status = check_constraints(fit, in)) return status;
  for (size_t i = 0; in.stages && i < fit.raw_count; ++i) {
    if (in.stages[i] >= kMostStages) return MIEN_ERROR_INVALID_ARGUMENT;
  }
  const auto finite = [&](const float* row) {
    for (size_t i = 0; row && i < fit.raw_count; ++i) {
      if (!std::isfinite(row[i])) return false;
    }
    return true;
  };
  return finite(in.start) && finite(in.prior) ? MIEN_OK : MIEN_ERROR_INVALID_ARGUMENT;
}

/// Start and prior, the start within its bounds.
void read_rows(Frame& f) {
  MienFit& fit = f.fit;
  const float* start = f.in.start ? f.in.start : fit.initial.data;
  const float* prior = f.in.prior ? f.in.prior : fit.initial.data;
  std::copy(start, start + fit.raw_count, fit.start.data);
  std::copy(prior, prior + fit.raw_count, fit.prior.data);
  std::copy(start, start + fit.raw_count, fit.raw.data);
  for (size_t i = 0; i < fit.controls.count; ++i) {
    float& v = fit.raw[fit.controls[i]];
    v = std::min(std::max(v, fit.lower[i]), fit.upper[i]);
  }
  normalize_rotations(fit);
}

void tell(const MienFit& fit, const Frame& f, float* out_raw, MienFitResult& told) {
  std::copy(fit.best.begin(), fit.best.end(), out_raw);
  told.missing_points = f.missing;
  for (int k = 0; k < 9; ++k) told.rotation[k] = static_cast<float>(f.motion.rotation[k]);
  for (int k = 0; k < 3; ++k) told.translation[k] = static_cast<float>(f.motion.translation[k]);
  for (int k = 0; k < 2 && f.in.images; ++k) told.focal[k] = static_cast<float>(f.motion.focal[k]);
}

/// One frame, by itself.
void solve_one(MienFit& fit, const MienFitFrame& in, float* out_raw, MienFitResult& told) {
  Frame f = {fit, in, {}};
  read_rows(f);
  if (fit.points.count != 0) read_points(f);
  solve_frame(f, told);
  tell(fit, f, out_raw, told);
}

MienStatus read_frame(const MienFit* fit, const MienFitFrame* frame, MienFitFrame& known) {
  if (!frame) return MIEN_ERROR_NULL_ARGUMENT;
  if (MienStatus status = check_tag(fit, kFitTag)) return status;
  return read_struct(frame, known);
}

/// Frame i of several: its rows of the targets.
MienFitFrame row_of(const MienFit& fit, const MienFitFrame& frame, size_t i) {
  MienFitFrame in = frame;
  const size_t points = fit.points.count;
  if (in.joints) in.joints += i * fit.joint_count;
  if (in.points) in.points += i * points * 3;
  if (in.images) in.images += i * points * 2;
  if (in.point_weights) in.point_weights += i * points;
  if (in.surface_weights) in.surface_weights += i * points;
  return in;
}

}  // namespace

namespace mien {

void tell_cost(const MienFitFrame& in, const Cost& cost, MienFitResult& told) {
  const auto tell = [](const Sum& sum, double& residual, double& worst) {
    residual = sum.weight > 0 ? std::sqrt(sum.squares / sum.weight) : 0.0;
    worst = std::sqrt(sum.worst);
  };
  const Kind first = in.points ? kPoints : in.images ? kImages : kSurface;
  told.cost = cost.total;
  tell(cost.joints, told.joint_residual, told.joint_worst);
  tell(cost.points[first], told.point_residual, told.point_worst);
  tell(cost.points[kImages], told.image_residual, told.image_worst);
  tell(cost.points[kSurface], told.surface_residual, told.surface_worst);
  tell(cost.constraints, told.constraint_residual, told.constraint_worst);
}

}  // namespace mien

MienStatus mien_fit_solve(MienFit* fit, const MienFitFrame* frame, float* out_raw,
                          MienFitResult* result) {
  if (!out_raw) return MIEN_ERROR_NULL_ARGUMENT;
  MienFitFrame known;
  if (MienStatus status = read_frame(fit, frame, known)) return status;
  if (result) {
    if (MienStatus status = clear_struct(result)) return status;
  }
  if (MienStatus status = check_frame(*fit, known)) return status;
  MienFitResult told = {};
  solve_one(*fit, known, out_raw, told);
  if (result) write_struct(result, told);
  return MIEN_OK;
}

MienStatus mien_fit_solve_frames(MienFit* fit, const MienFitFrame* frame, size_t count,
                                 float* out_raw, MienFitResult* results) {
  MienFitFrame known;
  if (MienStatus status = read_frame(fit, frame, known)) return status;
  if (count == 0) return MIEN_OK;
  if (!out_raw) return MIEN_ERROR_NULL_ARGUMENT;
  const size_t result_size = results ? results->struct_size : 0;
  const auto result_of = [&](size_t i) {
    return reinterpret_cast<MienFitResult*>(reinterpret_cast<uint8_t*>(results) + i * result_size);
  };
  for (size_t i = 0; i < count; ++i) {
    if (results && result_of(i)->struct_size != result_size) return MIEN_ERROR_INVALID_ARGUMENT;
    if (results) {
      if (MienStatus status = clear_struct(result_of(i))) return status;
    }
    if (MienStatus status = check_frame(*fit, row_of(*fit, known, i))) return status;
  }
  JointFrames joints = {*fit};
  bool plain = false;  // joints are the only targets of this block of frames
  MienFitCamera camera = known.camera ? *known.camera : MienFitCamera{};
  for (size_t i = 0; i < count; ++i) {
    MienFitFrame in = row_of(*fit, known, i);
    const size_t lane = i % kBlockFrames;
    if (lane == 0) plain = joints.begin_block(in, std::min<size_t>(count - i, kBlockFrames));
    if (i != 0) {
      in.start = out_raw + (i - 1) * fit->raw_count;
      in.stages = nullptr;
    }
    if (in.camera) in.camera = &camera;
    float* const out = out_raw + i * fit->raw_count;
    MienFitResult told = {};
    bool solved = false;
    if (plain && !in.stages) {
      Frame f = {*fit, in, {}};
      read_rows(f);
      solved = !(in.canceled && in.canceled(in.user)) && joints.solve(f, lane, told);
      if (solved) tell(*fit, f, out, told);
    }
    if (!solved) {
      solve_one(*fit, in, out, told);
      joints.follows = false;
      joints.factor_count = 0;
    }
    if (in.camera && in.rigid) {
      std::copy(told.rotation, told.rotation + 9, camera.rotation);
      std::copy(told.translation, told.translation + 3, camera.translation);
      std::copy(told.focal, told.focal + 2, camera.focal);
    }
    if (results) write_struct(result_of(i), told);
  }
  return MIEN_OK;
}
