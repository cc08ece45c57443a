// SPDX-License-Identifier: MIT
#include "integrations/program/view/viewer_server.h"

#include <dlfcn.h>

#include <string>

#include "integrations/program/io/failure.h"
#include "integrations/program/view/page.h"
#include "integrations/program/view/server_module.h"

namespace mien::view {
namespace {

/// mien_serve_page() of the module, loaded once and kept.
decltype(&mien_serve_page) load_server() {
  const std::string path = installed_folder() / MIEN_SERVER_MODULE;
  void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const function = module ? dlsym(module, "mien_serve_page") : nullptr;
  if (!function) {
    const char* const why = dlerror();
    cli::fail(cli::kFile, "cannot view", path, why ? why : "it has no server",
              "install mien again");
  }
  return reinterpret_cast<decltype(&mien_serve_page)>(function);
}

}  // namespace

void require_server() { load_server(); }

void serve(const Files& files, LiveRows* live, uint16_t port,
           const std::function<void(uint16_t)>& started) {
  if (load_server()(files, live, port, started)) return;
  const std::string where = port == 0 ? "a free port" : "port " + std::to_string(port);
  cli::fail(cli::kFile, "cannot listen", "127.0.0.1, " + where, "it is taken or not allowed",
            "choose another one with --port");
}

}  // namespace mien::view
