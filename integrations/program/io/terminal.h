// SPDX-License-Identifier: MIT
// Colors, notes and progress, shown only where a person reads them.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
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
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

/// `text` in that style if `colors` are wanted.
std::string paint(const std::string& text, Style style, bool colors);

/// "mien: note: text" on standard error, unless --quiet.
void note(const Session& session, const std::string& text);

/// "mien: text" on standard error.
void print_failure(const Session& session, const std::string& text);

/// "wrote head.glb, 9.0 MB, 1.2 s" on standard error: the file and the time since the program started.
/// Only on a terminal, without --quiet, and not for standard output ("-").
void note_written(const Session& session, const std::string& path, uint64_t bytes);

/// "image  [=====>    ]  45 %  23/52  3.4/s  9 s left" on standard error while the object lives, once
/// that is longer than a second; only on a terminal and without --quiet.
class Progress {
 public:
  /// Without a total, `what` alone is shown, at once: what comes cannot tell how far it is.
  Progress(const Session& session, std::string what, size_t total = 0);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(size_t done);
  /// Removes the line; the destructor does, too.
  void finish();
  /// The same as at() where there is nothing to count: only bar and remaining time are shown.
  void at_share(double share);

 private:
  using Clock = std::chrono::steady_clock;

  bool is_due();
  void show(double share, const std::string& counts);

  bool shown_;
  std::string what_;
  size_t total_;
  Clock::time_point start_, next_;
};

}  // namespace mien::cli
