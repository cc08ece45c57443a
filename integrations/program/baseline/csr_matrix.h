// SPDX-License-Identifier: MIT
// The reference of `mien bench`: the joint matrix in compressed sparse rows, multiplied in the plain way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mien::bench {

/// Row r: entries row_starts[r] ... row_starts[r + 1]. Only entries that are not zero are kept.
struct CsrMatrix {
  std::vector<uint32_t> row_starts;
  std::vector<uint32_t> columns;
  std::vector<float> values;
};

/// A dense piece of the joint matrix, as DNA files have it: values row-major [outputs][inputs],
/// `lods[l]` leading rows at LOD l.
struct DenseGroup {
  std::vector<int64_t> lods, inputs, outputs;
  std::vector<float> values;
};

/// All `row_count` rows at a LOD; those that no group has are empty.
CsrMatrix make_csr(const std::vector<DenseGroup>& groups, uint32_t lod, std::size_t row_count);

/// y = matrix * x: one scalar dot product per row.
void multiply(const CsrMatrix& matrix, const float* x, float* y);

}  // namespace mien::bench
