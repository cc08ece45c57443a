// SPDX-License-Identifier: MIT
// VMC, the Virtual Motion Capture protocol: values of expressions as OSC messages over UDP.
//
//     /VMC/Ext/T          f    time in seconds, of the sender
//     /VMC/Ext/Blend/Val  s f  an expression and its value
//     /VMC/Ext/Blend/Apply     the values so far are a frame
//
// Messages are alone in a datagram or in bundles. liblo decodes and encodes them; a build without it says
// so (vmc_without_liblo.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "integrations/program/live/address.h"

namespace mien::live {

constexpr uint16_t kVmcPort = 39539;

/// Fails unless this build has liblo.
void require_vmc(const std::string& option);

class VmcDecoder {
 public:
  /// Finds the number of an expression, or -1 for one that does not count.
  using Find = std::function<int(std::string_view name)>;
  VmcDecoder(size_t count, Find find);

  /// Calls `use` for each frame that a datagram completes, with one value per expression; those that have
  /// not come keep their values, at first 0. `seconds` is negative if the sender gave no time. False if
  /// something in the datagram is damaged: that is left out.
  using Use = std::function<void(double seconds, const std::vector<float>& values)>;
  bool decode(const uint8_t* bytes, size_t size, const Use& use);

 private:
  bool decode_message(const uint8_t* bytes, size_t size, const Use& use);

  Find find_;
  std::vector<float> values_;
  double seconds_ = -1;
};

class VmcSender {
 public:
  VmcSender(const Address& to, std::vector<std::string> names);

  /// A frame, in datagrams that fit into those of Ethernet. False if the system did not take one.
  bool send(double seconds, const float* values);

 private:
  std::vector<std::string> names_;
  std::shared_ptr<void> address_;
};

}  // namespace mien::live
