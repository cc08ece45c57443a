// SPDX-License-Identifier: MIT
// The commands of `mien`: each adds itself to the parser and says what to run.
//
//     command line -> commands/ -> io/ (files, frames, JSON) -> mien.h
//                              \-> scene/ (a rig in a pose) -> render/ -> PNG
//                              \-> gltf/ -> GLB, OBJ
//     meshes -> mesh/ -> mien_author.h
//     captured motion -> solve -> mien_solve.h
//     DNA files -> edit/ (documents) -> mien_author.h; diff/ (two files)
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

#include "integrations/program/io/failure.h"
#include "integrations/program/io/handles.h"
#include "integrations/program/io/terminal.h"

namespace mien::cli {

/// Its options are parsed by `app`, then it is run.
struct Command {
  CLI::App* app;
  std::function<void()> run;
};

Command add_info_command(CLI::App& app, const Session& session);
Command add_validate_command(CLI::App& app, const Session& session);
Command add_accept_command(CLI::App& app, const Session& session);
Command add_eval_command(CLI::App& app, const Session& session);
Command add_bake_command(CLI::App& app, const Session& session);
Command add_convert_command(CLI::App& app, const Session& session);
Command add_edit_command(CLI::App& app, const Session& session);
Command add_diff_command(CLI::App& app, const Session& session);
Command add_export_command(CLI::App& app, const Session& session);
Command add_extract_command(CLI::App& app, const Session& session);
Command add_gen_command(CLI::App& app, const Session& session);
Command add_demo_head_command(CLI::App& app, const Session& session);
Command add_author_command(CLI::App& app, const Session& session);
Command add_clip_command(CLI::App& app, const Session& session);
Command add_play_command(CLI::App& app, const Session& session);
Command add_speak_command(CLI::App& app, const Session& session);
Command add_bench_command(CLI::App& app, const Session& session);
Command add_solve_command(CLI::App& app, const Session& session);
Command add_farm_command(CLI::App& app, const Session& session);
Command add_render_command(CLI::App& app, const Session& session);
Command add_inspect_command(CLI::App& app, const Session& session);
Command add_view_command(CLI::App& app, const Session& session);
Command add_completion_command(CLI::App& app);
Command add_help_command(CLI::App& app);

}  // namespace mien::cli
