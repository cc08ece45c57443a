// SPDX-License-Identifier: MIT
#include "integrations/cli/io/baked_file.h"

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "integrations/cli/io/output.h"
#include "integrations/cli/io/rig_file.h"

namespace mien::cli {

namespace {

constexpr char kMagic[] = "MIENBAKE";
constexpr size_t kMagicSize = sizeof(kMagic) - 1;

}  // namespace

bool is_baked_file(const std::string& path) {
  if (path == "-") {
    // One byte can be put back, and one is enough: a DNA file begins with D.
    const int first = std::getc(stdin);
    if (first != EOF) std::ungetc(first, stdin);
    return first == kMagic[0];
  }
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  char start[kMagicSize] = {};
  std::ifstream(path, std::ios::binary).read(start, sizeof(start));
  return std::memcmp(start, kMagic, kMagicSize) == 0;
}

bool is_baked_bytes(const std::string& bytes) { return bytes.compare(0, kMagicSize, kMagic) == 0; }

BakedFile open_baked_file(const std::string& path, const MienBakedDesc& desc) {
  BakedFile file;
  file.shown = shown_name(path);
  MienRig* rig = nullptr;
  auto error = sized<MienError>();
  MienStatus status;
  if (path == "-") {
    file.bytes = read_standard_input();
    status = mien_rig_open_memory(file.bytes.data(), file.bytes.size(), &desc, &rig, &error);
  } else {
    status = mien_rig_open_file(path.c_str(), &desc, &rig, &error);
  }
  check(status, &error, "cannot open baked file", file.shown);
  file.rig.reset(rig);
  return file;
}

}  // namespace mien::cli
