// SPDX-License-Identifier: MIT
// Colors, notes and progress: only where a person looks.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace mien::cli {

struct Session;

enum class Style { kPlain, kBold, kRed, kYellow, kGreen };

struct Terminal {
  bool out_is_terminal = false;
  bool error_is_terminal = false;
  bool out_colours = false;
  bool error_colours = false;
};

/// Asks the system; honors NO_COLOR and TERM=dumb.
Terminal find_terminal();

/// `text` in that style if `colors` are wanted.
std::string paint(const std::string& text, Style style, bool colors);

/// "mien: note: text" on standard error, unless --quiet.
void note(const Session& session, const std::string& text);

/// "mien: text" on standard error.
void print_failure(const Session& session, const std::string& text);

/// "evaluating 3/8" on standard error while it lives: on a terminal only, not with --quiet.
class Progress {
 public:
  Progress(const Session& session, std::string what, size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(size_t done) { at(what_, done); }
  void at(const std::string& what, size_t done);

 private:
  using Clock = std::chrono::steady_clock;

  bool shown_;
  std::string what_;
  size_t total_;
  Clock::time_point next_;
};

}  // namespace mien::cli
