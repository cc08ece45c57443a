// SPDX-License-Identifier: MIT
#include "integrations/program/io/output.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <process.h>
#else
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include "integrations/program/io/failure.h"
#include "integrations/program/io/fingerprint.h"
#include "integrations/program/math/finite.h"

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

/// A file without a name, which vanishes with the process however that ends. Null where the system has
/// none.
FILE* open_unnamed(const fs::path& folder) {
#if defined(O_TMPFILE)
  const std::string name = folder.empty() ? "." : folder.string();
  const int file = open(name.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (file < 0) return nullptr;
  // It gets its name through this folder, see name_file().
  FILE* stream = access("/proc/self/fd", X_OK) == 0 ? fdopen(file, "wb") : nullptr;
  if (!stream) close(file);
  return stream;
#else
  static_cast<void>(folder);
  return nullptr;
#endif
}

/// Gives a name that is not taken to a file of open_unnamed().
bool name_file(FILE* stream, const std::string& name) {
#if defined(O_TMPFILE)
  const std::string open_file = "/proc/self/fd/" + std::to_string(fileno(stream));
  return linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
#else
  static_cast<void>(stream);
  static_cast<void>(name);
  return false;
#endif
}

/// Removes temporary files in the folder that processes which were killed left behind: of this user, not
/// touched for an hour (a folder may be shared with another machine, whose processes are not seen here).
void remove_abandoned_files(const fs::path& folder) {
#if !defined(_WIN32)
  constexpr auto kAge = std::chrono::hours(1);
  std::error_code failed;
  fs::directory_iterator entries(folder.empty() ? fs::path(".") : folder, failed);
  for (; !failed && entries != fs::directory_iterator(); entries.increment(failed)) {
    const std::string name = entries->path().filename().string();
    int process = 0, attempt = 0, end = 0;
    if (std::sscanf(name.c_str(), ".mien-%9d-%3d%n", &process, &attempt, &end) != 2) continue;
    if (static_cast<size_t>(end) != name.size() || process <= 0) continue;
    struct stat file;
    if (lstat(entries->path().c_str(), &file) != 0 || !S_ISREG(file.st_mode)) continue;
    const auto age =
        std::chrono::system_clock::now() - std::chrono::system_clock::from_time_t(file.st_mtime);
    const bool is_dead = kill(process, 0) != 0 && errno == ESRCH;
    if (is_dead && file.st_uid == geteuid() && age > kAge) unlink(entries->path().c_str());
  }
#else
  static_cast<void>(folder);
#endif
}

/// Like fwrite(), but large pieces go past the buffer of the stream: in one call of the system, and without a copy.
bool write_all(FILE* stream, const void* bytes, size_t size) {
#if !defined(_WIN32)
  constexpr size_t kLarge = 8192;
  if (size >= kLarge) {
    if (std::fflush(stream) != 0) return false;
    for (const char* at = static_cast<const char*>(bytes); size != 0;) {
      const ssize_t written = ::write(fileno(stream), at, size);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      at += written;
      size -= static_cast<size_t>(written);
    }
    return true;
  }
#endif
  return std::fwrite(bytes, 1, size, stream) == size;
}

void make_binary(FILE* stream) {
#if defined(_WIN32)
  _setmode(_fileno(stream), _O_BINARY);
#else
  static_cast<void>(stream);
#endif
}

}  // namespace

Output::Output(const std::string& path, Fingerprint* content) : path_(path), content_(content) {
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
  if (fs::exists(status)) permissions_ = status.permissions();
  stream_ = open_unnamed(target.parent_path());
  if (stream_) return;
  remove_abandoned_files(target.parent_path());
  take_temporary_name([&] {
    stream_ = std::fopen(temporary_.c_str(), "wbx");
    return stream_ != nullptr;
  });
}

