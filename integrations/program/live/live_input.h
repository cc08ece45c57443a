// SPDX-License-Identifier: MIT
// A live source on a rig: datagrams of a port -> rows of raw controls with times, ready for a mixer.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "integrations/program/io/handles.h"
#include "integrations/program/io/terminal.h"
#include "integrations/program/live/play_out.h"
#include "integrations/program/live/udp_socket.h"
#include "integrations/program/live/vmc.h"

namespace mien::live {

class LiveInput {
 public:
  /// Listens from now on. Notes channels that the rig has no controls for. `device`: the only device of
  /// Live Link Face that counts, by its id or the name of its subject; empty: whichever comes first.
  LiveInput(const Address& address, int64_t delay, const std::string& device, const MienRig* rig,
            const cli::Session& session);

  /// Raw controls that the source drives, in the order of the rows.
  const std::vector<uint16_t>& curves() const { return curves_; }

  /// Begins to count time: tick 0 is now.
  void start();
  /// Receives until `tick`. Returns early on a signal.
  void receive_until(int64_t tick);
  /// The next row that playing at `tick` needs.
  bool take(int64_t tick, int64_t& time, std::vector<float>& row);

  /// "received 118 packets; 2 damaged, 1 late"
  std::string summary() const;

 private:
  void bind(const MienRig* rig, const cli::Session& session);
  int64_t now() const;
  void use_datagram(const uint8_t* bytes, size_t size);
  void use_live_link(const uint8_t* bytes, size_t size);
  void use_row(double seconds, const float* values);

  Address address_;
  UdpSocket socket_;
  PlayOut play_out_;
  std::vector<std::string> channels_;
  std::unique_ptr<VmcDecoder> vmc_;
  std::unique_ptr<MienClipBinding, cli::Destroy<MienClipBinding, mien_clip_binding_destroy>>
      binding_;
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

  uint64_t packets_ = 0, damaged_ = 0, foreign_ = 0, twice_ = 0, late_ = 0, strange_ = 0;
};

}  // namespace mien::live
