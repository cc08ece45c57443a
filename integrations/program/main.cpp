// SPDX-License-Identifier: MIT
// mien: a command line tool for facial rigs in DNA files.
#include <cstdio>
#include <new>

#include "integrations/program/commands/commands.h"
#include "integrations/program/commands/help_format.h"
#include "integrations/program/commands/options.h"
#include "integrations/program/io/nearest_name.h"

namespace mien::cli {

namespace {

std::string version_text() {
  const uint32_t version = mien_version();
  return "mien " + std::to_string(version >> 24) + "." + std::to_string(version >> 16 & 255) + "." +
         std::to_string(version & 0xffff);
}

/// May stand before the command or after it.
void add_quiet_option(CLI::App& app, Session& session) {
  app.add_flag("-q,--quiet", session.quiet, "Print no notes and no progress");
}

/// For a command and its actions.
template <class Do>
void for_each_command(CLI::App* command, const Do& what) {
  what(command);
  for (CLI::App* action : command->get_subcommands([](const CLI::App*) { return true; })) {
    for_each_command(action, what);
  }
}

/// An empty value (from an unset variable in a script, say) is an error.
void refuse_empty_values(CLI::App* command) {
  for (CLI::Option* option : command->get_options()) {
    if (option->get_expected_max() == 0 || option->get_type_size() == 0) continue;
    option->check(
        [](const std::string& value) { return value.empty() ? "the value is empty" : ""; });
  }
}

Words option_names(const CLI::App& command) {
  Words names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// An error of the parser, in our words.
[[noreturn]] void fail_parse(const CLI::App& app, const CLI::ParseError& error) {
  // The command that was reached: of a command with actions, the action.
  const CLI::App* reached = &app;
  std::string where;
  while (!reached->get_subcommands().empty()) {
    reached = reached->get_subcommands()[0];
    where += (where.empty() ? "" : " ") + reached->get_name();
  }
  const CLI::App& command = *reached;
  const bool lacks_command = !command_names(command).empty();
  const std::string help = "see 'mien " + where + (where.empty() ? "" : " ") + "--help'";
  const std::string what = "wrong usage";

  // If an option is mistyped, other errors follow from that.
  const std::vector<std::string> extras = app.remaining(true);
  for (const std::string& extra : extras) {
    if (extra.size() < 2 || extra[0] != '-') continue;
    fail(kUsage, what, where, "unknown option " + extra,
         nearest_question(extra, option_names(command), help));
  }
  if (lacks_command && !extras.empty()) {
    fail(kUsage, what, where, "unknown command " + extras[0],
         nearest_question(extras[0], command_names(command), help));
  }
  if (lacks_command) fail(kUsage, what, where, "no command is given", help);
  if (!extras.empty()) {
    fail(kUsage, what, where, "unexpected argument \"" + extras[0] + "\"", help);
  }
  fail(kUsage, what, where, error.what(), help);
}

int run(int argument_count, char** arguments, Session& session) {
  CLI::App app(
      "A tool for facial rigs in DNA files: inspect, check, evaluate, convert, render, export.",
      "mien");
  app.formatter(std::make_shared<HelpFormatter>());  // the commands inherit it
  app.set_help_flag("-h,--help", "Show this help");
  app.set_version_flag("--version", version_text(), "Show the version");
  add_quiet_option(app, session);
  app.require_subcommand(1);
  app.footer(
      "'mien help COMMAND' shows the options of a command, with examples.\n\n"
      "Exit codes: 0 success, 1 wrong usage, 2 invalid input, 3 a file cannot be read or written,\n"
      "4 out of memory or internal error.");

  const std::vector<Command> commands = {
      add_info_command(app, session),
      add_validate_command(app, session),
      add_accept_command(app, session),
      add_eval_command(app, session),
      add_convert_command(app, session),
      add_edit_command(app, session),
      add_diff_command(app, session),
      add_extract_command(app, session),
      add_gen_command(app, session),
      add_demo_head_command(app, session),
      add_author_command(app, session),
      add_export_command(app, session),
      add_render_command(app, session),
      add_inspect_command(app, session),
      add_bake_command(app, session),
      add_clip_command(app, session),
      add_speak_command(app, session),
      add_play_command(app, session),
      add_solve_command(app, session),
      add_farm_command(app, session),  // many tasks of the others
      add_view_command(app, session),
      add_bench_command(app, session),
      add_completion_command(app),
      add_help_command(app),
  };
  for (const Command& command : commands) {
    for_each_command(command.app, [&session](CLI::App* one) {
      add_quiet_option(*one, session);
      refuse_empty_values(one);
    });
  }

  if (argument_count == 1) {
    // As wrong usage, so that a script notices.
    std::fputs(app.help().c_str(), stdout);
    return kUsage;
  }
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    // --help and --version end here too.
    if (error.get_exit_code() == 0) return app.exit(error) == 0 ? kDone : kInternal;
    fail_parse(app, error);
  }
  for (const Command& command : commands) {
    if (command.app->parsed()) command.run();
  }
  return kDone;
}

}  // namespace

}  // namespace mien::cli

int main(int argument_count, char** arguments) {
  using namespace mien::cli;
  Session session;
  session.terminal = find_terminal();
  try {
    return run(argument_count, arguments, session);
  } catch (const Failure& failure) {
    print_failure(session, failure.what());
    return failure.exit_code;
  } catch (const std::bad_alloc&) {
    print_failure(session, "out of memory; free some memory");
  } catch (const std::exception& error) {
    print_failure(session, std::string("internal error: ") + error.what() + "; please report it");
  }
  return kInternal;
}
