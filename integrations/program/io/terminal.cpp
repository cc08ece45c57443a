// SPDX-License-Identifier: MIT
#include "integrations/program/io/terminal.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#if defined(_WIN32)
#include <io.h>
#else
#include <unistd.h>
#endif

#include "integrations/program/io/text.h"

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

void note_written(const Session& session, const std::string& path, uint64_t bytes) {
  if (!session.terminal.error_is_terminal || session.quiet || path == "-") return;
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - session.start;
  std::fprintf(stderr, "wrote %s, %s, %s\n", one_line(path).c_str(), size_text(bytes).c_str(),
               duration_text(time.count()).c_str());
}

Progress::Progress(const Session& session, std::string what, size_t total)
    : shown_(session.terminal.error_is_terminal && !session.quiet), what_(std::move(what)),
      total_(total), start_(Clock::now()), next_(start_ + std::chrono::seconds(1)) {
  if (!shown_ || total != 0) return;
  std::fprintf(stderr, "%s ...", what_.c_str());
  std::fflush(stderr);
}

Progress::~Progress() { finish(); }

void Progress::finish() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

bool Progress::is_due() {
  const Clock::time_point now = Clock::now();
  if (!shown_ || now < next_) return false;
  next_ = now + std::chrono::milliseconds(100);
  return true;
}

void Progress::at(size_t done) {
  if (total_ == 0 || !is_due()) return;
  const std::chrono::duration<double> time = Clock::now() - start_;
  const double rate = static_cast<double>(done) / time.count();
  char counts[96];
  std::snprintf(counts, sizeof(counts), "  %s/%s  %.*f/s", grouped(done).c_str(),
                grouped(total_).c_str(), rate < 10 ? 1 : 0, rate);
  show(static_cast<double>(done) / static_cast<double>(total_), counts);
}

void Progress::at_share(double share) {
  if (is_due()) show(share, "");
}

void Progress::show(double share, const std::string& counts) {
  constexpr size_t kBar = 20;
  share = std::min(std::max(share, 0.0), 1.0);
  const auto filled = static_cast<size_t>(share * kBar);
  std::string bar(filled, '=');
  if (filled < kBar) bar += '>';
  bar.resize(kBar, ' ');
  const std::chrono::duration<double> time = Clock::now() - start_;
  std::string left;
  if (share > 0) left = "  " + duration_text(time.count() * (1 - share) / share) + " left";
  std::fprintf(stderr, "\r\033[K%s  [%s] %3.0f %%%s%s", what_.c_str(), bar.c_str(), 100 * share,
               counts.c_str(), left.c_str());
  std::fflush(stderr);
}

}  // namespace mien::cli
