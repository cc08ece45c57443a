// SPDX-License-Identifier: MIT
// The solve of solve/ as programs without derivatives do it: Levenberg-Marquardt steps within bounds of 0 and 1, whose
// matrix comes from central differences. It stops where mien_fit_solve() does.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <functional>
#include <vector>

namespace mien {

struct NumericSolve {
  /// Values of the pose of some controls.
  std::function<const float*(const std::vector<float>&)> evaluate;
  size_t value_count = 0, control_count = 0;
  double prior = 0;  // times the squared controls
  float step = 1e-3f;

  // Of the last solve.
  int iterations = 0;
  double difference_seconds = 0;  // of all solves

  std::vector<float> columns;  // [control][value]

  /// The matrix by differences of `h` to both sides, less at a bound.
  void differentiate(const std::vector<float>& x, float h) {
    const std::clock_t start = std::clock();
    columns.resize(control_count * value_count);
    std::vector<float> moved = x;
    for (size_t c = 0; c < control_count; ++c) {
      float* const column = columns.data() + c * value_count;
      const float low = std::max(x[c] - h, 0.0f), high = std::min(x[c] + h, 1.0f);
      moved[c] = high;
      const float* values = evaluate(moved);
      std::copy(values, values + value_count, column);
      moved[c] = low;
      values = evaluate(moved);
      for (size_t i = 0; i < value_count; ++i) column[i] = (column[i] - values[i]) / (high - low);
      moved[c] = x[c];
    }
    difference_seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  }

  double cost_of(const std::vector<float>& x, const std::vector<float>& targets,
                 std::vector<float>& residuals) const {
    const float* const values = evaluate(x);
    double cost = 0;
    for (size_t i = 0; i < value_count; ++i) {
      residuals[i] = values[i] - targets[i];
      cost += double{residuals[i]} * double{residuals[i]};
    }
    for (const float v : x) cost += prior * double{v} * double{v};
    return cost;
  }

  static double dot(const float* a, const float* b, size_t count) {
    double sums[4] = {};
    for (size_t i = 0; i < count; ++i) sums[i % 4] += double{a[i]} * double{b[i]};
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
  }

  /// From x, which becomes the result; returns the root mean square of the residuals.
  double solve(std::vector<float>& x, const std::vector<float>& targets, int limit) {
    std::vector<float> residuals(value_count), next(value_count);
    double cost = cost_of(x, targets, residuals), damping = 1e-5, largest = 0;
    for (const float v : targets) largest = std::max(largest, std::fabs(double{v}));
    const double rounding = static_cast<double>(value_count) * std::pow(1e-7 * largest, 2);
    const double first = cost;
    iterations = 0;
    for (bool ended = cost <= rounding; !ended && iterations < limit; ++iterations) {
      differentiate(x, step);
      make_matrix(x, residuals);
      for (ended = true; damping < 1e8; damping *= 10) {
        const std::vector<float> tried = take_step(x, damping);
        const double reached = cost_of(tried, targets, next);
        if (!(reached < cost)) continue;
        const double enough = std::max({1e-6 * cost, 1e-10 * first, rounding});
        ended = cost - reached <= enough || reached <= rounding;
        cost = reached;
        x = tried;
        residuals = next;
        damping = std::max(damping * 0.2, 1e-7);
        break;
      }
    }
    return std::sqrt(dot(residuals.data(), residuals.data(), value_count) /
                     static_cast<double>(value_count));
  }

 private:
  std::vector<double> matrix_, gradient_;

  void make_matrix(const std::vector<float>& x, const std::vector<float>& residuals) {
    matrix_.assign(control_count * control_count, 0);
    gradient_.resize(control_count);
    for (size_t a = 0; a < control_count; ++a) {
      const float* const column = columns.data() + a * value_count;
      gradient_[a] = dot(column, residuals.data(), value_count) + prior * double{x[a]};
      for (size_t b = 0; b <= a; ++b) {
        const double sum = dot(column, columns.data() + b * value_count, value_count);
        matrix_[a * control_count + b] = matrix_[b * control_count + a] = sum;
      }
      matrix_[a * control_count + a] += prior + 1e-12;
    }
  }

  /// Controls that would leave their bounds stop there, and the others take that into account.
  std::vector<float> take_step(const std::vector<float>& x, double damping) const {
    std::vector<size_t> free;
    for (size_t c = 0; c < control_count; ++c) {
      const bool held = (x[c] <= 0 && gradient_[c] >= 0) || (x[c] >= 1 && gradient_[c] <= 0);
      if (!held) free.push_back(c);
    }
    std::vector<double> change(control_count);
    for (bool stopped = true; stopped && !free.empty();) {
      const size_t n = free.size();
      std::vector<double> a(n * n), right(n);
      for (size_t i = 0; i < n; ++i) {
        const double* const row = matrix_.data() + free[i] * control_count;
        right[i] = -gradient_[free[i]];
        for (size_t c = 0; c < control_count; ++c) right[i] -= row[c] * change[c];
        for (size_t j = 0; j < n; ++j) {
          right[i] += row[free[j]] * change[free[j]];
          a[i * n + j] = row[free[j]];
        }
        a[i * n + i] *= 1 + damping;
      }
      solve_positive(a, right);
      std::vector<size_t> left;
      for (size_t i = 0; i < n; ++i) {
        const double low = -double{x[free[i]]}, high = 1 + low;
        change[free[i]] = std::min(std::max(right[i], low), high);
        if (right[i] >= low && right[i] <= high) left.push_back(free[i]);
      }
      stopped = left.size() != n;
      free = left;
    }
    std::vector<float> out = x;
    for (size_t c = 0; c < control_count; ++c) {
      const double to = double{x[c]} + change[c];
      out[c] = static_cast<float>(std::min(std::max(to, 0.0), 1.0));
    }
    return out;
  }

  /// By Cholesky's factors; a pivot of 0 leaves its control where it is.
  static void solve_positive(std::vector<double>& a, std::vector<double>& x) {
    const size_t n = x.size();
    for (size_t i = 0; i < n; ++i) {
      for (size_t j = 0; j <= i; ++j) {
        double sum = a[i * n + j];
        for (size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
        if (i == j) a[i * n + i] = sum > 0 ? std::sqrt(sum) : HUGE_VAL;
        if (i != j) a[i * n + j] = sum / a[j * n + j];
      }
      for (size_t k = 0; k < i; ++k) x[i] -= a[i * n + k] * x[k];
      x[i] /= a[i * n + i];
    }
    for (size_t i = n; i-- != 0;) {
      for (size_t k = i + 1; k < n; ++k) x[i] -= a[k * n + i] * x[k];
      x[i] /= a[i * n + i];
    }
  }
};

}  // namespace mien
