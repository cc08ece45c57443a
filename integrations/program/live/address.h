// SPDX-License-Identifier: MIT
// "vmc://host:port": where data come from or go to.
#pragma once

#include <cstdint>
#include <string>

namespace mien::live {

/// In the order of the schemes. Landmarks: two coordinates each, or three.
enum class Protocol { kLiveLink, kVmc, kLandmarks2, kLandmarks3 };

inline bool has_landmarks(Protocol protocol) {
  return protocol == Protocol::kLandmarks2 || protocol == Protocol::kLandmarks3;
}

struct Address {
  Protocol protocol = Protocol::kLiveLink;
  std::string host;  // empty: every address of this machine
  uint16_t port = 0;
};

/// "livelink://:11111", "vmc://127.0.0.1:39539", "landmarks3://:11112"; without a port the usual one of the protocol. Wrong usage of
/// `option` for anything else. A destination needs a host and takes VMC only.
Address parse_address(const std::string& option, const std::string& text, bool is_destination);

std::string to_text(const Address& address);

}  // namespace mien::live
