// SPDX-License-Identifier: MIT
// A web server for this machine alone: shows the page of integrations/web with a file in it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "integrations/program/view/live_rows.h"

namespace mien::view {

struct Served {
  std::string type;  // as in Content-Type
  std::string bytes;
};

/// By path, such as "/viewer.css", decoded. Nothing else is served.
using Files = std::map<std::string, Served>;

/// Fails unless this build has a server.
void require_server();

/// Serves until the program is interrupted. Listens on 127.0.0.1 alone, at `port`, or at a free one if it
/// is 0; `started` gets the port. Answers GET only, and only if it is asked for under this address: a page
/// of elsewhere whose name has come to point here does not get the files. Fails if the port is taken.
/// "/live" answers with the heading of `live` and a line for each row that comes within the next seconds; null:
/// there are none. Its waiting is ended when the program is interrupted.
void serve(const Files& files, LiveRows* live, uint16_t port,
           const std::function<void(uint16_t port)>& started);

/// Asks the desktop to show an address; false if there is none.
bool open_browser(const std::string& url);

}  // namespace mien::view
