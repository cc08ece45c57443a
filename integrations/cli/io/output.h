// SPDX-License-Identifier: MIT
// Where results go: standard output, or a file that appears completely or not at all.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

#include "integrations/cli/io/terminal.h"

namespace mien::cli {

/// Writes to a temporary file beside `path`, which commit() renames. Without commit() nothing stays
/// behind, not even after an interrupt. "-" and devices are written directly.
class Output {
 public:
  explicit Output(const std::string& path);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void write(const void* bytes, size_t size);
  void write(const std::string& text) { write(text.data(), text.size()); }

  /// Everything is on disk (or handed to standard output) when this returns.
  void commit();

 private:
  [[noreturn]] void fail_write(int reason) const;

  std::string path_;       // as given, for messages
  std::string target_;     // the file to replace; empty if written directly
  std::string temporary_;  // written until commit() renames it
  FILE* stream_ = nullptr;
};

/// Wrong usage if `path` is "-" and standard output is a terminal. `what` is "a DNA file", say.
void refuse_terminal(const std::string& path, const Session& session, const char* what);

/// All bytes of standard input.
std::string read_standard_input();

}  // namespace mien::cli
