// SPDX-License-Identifier: MIT
// `mien play` by the clock: live data in, frames out, until the scene ends or Ctrl-C.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "integrations/program/commands/solve_live.h"
#include "integrations/program/live/live_input.h"
#include "integrations/program/play/performance.h"

namespace mien::cli {

/// As they were typed; empty: none.
struct RealTimeOptions {
  std::string live, send, delay, device;
  LandmarkOptions landmarks;

  bool given() const { return !live.empty() || !send.empty(); }
};

/// Whether --live takes landmarks, for which a rig needs its meshes.
bool solves_landmarks(const RealTimeOptions& options);

/// A rig that live data move.
struct LiveRig {
  const MienRig* rig = nullptr;
  const MienDeformer* deformer = nullptr;  // null without geometry, which landmarks need
  std::string shown;
};

/// The live source of checked options. Listens from now on. The rig and the session outlive it.
std::unique_ptr<live::LiveInput> open_live(const RealTimeOptions& options, const LiveRig& rig,
                                           const NamesFile& names, const Session& session);

class RealTime {
 public:
  /// Wrong usage before anything is opened.
  static void check(const RealTimeOptions& options);

  /// Listens from now on.
  RealTime(const RealTimeOptions& options, const LiveRig& rig, const NamesFile& names,
           const Session& session);
  ~RealTime();
  RealTime(const RealTime&) = delete;
  RealTime& operator=(const RealTime&) = delete;

  const StreamScript& stream() const { return stream_; }

  /// Sleeps until a tick, and pushes the rows that have come and are needed then. False after Ctrl-C.
  bool wait(int64_t tick, Performance& performance);
  void send(double time, const float* row);
  /// Notes what was received, and what could not be sent.
  void finish(const Session& session);

 private:
  StreamScript stream_;
  std::unique_ptr<live::LiveInput> input_;
  std::unique_ptr<live::VmcSender> sender_;
  std::chrono::steady_clock::time_point start_;
  bool started_ = false;
  uint64_t unsent_ = 0;
};

}  // namespace mien::cli
