// SPDX-License-Identifier: MIT
// All frames of a performance, and the files of text and curves that they become.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/io/frames.h"
#include "integrations/program/io/output.h"
#include "integrations/program/play/performance.h"

namespace mien::cli {

struct Recording {
  double rate = 60;
  std::vector<double> times;
  std::vector<float> rows;                      // [frame][curve]
  std::vector<uint16_t> watched;                // curves with stages
  std::vector<std::vector<float>> stages;       // [frame][watched curve * stages + stage]
  std::vector<std::vector<GuardFrame>> guards;  // [frame][guard]
  Captions captions;
  std::vector<HeadPose> heads;  // of each frame, or empty

  /// What images and GLB files show of a frame; `raw` are the first of its curves.
  Frame shown_frame(size_t number, size_t raw_count) const;
};

/// Drops the watched curves that stay as they are, with their stages.
void keep_moving(const Performance& performance, Recording& recording);

/// Frames as `mien eval` takes them. `stages`: those of the watched curves as well.
void write_json(const std::string& rig_name, const Performance& performance,
                const Recording& recording, bool stages, Output& output);
void write_csv(const Performance& performance, const Recording& recording, Output& output);
/// `shown` is for messages.
void write_clip(const Performance& performance, const Recording& recording,
                const std::string& shown, Output& output);
/// The watched curves over time.
void write_svg(const Performance& performance, const Recording& recording, Output& output);

}  // namespace mien::cli
