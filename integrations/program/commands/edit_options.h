// SPDX-License-Identifier: MIT
// What `mien edit` can do: one table for the command line, for scripts, and for the help.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/edit/document.h"

namespace mien::cli {

/// An option as it was typed: {"--rename", "joint:a=b"}.
struct Edit {
  std::string option, value;
  std::string script;  // the file that it comes from; empty: the command line
};

struct EditOption {
  const char* name;
  const char* type_name;
  const char* group;
  const char* text;
  /// Changes the document and says what it did. Null: the option belongs to the one before it.
  std::string (*apply)(Document& document, const std::string& value);
};

const std::vector<EditOption>& edit_options();

/// Makes one edit of options that belong together: "--make-lod N --from M". Wrong usage if one is alone.
std::vector<Edit> join_options(const std::vector<Edit>& edits);

/// Applies edits one after the other; returns a sentence for each. Wrong values in scripts are invalid input.
std::vector<std::string> apply_edits(Document& document, const std::vector<Edit>& edits);

/// A list of lists of words, [["--rename", "joint:a=b"], ["--scale", "2"]]; joined.
std::vector<Edit> read_edit_script(const std::string& path);

}  // namespace mien::cli
