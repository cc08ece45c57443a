// SPDX-License-Identifier: MIT
// The page that shows rigs, as `./dev web build` makes it or an installation has it.
#pragma once

#include <filesystem>
#include <string>

#include "integrations/program/view/viewer_server.h"

namespace mien::view {

/// The folder above that of the program, such as /usr; empty if it is unknown.
std::filesystem::path installed_folder();

/// The files of the page. `folder` is where it is, or empty: beside the program, installed or built.
Files load_page(const std::string& folder);

}  // namespace mien::view
