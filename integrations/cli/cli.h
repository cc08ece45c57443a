// SPDX-License-Identifier: MIT
// What the commands of the `mien` program share: how they are registered, how they fail, and the
// handles of the library as owners.
//
//     main.cpp -> one file per command -> rig_file, fields, frames, output, json_writer, terminal
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "capi/mien.h"
#include "integrations/cli/terminal.h"

namespace mien::cli {

enum ExitCode : int {
  kDone = 0,
  kUsage = 1,     // the command line is wrong
  kInvalid = 2,   // the input is malformed, inconsistent or unsupported
  kFile = 3,      // a file cannot be read or written
  kInternal = 4,  // out of memory, or a mistake in this program
};

/// Ends the program with an exit code and one line on standard error.
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

/// The family of a status, as an exit code.
ExitCode exit_code_of(MienStatus status);

/// Throws unless `status` is MIEN_OK. `file` is the name to show; `error` may be null.
void check(MienStatus status, const MienError* error, const std::string& what,
           const std::string& file);

/// A struct of the library, zeroed, with its size set.
template <class T>
T sized() {
  T value{};
  value.struct_size = sizeof(T);
  return value;
}

template <class T, void (*destroy)(T*)>
struct Destroy {
  void operator()(T* handle) const { destroy(handle); }
};
using Dna = std::unique_ptr<MienDna, Destroy<MienDna, mien_dna_close>>;
using Rig = std::unique_ptr<MienRig, Destroy<MienRig, mien_rig_destroy>>;
using Instance = std::unique_ptr<MienInstance, Destroy<MienInstance, mien_instance_destroy>>;
using Batch = std::unique_ptr<MienBatch, Destroy<MienBatch, mien_batch_destroy>>;
using Report = std::unique_ptr<MienReport, Destroy<MienReport, mien_report_destroy>>;

inline std::string to_string(MienStringView view) { return std::string(view.data, view.count); }

/// What all commands see of the surroundings.
struct Session {
  bool quiet = false;
  Terminal terminal;
};

/// A command: its options are parsed by `app`, then it is run.
struct Command {
  CLI::App* app;
  std::function<void()> run;
};

Command add_info_command(CLI::App& app, const Session& session);
Command add_validate_command(CLI::App& app, const Session& session);
Command add_eval_command(CLI::App& app, const Session& session);
Command add_bake_command(CLI::App& app, const Session& session);
Command add_convert_command(CLI::App& app, const Session& session);
Command add_export_command(CLI::App& app, const Session& session);
Command add_gen_command(CLI::App& app, const Session& session);
Command add_demo_head_command(CLI::App& app, const Session& session);
Command add_bench_command(CLI::App& app, const Session& session);
Command add_render_command(CLI::App& app, const Session& session);
Command add_inspect_command(CLI::App& app, const Session& session);
Command add_completion_command(CLI::App& app);

}  // namespace mien::cli
