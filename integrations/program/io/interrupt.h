// SPDX-License-Identifier: MIT
// Ctrl-C while a command works and has written nothing yet.
#pragma once

#include <csignal>
#include <cstdlib>

namespace mien::cli {

constexpr int kInterrupted = 130;  // as shells say of a program that Ctrl-C ended

// Nothing has been written, so nothing needs to be taken back.
extern "C" inline void end_interrupted(int) { std::_Exit(kInterrupted); }

/// While it lives, Ctrl-C ends the program at once.
struct EndOnInterrupt {
  void (*before)(int);
  EndOnInterrupt() : before(std::signal(SIGINT, end_interrupted)) {}
  ~EndOnInterrupt() { std::signal(SIGINT, before); }
  EndOnInterrupt(const EndOnInterrupt&) = delete;
  EndOnInterrupt& operator=(const EndOnInterrupt&) = delete;
};

}  // namespace mien::cli
