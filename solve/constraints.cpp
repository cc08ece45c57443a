// SPDX-License-Identifier: MIT
// Constraints of a frame: residuals of joints and of distances of points, and their derivatives by model matrices
// and by points.
#include <algorithm>
#include <cmath>

#include "solve/frame.h"

using namespace mien;

namespace {

/// Up to three residuals, and the derivative of each: by the axes and the origin of a joint, or by two points.
struct Residuals {
  size_t count = 0;
  double values[3] = {};
  double by_joint[3][12] = {};  // x y z of each axis, then of the origin
  double by_points[3][2][3] = {};
};

bool is_of_joint(uint32_t kind) { return kind <= MIEN_CONSTRAINT_JOINT_AIM; }

bool are_finite(const float* v, size_t count) {
  return std::all_of(v, v + count, [](float x) { return std::isfinite(x); });
}

bool is_present(const MienFitConstraint& c) {
  return c.weight > 0 && are_finite(c.axis, 3) && are_finite(c.target, 3) &&
         !std::isnan(c.distances[0]) && !std::isnan(c.distances[1]);
}

/// v = v / its length, which is returned; false if it is 0.
bool make_unit_vector(double* v, double& length) {
  length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (!(length > 0)) return false;
  for (int k = 0; k < 3; ++k) v[k] /= length;
  return true;
}

/// The axis of a joint against the direction of the target, both of length 1.
void compare_directions(const MienFitConstraint& c, const float* model, Residuals& out) {
  double own[3], wanted[3], own_length, wanted_length;
  const bool aims = c.kind == MIEN_CONSTRAINT_JOINT_AIM;
  for (size_t r = 0; r < 3; ++r) {
    own[r] = 0;
    for (size_t k = 0; k < 3; ++k) own[r] += double{c.axis[k]} * model[4 * k + r];
    wanted[r] = double{c.target[r]} - (aims ? double{model[12 + r]} : 0.0);
  }
  if (!make_unit_vector(own, own_length) || !make_unit_vector(wanted, wanted_length)) return;
  out.count = 3;
  for (size_t r = 0; r < 3; ++r) {
    out.values[r] = own[r] - wanted[r];
    for (size_t n = 0; n < 3; ++n) {
      const double same = n == r;
      const double by_own = (same - own[r] * own[n]) / own_length;
      for (size_t k = 0; k < 3; ++k) out.by_joint[r][3 * k + n] = double{c.axis[k]} * by_own;
      if (aims) out.by_joint[r][9 + n] = (same - wanted[r] * wanted[n]) / wanted_length;
    }
  }
}

void compare_points(const MienFitConstraint& c, const double* a, const double* b, Residuals& out) {
  double apart[3], length;
  for (size_t k = 0; k < 3; ++k) apart[k] = a[k] - b[k];
  const double least = c.distances[0], most = c.distances[1];
  if (!(most > 0)) {  // in one place: three residuals, smooth there
    out.count = 3;
    for (size_t r = 0; r < 3; ++r) {
      out.values[r] = apart[r];
      out.by_points[r][0][r] = 1;
      out.by_points[r][1][r] = -1;
    }
    return;
  }
  if (!make_unit_vector(apart, length)) return;
  const double off = length < least ? length - least : length > most ? length - most : 0;
  if (off == 0) return;
  out.count = 1;
  out.values[0] = off;
  for (size_t k = 0; k < 3; ++k) {
    out.by_points[0][0][k] = apart[k];
    out.by_points[0][1][k] = -apart[k];
  }
}

/// A point of the rig itself, without its offset.
void find_own_point(const Frame& f, uint32_t point, double* out) {
  for (size_t k = 0; k < 3; ++k) {
    const size_t at = size_t{point} * 3 + k;
    out[k] = f.fit.surface[at] - (f.in.point_offsets ? double{f.in.point_offsets[at]} : 0.0);
  }
}

Residuals find_residuals(const Frame& f, const MienFitConstraint& c, const float* models) {
  Residuals out;
  if (!is_present(c)) return out;
  const float* model = models ? models + size_t{c.joint} * 16 : nullptr;
  double a[3] = {}, b[3] = {};
  if (!is_of_joint(c.kind)) {
    find_own_point(f, c.points[0], a);
    if (c.kind == MIEN_CONSTRAINT_POINT_DISTANCE) find_own_point(f, c.points[1], b);
  }
  switch (c.kind) {
    case MIEN_CONSTRAINT_JOINT_POSITION:
    case MIEN_CONSTRAINT_POINT_POSITION:
      out.count = 3;
      for (size_t r = 0; r < 3; ++r) {
        out.values[r] = (model ? double{model[12 + r]} : a[r]) - double{c.target[r]};
        (model ? out.by_joint[r][9 + r] : out.by_points[r][0][r]) = 1;
      }
      break;
    case MIEN_CONSTRAINT_POINT_DISTANCE: compare_points(c, a, b, out); break;
    default: compare_directions(c, model, out); break;
  }
  return out;
}

const float* models_of(const MienFit& fit, const MienFitConstraint& c) {
  if (!is_of_joint(c.kind)) return nullptr;
  MienFloatView view = {};
  static_cast<void>(mien_deformer_instance_joint_matrices(fit.deformed, &view));
  return view.data;
}

/// Where number `part` of Residuals::by_joint is among the 16 of a matrix.
size_t matrix_place(size_t part) { return part / 3 * 4 + part % 3; }

/// Gradients, row by row: of model matrices, and of positions of one mesh after the other.
struct Rows {
  float *models, *positions;
  size_t count;

