// SPDX-License-Identifier: MIT
// What each stage of an evaluation reads and writes, and the rule that decides which results an
// instance may reuse.
//
//     stage          reads                                               writes
//     -------------  --------------------------------------------------  -----------------------------
//     ML             controls that networks and sums gather, masks       controls that they scatter;
//                                                                        of converted ML joints, too
//     RBF            inputs of solvers and of poses                      outputs of poses
//     PSD            inputs of correctives                               correctives
//     joints         columns of the joint matrix and of quaternion       joint values
//                    joints, inputs of twists and swings, controls of
//                    ML joints
//     blend shapes   inputs of channels                                  channel weights
//     animated maps  inputs of the map table                             map weights
//
// In addition, the caller writes raw controls and masks; resetting an instance or changing its LOD
// writes everything except these inputs.
//
// A stage is stale if running it might change something that it writes. The rule:
//
//     When a value changes, all stages that read or write it become stale. The only exception is the
//     stage that has just written it, unless it also reads it.
//
// The rule covers files whose stages write raw controls, overwrite each other, or read values that are
// written later (they then read the value of the previous frame). Only stale stages run. The results of
// a stage depend only on the values that it reads and on the LOD, so the other stages would write the
// values that are already there.
//
// Rig::control_uses is the rule as a table: for each control the stages that read or write it, and
// the row panels of the joint matrix that read it. Instance::stale is a union of such entries.
#pragma once

#include <cstdint>

#include "runtime/rig/joint_matrix.h"

namespace mien {

struct Rig;

/// Numbers of MIEN_STAGE_... in mien.h, in the order of evaluation.
enum Stages : uint32_t {
  kStageMl = 1,
  kStageRbf = 2,
  kStagePsd = 4,
  kStageJoints = 8,  // groups, then twists and swings, then ML joints
  kStageBlendShapes = 16,
  kStageAnimatedMaps = 32,
  kStagesAll = 63,
};

/// A set of stages, in the low bits, and of row panels, from bit kFirstPanelBit on: bit panel_bit()
/// for a panel.
using Uses = uint64_t;
constexpr uint32_t kFirstPanelBit = 8;
constexpr uint32_t kPanelBits = 64 - kFirstPanelBit;
constexpr Uses kAllPanels = ~Uses{0} << kFirstPanelBit;
constexpr Uses kAllUses = kStagesAll | kAllPanels;

inline uint32_t panel_bit(const JointMatrix& joints, uint32_t panel) {
  return kFirstPanelBit + (panel >> joints.panel_shift);
}

/// A range of the control vector.
struct ControlRange {
  uint32_t first = 0, end = 0;
};

/// The derived part of a compiled rig: Rig::control_uses, ml_writes, rbf_writes and feedback_stages.
/// All other parts have been filled.
void fill_stage_access(Rig& rig);

}  // namespace mien
