// SPDX-License-Identifier: MIT
// How a command ends without success: an exit code, and one line on standard error.
#pragma once

#include <mien.h>

#include <stdexcept>
#include <string>

namespace mien::cli {

enum ExitCode : int {
  kDone = 0,
  kUsage = 1,     // the command line is wrong
  kInvalid = 2,   // the input is malformed, inconsistent or unsupported
  kFile = 3,      // a file cannot be read or written
  kInternal = 4,  // out of memory, or a bug in this program
};

/// Thrown anywhere, caught in main().
struct Failure : std::runtime_error {
  Failure(ExitCode code, const std::string& line) : std::runtime_error(line), exit_code(code) {}
  ExitCode exit_code;
};

/// "what, where: why; what_to_do". `where` and `what_to_do` may be empty.
[[noreturn]] void fail(ExitCode code, const std::string& what, const std::string& where,
                       const std::string& why, const std::string& what_to_do);

/// Wrong usage of an option: "--lod x: why; what_to_do".
[[noreturn]] void fail_usage(const std::string& option, const std::string& why,
                             const std::string& what_to_do);

/// The exit code for a status of the library.
ExitCode exit_code_of(MienStatus status);

/// Fails unless `status` is MIEN_OK. `file` is the name to show; `error` may be null; `what_to_do` is
/// said of invalid values in place of what is usual.
void check(MienStatus status, const MienError* error, const std::string& what,
           const std::string& file, const std::string& what_to_do = "");

}  // namespace mien::cli
