// SPDX-License-Identifier: MIT
// Small dense systems and rigid alignment, in double precision and one order of sums.
#include <algorithm>
#include <cmath>

#include "solve/fit.h"

namespace mien {

// By rows, so that the inner loop runs over neighbors in memory: L L^T, L in the lower triangle.
bool factor_matrix(const double* matrix, size_t count, double damping, double* factor) {
  for (size_t i = 0; i < count; ++i) {
    double* const row = factor + i * count;
    std::copy(matrix + i * count, matrix + i * count + i + 1, row);
    row[i] += damping * matrix[i * count + i] + 1e-12;
    for (size_t j = 0; j <= i; ++j) {
      const double* const other = factor + j * count;
      double sums[4] = {};
      size_t k = 0;
      for (; k + 4 <= j; k += 4) {
        for (size_t n = 0; n < 4; ++n) sums[n] += row[k + n] * other[k + n];
      }
      double sum = (sums[0] + sums[2]) + (sums[1] + sums[3]);
      for (; k < j; ++k) sum += row[k] * other[k];
      const double rest = row[j] - sum;
      if (j < i) {
        row[j] = rest / other[j];
      } else {
        if (!(rest > 0)) return false;
        row[i] = std::sqrt(rest);
      }
    }
  }
  return true;
}

void factor_damped(const double* matrix, size_t count, double damping, double* factor) {
  while (!factor_matrix(matrix, count, damping, factor)) damping = std::max(damping * 10, 1e-8);
}

void solve_factored(const double* factor, size_t count, double* x) {
  for (size_t i = 0; i < count; ++i) {
    const double* const row = factor + i * count;
    double sum = x[i];
    for (size_t k = 0; k < i; ++k) sum -= row[k] * x[k];
    x[i] = sum / row[i];
  }
  for (size_t i = count; i-- > 0;) {
    x[i] /= factor[i * count + i];
    const double* const row = factor + i * count;
    for (size_t k = 0; k < i; ++k) x[k] -= row[k] * x[i];
  }
}

namespace {

/// The eigenvector of the largest eigenvalue of a symmetric 4x4 matrix, by Jacobi rotations.
void largest_eigenvector(double (&m)[4][4], double* out) {
  double v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  for (int sweep = 0; sweep < 12; ++sweep) {
    for (int p = 0; p < 3; ++p) {
      for (int q = p + 1; q < 4; ++q) {
        if (m[p][q] == 0) continue;
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = (theta < 0 ? -1 : 1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (auto& row : m) {
          const double a = row[p], b = row[q];
          row[p] = c * a - s * b;
          row[q] = s * a + c * b;
        }
        for (int k = 0; k < 4; ++k) {
          const double a = m[p][k], b = m[q][k];
          m[p][k] = c * a - s * b;
          m[q][k] = s * a + c * b;
        }
        for (auto& row : v) {
          const double a = row[p], b = row[q];
          row[p] = c * a - s * b;
          row[q] = s * a + c * b;
        }
      }
    }
  }
  int best = 0;
  for (int k = 1; k < 4; ++k) best = m[k][k] > m[best][best] ? k : best;
  for (int k = 0; k < 4; ++k) out[k] = v[k][best];
}

}  // namespace

// B. K. P. Horn: Closed-form solution of absolute orientation using unit quaternions. J. Opt. Soc. Am. A 4,
// 1987. Three points that are not on a line determine the rotation.
void fit_rigid(const double* from, const double* to, const double* weights, size_t count,
               double* rotation, double* translation) {
  double total = 0, a[3] = {}, b[3] = {};
  for (size_t i = 0; i < count; ++i) {
    total += weights[i];
    for (size_t k = 0; k < 3; ++k) {
      a[k] += weights[i] * from[3 * i + k];
      b[k] += weights[i] * to[3 * i + k];
    }
  }
  double s[3][3] = {};
  for (size_t k = 0; k < 3 && total > 0; ++k) {
    a[k] /= total;
    b[k] /= total;
  }
  for (size_t i = 0; i < count; ++i) {
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 3; ++c) {
        s[r][c] += weights[i] * (from[3 * i + r] - a[r]) * (to[3 * i + c] - b[c]);
      }
    }
  }
  double n[4][4] = {
      {s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
      {0, s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
      {0, 0, s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
      {0, 0, 0, s[2][2] - s[0][0] - s[1][1]}};
  for (int r = 1; r < 4; ++r) {
    for (int c = 0; c < r; ++c) n[r][c] = n[c][r];
  }
  double q[4] = {1, 0, 0, 0};
  if (total > 0) largest_eigenvector(n, q);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                       2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                       2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  std::copy(m, m + 9, rotation);
  for (size_t r = 0; r < 3; ++r) {
    translation[r] = b[r];
    for (size_t c = 0; c < 3; ++c) translation[r] -= m[3 * r + c] * a[c];
  }
}

}  // namespace mien
