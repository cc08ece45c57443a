// SPDX-License-Identifier: MIT
// JOB of `mien farm`: rigs x takes x outputs, cut into tasks.
//
//     JOB.json -> FarmJob -> tasks, in the order of rigs, then takes, then frames -> piece K of N: some tasks in a row
//
// A task is a take on a rig, or a block of its frames if each frame has files of its own. Tasks depend on the job alone
// and not on the number of pieces, so files are the same whatever the cut.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/commands/exported_rig.h"
#include "integrations/program/commands/render_output.h"
#include "integrations/program/commands/solve.h"
#include "integrations/program/io/take.h"

namespace mien::cli {

/// In the order of the words of "kind".
enum class FarmKind { kJoints, kVertices, kGlb, kPng, kClip };

struct FarmOutput {
  FarmKind kind = FarmKind::kJoints;
  std::string pattern;        // path with {rig}, {take}, {frame}
  bool per_frame = false;     // the pattern has {frame}
  std::string mesh;           // of vertices
  std::string meshes;         // of images
  RenderOutputOptions image;  // of images
  GlbOptions glb;             // of GLB files
  SolveCommand solve;         // of clips; without rig, target and output
};

struct FarmJob {
  std::string path, folder, name;        // of the job file; its folder; its name without the ending
  std::vector<std::string> rigs, takes;  // paths
  std::vector<FarmOutput> outputs;
  uint32_t lod = 0;
  Rate rate;                     // unknown: that of each take
  uint64_t block = 0;            // frames of a task, if takes are cut
  uint32_t isa = MIEN_ISA_BEST;  // by default one that gives the same bits on every machine
  std::string settings;  // all that results depend on, but for the contents of rigs and takes

  bool has(FarmKind kind) const;
  bool solves() const { return has(FarmKind::kClip); }  // takes are captured data then
  bool cuts_takes() const;
};

/// Paths are relative to the folder of the file. Exit code 2 with the place of what is wrong.
FarmJob read_farm_job(const std::string& path);

struct FarmTask {
  uint32_t rig = 0, take = 0;  // indices
  uint64_t first = 0,
           count = 0;  // frames; count 0: all, or unknown because the take cannot be read
};

/// Opens each take once where takes are cut; those that cannot be opened are one task, which fails when it is run.
std::vector<FarmTask> farm_tasks(const FarmJob& job);

/// The frames of a take; throws if it cannot be read.
uint64_t count_frames(const FarmJob& job, uint32_t take);

/// The curves of a take at the rate of the job.
Take load_farm_take(const FarmJob& job, uint32_t take);

/// "line_0007", the name of a file without folder and ending.
std::string stem_of(const std::string& path);

/// The file of an output.
std::string farm_path(const FarmJob& job, const FarmOutput& output, const FarmTask& task,
                      uint64_t frame);

}  // namespace mien::cli
