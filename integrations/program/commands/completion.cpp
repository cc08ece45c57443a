// SPDX-License-Identifier: MIT
// mien completion: scripts for shells, made from the options that the program really has.
#include <algorithm>

#include "integrations/program/commands/options.h"
#include "integrations/program/io/output.h"

namespace mien::cli {

namespace {

struct CompletedOption {
  Words names;              // "-o", "--output"
  std::string description;  // its first line
  bool takes_value;
  Words values;  // empty: a file or a number
  bool takes_file;
};

struct CompletedCommand {
  std::string name, description;
  std::vector<CompletedOption> options;
  Words arguments;             // empty: files
  bool takes_actions = false;  // the arguments are the first, files follow
};

/// Words that an option offers in a command.
Words values_of(const std::string& command, const std::string& option) {
  if (option == "--names" && command != "info") return {};  // a file
  const Words& own = option_words(command + " " + option);
  Words words = own.empty() ? option_words(option) : own;
  if (command == "bench" && option == "--isa") words.push_back("all");
  if ((command == "eval" || command == "export") && option == "--lod") words.push_back("all");
  return words;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

void add_options(const CLI::App* command, CompletedCommand& words) {
  for (const CLI::Option* option : command->get_options()) {
    if (!option->nonpositional()) continue;
    CompletedOption entry;
    for (const std::string& name : option->get_snames()) entry.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) entry.names.push_back("--" + name);
    entry.description = first_line(option->get_description());
    entry.takes_value = option->get_expected_max() > 0 && option->get_type_size() > 0;
    if (entry.takes_value) entry.values = values_of(words.name, entry.names.back());
    const std::string& last = entry.names.back();
    entry.takes_file = last == "--output" || last == "--input" || last == "--frames" ||
                       last == "--animation" || (last == "--names" && entry.values.empty());
    const auto same = [&](const CompletedOption& other) { return other.names == entry.names; };
    if (std::any_of(words.options.begin(), words.options.end(), same)) continue;
    words.options.push_back(entry);
  }
}

CompletedCommand words_of(const CLI::App* command) {
  CompletedCommand words;
  words.name = command->get_name();
  words.description = command->get_description();
  if (words.name == "completion") words.arguments = option_words("SHELL");
  add_options(command, words);
  for (const CLI::App* action : command->get_subcommands([](const CLI::App*) { return true; })) {
    words.arguments.push_back(action->get_name());
    words.takes_actions = true;
    add_options(action, words);
  }
  return words;
}

std::string join(const Words& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

Words all_names(const CompletedCommand& command) {
  Words names;
  for (const CompletedOption& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

/// For the POSIX family of shells.
std::string shell_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + "'";
}

/// Descriptions within zsh's specs.
std::string without_specials(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    if (c == ':' || c == '[' || c == ']') plain += '\\';
    plain += c;
  }
  return plain;
}

std::string command_names(const std::vector<CompletedCommand>& commands) {
  Words names;
  for (const CompletedCommand& command : commands) names.push_back(command.name);
  return join(names, " ");
}

// bash ------------------------------------------------------------------------------------------

std::string bash_script(const std::vector<CompletedCommand>& commands) {
  std::string script =
      "# bash completion of mien: eval \"$(mien completion bash)\"\n"
      "_mien() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=\n"
      "  local i\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    if [[ ${COMP_WORDS[i]} != -* ]]; then command=${COMP_WORDS[i]}; break; fi\n"
      "  done\n"
      "  COMPREPLY=()\n"
      "  if [[ -z $command ]]; then\n"
      "    COMPREPLY=($(compgen -W '" +
      command_names(commands) +
      " --help --version --quiet' -- \"$word\"))\n"
      "    return\n"
      "  fi\n"
      "  case \"$command $before\" in\n";
  for (const CompletedCommand& command : commands) {
    for (const CompletedOption& option : command.options) {
      if (!option.takes_value) continue;
      Words patterns;
      for (const std::string& name : option.names)
        patterns.push_back("'" + command.name + " " + name + "'");
      script += "    " + join(patterns, " | ") + ")\n      ";
      if (!option.values.empty()) {
        script += "COMPREPLY=($(compgen -W '" + join(option.values, " ") + "' -- \"$word\"))";
      } else {
        script += option.takes_file ? "COMPREPLY=($(compgen -f -- \"$word\"))" : ":";
      }
      script += "\n      return ;;\n";
    }
  }
  script += "  esac\n  if [[ $word == -* ]]; then\n    case $command in\n";
  for (const CompletedCommand& command : commands) {
    script += "      " + command.name + ") COMPREPLY=($(compgen -W '" +
              join(all_names(command), " ") + "' -- \"$word\")) ;;\n";
  }
  script += "    esac\n    return\n  fi\n  case $command in\n";
  for (const CompletedCommand& command : commands) {
    if (command.arguments.empty()) continue;
    script += "    " + command.name + ") COMPREPLY=($(compgen " +
              (command.takes_actions ? "-f " : "") + "-W '" + join(command.arguments, " ") +
              "' -- \"$word\")) ;;\n";
  }
  script +=
      "    *) COMPREPLY=($(compgen -f -- \"$word\")) ;;\n"
      "  esac\n"
      "}\n"
      "complete -o filenames -F _mien mien\n";
  return script;
}

// zsh -------------------------------------------------------------------------------------------

std::string zsh_script(const std::vector<CompletedCommand>& commands) {
  std::string script =
      "#compdef mien\n"
      "# zsh completion of mien: mien completion zsh > a folder of $fpath, under the name _mien\n"
      "_mien() {\n"
      "  local -a commands\n"
      "  commands=(\n";
  for (const CompletedCommand& command : commands) {
    script +=
        "    " + shell_quoted(command.name + ":" + without_specials(command.description)) + "\n";
  }
  script +=
      "  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe -t commands command commands\n"
      "    return\n"
      "  fi\n"
      "  local command=${words[2]}\n"
      "  shift words\n"
      "  (( CURRENT-- ))\n"
      "  case $command in\n";
  for (const CompletedCommand& command : commands) {
    script += "    " + command.name + ")\n      _arguments";
    for (const CompletedOption& option : command.options) {
      for (const std::string& name : option.names) {
        std::string spec = name + "[" + without_specials(option.description) + "]";
        if (option.takes_value) {
          spec += ":value:";
          if (!option.values.empty()) {
            spec += "(" + join(option.values, " ") + ")";
          } else if (option.takes_file) {
            spec += "_files";
          }
        }
        script += " \\\n        " + shell_quoted(spec);
      }
    }
    const std::string list = "(" + join(command.arguments, " ") + ")";
    if (command.takes_actions) script += " \\\n        " + shell_quoted("1:action:" + list);
    const bool files = command.arguments.empty() || command.takes_actions;
    script += " \\\n        " + shell_quoted("*:argument:" + (files ? "_files" : list)) + " ;;\n";
  }
  script +=
      "  esac\n"
      "}\n"
      "if [[ ${funcstack[1]} == _mien ]]; then _mien \"$@\"; else compdef _mien mien; fi\n";
  return script;
}

// fish ------------------------------------------------------------------------------------------

/// Single quotes of fish know a backslash only before a quote or a backslash.
std::string fish_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "'";
}

std::string fish_script(const std::vector<CompletedCommand>& commands) {
  std::string script =
      "# fish completion of mien: mien completion fish | source\n"
      "complete -c mien -n __fish_use_subcommand -l version -d 'Show the version'\n";
  for (const CompletedCommand& command : commands) {
    script += "complete -c mien -f -n __fish_use_subcommand -a " + command.name + " -d " +
              fish_quoted(command.description) + "\n";
  }
  for (const CompletedCommand& command : commands) {
    const std::string start =
        "complete -c mien -n '__fish_seen_subcommand_from " + command.name + "'";
    for (const CompletedOption& option : command.options) {
      script += start;
      for (const std::string& name : option.names) {
        script += name[1] == '-' ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (option.takes_value) script += option.takes_file ? " -r -F" : " -x";
      if (!option.values.empty()) script += " -a " + fish_quoted(join(option.values, " "));
      script += " -d " + fish_quoted(option.description) + "\n";
    }
    if (!command.arguments.empty()) {
      script += start + (command.takes_actions ? " -a " : " -f -a ") +
                fish_quoted(join(command.arguments, " ")) + "\n";
    }
  }
  return script;
}

void run(const std::string& shell, const CLI::App& app) {
  const size_t index = parse_word("SHELL", shell);
  std::vector<CompletedCommand> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(words_of(command));
    if (commands.back().name == "help") commands.back().arguments = cli::command_names(app);
  }
  Output output("-");
  output.write(index == 0   ? bash_script(commands)
               : index == 1 ? zsh_script(commands)
                            : fish_script(commands));
  output.commit();
}

}  // namespace

Command add_completion_command(CLI::App& app) {
  auto shell = std::make_shared<std::string>();
  CLI::App* completion = app.add_subcommand("completion", "Print a completion script for a shell");
  completion->add_option("SHELL", *shell, "bash, zsh or fish")->type_name("")->required();
  completion->footer(
      "Examples:\n"
      "  eval \"$(mien completion bash)\"\n"
      "  mien completion zsh > ~/.zfunc/_mien\n"
      "  mien completion fish > ~/.config/fish/completions/mien.fish");
  return {completion, [shell, &app] { run(*shell, app); }};
}

}  // namespace mien::cli
