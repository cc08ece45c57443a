// SPDX-License-Identifier: MIT
// Landmarks that `mien author --landmarks` reads, and the confidence of those that were found.
#pragma once

#include <mien_author.h>

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

/// Places of a mesh by name, in its unit and axes.
class LandmarksFile {
 public:
  LandmarksFile() = default;
  /// {"nose": [0, 1.2, 9], "chin": 1043, "eye_l": "EyeBall_L"}: a place, a position of the mesh by its number from
  /// 0, or the middle of an object. An empty path has none. Exit code 2 for files of another form.
  LandmarksFile(const std::string& path, const MeshFile& mesh);
  LandmarksFile(const LandmarksFile&) = delete;
  LandmarksFile& operator=(const LandmarksFile&) = delete;

  /// Valid as long as this object.
  std::vector<MienAuthorLandmark> list() const;

 private:
  struct Given {
    std::string name;
    std::array<double, 3> at;
  };
  std::vector<Given> given_;
};

/// Fails with kInvalid if joints were placed by a landmark whose confidence is below `least`.
void refuse_uncertain(const nlohmann::ordered_json& report, double least, const std::string& shown);

}  // namespace mien::cli