  float* model(const MienFit& fit, size_t row, uint32_t joint) const {
    return models + row * fit.model_gradient.count + size_t{joint} * 16;
  }
  float* mesh(const FitMesh& mesh, size_t row) const {
    return positions + 3 * (count * mesh.first + row * mesh.count);
  }
};

/// Adds factor times the derivative of residual r to a row.
void add_derivative(const MienFit& fit, const MienFitConstraint& c, const Residuals& residuals,
                    size_t r, double factor, const Rows& rows, size_t row) {
  if (is_of_joint(c.kind)) {
    float* to = rows.model(fit, row, c.joint);
    for (size_t k = 0; k < 12; ++k) {
      to[matrix_place(k)] += static_cast<float>(factor * residuals.by_joint[r][k]);
    }
    return;
  }
  for (size_t p = 0; p < 2; ++p) {
    const MienSolvePoint& point = fit.points[c.points[p]];
    for (size_t n = 0; n < 3; ++n) {
      float* to = rows.mesh(fit.meshes[point.mesh], row) + size_t{point.positions[n]} * 3;
      for (size_t k = 0; k < 3; ++k) {
        to[k] +=
            static_cast<float>(factor * double{point.weights[n]} * residuals.by_points[r][p][k]);
      }
    }
    if (c.kind == MIEN_CONSTRAINT_POINT_POSITION) return;
  }
}

void clear_row(const MienFit& fit, bool of_joints, const Rows& rows, size_t row) {
  if (of_joints) {
    std::fill_n(rows.model(fit, row, 0), fit.model_gradient.count, 0.0f);
    return;
  }
  for (const FitMesh& mesh : fit.meshes) std::fill_n(rows.mesh(mesh, row), 3 * mesh.count, 0.0f);
}

/// The derivatives of `count` rows by `from`, a row of `width` each.
void find_rows(MienFit& fit, bool of_joints, const Rows& rows, size_t count, uint32_t from,
               size_t width, float* out) {
  const auto rows32 = static_cast<uint32_t>(count);
  if (of_joints) {
    static_cast<void>(mien_derivatives_reverse(fit.derivatives, from, MIEN_POINT_MODELS, 0, rows32,
                                               rows.models, out));
    return;
  }
  for (const FitMesh& mesh : fit.meshes) {
    const bool first = &mesh == fit.meshes.data;
    float* const to = first ? out : fit.row_parts.data;
    static_cast<void>(mien_derivatives_reverse(mesh.derivatives, from, MIEN_POINT_POSITIONS,
                                               mesh.mesh, rows32, rows.mesh(mesh, 0), to));
    for (size_t i = 0; !first && i < count * width; ++i) out[i] += to[i];
  }
}

}  // namespace

