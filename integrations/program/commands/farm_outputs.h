// SPDX-License-Identifier: MIT
// What a task of `mien farm` writes, by the functions of the other commands.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "integrations/program/commands/farm_job.h"
#include "integrations/program/scene/posed_scene.h"

namespace mien::cli {

/// Curves of a take, and the controls of the rig that they move.
struct BoundTake {
  Take take;
  std::vector<std::vector<MienControlShare>> controls;  // of each channel

  /// The controls of frame `number` of the take.
  Frame frame(uint64_t number) const;
  /// The same in raw controls that have no other values but those of another frame of the take.
  void set(uint64_t number, float* raw) const;
};

/// Instances for frames of a take that are evaluated together: these move the same controls, so that the rig is read
/// once for all of them.
struct FrameBlock {
  FrameBlock(const MienRig* rig, uint32_t lod);

  std::vector<Instance> owners;
  std::vector<MienInstance*> instances;
  std::vector<float*> raw;  // controls of each
  std::vector<uint32_t> lods;
  Batch batch;
};

/// A file that a task wrote, and what was written to it.
struct DoneFile {
  std::string path;
  uint64_t bytes = 0;
  std::string fingerprint;
};

/// Does tasks one after the other. Keeps one rig and one take open: that, and the frames of a block, is its memory. A
/// GLB needs all frames of its take.
class FarmWorker {
 public:
  FarmWorker(const FarmJob& job, const Session& session) : job_(job), session_(session) {}

  /// Names the file of an output.
  using Name = std::function<std::string(const FarmOutput& output, uint64_t frame)>;

  /// Returns the files that it wrote. Throws if anything fails; then only whole files are there.
  std::vector<DoneFile> run(const FarmTask& task, const Name& name);

  // What run() begins with, unless it is open: what the outputs need of the rig, then all frames of the take. Nothing
  // where takes are captured.
  void open_rig(uint32_t rig);
  void open_take(uint32_t take);

 private:
  void write_frames(const FarmTask& task, const Name& name, std::vector<DoneFile>& files);
  void evaluate(uint64_t first, uint32_t count);
  DoneFile write_glb(const FarmOutput& output, const FarmTask& task, const std::string& path);
  DoneFile solve(const FarmOutput& output, const FarmTask& task, const std::string& path);
  std::string draw(const FarmOutput& output);

  const FarmJob& job_;
  const Session& session_;
  std::optional<uint32_t> rig_, take_;  // that are open
  std::optional<PosedScene> scene_;
  std::optional<FrameBlock> block_;
  std::unique_ptr<ExportedRig> exported_;
  std::vector<gltf::RigScene> neutral_;  // of each GLB output
  BoundTake bound_;
};

}  // namespace mien::cli
