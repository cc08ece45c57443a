// SPDX-License-Identifier: MIT
// Eigenvectors of small symmetric matrices by Jacobi rotations: + - * / and square roots alone, so
// the same bits everywhere.
#pragma once

#include <cmath>

namespace mien::author {

/// Diagonalizes `a` in place; column k of `vectors` belongs to a[k][k]. Not sorted.
template <int N>
void diagonalize(double (&a)[N][N], double (&vectors)[N][N]) {
  for (int i = 0; i < N; ++i) {
    for (int k = 0; k < N; ++k) vectors[i][k] = i == k;
  }
  for (int sweep = 0; sweep < 50; ++sweep) {
    double off = 0, all = 0;
    for (int i = 0; i < N; ++i) {
      for (int k = 0; k < N; ++k) {
        all += a[i][k] * a[i][k];
        if (i != k) off += a[i][k] * a[i][k];
      }
    }
    if (!(off > all * 1e-32)) return;
    for (int p = 0; p < N; ++p) {
      for (int q = p + 1; q < N; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int k = 0; k < N; ++k) {
          const double kp = a[k][p], kq = a[k][q];
          a[k][p] = c * kp - s * kq;
          a[k][q] = s * kp + c * kq;
        }
        for (int k = 0; k < N; ++k) {
          const double pk = a[p][k], qk = a[q][k];
          a[p][k] = c * pk - s * qk;
          a[q][k] = s * pk + c * qk;
        }
        for (int k = 0; k < N; ++k) {
          const double kp = vectors[k][p], kq = vectors[k][q];
          vectors[k][p] = c * kp - s * kq;
          vectors[k][q] = s * kp + c * kq;
        }
      }
    }
  }
}

}  // namespace mien::author
