// SPDX-License-Identifier: MIT
// A UDP port of this machine, IPv4.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>

#include "integrations/program/live/address.h"

namespace mien::live {

class UdpSocket {
 public:
  /// Binds; the exit code of files if that fails. Port 0 takes a free one.
  explicit UdpSocket(const Address& address);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  uint16_t port() const { return port_; }

  using Time = std::chrono::steady_clock::time_point;
  /// Waits until `end`, and calls `use` for each datagram when it arrives. Returns early on a signal.
  void receive_until(Time end, const std::function<void(const uint8_t*, size_t)>& use);

 private:
  int socket_ = -1;
  uint16_t port_ = 0;
};

}  // namespace mien::live
