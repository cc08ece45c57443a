// SPDX-License-Identifier: MIT
// The array in an NPZ file: a ZIP file with one member, as numpy.savez() and numpy.savez_compressed() write it.
#pragma once

#include <string>

namespace mien::cli {

/// The bytes of the only member. Takes at most 16 MB plus 200 bytes for each byte of the file. Fails with kInvalid:
/// no ZIP file, several members, encrypted, another compression than Deflate, a size or checksum that is wrong.
std::string read_npz_member(const std::string& bytes, const std::string& path);

}  // namespace mien::cli
