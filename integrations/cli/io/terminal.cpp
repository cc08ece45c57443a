// SPDX-License-Identifier: MIT
#include "integrations/cli/io/terminal.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#if defined(_WIN32)
#include <io.h>
#else
#include <unistd.h>
#endif

#include "integrations/cli/io/text.h"

namespace mien::cli {

namespace {

bool is_terminal(FILE* stream) {
#if defined(_WIN32)
  return _isatty(_fileno(stream)) != 0;
#else
  return isatty(fileno(stream)) != 0;
#endif
}

}  // namespace

Terminal find_terminal() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  const bool wanted = !(no_color && *no_color) && term && std::strcmp(term, "dumb") != 0;
  Terminal terminal;
  terminal.out_is_terminal = is_terminal(stdout);
  terminal.error_is_terminal = is_terminal(stderr);
  terminal.out_colors = wanted && terminal.out_is_terminal;
  terminal.error_colors = wanted && terminal.error_is_terminal;
  return terminal;
}

std::string paint(const std::string& text, Style style, bool colors) {
  if (!colors) return text;
  switch (style) {
    case Style::kPlain: break;
    case Style::kBold: return "\033[1m" + text + "\033[0m";
    case Style::kRed: return "\033[1;31m" + text + "\033[0m";
    case Style::kYellow: return "\033[33m" + text + "\033[0m";
    case Style::kGreen: return "\033[32m" + text + "\033[0m";
  }
  return text;
}

void note(const Session& session, const std::string& text) {
  if (session.quiet) return;
  const bool colors = session.terminal.error_colors;
  std::fprintf(stderr, "%s %s\n", paint("mien: note:", Style::kYellow, colors).c_str(),
               one_line(text).c_str());
}

void print_failure(const Session& session, const std::string& text) {
  const bool colors = session.terminal.error_colors;
  std::fprintf(stderr, "%s %s\n", paint("mien:", Style::kRed, colors).c_str(),
               one_line(text).c_str());
}

Progress::Progress(const Session& session, std::string what, size_t total)
    : shown_(session.terminal.error_is_terminal && !session.quiet), what_(std::move(what)),
      total_(total), next_(Clock::now() + std::chrono::milliseconds(300)) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::at(const std::string& what, size_t done) {
  if (!shown_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(100);
  std::fprintf(stderr, "\r\033[K%s %zu/%zu", what.c_str(), done, total_);
  std::fflush(stderr);
}

}  // namespace mien::cli
