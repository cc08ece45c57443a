// SPDX-License-Identifier: MIT
// What `mien view` opens after the rig: takes, scenes and sounds.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/io/terminal.h"
#include "integrations/program/view/viewer_server.h"

namespace mien::cli {

/// Reads the files, and what scenes among them name: clips, and the takes and the sound of what they say. Adds all to
/// `files` and returns their part of the page's address.
std::string serve_takes(const std::vector<std::string>& paths, view::Files& files,
                        const Session& session);

/// Everything but letters, digits and - . _ ~ as %XX.
std::string url_encoded(const std::string& text);

}  // namespace mien::cli
