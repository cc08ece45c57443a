// SPDX-License-Identifier: MIT
// Colors, notes and progress, shown only where a person reads them.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace mien::cli {

enum class Style { kPlain, kBold, kRed, kYellow, kGreen };

struct Terminal {
  bool out_is_terminal = false;
  bool error_is_terminal = false;
  bool out_colors = false;
  bool error_colors = false;
};

/// Asks the system; honors NO_COLOR and TERM=dumb.
Terminal find_terminal();

/// What every command knows about how it was started.
struct Session {
  bool quiet = false;
  Terminal terminal;
};

/// `text` in that style if `colors` are wanted.
std::string paint(const std::string& text, Style style, bool colors);

/// "mien: note: text" on standard error, unless --quiet.
void note(const Session& session, const std::string& text);

/// "mien: text" on standard error.
void print_failure(const Session& session, const std::string& text);

/// "frame 3/8" on standard error while the object lives; only on a terminal and without --quiet.
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
