// SPDX-License-Identifier: MIT
// Compiled with the baseline flags of the machine family, whatever the rest of the build has.
#include "integrations/program/baseline/csr_matrix.h"

namespace mien::bench {

using std::size_t;

CsrMatrix make_csr(const std::vector<DenseGroup>& groups, uint32_t lod, std::size_t row_count) {
  struct Source {
    const DenseGroup* group = nullptr;
    size_t row = 0;
  };
  // Of several groups with the same output the last one counts.
  std::vector<Source> sources(row_count);
  for (const DenseGroup& group : groups) {
    const size_t rows = lod < group.lods.size() ? static_cast<size_t>(group.lods[lod]) : 0;
    for (size_t row = 0; row < rows; ++row) {
      const auto output = static_cast<size_t>(group.outputs[row]);
      if (output < row_count) sources[output] = {&group, row};
    }
  }

  CsrMatrix matrix;
  matrix.row_starts.push_back(0);
  for (const Source& source : sources) {
    const size_t width = source.group ? source.group->inputs.size() : 0;
    for (size_t column = 0; column < width; ++column) {
      const float value = source.group->values[source.row * width + column];
      if (value == 0.0f) continue;
      matrix.columns.push_back(static_cast<uint32_t>(source.group->inputs[column]));
      matrix.values.push_back(value);
    }
    matrix.row_starts.push_back(static_cast<uint32_t>(matrix.values.size()));
  }
  return matrix;
}

void multiply(const CsrMatrix& matrix, const float* x, float* y) {
  const uint32_t* starts = matrix.row_starts.data();
  const uint32_t* columns = matrix.columns.data();
  const float* values = matrix.values.data();
  const size_t rows = matrix.row_starts.size() - 1;
  for (size_t row = 0; row < rows; ++row) {
    float sum = 0.0f;
    for (uint32_t i = starts[row]; i < starts[row + 1]; ++i) sum += values[i] * x[columns[i]];
    y[row] = sum;
  }
}

}  // namespace mien::bench
