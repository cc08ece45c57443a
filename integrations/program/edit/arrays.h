// SPDX-License-Identifier: MIT
// Arrays for the geometry of a document, from OBJ, NPY and JSON files, by the ending of their names. All in the
// unit and axes of the document.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "integrations/program/edit/document.h"

namespace mien::cli {

/// 3 numbers per position of a mesh: an OBJ with as many vertices, an NPY of positions x 3, or JSON
/// [[x, y, z], ...].
std::vector<float> read_positions(const Document& document, const std::string& path,
                                  const std::vector<float>& current);

/// 3 numbers per position of a mesh: NPY and JSON as read_positions(); of an OBJ, its difference from the
/// mesh.
std::vector<float> read_deltas(const Document& document, const std::string& path,
                               const std::vector<float>& current);

struct WeightRows {
  uint32_t influences = 0;  // of each row; missing ones have weight 0
  std::vector<uint16_t> joints;
  std::vector<float> weights;
};

/// NPY of positions x joints, or JSON [[[joint, weight], ...], ...], where a joint is a name or a number.
WeightRows read_weight_rows(const Document& document, const std::string& path,
                            size_t position_count);

}  // namespace mien::cli
