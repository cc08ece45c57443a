// SPDX-License-Identifier: MIT
#include "integrations/program/live/address.h"

#include <algorithm>
#include <iterator>

#include "integrations/program/io/failure.h"
#include "integrations/program/live/landmark_packet.h"
#include "integrations/program/live/live_link_face.h"
#include "integrations/program/live/vmc.h"

namespace mien::live {

namespace {

struct Scheme {
  std::string text;
  uint16_t port;  // the usual one
};

/// In the order of Protocol.
const Scheme kSchemes[] = {{"livelink://", kLiveLinkPort},
                           {"vmc://", kVmcPort},
                           {"landmarks2://", kLandmarksPort},
                           {"landmarks3://", kLandmarksPort}};

uint16_t parse_port(const std::string& option, const std::string& text, const std::string& digits,
                    bool is_destination, const char* advice) {
  uint32_t port = 0;
  bool good = !digits.empty() && digits.size() <= 5;
  for (const char c : digits) {
    good = good && c >= '0' && c <= '9';
    port = port * 10 + static_cast<uint32_t>(c - '0');
  }
  if (good && port <= 65535 && (port != 0 || !is_destination)) return static_cast<uint16_t>(port);
  cli::fail_usage(option + " " + text, "the port is not a number up to 65535", advice);
}

}  // namespace

Address parse_address(const std::string& option, const std::string& text, bool is_destination) {
  Address address;
  const auto scheme = std::find_if(
      std::begin(kSchemes), std::end(kSchemes),
      [&](const Scheme& known) { return text.compare(0, known.text.size(), known.text) == 0; });
  address.protocol = static_cast<Protocol>(scheme - std::begin(kSchemes));
  const char* advice = is_destination
                           ? "write it as vmc://127.0.0.1:39539"
                           : "write it as livelink://:11111, vmc://:39539 or landmarks3://:11112";
  if (scheme == std::end(kSchemes) || (is_destination && address.protocol != Protocol::kVmc)) {
    cli::fail_usage(option + " " + text,
                    is_destination ? "only vmc:// can be sent"
                                   : "none of livelink://, vmc://, landmarks2:// and landmarks3://",
                    advice);
  }
  const std::string rest = text.substr(scheme->text.size());
  const size_t colon = rest.find(':');
  address.host = rest.substr(0, colon);
  address.port = colon == std::string::npos
                     ? scheme->port
                     : parse_port(option, text, rest.substr(colon + 1), is_destination, advice);
  const bool has_odd_bytes = address.host.find_first_not_of(
                                 "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                 "0123456789.-") != std::string::npos;
  if (has_odd_bytes || address.host.size() > 253 || (is_destination && address.host.empty())) {
    cli::fail_usage(option + " " + text, "this is not the name or IPv4 address of a machine",
                    advice);
  }
  return address;
}

std::string to_text(const Address& address) {
  return kSchemes[static_cast<size_t>(address.protocol)].text + address.host + ":" +
         std::to_string(address.port);
}

}  // namespace mien::live
