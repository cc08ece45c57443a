// SPDX-License-Identifier: MIT
// For a build without cpp-httplib.
#include "integrations/program/io/failure.h"
#include "integrations/program/view/viewer_server.h"

namespace mien::view {

void require_server() {
  cli::fail(cli::kUsage, "wrong usage", "view", "this build of mien has no web server",
            "build it where cpp-httplib is installed (Debian: libcpp-httplib-dev)");
}

void serve(const Files&, LiveRows*, uint16_t, const std::function<void(uint16_t)>&) {}
bool open_browser(const std::string&) { return false; }

}  // namespace mien::view
