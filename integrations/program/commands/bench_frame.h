// SPDX-License-Identifier: MIT
// Whole frames of `mien bench`: evaluation, pose and deformation of all meshes of LOD 0.
#pragma once

#include <vector>

#include "integrations/program/commands/bench_measurement.h"

namespace mien::cli {

/// Times are for one character.
struct FrameRow {
  MienRigInfo info;
  uint32_t characters;
  double evaluate_ns, pose_ns, deform_ns;

  double frame_ns() const { return evaluate_ns + pose_ns + deform_ns; }
};

/// A row for each desc and number of characters, in this order; none for a file without geometry. A
/// quarter of the raw controls are active, others in each character. Normals are skinned.
std::vector<FrameRow> measure_frames(const RigFile& file, const std::vector<MienRigDesc>& descs,
                                     const BenchPlan& plan, const Session& session);

}  // namespace mien::cli
