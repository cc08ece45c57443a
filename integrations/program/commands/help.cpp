// SPDX-License-Identifier: MIT
// mien help: the help of the program, or of a command.
#include <algorithm>

#include "integrations/program/commands/options.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/output.h"

namespace mien::cli {

Command add_help_command(CLI::App& app) {
  auto names = std::make_shared<Words>();
  CLI::App* help = app.add_subcommand("help", "Show the help of a command");
  help->add_option("COMMAND", *names, "One of the commands, and its action")
      ->type_name("")
      ->expected(0, 2);
  return {help, [names, &app] {
            const CLI::App* command = &app;
            std::string parents = "mien", typed = "help";
            for (const std::string& name : *names) {
              const Words commands = command_names(*command);
              typed += " " + name;
              if (std::find(commands.begin(), commands.end(), name) == commands.end()) {
                fail_usage(typed, "there is no such command",
                           nearest_question(name, commands, "see 'mien --help'"));
              }
              if (command != &app) parents += " " + command->get_name();
              command = command->get_subcommand(name);
            }
            Output output("-");
            output.write(names->empty() ? app.get_formatter()->make_help(&app, "mien",
                                                                         CLI::AppFormatMode::Normal)
                                        : command->help(parents));
            output.commit();
          }};
}

}  // namespace mien::cli
