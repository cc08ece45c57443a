// SPDX-License-Identifier: MIT
// Inputs that are read as a whole: standard input, pipes, devices, and JSON. Each has a limit, so that an
// endless input gives an error instead of using up all memory.
#pragma once

#include <cstdint>
#include <string>

namespace mien::cli {

// Offsets in DNA files have 32 bits.
constexpr uint64_t kMaxRigBytes = uint64_t{4} << 30;
constexpr uint64_t kMaxJsonBytes = uint64_t{512} << 20;
constexpr uint64_t kMaxTextBytes = kMaxJsonBytes;
constexpr uint64_t kMaxClipBytes = uint64_t{4} << 30;
constexpr uint64_t kMaxMeshBytes = uint64_t{2} << 30;

/// "standard input" for "-".
std::string shown_name(const std::string& path);

/// Whether `path` has to be read from its beginning to its end: "-", a pipe, a device.
bool is_stream(const std::string& path);

/// The bytes of a stream that should hold a DNA file, a baked file or an Unreal package. Of another one the
/// beginning is returned, for the library to refuse.
std::string read_rig_stream(const std::string& path);

/// All bytes of a stream, whatever they are.
std::string read_any_bytes(const std::string& path, const std::string& what);

/// A file or stream that should hold a DNA file, a baked file or a GLB. Of another one the beginning is
/// returned.
std::string read_viewable(const std::string& path);

/// The bytes of a stream that should hold a clip. Of another one the beginning is returned.
std::string read_clip_stream(const std::string& path);

/// A file or stream of text, such as a take. If the bytes are not text, the beginning is returned.
std::string read_text(const std::string& path, const std::string& what);

/// A file or stream that should hold a mesh or shapes: GLB, .mshp, or text. Of other bytes the beginning
/// is returned.
std::string read_mesh_bytes(const std::string& path, const std::string& what);

/// A file or stream of JSON with an object in it. Of anything else the beginning is returned.
std::string read_json(const std::string& path, const std::string& what);

}  // namespace mien::cli
