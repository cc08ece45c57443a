// SPDX-License-Identifier: MIT
// What `mien eval` writes for each frame and LOD, in the format that was chosen.
#pragma once

#include <memory>
#include <string>

#include "integrations/program/io/handles.h"
#include "integrations/program/io/output.h"

namespace mien::cli {

enum class EvalFormat { kJson, kJsonLines, kCsv, kNpy };  // in the order of the words of --format

/// What stands above the frames; a baked rig does not know its name and version.
struct EvalHeading {
  std::string shown, name, version;
  bool baked = false;
};

/// begin(), then write() for each LOD of each frame in order, then end(). Fails at the first value that
/// is not finite.
class EvalWriter {
 public:
  virtual ~EvalWriter() = default;
  /// `rows` is how often write() will be called.
  virtual void begin(const MienRig* rig, const EvalHeading& heading, size_t rows) = 0;
  virtual void write(size_t frame, uint32_t lod, const MienInstance* instance) = 0;
  virtual void end() = 0;
};

std::unique_ptr<EvalWriter> make_eval_writer(EvalFormat format, Output& output);

}  // namespace mien::cli
