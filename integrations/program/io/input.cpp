// SPDX-License-Identifier: MIT
#include "integrations/program/io/input.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#endif

#include "integrations/program/io/baked_file.h"
#include "integrations/program/io/failure.h"
#include "integrations/program/io/speech_input.h"

namespace mien::cli {

namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMaxWavBytes = uint64_t{1} << 30;

enum class Verdict { kWanted, kOther, kUndecided };

struct Limits {
  uint64_t bytes;
  const char* shown;       // of `bytes`
  const char* what_to_do;  // about more than that
  // What the bytes so far tell, those from `fresh` on being new. Reading ends with kOther.
  Verdict (*judge)(const std::string& text, size_t fresh);
};

struct CloseFile {
  void operator()(FILE* stream) const {
    if (stream != stdin) std::fclose(stream);
  }
};

[[noreturn]] void fail_read(const std::string& path, const std::string& what, int reason) {
  fail(kFile, what, shown_name(path), std::strerror(reason),
       path == "-" ? "check the program before the pipe" : "check the path and its permissions");
}

std::string read(const std::string& path, const std::string& what, const Limits& limits) {
  const std::unique_ptr<FILE, CloseFile> stream(path == "-" ? stdin
                                                            : std::fopen(path.c_str(), "rb"));
  if (!stream) fail_read(path, what, errno);
#if defined(_WIN32)
  _setmode(_fileno(stream.get()), _O_BINARY);
#endif
  const auto fail_size = [&] {
    fail(kInvalid, what, shown_name(path), std::string("it is larger than ") + limits.shown,
         limits.what_to_do);
  };
  std::error_code unknown;
  const uint64_t size = is_stream(path) ? 0 : fs::file_size(path, unknown);
  if (!unknown && size > limits.bytes) fail_size();
  std::string text;
  if (!unknown) text.reserve(size);
  char block[65536];
  size_t count;
  Verdict verdict = Verdict::kUndecided;
  while ((count = std::fread(block, 1, sizeof(block), stream.get())) != 0) {
    const size_t fresh = text.size();
    text.append(block, count);
    if (text.size() > limits.bytes) fail_size();
    if (verdict == Verdict::kUndecided) verdict = limits.judge(text, fresh);
    if (verdict == Verdict::kOther) return text;
  }
  if (std::ferror(stream.get())) fail_read(path, what, errno);
  return text;
}

}  // namespace

std::string shown_name(const std::string& path) { return path == "-" ? "standard input" : path; }

bool is_stream(const std::string& path) {
  if (path == "-") return true;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

std::string read_rig_stream(const std::string& path) {
  const auto judge = [](const std::string& text, size_t) {
    if (text.size() < 8) return Verdict::kUndecided;
    const bool package = text.compare(0, 4, "\xc1\x83\x2a\x9e") == 0;
    return text.compare(0, 3, "DNA") == 0 || is_baked_bytes(text) || package ? Verdict::kWanted
                                                                             : Verdict::kOther;
  };
  return read(path, "cannot read rig",
              {kMaxRigBytes, "4 GiB", "no rig is that large; check what was given", judge});
}

std::string read_any_bytes(const std::string& path, const std::string& what) {
  const auto judge = [](const std::string&, size_t) { return Verdict::kWanted; };
  return read(path, what, {kMaxRigBytes, "4 GiB", "write it to a file first", judge});
}

std::string read_viewable(const std::string& path) {
  const auto judge = [](const std::string& text, size_t) {
    if (text.size() < 8) return Verdict::kUndecided;
    return text.compare(0, 3, "DNA") == 0 || text.compare(0, 4, "glTF") == 0 || is_baked_bytes(text)
               ? Verdict::kWanted
               : Verdict::kOther;
  };
  return read(path, "cannot view",
              {kMaxMeshBytes, "2 GiB", "a page has no room for it; leave out LODs", judge});
}

std::string read_clip_stream(const std::string& path) {
  const auto judge = [](const std::string& text, size_t) {
    if (text.size() < 8) return Verdict::kUndecided;
    return text.compare(0, 7, "MIENCLP") == 0 ? Verdict::kWanted : Verdict::kOther;
  };
  return read(path, "cannot read clip",
              {kMaxClipBytes, "4 GiB", "no clip is that large; check what was given", judge});
}

std::string read_phonemes(const std::string& path) {
  const auto judge = [](const std::string& text, size_t fresh) {
    // UTF-16, by its mark, has bytes of 0.
    const bool is_wide = text.compare(0, 2, "\xFE\xFF") == 0 || text.compare(0, 2, "\xFF\xFE") == 0;
    if (is_wide) return Verdict::kWanted;
    return text.find('\0', fresh) == std::string::npos ? Verdict::kUndecided : Verdict::kOther;
  };
  return read(path, "cannot read phonemes",
              {kMaxTextBytes, "512 MiB", "give the phonemes part by part", judge});
}

std::string read_wav(const std::string& path) {
  const auto judge = [](const std::string& text, size_t) {
    if (text.size() < 12) return Verdict::kUndecided;
    return text.compare(0, 4, "RIFF") == 0 && text.compare(8, 4, "WAVE") == 0 ? Verdict::kWanted
                                                                              : Verdict::kOther;
  };
  return read(path, "cannot read sound", {kMaxWavBytes, "1 GiB", "cut it into parts", judge});
}

std::string read_text(const std::string& path, const std::string& what) {
  const auto judge = [](const std::string& text, size_t fresh) {
    return text.find('\0', fresh) == std::string::npos ? Verdict::kUndecided : Verdict::kOther;
  };
  return read(path, what, {kMaxTextBytes, "512 MiB", "split it into several files", judge});
}

std::string read_mesh_bytes(const std::string& path, const std::string& what) {
  const auto judge = [](const std::string& text, size_t fresh) {
    if (text.size() < 4) return Verdict::kUndecided;
    if (text.compare(0, 4, "glTF") == 0 || text.compare(0, 4, "MSHP") == 0) return Verdict::kWanted;
    return text.find('\0', fresh) == std::string::npos ? Verdict::kUndecided : Verdict::kOther;
  };
  return read(path, what, {kMaxMeshBytes, "2 GiB", "split it into several files", judge});
}

std::string read_json(const std::string& path, const std::string& what) {
  const auto judge = [](const std::string& text, size_t fresh) {
    const size_t first = text.find_first_not_of(" \t\r\n", fresh);
    if (first == std::string::npos) return Verdict::kUndecided;
    // A mark of UTF-8 may stand before it.
    return text[first] == '{' || text[first] == '\xef' ? Verdict::kWanted : Verdict::kOther;
  };
  return read(path, what, {kMaxJsonBytes, "512 MiB", "split it into several files", judge});
}

}  // namespace mien::cli