namespace mien {

bool has_joint_constraints(const Frame& f) {
  for (size_t i = 0; f.in.constraints && i < f.in.constraint_count; ++i) {
    if (is_of_joint(f.in.constraints[i].kind)) return true;
  }
  return false;
}

MienStatus check_constraints(const MienFit& fit, const MienFitFrame& in) {
  if (!in.constraints) return in.constraint_count == 0 ? MIEN_OK : MIEN_ERROR_NULL_ARGUMENT;
  if (in.constraint_count > kMostConstraints) return MIEN_ERROR_INVALID_ARGUMENT;
  const size_t joints = fit.model_gradient.count / 16;
  for (size_t i = 0; i < in.constraint_count; ++i) {
    const MienFitConstraint& c = in.constraints[i];
    if (c.kind > MIEN_CONSTRAINT_POINT_DISTANCE || !(c.weight >= 0) || !std::isfinite(c.weight)) {
      return MIEN_ERROR_INVALID_ARGUMENT;
    }
    if (is_of_joint(c.kind)) {
      if (!fit.deformed) return MIEN_ERROR_NULL_ARGUMENT;
      if (c.joint >= joints) return MIEN_ERROR_INDEX;
    } else if (c.points[0] >= fit.points.count ||
               (c.kind == MIEN_CONSTRAINT_POINT_DISTANCE && c.points[1] >= fit.points.count)) {
      return MIEN_ERROR_INDEX;
    }
    const auto all_zero = [](const float* v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; };
    const bool turns =
        c.kind == MIEN_CONSTRAINT_JOINT_DIRECTION || c.kind == MIEN_CONSTRAINT_JOINT_AIM;
    if ((turns && all_zero(c.axis)) ||
        (c.kind == MIEN_CONSTRAINT_JOINT_DIRECTION && all_zero(c.target)) ||
        (c.kind == MIEN_CONSTRAINT_POINT_DISTANCE &&
         (c.distances[0] < 0 || c.distances[1] < c.distances[0]))) {
      return MIEN_ERROR_INVALID_ARGUMENT;
    }
  }
  return MIEN_OK;
}

void add_constraint_cost(Frame& f, Cost& cost) {
  MienFit& fit = f.fit;
  const Rows rows = {fit.model_gradient.data, fit.position_gradient.data, 1};
  std::fill(fit.model_gradient.begin(), fit.model_gradient.end(), 0.0f);
  for (size_t i = 0; i < f.in.constraint_count; ++i) {
    const MienFitConstraint& c = f.in.constraints[i];
    if (!is_present(c)) continue;
    const Residuals residuals = find_residuals(f, c, models_of(fit, c));
    double squared = 0;
    for (size_t r = 0; r < residuals.count; ++r) {
      squared += square(residuals.values[r]);
      add_derivative(fit, c, residuals, r, double{c.weight} * residuals.values[r], rows, 0);
    }
    cost.constraints.squares += double{c.weight} * squared;
    cost.constraints.weight += double{c.weight};
    cost.constraints.worst = std::max(cost.constraints.worst, squared);
  }
}

void list_constraint_rows(Frame& f, uint32_t from) {
  MienFit& fit = f.fit;
  f.row_count = 0;
  if (!f.in.constraints) return;
  const size_t width = from == MIEN_POINT_RAW ? fit.raw_count : fit.control_count;
  const Rows rows = {fit.row_models.data, fit.moved.data, kRowsAtOnce};
  // Those of joints, then those of points, some rows at a time.
  for (const bool of_joints : {true, false}) {
    size_t begin = 0;
    while (begin < f.in.constraint_count) {
      size_t count = 0, end = begin;
      for (; end < f.in.constraint_count && count + 3 <= kRowsAtOnce; ++end) {
        const MienFitConstraint& c = f.in.constraints[end];
        if (is_of_joint(c.kind) != of_joints) continue;
        const Residuals residuals = find_residuals(f, c, models_of(fit, c));
        for (size_t r = 0; r < residuals.count; ++r, ++count) {
          clear_row(fit, of_joints, rows, count);
          add_derivative(fit, c, residuals, r, 1, rows, count);
          fit.row_weights[f.row_count + count] = double{c.weight};
        }
      }
      if (count != 0) {
        find_rows(fit, of_joints, rows, count, from, width,
                  fit.constraint_rows.data + f.row_count * width);
      }
      f.row_count += count;
      begin = end;
    }
  }
}

}  // namespace mien
