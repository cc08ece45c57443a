// SPDX-License-Identifier: MIT
#include "bench/plain_rbf.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bench/bench_support.h"

namespace mien::bench {
namespace {

// Reading -----------------------------------------------------------------------------------------

template <class Out, class T, class Read>
std::vector<Out> read(const MienDna* dna, const std::string& path, Read call) {
  MienDnaField field = sized<MienDnaField>();
  MienError error = sized<MienError>();
  require(mien_dna_field(dna, path.c_str(), &field, &error), error);
  std::vector<T> values(static_cast<size_t>(field.count));
  require(call(dna, path.c_str(), 0, field.count, values.data(), &error), error);
  return {values.begin(), values.end()};
}

std::vector<uint16_t> indices(const MienDna* dna, const std::string& path) {
  return read<uint16_t, int64_t>(dna, path, mien_dna_read_integers);
}
std::vector<float> floats(const MienDna* dna, const std::string& path) {
  return read<float, float>(dna, path, mien_dna_read_floats);
}

// The formulas ------------------------------------------------------------------------------------

/// The part of a rotation about an axis (distance 3), or what is left without it (2).
void take_part(const PlainSolver& solver, float* q) {
  const uint32_t a = solver.twist_axis, b = (a + 1) % 3, c = (a + 2) % 3;
  const float n = std::sqrt(q[a] * q[a] + q[3] * q[3]);
  if (solver.distance == 3) {
    q[a] /= n;
    q[3] /= n;
    q[b] = q[c] = 0;
    return;
  }
  const float at_b = (q[3] * q[b] - q[a] * q[c]) / -n;
  const float at_c = (q[3] * q[c] + q[a] * q[b]) / -n;
  q[a] = 0;
  q[b] = at_b;
  q[c] = at_c;
  q[3] = -n;
}

float distance(const PlainSolver& solver, const float* a, const float* b) {
  float sum = 0;
  const size_t count = solver.inputs.size();
  if (solver.distance == 0) {
    for (size_t i = 0; i < count; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum);
  }
  for (size_t i = 0; i + 4 <= count; i += 4) {
    const float dot = a[i] * b[i] + a[i + 1] * b[i + 1] + a[i + 2] * b[i + 2] + a[i + 3] * b[i + 3];
    const float u = dot * dot;
    const float angle = u > 1 ? 0 : std::acos(2 * u - 1);
    sum += angle * angle;
  }
  return std::sqrt(sum);
}

float weight(const PlainSolver& solver, float d) {
  const float r = solver.radius, x = d / r;
  switch (solver.function) {
    case 0: return std::exp(-d / (r * r));
    case 1: return std::exp(-2 * x);
    case 2: return std::max(0.0f, 1 - x);
    case 3: return std::max(0.0f, 1 - x * x * x);
    default: return std::max(0.0f, 1 - x * x * x * x * x);
  }
}

// Preparation, not timed --------------------------------------------------------------------------

std::vector<float> inverse_of(const PlainSolver& solver) {
  const size_t n = solver.poses.size(), count = solver.inputs.size(), width = 2 * n;
  std::vector<double> m(n * width);
  for (size_t r = 0; r < n; ++r) {
    for (size_t c = 0; c < n; ++c) {
      m[r * width + c] =
          weight(solver, distance(solver, &solver.targets[r * count], &solver.targets[c * count]));
    }
    m[r * width + n + r] = 1;
  }
  for (size_t c = 0; c < n; ++c) {
    size_t best = c;
    for (size_t r = c; r < n; ++r) {
      if (std::fabs(m[r * width + c]) > std::fabs(m[best * width + c])) best = r;
    }
    std::swap_ranges(&m[c * width], &m[c * width] + width, &m[best * width]);
    const double pivot = m[c * width + c] == 0 ? 1e-20 : m[c * width + c];
    for (size_t k = 0; k < width; ++k) m[c * width + k] /= pivot;
    for (size_t r = 0; r < n; ++r) {
      const double factor = m[r * width + c];
      for (size_t k = 0; r != c && k < width; ++k) m[r * width + k] -= factor * m[c * width + k];
    }
  }
  std::vector<float> inverse(n * n);
  for (size_t r = 0; r < n; ++r) {
    for (size_t c = 0; c < n; ++c) inverse[r * n + c] = static_cast<float>(m[r * width + n + c]);
  }
  return inverse;
}

float mean_distance(const PlainSolver& solver) {
  const size_t n = solver.poses.size(), count = solver.inputs.size();
  double sum = 0;
  for (size_t a = 0; a < n; ++a) {
    for (size_t b = 0; b < a; ++b) {
      sum += distance(solver, &solver.targets[a * count], &solver.targets[b * count]);
    }
  }
  return static_cast<float>(sum / (0.5 * static_cast<double>(n * (n - 1))));
}

}  // namespace

PlainRbf read_plain_rbf(const MienDna* dna) {
  PlainRbf rbf;
  MienDnaInfo info = sized<MienDnaInfo>();
  require(mien_dna_info(dna, &info));
  for (uint32_t p = 0; p < info.rbf_pose_count; ++p) {
    const std::string number = "[" + std::to_string(p) + "].";
    const std::string controls = "rbfe.poses" + number;
    rbf.poses.push_back({floats(dna, "rbfb.poses" + number + "scale")[0],
                         indices(dna, controls + "inputControlIndices"),
                         indices(dna, controls + "outputControlIndices"),
                         floats(dna, controls + "outputControlWeights")});
  }
  for (uint32_t s = 0; s < info.rbf_solver_count; ++s) {
    const std::string at = "rbfb.solvers[" + std::to_string(s) + "].";
    PlainSolver solver;
    solver.inputs = indices(dna, at + "rawControlIndices");
    solver.poses = indices(dna, at + "poseIndices");
    solver.targets = floats(dna, at + "rawControlValues");
    solver.threshold = floats(dna, at + "weightThreshold")[0];
    solver.distance = indices(dna, at + "distanceMethod")[0];
    solver.function = indices(dna, at + "functionType")[0];
    solver.twist_axis = indices(dna, at + "twistAxis")[0];
    solver.interpolative = indices(dna, at + "solverType")[0] == 1;
    solver.always_normalize = indices(dna, at + "normalizeMethod")[0] == 1;
    for (size_t i = 0; solver.distance >= 2 && i + 4 <= solver.targets.size(); i += 4) {
      take_part(solver, &solver.targets[i]);
    }
    const bool automatic = indices(dna, at + "automaticRadius")[0] == 0;
    solver.radius = floats(dna, at + "radius")[0];
    if (info.rotation_unit == MIEN_ROTATION_UNIT_DEGREES) solver.radius *= 0.0174532925f;
    if (automatic) solver.radius = mean_distance(solver);
    if (solver.interpolative) solver.inverse = inverse_of(solver);
    rbf.solvers.push_back(solver);
  }
  return rbf;
}

// The stage ---------------------------------------------------------------------------------------

void evaluate(const PlainRbf& rbf, std::vector<float>& controls) {
  static thread_local std::vector<float> inputs, kernel, weights;
  for (const PlainSolver& solver : rbf.solvers) {
    for (uint16_t pose : solver.poses) {
      for (uint16_t output : rbf.poses[pose].outputs) controls[output] = 0;
    }
    const size_t count = solver.inputs.size(), poses = solver.poses.size();
    inputs.resize(count);
    for (size_t i = 0; i < count; ++i) inputs[i] = controls[solver.inputs[i]];
    for (size_t i = 0; solver.distance >= 2 && i + 4 <= count; i += 4) {
      take_part(solver, &inputs[i]);
    }
    weights.resize(poses);
    for (size_t p = 0; p < poses; ++p) {
      weights[p] = weight(solver, distance(solver, &solver.targets[p * count], inputs.data()));
    }
    if (solver.interpolative) {
      kernel = weights;
      for (size_t r = 0; r < poses; ++r) {
        float sum = 0;
        for (size_t c = 0; c < poses; ++c) sum += solver.inverse[r * poses + c] * kernel[c];
        weights[r] = std::min(std::max(sum, 0.0f), 1.0f);
      }
    }
    float sum = 0;
    for (float w : weights) sum += w;
    const float scale = sum > 1 || solver.always_normalize ? 1 / sum : 1;
    for (size_t p = 0; p < poses; ++p) {
      const PlainPose& pose = rbf.poses[solver.poses[p]];
      float value = weights[p] * scale * pose.scale;
      if (!(value > solver.threshold)) continue;
      for (uint16_t input : pose.inputs) value *= controls[input];
      for (size_t o = 0; o < pose.outputs.size(); ++o) {
        controls[pose.outputs[o]] += pose.weights[o] * value;
      }
    }
  }
}

}  // namespace mien::bench
