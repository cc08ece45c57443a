// SPDX-License-Identifier: MIT
// For a build without liblo: VMC is refused before anything is opened.
#include "integrations/program/io/failure.h"
#include "integrations/program/live/vmc.h"

namespace mien::live {

void require_vmc(const std::string& option) {
  cli::fail_usage(option, "this build of mien has no OSC",
                  "build it where liblo is installed (Debian: liblo-dev)");
}

VmcDecoder::VmcDecoder(size_t, Find) {}
bool VmcDecoder::decode(const uint8_t*, size_t, const Use&) { return false; }
VmcSender::VmcSender(const Address&, std::vector<std::string>) {}
bool VmcSender::send(double, const float*) { return false; }

}  // namespace mien::live
