// SPDX-License-Identifier: MIT
// One frame while it is solved: what the caller gave, and how the target is moved as a whole.
#pragma once

#include <cmath>

#include "solve/fit.h"
#include "solve/surface.h"

namespace mien {

constexpr size_t kMostSamples = 400;  // more points add time and no new directions
constexpr size_t kMostMotion = 7;     // rotation, translation, focal length

/// From model space to that of the targets, or to the camera.
struct Motion {
  double rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // rows
  double translation[3] = {0, 0, 0};
  double focal[2] = {1, 1};

  void place(const double* point, double* out) const {
    for (size_t r = 0; r < 3; ++r) {
      out[r] = translation[r];
      for (size_t c = 0; c < 3; ++c) out[r] += rotation[3 * r + c] * point[c];
    }
  }
  /// out = rotation, transposed, * direction
  void turn_back(const double* direction, double* out) const {
    for (size_t c = 0; c < 3; ++c) {
      out[c] = 0;
      for (size_t r = 0; r < 3; ++r) out[c] += rotation[3 * r + c] * direction[r];
    }
  }
};

struct Frame {
  MienFit& fit;
  MienFitFrame in;
  Motion motion;
  uint32_t missing = 0;
  bool exact = false;  // steps take the effects of controls on points from the pose at hand

  bool has_points() const { return in.points || in.images || in.surface; }
  /// Steps need more than the metric of points at rest.
  bool has_rows() const { return in.images || in.surface || in.rigid || exact; }
  size_t motion_count() const { return !in.rigid ? 0 : in.images && in.focal ? 7 : 6; }
  double joint_factor() const { return in.joint_weight > 0 ? in.joint_weight : 1; }
};

/// The robust cost of a squared residual, and the weight that it has in a step (S. Geman, D. McClure 1987).
inline double robust(double squared, double scale, double& weight) {
  if (!(scale > 0)) {
    weight = 1;
    return squared;
  }
  const double s = scale * scale, share = s / (s + squared);
  weight = share * share;
  return squared * share;
}

// Points ------------------------------------------------------------------------------------------------

/// Targets and weights as given; missing ones have no weight.
void read_points(Frame& f);
/// The points at the controls of the instance, and, for a surface, their normals.
void find_points(Frame& f);
/// Where each point is drawn to, if that is a surface.
void match_surface(Frame& f);
/// The squared residual of a point, and half of its derivative by the point in model space.
double point_residual(const Frame& f, size_t point, double* gradient);
/// The residuals of a point as steps see them, and their derivatives by the point where the targets are. Up to 3.
size_t point_rows(const Frame& f, size_t point, double (*directions)[3], double* residuals);

// Motion ------------------------------------------------------------------------------------------------

/// A camera that sees the face from the front, as large and where the targets are.
void guess_camera(Frame& f);
/// Moves the targets, or the camera, nearer to the points.
void fit_motion(Frame& f, uint32_t rounds);
/// The derivatives of a residual by the numbers of the motion: row `row` of a point, which has been moved.
void list_motion(const Frame& f, const double* moved, const double* direction, size_t row,
                 double* out);

// Steps -------------------------------------------------------------------------------------------------

/// matrix += J^T W J of the points by the free controls, whatever the motion, which follows them.
void add_point_rows(Frame& f, size_t free_count);

}  // namespace mien
