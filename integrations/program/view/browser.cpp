// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <spawn.h>

#include <csignal>
#include <cstdlib>

#include "integrations/program/view/viewer_server.h"

extern char** environ;

namespace mien::view {

bool open_browser(const std::string& url) {
#if defined(__APPLE__)
  const char* const program = "open";
#else
  const char* const program = "xdg-open";
  // Without a desktop it would show the page in the terminal, if at all.
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return false;
#endif
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  if (posix_spawn_file_actions_init(&files) != 0) return false;
  if (posix_spawnattr_init(&attributes) != 0) {
    posix_spawn_file_actions_destroy(&files);
    return false;
  }
  for (const int descriptor : {0, 1, 2}) {
    posix_spawn_file_actions_addopen(&files, descriptor, "/dev/null", O_RDWR, 0);
  }
  // In a group of its own, so that Ctrl+C ends this program and not the browser.
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  std::string name = program, address = url;
  char* arguments[] = {name.data(), address.data(), nullptr};
  std::signal(SIGCHLD, SIG_IGN);  // this program does not wait for it
  pid_t child = 0;
  const int failed = posix_spawnp(&child, program, &files, &attributes, arguments, environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  return failed == 0;
}

}  // namespace mien::view
