// SPDX-License-Identifier: MIT
// A set of expressions out of a JSON file of the user:
//
//     {"aa": {"jawOpen": 0.6}, "close": {"plus": {"jawOpen": 1, "mouthClose": 1}, "minus": {"jawOpen": 1}}}
#pragma once

#include <string>

#include "integrations/program/gltf/expression_set.h"

namespace mien::gltf {

/// Values are 0 to 1; there is at least one expression, and 512 at most. Fails with exit code 2 and the
/// place in the file.
ExpressionSet read_expression_set(const std::string& path);

}  // namespace mien::gltf
