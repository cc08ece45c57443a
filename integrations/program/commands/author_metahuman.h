// SPDX-License-Identifier: MIT
// mien author --preset metahuman: shapes become the raw controls of MetaHuman heads.
#pragma once

#include <nlohmann/json.hpp>

#include "integrations/program/commands/author_input.h"
#include "integrations/program/io/terminal.h"
#include "integrations/program/mesh/mesh_file.h"

namespace mien::cli {

/// Names shapes after the raw controls that they mean. A shape that means several, such as mouthFunnel, is divided
/// among them: between left and right, and between the upper and the lower lip, so that all of them together are the
/// shape. Others keep their names, and a note lists them. Combinations of shapes get the new names of their
/// members; members are not divided. Returns what became of each shape: an object of lists of names.
nlohmann::ordered_json name_as_metahuman(const MeshStand& stand, MeshFile& mesh,
                                         const Session& session);

}  // namespace mien::cli
