// SPDX-License-Identifier: MIT
// Checks of the results of evaluation.
#pragma once

#include "integrations/program/accept/accepted_rig.h"
#include "integrations/program/accept/check.h"
#include "integrations/program/io/terminal.h"

namespace mien::cli {

/// All LODs against the model in double precision, a check for each instruction set, with angles and with
/// quaternions; then whether instruction sets of a family agree bit by bit.
std::vector<Check> check_model(const AcceptedRig& rig, const Session& session);

/// Each LOD opened alone against the same LOD of the whole file.
Check check_subsets(const AcceptedRig& rig, const std::string& path, const Session& session);

/// Baked to memory and opened again: the same bits.
Check check_bake(const AcceptedRig& rig);

/// Written again: the same bytes.
Check check_round_trip(const AcceptedRig& rig, const std::string& path);

}  // namespace mien::cli
