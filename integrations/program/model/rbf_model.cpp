// SPDX-License-Identifier: MIT
#include "integrations/program/model/rbf_model.h"

#include <algorithm>
#include <cmath>

namespace mien::model {
namespace {

template <class T>
using RowOf = std::vector<T>;
using Row = RowOf<double>;

// 6.2
template <class T>
RowOf<T> prepared(const PlainRbfSolver& solver, RowOf<T> values) {
  if (solver.distance < 2) return values;
  for (size_t i = 0; i + 4 <= values.size(); i += 4) {
    const T x = values[i], y = values[i + 1], z = values[i + 2], w = values[i + 3];
    const T a = solver.axis == 0 ? x : solver.axis == 1 ? y : z;
    const T n = sqrt(a * a + w * w);
    RowOf<T> q(4);
    if (solver.distance == 3) {
      q[solver.axis] = a / n;
      q[3] = w / n;
    } else if (solver.axis == 0) {
      q = {0, (w * y - x * z) / -n, (w * z + x * y) / -n, -n};
    } else if (solver.axis == 1) {
      q = {(w * x + y * z) / -n, 0, (w * z - y * x) / -n, -n};
    } else {
      q = {(w * x - z * y) / -n, (w * y + z * x) / -n, 0, -n};
    }
    std::copy(q.begin(), q.end(), values.begin() + static_cast<long>(i));
  }
  return values;
}

std::vector<Row> targets_of(const PlainRbfSolver& solver) {
  const size_t n = solver.inputs.size();
  std::vector<Row> targets;
  const float* from = solver.targets.data();
  for (size_t t = 0; t < solver.poses.size(); ++t, from += n) {
    targets.push_back(prepared(solver, Row(from, from + n)));
  }
  return targets;
}

// 6.3: as it says there, the dot product of quaternions has 32-bit floats, each product and sum rounded once.
double squared_dot(const double* a, const double* b) {
  float dot = 0;
  for (size_t k = 0; k < 4; ++k) dot += static_cast<float>(a[k]) * static_cast<float>(b[k]);
  return dot * dot;
}
// Targets are floats, but rounding of products has no derivative.
Dual squared_dot(const double* a, const Dual* b) {
  Dual dot;
  for (size_t k = 0; k < 4; ++k) dot += double{static_cast<float>(a[k])} * b[k];
  return dot * dot;
}

template <class T>
T distance(const PlainRbfSolver& solver, const Row& a, const RowOf<T>& b, double noise = 0) {
  T sum = 0;
  if (solver.distance == 0) {
    for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(sum);
  }
  for (size_t i = 0; i + 4 <= a.size(); i += 4) {
    const T u = squared_dot(a.data() + i, b.data() + i) * (1 + noise);
    const T angle = u > 1 ? T(0) : acos(2 * u - 1);
    sum += angle * angle;
  }
  return sqrt(sum);
}

// 6.4
double radius(const LayerRig& rig, const PlainRbfSolver& solver, const std::vector<Row>& targets) {
  if (solver.automatic_radius == 1) {
    return rig.rotation_unit == 0 ? solver.radius * 3.14159265358979323846 / 180
                                  : double{solver.radius};
  }
  double sum = 0, pairs = 0;
  for (size_t a = 0; a < targets.size(); ++a) {
    for (size_t b = 0; b < a; ++b, ++pairs) sum += distance(solver, targets[a], targets[b]);
  }
  return sum / pairs;
}

// 6.5
template <class T>
T weight(const PlainRbfSolver& solver, const T& d, double r) {
  T w;
  switch (solver.function) {
    case 0: w = exp(-d / (r * r)); break;
    case 1: w = exp(-2 * d / r); break;
    case 2: w = 1 - d / r; break;
    case 3: w = 1 - pow(d / r, 3); break;
    default: w = 1 - pow(d / r, 5); break;
  }
  return w > 0 ? w : T(0);  // also where it is no number
}

/// Solves m * x = b.
template <class T>
RowOf<T> solution(std::vector<Row> m, RowOf<T> b) {
  const size_t n = b.size();
  for (size_t c = 0; c < n; ++c) {
    size_t best = c;
    for (size_t r = c; r < n; ++r) {
      if (std::fabs(m[r][c]) > std::fabs(m[best][c])) best = r;
    }
    std::swap(m[c], m[best]);
    std::swap(b[c], b[best]);
    for (size_t r = c + 1; r < n; ++r) {
      const double factor = m[r][c] / m[c][c];
      for (size_t k = c; k < n; ++k) m[r][k] -= factor * m[c][k];
      b[r] -= factor * b[c];
    }
  }
  for (size_t r = n; r-- > 0;) {
    for (size_t k = r + 1; k < n; ++k) b[r] -= m[r][k] * b[k];
    b[r] /= m[r][r];
  }
  return b;
}

}  // namespace

template <class T>
std::vector<T> model_rbf_weights(const LayerRig& rig, const PlainRbfSolver& solver,
                                 const std::vector<T>& inputs, const Rounding& rounding) {
  const std::vector<Row> targets = targets_of(solver);
  const double r = radius(rig, solver, targets);
  // splitmix64: neighboring states start independent sequences.
  uint64_t state = rounding.signs;
  const auto noise = [&] {
    uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z >> 63 != 0 ? rounding.noise : -rounding.noise;
  };
  const size_t n = targets.size();
  const RowOf<T> input = prepared(solver, inputs);
  RowOf<T> weights(n);
  for (size_t t = 0; t < n; ++t) {
    weights[t] = weight(solver, distance(solver, targets[t], input, noise()), r);
    weights[t] *= 1 + noise() / 32;
  }
  if (solver.type == 0) return weights;
  std::vector<Row> kernel(n, Row(n));
  for (size_t s = 0; s < n; ++s) {
    for (size_t t = 0; t < n; ++t) {
      kernel[s][t] = weight(solver, distance(solver, targets[s], targets[t], noise()), r);
    }
  }
  weights = solution(kernel, weights);
  for (T& w : weights) w = clamp01(w + rounding.noise);
  return weights;
}

template <class T>
void model_rbf_solver(const LayerRig& rig, const PlainRbfSolver& solver, std::vector<T>& controls,
                      const Rounding& rounding) {
  for (uint16_t pose : solver.poses) {
    for (uint16_t output : rig.poses[pose].outputs) controls[output] = 0;
  }
  RowOf<T> inputs;
  for (uint16_t input : solver.inputs) inputs.push_back(controls[input]);
  const RowOf<T> weights = model_rbf_weights(rig, solver, inputs, rounding);
  T sum = 0;
  for (const T& w : weights) sum += w;
  const T scale = sum > 1 || (solver.normalize == 1 && sum > 0) ? 1 / sum : T(1);
  for (size_t t = 0; t < solver.poses.size(); ++t) {
    const PlainRbfPose& pose = rig.poses[solver.poses[t]];
    T value = beyond(weights[t] * scale * pose.scale, solver.threshold);
    for (uint16_t input : pose.inputs) value *= controls[input];
    for (size_t o = 0; o < pose.outputs.size(); ++o) {
      controls[pose.outputs[o]] += pose.weights[o] * value;
    }
  }
}

template <class T>
void model_rbf(const LayerRig& rig, uint32_t lod, std::vector<T>& controls,
               const Rounding& rounding) {
  for (size_t s = 0; s < rig.solvers.size(); ++s) {
    if (rig.has(rig.lod_solvers, lod, static_cast<uint32_t>(s))) {
      model_rbf_solver(rig, rig.solvers[s], controls, rounding);
    }
  }
}

#define MIEN_MODEL_RBF(T)                                                                 \
  template std::vector<T> model_rbf_weights(const LayerRig&, const PlainRbfSolver&,       \
                                            const std::vector<T>&, const Rounding&);      \
  template void model_rbf_solver(const LayerRig&, const PlainRbfSolver&, std::vector<T>&, \
                                 const Rounding&);                                        \
  template void model_rbf(const LayerRig&, uint32_t, std::vector<T>&, const Rounding&);
MIEN_MODEL_RBF(double)
MIEN_MODEL_RBF(Dual)

}  // namespace mien::model
