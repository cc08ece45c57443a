// SPDX-License-Identifier: MIT
// Raw controls that are the parts of a unit quaternion: steps turn them, their length stays 1.
#include <algorithm>
#include <cmath>

#include "solve/frame.h"

namespace mien {
namespace {

constexpr double kAtRest = 1e-3;       // of the quaternion: the noise of angles of floats
constexpr double kLongestTurn = 0.25;  // of the quaternion in a step: about 30 degrees

/// NAME.x NAME.y NAME.z NAME.w, or .qx .qy .qz .qw, from raw control `first` on.
bool named_as_quaternion(const MienRig* rig, uint32_t first) {
  MienStringView names[4] = {};
  for (uint32_t k = 0; k < 4; ++k) {
    static_cast<void>(mien_rig_name(rig, MIEN_KIND_RAW_CONTROL, first + k, &names[k]));
    const size_t stem = names[0].count;
    if (stem < 3 || names[k].count != stem || names[k].data[stem - 1] != "xyzw"[k]) return false;
    if (!std::equal(names[k].data, names[k].data + stem - 1, names[0].data)) return false;
  }
  const char* const end = names[0].data + names[0].count - 1;
  return end[-1] == '.' || (end[-1] == 'q' && end[-2] == '.');
}

void normalize(double* q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 1e-9)) return;
  for (size_t k = 0; k < 4; ++k) q[k] /= length;
}

/// Calls f(its place in the free list, its place in the controls) for each rotation all parts of which are free.
template <class F>
void for_each_free(const MienFit& fit, size_t free_count, F&& f) {
  size_t a = 0;
  for (const uint32_t r : fit.rotations) {
    while (a < free_count && fit.free[a] < r) ++a;
    if (a + 3 < free_count && fit.free[a] == r && fit.free[a + 3] == r + 3) f(a, r);
  }
}

/// values -= q (q . values)
void hold_length(const double* q, double* values, size_t stride) {
  double along = 0;
  for (size_t k = 0; k < 4; ++k) along += q[k] * values[k * stride];
  for (size_t k = 0; k < 4; ++k) values[k * stride] -= along * q[k];
}

void read_rotation(const MienFit& fit, const Span<float>& raw, uint32_t rotation, double* q) {
  for (uint32_t k = 0; k < 4; ++k) q[k] = raw[fit.controls[rotation + k]];
  normalize(q);
}

}  // namespace

size_t find_rotations(const MienRig* rig, const Span<const float>& initial, const uint32_t* moving,
                      size_t count, uint32_t* out) {
  size_t found = 0;
  for (size_t i = 0; i + 3 < count; ++i) {
    const uint32_t c = moving ? moving[i] : static_cast<uint32_t>(i);
    if (moving && moving[i + 3] != c + 3) continue;
    if (initial[c] != 0 || initial[c + 1] != 0 || initial[c + 2] != 0 || initial[c + 3] != 1 ||
        !named_as_quaternion(rig, c)) {
      continue;
    }
    if (out) out[found] = static_cast<uint32_t>(i);
    ++found;
    i += 3;
  }
  return found;
}

void normalize_rotations(MienFit& fit) {
  for (const uint32_t r : fit.rotations) {
    double q[4];
    read_rotation(fit, fit.raw, r, q);
    for (uint32_t k = 0; k < 4; ++k) fit.raw[fit.controls[r + k]] = static_cast<float>(q[k]);
  }
}

void hold_gradient(MienFit& fit) {
  for (const uint32_t r : fit.rotations) {
    double q[4];
    read_rotation(fit, fit.raw, r, q);
    hold_length(q, fit.gradient.data + r, 1);
  }
}

void hold_matrix(MienFit& fit, size_t free_count) {
  double* const m = fit.matrix.data;
  for_each_free(fit, free_count, [&](size_t a, uint32_t r) {
    double q[4];
    read_rotation(fit, fit.raw, r, q);
    for (size_t b = 0; b < free_count; ++b) hold_length(q, m + b * free_count + a, 1);
    for (size_t b = 0; b < free_count; ++b) hold_length(q, m + a * free_count + b, free_count);
  });
}

void stiffen_lengths(MienFit& fit, size_t free_count) {
  double* const m = fit.matrix.data;
  for_each_free(fit, free_count, [&](size_t a, uint32_t r) {
    double q[4], stiffness = 1e-12;
    read_rotation(fit, fit.raw, r, q);
    for (size_t k = 0; k < 4; ++k) stiffness += m[(a + k) * (free_count + 1)];
    for (size_t k = 0; k < 4; ++k) {
      for (size_t n = 0; n < 4; ++n) m[(a + k) * free_count + a + n] += stiffness * q[k] * q[n];
    }
  });
}

bool rest_rotations(MienFit& fit) {
  bool any = false;
  for (const uint32_t r : fit.rotations) {
    if (fit.resting[r]) continue;
    double squared = 0;
    for (uint32_t k = 0; k < 4; ++k) {
      squared += square(double{fit.raw[fit.controls[r + k]]} - fit.initial[fit.controls[r + k]]);
    }
    if (!(squared < kAtRest * kAtRest)) continue;
    any = true;
    for (uint32_t k = 0; k < 4; ++k) {
      fit.raw[fit.controls[r + k]] = fit.initial[fit.controls[r + k]];
      fit.resting[r + k] = 1;
    }
  }
  return any;
}

void turn_rotations(MienFit& fit, size_t free_count) {
  for_each_free(fit, free_count, [&](size_t a, uint32_t r) {
    double q[4], length = 0;
    read_rotation(fit, fit.best, r, q);
    double* const step = fit.step.data + a;
    hold_length(q, step, 1);
    for (size_t k = 0; k < 4; ++k) length += step[k] * step[k];
    length = std::sqrt(length);
    const double scale = length > kLongestTurn ? kLongestTurn / length : 1;
    for (size_t k = 0; k < 4; ++k) q[k] += scale * step[k];
    normalize(q);
    for (uint32_t k = 0; k < 4; ++k) {
      const uint32_t c = fit.controls[r + k];
      step[k] = q[k] - double{fit.best[c]};
    }
  });
}

}  // namespace mien
