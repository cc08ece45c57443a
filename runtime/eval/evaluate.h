// SPDX-License-Identifier: MIT
// Rig + instance -> joint values, channel weights, map weights. Nothing here allocates, locks or
// fails: the rig was checked when it was compiled, and callers check LODs and indices.
//
//     GUI controls -> raw controls -> ML -> RBF -> PSD -> joints
//                                                      -> blend shapes
//                                                      -> animated maps
//
// The order is that of docs/rig-evaluation.md, 1.3 "Order of evaluation".
#pragma once

#include "runtime/eval/instance.h"

namespace mien {

/// docs/rig-evaluation.md, 2.3 "GUI controls to raw controls" and 2.4 "Raw controls to GUI controls".
void map_gui_to_raw(const Rig& rig, Instance& instance);
void map_raw_to_gui(const Rig& rig, Instance& instance);

/// Evaluates the given stages (MIEN_STAGE_...), in the order above. Stages whose results cannot have
/// changed do not run (runtime/rig/stage_access.h).
void evaluate(const Rig& rig, Instance& instance, uint32_t lod, uint32_t stages);

/// Evaluates the joint values of one group. Other values do not change, and neither do values that a
/// later group overrides wherever this group writes them.
void evaluate_joint_group(const Rig& rig, Instance& instance, uint32_t lod, uint32_t group);

/// Evaluates the pose controls of one solver, whether the LOD lists it or not.
void evaluate_rbf_solver(const Rig& rig, Instance& instance, uint32_t lod, uint32_t solver);

/// Evaluates the joints of one twist and swing setup.
void evaluate_twist_swing(const Rig& rig, Instance& instance, uint32_t lod, uint32_t setup);

}  // namespace mien
