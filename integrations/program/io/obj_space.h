// SPDX-License-Identifier: MIT
// OBJ has no unit and no axes: the comment by which files of `mien export` say theirs, to be read back.
#pragma once

namespace mien::cli {

constexpr const char kObjInMeters[] = "# meters, y up, z to the front";  // the first line

}  // namespace mien::cli
