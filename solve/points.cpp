// SPDX-License-Identifier: MIT
// The points of a frame: where they are, where they are drawn to, and how far that is.
#include <algorithm>

#include "solve/frame.h"

namespace mien {
namespace {

/// Sums of the area vectors around each position of a mesh.
void find_position_normals(MienFit& fit, const FitMesh& mesh, const float* positions) {
  float* const normals = fit.position_normals.data + 3 * mesh.first_whole;
  for (size_t t = 0; t < mesh.triangle_count; ++t) {
    const uint32_t* corner = fit.triangles.data + 3 * (mesh.first_triangle + t);
    const float *a = positions + size_t{corner[0]} * 3, *b = positions + size_t{corner[1]} * 3,
                *c = positions + size_t{corner[2]} * 3;
    float ab[3], ac[3];
    for (int k = 0; k < 3; ++k) ab[k] = b[k] - a[k], ac[k] = c[k] - a[k];
    const float sign = mesh.inward ? -1.0f : 1.0f;
    const float normal[3] = {sign * (ab[1] * ac[2] - ab[2] * ac[1]),
                             sign * (ab[2] * ac[0] - ab[0] * ac[2]),
                             sign * (ab[0] * ac[1] - ab[1] * ac[0])};
    for (int n = 0; n < 3; ++n) {
      for (int k = 0; k < 3; ++k)
        normals[size_t{corner[n]} * 3 + static_cast<size_t>(k)] += normal[k];
    }
  }
}

void sum_rows(const MienSolvePoint& point, const float* rows, double* out) {
  for (size_t k = 0; k < 3; ++k) {
    out[k] = 0;
    for (size_t n = 0; n < 3; ++n)
      out[k] += double{point.weights[n]} * rows[size_t{point.positions[n]} * 3 + k];
  }
}

bool is_finite(const float* row, size_t count) {
  return std::all_of(row, row + count, [](float v) { return std::isfinite(v); });
}

double squared_length(const double* v) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

/// Samples of the points that count, of each kind, where those of all points are few of them.
void choose_own_samples(Frame& f) {
  MienFit& fit = f.fit;
  f.samples = fit.samples;
  size_t kinds = 0, given[kKinds] = {};
  for (const Kind kind : kAllKinds) kinds += f.has(kind);
  const size_t most = std::max<size_t>(fit.samples.count / std::max<size_t>(kinds, 1), 1);
  for (const Kind kind : kAllKinds) {
    if (!f.has(kind)) continue;
    const Span<double>& weights = fit.kinds[kind].weights;
    given[kind] = static_cast<size_t>(
        std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0; }));
    const auto sampled = static_cast<size_t>(std::count_if(
        fit.samples.begin(), fit.samples.end(), [&](uint32_t i) { return weights[i] > 0; }));
    const bool few = given[kind] != 0 && 2 * given[kind] < fit.points.count;
    f.few = f.few || few;
    f.own_samples = f.own_samples || (few && 2 * sampled < sample_count(given[kind], most));
  }
  if (!f.own_samples) return;
  std::fill(fit.is_sample.begin(), fit.is_sample.end(), uint8_t{0});
  for (const Kind kind : kAllKinds) {
    const Span<uint32_t> own = fit.own_samples.first(sample_count(given[kind], most));
    choose_samples(given[kind], own);
    uint32_t place = 0;
    size_t s = 0;
    for (uint32_t i = 0; s < own.count; ++i) {
      if (!(fit.kinds[kind].weights[i] > 0)) continue;
      if (own[s] == place) fit.is_sample[i] = 1, ++s;
      ++place;
    }
  }
  size_t count = 0;
  for (uint32_t i = 0; i < fit.points.count; ++i) {
    if (fit.is_sample[i]) fit.own_samples[count++] = i;
  }
  f.samples = fit.own_samples.first(count);
}

/// The targets of a kind, and their weights. Those of a surface are found later.
void read_kind(const Frame& f, Kind kind) {
  MienFit& fit = f.fit;
  const KindTargets& to = fit.kinds[kind];
  const float* const rows = kind == kPoints ? f.in.points : kind == kImages ? f.in.images : nullptr;
  const size_t width = kind == kPoints ? 3 : 2;
  std::fill(to.targets.begin(), to.targets.end(), 0.0);
  for (size_t i = 0; i < fit.points.count; ++i) {
    const float* const row = rows ? rows + width * i : nullptr;
    const bool present = kind == kSurface ? f.in.surface != nullptr : row && is_finite(row, width);
    to.weights[i] = present ? f.given_weight(kind, i) : 0.0;
    for (size_t k = 0; row && present && k < width; ++k) to.targets[3 * i + k] = double{row[k]};
  }
}

}  // namespace

