// SPDX-License-Identifier: MIT
// Inputs of `mien speak`, read as a whole: see input.h.
#pragma once

#include <string>

namespace mien::cli {

/// A file or stream of phonemes as text, in UTF-8 or UTF-16. Of other bytes the beginning is returned.
std::string read_phonemes(const std::string& path);

/// A file or stream that should hold a WAV file. Of another one the beginning is returned.
std::string read_wav(const std::string& path);

}  // namespace mien::cli
