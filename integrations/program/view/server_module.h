// SPDX-License-Identifier: MIT
// The web server, a module that is loaded when a page is served: cpp-httplib brings OpenSSL and Brotli, which take as
// long to load as the rest of the program.
#pragma once

#include "integrations/program/view/viewer_server.h"

namespace mien::view {

/// As serve(), but false if it cannot listen at the port.
extern "C" __attribute__((visibility("default"))) bool mien_serve_page(
    const Files& files, LiveRows* live, uint16_t port,
    const std::function<void(uint16_t)>& started);

}  // namespace mien::view
