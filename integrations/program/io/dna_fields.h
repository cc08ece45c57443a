// SPDX-License-Identifier: MIT
// Fields of a DNA file by their path, as values. Failures name the path.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "integrations/program/io/rig_file.h"

namespace mien::cli {

/// "geom.meshes[3].faces" from ("geom.meshes", 3, ".faces").
std::string element(const std::string& list, uint64_t index, const std::string& rest = "");

uint64_t field_count(const RigFile& file, const std::string& path);
int64_t read_integer(const RigFile& file, const std::string& path);
std::vector<int64_t> read_integers(const RigFile& file, const std::string& path);
std::vector<float> read_floats(const RigFile& file, const std::string& path);
std::string read_string(const RigFile& file, const std::string& path);

}  // namespace mien::cli
