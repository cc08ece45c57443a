// SPDX-License-Identifier: MIT
#include "integrations/program/commands/help_format.h"

#include <sstream>

namespace mien::cli {

namespace {

constexpr size_t kNameWidth = 26;

}  // namespace

std::string wrap(const std::string& text, size_t width) {
  std::string wrapped;
  size_t column = 0;  // of the paragraph that goes on; 0: none
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == ' ') {
      if (column != 0) wrapped += '\n';
      wrapped += line + '\n';
      column = 0;
      continue;
    }
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      if (column != 0 && column + 1 + word.size() > width) {
        wrapped += '\n';
        column = 0;
      } else if (column != 0) {
        wrapped += ' ';
        ++column;
      }
      wrapped += word;
      column += word.size();
    }
    // What a colon announces begins on a line of its own.
    if (!line.empty() && line.back() == ':') {
      wrapped += '\n';
      column = 0;
    }
  }
  if (column == 0 && !wrapped.empty()) wrapped.pop_back();
  return wrapped;
}

HelpFormatter::HelpFormatter() { column_width(kNameWidth); }

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return wrap(CLI::Formatter::make_description(app), kHelpWidth) + "\n";
}

std::string HelpFormatter::make_footer(const CLI::App* app) const {
  return wrap(CLI::Formatter::make_footer(app), kHelpWidth) + "\n";
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  return wrap(option->get_description(), kHelpWidth - kNameWidth);
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  std::ostringstream out;
  CLI::detail::format_help(out, command->get_name(),
                           wrap(command->get_description(), kHelpWidth - kNameWidth), kNameWidth);
  return out.str();
}

}  // namespace mien::cli
