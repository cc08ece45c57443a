// SPDX-License-Identifier: MIT
// Where results go: standard output, or a file that appears completely or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "integrations/program/io/terminal.h"

namespace mien::cli {

class Fingerprint;

/// Writes to a temporary file in the folder of `path`, which commit() names so. Without commit() nothing
/// stays behind: where the system has files without names the temporary file is one, so not even a
/// killed process leaves it; elsewhere it goes with an interrupt. "-" and devices are written directly.
class Output {
 public:
  /// `content` may be null; it gets all bytes as they are written.
  explicit Output(const std::string& path, Fingerprint* content = nullptr);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void write(const void* bytes, size_t size);
  void write(const std::string& text) { write(text.data(), text.size()); }
  /// The bytes of the floats, as they are in memory. Returns the index of the first that is not finite, or `count`; then
  /// all are written, else none.
  size_t write_floats(const float* numbers, size_t count);

  /// Everything is on disk (or handed to standard output) when this returns.
  void commit();

  uint64_t size() const { return size_; }  // written so far

 private:
  [[noreturn]] void fail_write(int reason) const;
  /// Tries names for temporary_ until `create` makes a file of that name.
  void take_temporary_name(const std::function<bool()>& create);

  std::string path_;       // as given, for messages
  std::string target_;     // the file to replace; empty if written directly
  std::string temporary_;  // what commit() renames; empty while the file has no name
  std::filesystem::perms permissions_ = std::filesystem::perms::unknown;  // of the file to replace
  FILE* stream_ = nullptr;
  Fingerprint* content_;
  uint64_t size_ = 0;
};

/// Wrong usage if `path` is "-" and standard output is a terminal. `what` is "a DNA file", say.
void refuse_terminal(const std::string& path, const Session& session, const char* what);

/// Fails if the folder that `path` would be written to does not exist.
void refuse_missing_folder(const std::string& path);

/// A folder for several files, made if it is missing, and removed again if nothing was put into it.
class OutputFolder {
 public:
  explicit OutputFolder(const std::string& path);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  std::string file(const std::string& name) const;

 private:
  std::string path_;
  bool made_ = false;
};

/// -o and --force as they were typed.
struct OutputFile {
  std::string path;
  bool force = false;
};

/// Fails if the output is also one of the inputs, or read-only, unless it is forced.
void refuse_replacing(const OutputFile& output, const std::vector<std::string>& inputs);

}  // namespace mien::cli
