// SPDX-License-Identifier: MIT
// A live source on a rig: datagrams of a port -> rows of raw controls with times, ready for a mixer.
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "integrations/program/io/bound_clip.h"
#include "integrations/program/io/terminal.h"
#include "integrations/program/live/landmark_packet.h"
#include "integrations/program/live/play_out.h"
#include "integrations/program/live/udp_socket.h"
#include "integrations/program/live/vmc.h"

namespace mien::live {

/// What makes raw controls of landmarks.
struct LandmarkSolver {
  enum class Outcome {
    kSolved,
    kCutShort,  // by the time; the best controls so far
    kNeutral,   // the face at rest, which is being measured
    kNoFace,    // too few landmarks, or they are not those of the face
  };
  LandmarkNames names;
  std::vector<uint16_t> curves;  // raw controls that the landmarks determine
  double seconds = 0;            // that solving may take in a frame
  /// Writes all raw controls of the rig, where it solved. Each solve starts from the one before, but `anew`
  /// from rest.
  std::function<Outcome(const LandmarkPacket& packet, double seconds, bool anew, float* raw)> solve;
};

class LiveInput {
 public:
  /// Listens from now on. Notes what `names` and the library match to controls of other names, and channels that
  /// the rig has no controls for. `device`: the only device of Live Link Face that counts, by its id or the name of
  /// its subject; empty: whichever comes first. The rig and the session outlive it.
  LiveInput(const Address& address, int64_t delay, const std::string& device, const MienRig* rig,
            const cli::NamesFile& names, const cli::Session& session);
  /// Landmarks, which `solver` makes controls of. Listens from now on.
  LiveInput(const Address& address, int64_t delay, LandmarkSolver solver, const MienRig* rig,
            const cli::Session& session);

  /// Raw controls that the source drives, in the order of the rows.
  const std::vector<uint16_t>& curves() const { return curves_; }

  /// Begins to count time: tick 0 is now.
  void start();
  /// Receives until `tick`, which is a frame: landmarks are solved when they arrive, as long as the time of the frame
  /// lasts. Returns early on a signal.
  void receive_until(int64_t tick);
  /// The next row that playing at `tick` needs.
  bool take(int64_t tick, int64_t& time, std::vector<float>& row);

  /// "received 118 packets; 2 damaged, 1 late"
  std::string summary() const;

 private:
  /// A name of a VMC sender that is no channel, and the controls that it means.
  struct OtherName {
    bool
        adds_up;  // given, or an expression of several controls; else the largest value of a control counts
    std::vector<MienControlShare> shares;
  };

  void bind(const cli::NamesFile& names);
  void add_given_names(const cli::NamesFile& names);
  int find_channel(std::string_view name);
  int64_t now() const;
  void use_datagram(const uint8_t* bytes, size_t size);
  void use_live_link(const uint8_t* bytes, size_t size);
  void use_landmarks(const uint8_t* bytes, size_t size);
  void use_row(double seconds, const float* values);
  void play(double seconds);
  void note_once(const std::string& what);

  const MienRig* rig_;
  const cli::Session& session_;
  Address address_;
  UdpSocket socket_;
  PlayOut play_out_;
  std::vector<std::string> channels_;
  std::unordered_map<std::string, int>
      numbers_;  // of channels in lower case, then of other names; -1: none
  std::vector<OtherName> others_;
  std::unique_ptr<VmcDecoder> vmc_;
  cli::ClipBinding binding_;
  std::vector<uint16_t> curves_;
  std::vector<float> raw_;  // all raw controls
  std::chrono::steady_clock::time_point start_;

  // Of two devices that send to one port, the first one counts until it is silent for a second, which
  // packets of others do not extend; with a name, only the device of that name.
  std::string wanted_, device_;
  int64_t device_seen_ = 0;
  // VMC: what the sender last said, and when; frames without a time go on from it.
  double said_ = -1;
  int64_t said_at_ = 0;

  // Landmarks.
  LandmarkSolver solver_;
  std::unique_ptr<LandmarkDecoder> landmarks_;
  double solving_ = 0;      // seconds in this frame
  int64_t solved_at_ = -1;  // negative: never
  std::set<std::string> noted_;
  uint64_t solved_ = 0, cut_short_ = 0, unsolved_ = 0, faceless_ = 0, neutral_ = 0;
  double cpu_sum_ = 0, cpu_most_ = 0;  // seconds of the processor for each solve

  uint64_t packets_ = 0, damaged_ = 0, foreign_ = 0, twice_ = 0, late_ = 0, strange_ = 0;
};

}  // namespace mien::live
