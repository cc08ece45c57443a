// SPDX-License-Identifier: MIT
// Symmetric positive definite systems. Our own code instead of a library: sums run in index order, so the
// bits depend neither on vector width nor on cache sizes, and it allocates nothing.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace mien::author {

/// Works in place on `size` rows of `size` numbers, of which it reads the lower triangle.
class Cholesky {
 public:
  Cholesky(double* matrix, uint32_t size) : m_(matrix), n_(size) {}

  void factor() {
    for (uint32_t c = 0; c < n_; ++c) {
      for (uint32_t r = c; r < n_; ++r) {
        double sum = at(r, c);
        for (uint32_t k = 0; k < c; ++k) sum -= at(r, k) * at(c, k);
        at(r, c) = r == c ? std::sqrt(sum) : sum / at(c, c);
      }
    }
  }

  /// `T` is anything with + - and multiplication by a number.
  template <class T>
  void solve(T* x) const {
    for (uint32_t r = 0; r < n_; ++r) {
      for (uint32_t k = 0; k < r; ++k) x[r] = x[r] - x[k] * at(r, k);
      x[r] = x[r] * (1 / at(r, r));
    }
    for (uint32_t r = n_; r-- > 0;) {
      for (uint32_t k = r + 1; k < n_; ++k) x[r] = x[r] - x[k] * at(k, r);
      x[r] = x[r] * (1 / at(r, r));
    }
  }

 private:
  double& at(uint32_t r, uint32_t c) const { return m_[size_t{r} * n_ + c]; }
  double* m_;
  uint32_t n_;
};

}  // namespace mien::author
