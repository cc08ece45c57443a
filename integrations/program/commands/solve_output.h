// SPDX-License-Identifier: MIT
// What `mien solve` writes: controls as JSON or a clip, a report, images.
#pragma once

#include "integrations/program/commands/solve_target.h"
#include "integrations/program/io/frames.h"

namespace mien::cli {

struct SolvedFrame {
  double rms = 0, worst = 0;  // of joint values or distances
  uint32_t iterations = 0;
  uint32_t status = 0;   // MIEN_FIT_...
  uint32_t missing = 0;  // points or joint values without a target
  bool jumped = false;   // it moved farther than the target asks for
  // Points of the target = rotation (rows) * model + translation.
  float rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, translation[3] = {};
  float focal[2] = {};  // of a camera that was found
};

/// What is left of a landmark, a joint, or a region of vertices, over all frames.
struct SolvedDatum {
  std::string name;
  double rms, worst;
  size_t worst_frame;
};

/// What is left of all targets of a kind, over the frames that have data.
struct SolvedKind {
  std::string name;
  double squares = 0, worst = 0;
  size_t frame_count = 0;
};

/// Controls of a take.
struct SolvedTake {
  std::string rig;                    // its name
  std::vector<std::string> controls;  // names of all raw controls
  std::vector<float> values;          // [frame][control]
  std::vector<SolvedFrame> frames;
  std::vector<SolvedDatum> data;            // the worst first; empty without a report
  std::vector<SolvedKind> kinds;            // of several targets; else empty
  std::vector<std::string> unobservable;    // names of controls that the data does not determine
  std::vector<std::vector<uint32_t>> keys;  // of each control, frame numbers; empty: every frame
  Rate rate;
  bool rigid = false;  // frames have a rotation and a translation
  float reach = 0;     // of surfaces; 0: no limit
  double seconds = 0;  // that solving took

  const float* row(size_t frame) const { return values.data() + frame * controls.size(); }
  Frame pose(size_t frame) const;
};

/// Chooses keys, between which the curves become straight lines within `tolerance` of what they were.
void reduce_keys(SolvedTake& take, float tolerance);

/// As `mien play` writes frames, and the frame numbers of keys if there are any.
void write_solved_json(const SolvedTake& take, Output& output);
void write_solved_clip(const SolvedTake& take, Output& output);
void write_solve_report(const SolvedTake& take, const SolveTarget& target, Output& output);

/// Some frames: the target, what was solved, and the distance between them. `rig` is the path.
std::string draw_solve(const SolvedTake& take, const SolveTarget& target, const SolvedRig& solved,
                       const std::string& rig, const Session& session);

}  // namespace mien::cli
