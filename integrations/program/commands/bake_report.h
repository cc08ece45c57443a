// SPDX-License-Identifier: MIT
// What baked expressions lose against the rig, for people and for programs.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "integrations/program/gltf/expression_bake.h"

namespace mien::cli {

/// A table: how far each expression moves, and by how much it is off, alone and in combinations.
void print_bake_report(const gltf::BakeReport& report, FILE* stream);

/// The same as JSON, in millimeters; a member of "shapes" for each expression. `missing` are expressions that the
/// rig has no controls for.
std::string bake_report_json(const gltf::BakeReport& report,
                             const std::vector<std::string>& missing);

}  // namespace mien::cli
