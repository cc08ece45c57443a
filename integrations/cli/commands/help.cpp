// SPDX-License-Identifier: MIT
// mien help: the help of the program, or of a command.
#include <algorithm>

#include "integrations/cli/commands/options.h"
#include "integrations/cli/io/nearest_name.h"
#include "integrations/cli/io/output.h"

namespace mien::cli {

Command add_help_command(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  CLI::App* help = app.add_subcommand("help", "Show the help of a command");
  help->add_option("COMMAND", *name, "One of the commands")->type_name("");
  return {help, [name, &app] {
            const Words commands = command_names(app);
            if (!name->empty() &&
                std::find(commands.begin(), commands.end(), *name) == commands.end()) {
              fail_usage("help " + *name, "there is no such command",
                         nearest_question(*name, commands, "see 'mien --help'"));
            }
            Output output("-");
            output.write(name->empty() ? app.get_formatter()->make_help(&app, "mien",
                                                                        CLI::AppFormatMode::Normal)
                                       : app.get_subcommand(*name)->help("mien"));
            output.commit();
          }};
}

}  // namespace mien::cli