size_t sample_count(size_t count, size_t most) {
  const size_t every = count == 0 ? 1 : (count + most - 1) / most;
  return (count + every - 1) / every;
}

/// One of each run of points, not always the same: a stride would follow rows of the mesh.
void choose_samples(size_t count, const Span<uint32_t>& out) {
  if (out.empty()) return;
  const size_t every = (count + out.count - 1) / out.count;
  uint32_t random = 1;
  for (size_t s = 0; s < out.count; ++s) {
    random = random * 1664525u + 1013904223u;
    const size_t left = std::min(every, count - s * every);
    out[s] = static_cast<uint32_t>(s * every + (random >> 8) % left);
  }
}

void read_points(Frame& f) {
  MienFit& fit = f.fit;
  std::fill(fit.lost.begin(), fit.lost.end(), uint8_t{0});
  std::fill(fit.kept_lost.begin(), fit.kept_lost.end(), uint8_t{1});
  for (const Kind kind : kAllKinds) read_kind(f, kind);
  for (size_t i = 0; i < fit.points.count && f.has_points() && !f.in.surface; ++i) {
    f.missing += !(f.in.points && is_finite(f.in.points + 3 * i, 3)) &&
                 !(f.in.images && is_finite(f.in.images + 2 * i, 2));
  }
  choose_own_samples(f);
  if (!f.in.images) return;
  const MienFitCamera& camera = *f.in.camera;
  std::copy(camera.rotation, camera.rotation + 9, f.motion.rotation);
  std::copy(camera.translation, camera.translation + 3, f.motion.translation);
  std::copy(camera.focal, camera.focal + 2, f.motion.focal);
}

void find_points(Frame& f) {
  MienFit& fit = f.fit;
  const auto deform = [&](MienDeformerInstance* deformed, uint32_t mesh) {
    MienFloatView positions = {};
    static_cast<void>(mien_deformer_instance_deform(deformed, mesh, MIEN_NORMALS_NONE, nullptr));
    static_cast<void>(mien_deformer_instance_positions(deformed, mesh, &positions));
    return positions.data;
  };
  if (fit.meshes.empty()) {
    static_cast<void>(mien_deformer_instance_update(fit.deformed, fit.instance));
  }
  for (FitMesh& mesh : fit.meshes) {
    static_cast<void>(mien_deformer_instance_update(mesh.deformed, fit.instance));
    mesh.at = deform(mesh.deformed, mesh.mesh);
  }
  for (size_t i = 0; i < fit.points.count; ++i) {
    const MienSolvePoint& point = fit.points[i];
    const float* const positions = fit.meshes[point.mesh].at;
    double* const to = fit.surface.data + 3 * i;
    if (is_position(point)) {
      const float* from = positions + size_t{point.positions[0]} * 3;
      for (size_t k = 0; k < 3; ++k) to[k] = double{from[k]};
    } else {
      sum_rows(point, positions, to);
    }
    for (size_t k = 0; f.in.point_offsets && k < 3; ++k)
      to[k] += double{f.in.point_offsets[3 * i + k]};
  }
  if (!f.in.surface) return;
  std::fill(fit.position_normals.begin(), fit.position_normals.end(), 0.0f);
  const bool own = fit.whole != fit.deformed;
  if (own) static_cast<void>(mien_deformer_instance_update(fit.whole, fit.instance));
  for (const FitMesh& mesh : fit.meshes) {
    find_position_normals(fit, mesh, own ? deform(fit.whole, mesh.mesh) : mesh.at);
  }
}

void view_point(const Frame& f, Kind kind, const double* point, double* out) {
  f.motion_of(kind).place(point, out);
  if (kind != kImages) return;
  const double z = std::max(out[2], 1e-6);
  for (size_t k = 0; k < 2; ++k) out[k] *= f.motion.focal[k] / z;
  out[2] = 0;
}

