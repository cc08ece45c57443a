// SPDX-License-Identifier: MIT
#include "integrations/cli/io/output.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <process.h>
#else
#include <unistd.h>
#endif

#include "integrations/cli/io/failure.h"

namespace mien::cli {

namespace fs = std::filesystem;

namespace {

// The current temporary file, for the signal handler; empty if there is none.
char pending_file[4096];

extern "C" void remove_pending_file(int signal_number) {
  if (pending_file[0] != '\0') std::remove(pending_file);
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);
}

void remember_pending_file(const std::string& path) {
  if (path.size() >= sizeof(pending_file)) return;
  std::memcpy(pending_file, path.c_str(), path.size() + 1);
  std::signal(SIGINT, remove_pending_file);
  std::signal(SIGTERM, remove_pending_file);
#if !defined(_WIN32)
  std::signal(SIGHUP, remove_pending_file);
#endif
}

/// Signals that end the program wait while this lives: between creating a file and remembering its
/// name, one of them would leave the file behind.
class HeldSignals {
 public:
#if defined(_WIN32)
  HeldSignals() {}
#else
  HeldSignals() {
    sigset_t set;
    sigemptyset(&set);
    for (int number : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&set, number);
    sigprocmask(SIG_BLOCK, &set, &before_);
  }
  ~HeldSignals() { sigprocmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  sigset_t before_;
#endif
};

int process_id() {
#if defined(_WIN32)
  return _getpid();
#else
  return getpid();
#endif
}

void make_binary(FILE* stream) {
#if defined(_WIN32)
  _setmode(_fileno(stream), _O_BINARY);
#else
  static_cast<void>(stream);
#endif
}

}  // namespace

Output::Output(const std::string& path) : path_(path) {
  if (path == "-") {
    stream_ = stdout;
    make_binary(stdout);
    return;
  }
  if (path.empty())
    fail_usage("-o", "the name of the file is empty", "name a file, or - for standard output");

  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) fail_write(EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    stream_ = std::fopen(path.c_str(), "wb");
    if (!stream_) fail_write(errno);
    return;
  }

  // A link stays a link: the file that it points to is replaced.
  const fs::path target = fs::exists(status) ? fs::canonical(path, ignored) : fs::path(path);
  target_ = target.string();
  const HeldSignals held;
  // Process ids repeat, and a process that was killed may have left a file of that name.
  for (int attempt = 0; attempt < 100 && !stream_; ++attempt) {
    const std::string name =
        ".mien-" + std::to_string(process_id()) + "-" + std::to_string(attempt);
    temporary_ = (target.parent_path() / name).string();
    stream_ = std::fopen(temporary_.c_str(), "wbx");
    if (!stream_ && errno != EEXIST) break;
  }
  if (!stream_) fail_write(errno);
  remember_pending_file(temporary_);
  if (fs::exists(status)) fs::permissions(temporary_, status.permissions(), ignored);
}

Output::~Output() {
  if (stream_ && stream_ != stdout) std::fclose(stream_);
  if (!temporary_.empty()) std::remove(temporary_.c_str());
  pending_file[0] = '\0';
}

void Output::write(const void* bytes, size_t size) {
  if (size != 0 && std::fwrite(bytes, 1, size, stream_) != size) fail_write(errno);
}

void Output::commit() {
  if (std::fflush(stream_) != 0) fail_write(errno);
  if (stream_ == stdout) return;
  FILE* stream = stream_;
  stream_ = nullptr;
  if (std::fclose(stream) != 0) fail_write(errno);
  if (temporary_.empty()) return;
  std::error_code failed;
  fs::rename(temporary_, target_, failed);
  if (failed) fail_write(failed.value());
  temporary_.clear();
}

void Output::fail_write(int reason) const {
  fail(kFile, "cannot write", path_ == "-" ? "standard output" : path_, std::strerror(reason),
       "check the folder, its permissions and the space left");
}

void refuse_terminal(const std::string& path, const Session& session, const char* what) {
  if (path != "-" || !session.terminal.out_is_terminal) return;
  fail_usage("-o -", std::string(what) + " is not for a terminal",
             "name a file, or pipe the output");
}

std::string read_standard_input() {
  make_binary(stdin);
  std::string text;
  char block[65536];
  size_t count;
  while ((count = std::fread(block, 1, sizeof(block), stdin)) != 0) text.append(block, count);
  if (std::ferror(stdin)) {
    fail(kFile, "cannot read", "standard input", std::strerror(errno),
         "check the program before the pipe");
  }
  return text;
}

}  // namespace mien::cli
