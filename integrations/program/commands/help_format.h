// SPDX-License-Identifier: MIT
// How help is laid out: lines of at most kHelpWidth characters.
#pragma once

#include <string>

#include "integrations/program/commands/commands.h"

namespace mien::cli {

constexpr size_t kHelpWidth = 80;

/// Breaks paragraphs into lines of at most `width` characters. Indented lines stay as they are.
std::string wrap(const std::string& text, size_t width);

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();

 private:
  std::string make_description(const CLI::App* app) const override;
  std::string make_footer(const CLI::App* app) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

}  // namespace mien::cli
