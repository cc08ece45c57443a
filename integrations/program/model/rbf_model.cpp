// SPDX-License-Identifier: MIT
#include "integrations/program/model/rbf_model.h"

#include <algorithm>
#include <cmath>

namespace mien::model {
namespace {

using Row = std::vector<double>;

// 6.2
Row prepared(const PlainRbfSolver& solver, Row values) {
  if (solver.distance < 2) return values;
  for (size_t i = 0; i + 4 <= values.size(); i += 4) {
    const double x = values[i], y = values[i + 1], z = values[i + 2], w = values[i + 3];
    const double a = solver.axis == 0 ? x : solver.axis == 1 ? y : z;
    const double n = std::sqrt(a * a + w * w);
    Row q(4);
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

Row target(const PlainRbfSolver& solver, size_t pose) {
  const size_t n = solver.inputs.size();
  const float* from = solver.targets.data() + pose * n;
  return prepared(solver, Row(from, from + n));
}

// 6.3: as it says there, the dot product of quaternions has 32-bit floats, each product and sum rounded once.
double distance(const PlainRbfSolver& solver, const Row& a, const Row& b, double noise = 0) {
  double sum = 0;
  if (solver.distance == 0) {
    for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
  }
  for (size_t i = 0; i + 4 <= a.size(); i += 4) {
    float dot = 0;
    for (size_t k = i; k < i + 4; ++k) dot += static_cast<float>(a[k]) * static_cast<float>(b[k]);
    const double u = double{dot * dot} * (1 + noise), angle = u > 1 ? 0 : std::acos(2 * u - 1);
    sum += angle * angle;
  }
  return std::sqrt(sum);
}

// 6.4
double radius(const LayerRig& rig, const PlainRbfSolver& solver) {
  if (solver.automatic_radius == 1) {
    return rig.rotation_unit == 0 ? solver.radius * 3.14159265358979323846 / 180
                                  : double{solver.radius};
  }
  double sum = 0, pairs = 0;
  for (size_t a = 0; a < solver.poses.size(); ++a) {
    for (size_t b = 0; b < a; ++b, ++pairs) {
      sum += distance(solver, target(solver, a), target(solver, b));
    }
  }
  return sum / pairs;
}

// 6.5
double weight(const PlainRbfSolver& solver, double d, double r) {
  switch (solver.function) {
    case 0: return std::exp(-d / (r * r));
    case 1: return std::exp(-2 * d / r);
    case 2: return std::fmax(0, 1 - d / r);
    case 3: return std::fmax(0, 1 - std::pow(d / r, 3));
    default: return std::fmax(0, 1 - std::pow(d / r, 5));
  }
}

/// Solves m * x = b.
Row solution(std::vector<Row> m, Row b) {
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

std::vector<double> model_rbf_weights(const LayerRig& rig, const PlainRbfSolver& solver,
                                      const std::vector<double>& inputs, double noise) {
  const double r = radius(rig, solver);
  uint32_t draw = 0;  // of a linear congruential sequence, whose highest bit is the sign
  const auto next_noise = [&] {
    draw = draw * 1664525u + 1013904223u;
    return draw >> 31 ? noise : -noise;
  };
  const size_t n = solver.poses.size();
  const Row input = prepared(solver, inputs);
  Row weights(n);
  for (size_t t = 0; t < n; ++t) {
    weights[t] = weight(solver, distance(solver, target(solver, t), input, next_noise()), r);
  }
  if (solver.type == 0) return weights;
  std::vector<Row> kernel(n, Row(n));
  for (size_t s = 0; s < n; ++s) {
    for (size_t t = 0; t < n; ++t) {
      kernel[s][t] =
          weight(solver, distance(solver, target(solver, s), target(solver, t), next_noise()), r);
    }
  }
  weights = solution(kernel, weights);
  for (double& w : weights) w = std::fmin(std::fmax(w, 0), 1);
  return weights;
}

void model_rbf_solver(const LayerRig& rig, const PlainRbfSolver& solver,
                      std::vector<double>& controls, double noise) {
  for (uint16_t pose : solver.poses) {
    for (uint16_t output : rig.poses[pose].outputs) controls[output] = 0;
  }
  Row inputs;
  for (uint16_t input : solver.inputs) inputs.push_back(controls[input]);
  const Row weights = model_rbf_weights(rig, solver, inputs, noise);
  double sum = 0;
  for (double w : weights) sum += w;
  const double scale = sum > 1 || (solver.normalize == 1 && sum > 0) ? 1 / sum : 1;
  for (size_t t = 0; t < solver.poses.size(); ++t) {
    const PlainRbfPose& pose = rig.poses[solver.poses[t]];
    double value = weights[t] * scale * pose.scale;
    if (!(value > solver.threshold)) continue;
    for (uint16_t input : pose.inputs) value *= controls[input];
    for (size_t o = 0; o < pose.outputs.size(); ++o) {
      controls[pose.outputs[o]] += pose.weights[o] * value;
    }
  }
}

void model_rbf(const LayerRig& rig, uint32_t lod, std::vector<double>& controls, double noise) {
  for (size_t s = 0; s < rig.solvers.size(); ++s) {
    if (rig.has(rig.lod_solvers, lod, static_cast<uint32_t>(s))) {
      model_rbf_solver(rig, rig.solvers[s], controls, noise);
    }
  }
}

}  // namespace mien::model