void match_surface(Frame& f) {
  MienFit& fit = f.fit;
  const KindTargets& to = fit.kinds[kSurface];
  const Motion& motion = f.motion_of(kSurface);
  const double reach = f.in.surface_reach > 0 ? double{f.in.surface_reach} : 1e30;
  f.missing = 0;
  for (size_t i = 0; i < fit.points.count; ++i) {
    if (!(to.weights[i] > 0)) continue;
    double at[3], own[3], normal[3] = {};
    motion.place(fit.surface.data + 3 * i, at);
    const MienSolvePoint& point = fit.whole_points[i];
    sum_rows(point, fit.position_normals.data + 3 * fit.meshes[point.mesh].first_whole, own);
    const double length = std::sqrt(squared_length(own));
    for (size_t r = 0; r < 3 && length > 0; ++r) {
      for (size_t c = 0; c < 3; ++c) normal[r] += motion.rotation[3 * r + c] * own[c] / length;
    }
    SurfacePoint found;
    const bool near_enough = find_nearest(*f.in.surface, at, normal, reach, found);
    if (near_enough) {
      std::copy(found.position, found.position + 3, to.targets.data + 3 * i);
      std::copy(found.normal, found.normal + 3, fit.normals.data + 3 * i);
    }
    fit.lost[i] = !near_enough || found.border;
    f.missing += fit.lost[i];
  }
}

void keep_targets(MienFit& fit) {
  const Span<double>& targets = fit.kinds[kSurface].targets;
  std::copy(targets.begin(), targets.end(), fit.kept_targets.begin());
  std::copy(fit.lost.begin(), fit.lost.end(), fit.kept_lost.begin());
}

double compared_residual(const Frame& f, size_t i, double squared) {
  const MienFit& fit = f.fit;
  if (fit.kept_lost[i]) return 0;
  double apart[3];
  f.motion_of(kSurface).place(fit.surface.data + 3 * i, apart);
  for (size_t k = 0; k < 3; ++k) apart[k] -= fit.kept_targets[3 * i + k];
  return fit.lost[i] ? squared_length(apart) : std::min(squared, squared_length(apart));
}

double point_residual(const Frame& f, Kind kind, size_t i, double* gradient) {
  const Motion& motion = f.motion_of(kind);
  double moved[3];
  motion.place(f.fit.surface.data + 3 * i, moved);
  const double* target = f.fit.kinds[kind].targets.data + 3 * i;
  double squared = 0, by_moved[3] = {};
  if (kind != kImages) {
    for (size_t k = 0; k < 3; ++k) by_moved[k] = moved[k] - target[k];
    squared = squared_length(by_moved);
  } else if (moved[2] > 1e-6) {
    for (size_t k = 0; k < 2; ++k) {
      const double focal = motion.focal[k], z = moved[2];
      const double r = focal * moved[k] / z + double{f.in.camera->center[k]} - target[k];
      squared += r * r;
      by_moved[k] += r * focal / z;
      by_moved[2] -= r * focal * moved[k] / (z * z);
    }
  }
  motion.turn_back(by_moved, gradient);
  return squared;
}

size_t point_rows(const Frame& f, Kind kind, size_t i, double (*directions)[3], double* residuals) {
  const Motion& motion = f.motion_of(kind);
  double moved[3];
  motion.place(f.fit.surface.data + 3 * i, moved);
  const double* target = f.fit.kinds[kind].targets.data + 3 * i;
  if (kind == kImages) {
    if (!(moved[2] > 1e-6)) return 0;
    for (size_t k = 0; k < 2; ++k) {
      const double focal = motion.focal[k], z = moved[2];
      std::fill(directions[k], directions[k] + 3, 0.0);
      directions[k][k] = focal / z;
      directions[k][2] = -focal * moved[k] / (z * z);
      residuals[k] = focal * moved[k] / z + double{f.in.camera->center[k]} - target[k];
    }
    return 2;
  }
  if (kind == kSurface) {
    // Along the surface a point may slide.
    residuals[0] = 0;
    for (size_t k = 0; k < 3; ++k) {
      directions[0][k] = f.fit.normals[3 * i + k];
      residuals[0] += directions[0][k] * (moved[k] - target[k]);
    }
    return 1;
  }
  for (size_t k = 0; k < 3; ++k) {
    for (size_t n = 0; n < 3; ++n) directions[k][n] = n == k;
    residuals[k] = moved[k] - target[k];
  }
  return 3;
}

}  // namespace mien
