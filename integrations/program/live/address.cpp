// SPDX-License-Identifier: MIT
#include "integrations/program/live/address.h"

#include "integrations/program/io/failure.h"
#include "integrations/program/live/live_link_face.h"
#include "integrations/program/live/vmc.h"

namespace mien::live {

namespace {

constexpr const char* kSchemes[] = {"livelink://", "vmc://"};

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
  const bool is_link = text.rfind(kSchemes[0], 0) == 0, is_vmc = text.rfind(kSchemes[1], 0) == 0;
  const char* advice = is_destination ? "write it as vmc://127.0.0.1:39539"
                                      : "write it as livelink://:11111 or vmc://:39539";
  if (!is_vmc && (!is_link || is_destination)) {
    cli::fail_usage(option + " " + text,
                    is_destination ? "only vmc:// can be sent" : "neither livelink:// nor vmc://",
                    advice);
  }
  address.protocol = is_vmc ? Protocol::kVmc : Protocol::kLiveLink;
  const std::string rest = text.substr(std::string(kSchemes[is_vmc ? 1 : 0]).size());
  const size_t colon = rest.find(':');
  address.host = rest.substr(0, colon);
  address.port = colon == std::string::npos
                     ? (is_vmc ? kVmcPort : kLiveLinkPort)
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
  return kSchemes[address.protocol == Protocol::kVmc ? 1 : 0] + address.host + ":" +
         std::to_string(address.port);
}

}  // namespace mien::live