void Output::take_temporary_name(const std::function<bool()>& create) {
  const HeldSignals held;
  const fs::path folder = fs::path(target_).parent_path();
  // Process ids repeat, and a process that was killed may have left a file of that name.
  for (int attempt = 0; attempt < 100; ++attempt) {
    const std::string name =
        ".mien-" + std::to_string(process_id()) + "-" + std::to_string(attempt);
    temporary_ = (folder / name).string();
    if (create()) {
      remember_pending_file(temporary_);
      return;
    }
    if (errno != EEXIST) break;
  }
  const int reason = errno;
  temporary_.clear();
  fail_write(reason);
}

Output::~Output() {
  if (stream_ && stream_ != stdout) std::fclose(stream_);
  if (!temporary_.empty()) std::remove(temporary_.c_str());
  pending_file[0] = '\0';
}

void Output::write(const void* bytes, size_t size) {
  if (size != 0 && !write_all(stream_, bytes, size)) fail_write(errno);
  if (content_) content_->add(bytes, size);
  size_ += size;
}

size_t Output::write_floats(const float* numbers, size_t count) {
  const size_t finite =
      content_ ? content_->add_floats(numbers, count) : math::finite_count(numbers, count);
  if (finite != count) return finite;
  if (count != 0 && !write_all(stream_, numbers, 4 * count)) fail_write(errno);
  size_ += 4 * count;
  return count;
}

void Output::commit() {
  if (std::fflush(stream_) != 0) fail_write(errno);
  if (stream_ == stdout) return;
  if (!target_.empty() && temporary_.empty()) {
    take_temporary_name([this] { return name_file(stream_, temporary_); });
  }
  FILE* stream = stream_;
  stream_ = nullptr;
  if (std::fclose(stream) != 0) fail_write(errno);
  if (target_.empty()) return;
  std::error_code failed;
  if (permissions_ != fs::perms::unknown) fs::permissions(temporary_, permissions_, failed);
  fs::rename(temporary_, target_, failed);
  if (failed) fail_write(failed.value());
  temporary_.clear();
}

void Output::fail_write(int reason) const {
  fail(kFile, "cannot write", path_ == "-" ? "standard output" : path_, std::strerror(reason),
       "check the folder, its permissions and the space left");
}

OutputFolder::OutputFolder(const std::string& path) : path_(path) {
  std::error_code reason;
  made_ = std::filesystem::create_directories(path, reason);
  if (!reason && std::filesystem::is_directory(path, reason)) return;
  fail(kFile, "cannot write", path, reason ? reason.message() : "this is not a folder",
       "name another folder");
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (made_) std::filesystem::remove(path_, ignored);  // fails if there is something in it
}

std::string OutputFolder::file(const std::string& name) const {
  return (std::filesystem::path(path_) / name).string();
}

void refuse_terminal(const std::string& path, const Session& session, const char* what) {
  if (path != "-" || !session.terminal.out_is_terminal) return;
  fail_usage("-o -", std::string(what) + " is not for a terminal",
             "name a file, or pipe the output");
}

void refuse_missing_folder(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  std::error_code reason;
  if (path == "-" || folder.empty() || fs::is_directory(folder, reason)) return;
  fail(kFile, "cannot write", path, "there is no folder " + folder.string(), "make it first");
}

void refuse_replacing(const OutputFile& output, const std::vector<std::string>& inputs) {
  std::error_code ignored;
  if (output.force || output.path == "-" || !fs::is_regular_file(output.path, ignored)) return;
  for (const std::string& input : inputs) {
    if (input != "-" && fs::equivalent(input, output.path, ignored)) {
      fail_usage("-o " + output.path, "this file is also an input",
                 "name another one, or replace it with --force");
    }
  }
  constexpr fs::perms kWrite =
      fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  const fs::perms permissions = fs::status(output.path, ignored).permissions();
  if ((permissions & kWrite) == fs::perms::none) {
    fail(kFile, "cannot write", output.path, "the file is read-only",
         "name another one, or replace it with --force");
  }
}

}  // namespace mien::cli
